//! `prose`: code quoted in documents and comments, with the line it starts on.

use match_tests::workspace::Source;

/// Quoted code, which may span lines, and the lines of fenced blocks.
pub(crate) struct Quoted {
    /// Between backquotes, in the order of the text.
    pub(crate) spans: Vec<(usize, String)>,
    /// Lines between fences.
    pub(crate) fenced: Vec<(usize, String)>,
}

impl Quoted {
    /// The code quoted in a document, or in the comments of a source; nothing of other files.
    pub(crate) fn of(source: &Source) -> Self {
        let extension = source.path.rsplit('.').next().unwrap_or_default();
        let mut quoted = Self { spans: Vec::new(), fenced: Vec::new() };
        let (mut block, mut begins, mut in_fence) = (String::new(), 1, false);
        for (number, line) in (1..).zip(source.text.lines()) {
            let Some((description, alone)) = comment(extension, line) else {
                quoted.take(&mut block, begins);
                in_fence = false;
                continue;
            };
            let fence = description.trim_start().starts_with("```");
            if fence {
                quoted.take(&mut block, begins);
                in_fence = !in_fence;
            } else if in_fence {
                quoted.fenced.push((number, description.to_owned()));
            } else {
                // A paragraph, a row of a table and an item of a list each end an open quote.
                let fresh =
                    description.trim().is_empty() || description.trim_start().starts_with(['|', '-', '#']);
                if !alone || fresh {
                    quoted.take(&mut block, begins);
                }
                if block.is_empty() {
                    begins = number;
                }
                block.push_str(description);
                block.push('\n');
            }
        }
        quoted.take(&mut block, begins);
        quoted
    }

    fn take(&mut self, block: &mut String, begins: usize) {
        let mut rest = block.as_str();
        while let Some(open) = rest.find('`') {
            let run = rest[open..].len() - rest[open..].trim_start_matches('`').len();
            let inner = &rest[open + run..];
            let Some(close) = closing(inner, run) else { break };
            let line = begins + block[..block.len() - inner.len()].matches('\n').count();
            self.spans.push((line, inner[..close].replace('\n', " ")));
            rest = &inner[close + run..];
        }
        block.clear();
    }
}

/// Start of the next run of exactly `run` backquotes.
fn closing(text: &str, run: usize) -> Option<usize> {
    let mut at = 0;
    while let Some(found) = text[at..].find('`') {
        let start = at + found;
        let length = text[start..].len() - text[start..].trim_start_matches('`').len();
        if length == run {
            return Some(start);
        }
        at = start + length;
    }
    None
}

/// A line's comment text, and whether there is nothing else in the line.
fn comment<'a>(extension: &str, line: &'a str) -> Option<(&'a str, bool)> {
    let sign = match extension {
        "md" => return Some((line, true)),
        "rs" => "//",
        "toml" => "#",
        _ => return None,
    };
    let (code, description) = line.split_once(sign)?;
    let description = description.trim_start_matches(['/', '!']);
    Some((description.strip_prefix(' ').unwrap_or(description), code.trim().is_empty()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn code_spans_are_found_across_lines_and_in_fences() {
        let text = "//! Uses `a b\n//! c` and ``d ` e``.\nlet x = 1; // `f`\nlet y = '`';\n/// ```sh\n/// g\n/// ```\n";
        let quoted = Quoted::of(&Source { path: "x.rs".into(), text: text.into() });
        let spans = [(1, "a b c"), (2, "d ` e"), (3, "f")].map(|(line, span)| (line, span.to_owned()));
        assert_eq!((quoted.spans, quoted.fenced), (spans.to_vec(), vec![(6, "g".to_owned())]));
        let table = Quoted::of(&Source { path: "x.md".into(), text: "| ` | `a` |\n| `b` |\n".into() });
        assert_eq!(table.spans.last(), Some(&(2, "b".to_owned())));
    }
}
