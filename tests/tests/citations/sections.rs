//! `sections`: citations of numbered sections and of the papers' marks.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use match_tests::workspace::{Finding, Source, root};

use crate::is_document;

/// The numbered sections of a page, by its path from the root.
pub(crate) struct Sections(BTreeMap<String, BTreeSet<String>>);

impl Sections {
    /// Those of all pages in `docs`.
    pub(crate) fn read() -> Self {
        let names = std::fs::read_dir(root().join("docs")).expect("docs is there").flatten();
        let names = names.map(|entry| entry.file_name().to_string_lossy().into_owned());
        let pages = names
            .filter(|name| Path::new(name).extension().is_some_and(|extension| extension == "md"))
            .map(|name| page(&format!("docs/{name}")));
        Self(pages.map(|page| (page.path, numbered(&page.text))).collect())
    }

    /// Citations of sections that do not exist.
    pub(crate) fn dangling(&self, source: &Source) -> Vec<Finding> {
        let text = joined(source);
        let mut findings = Vec::new();
        for (at, _) in text.match_indices(".md") {
            let after = &text[at + 3..];
            let Some(list) = cited_list(after) else { continue };
            let start = text[..at]
                .rfind(|c: char| !is_path(c))
                .map_or(0, |before| before + text[before..].chars().next().map_or(1, char::len_utf8));
            let name = &text[start..at + 3];
            // Pages cite their neighbours without the directory.
            let page = if name.contains('/') { name.to_owned() } else { format!("docs/{name}") };
            // `[page](page) §1` is one citation, not two.
            if text[..start].ends_with("](") {
                continue;
            }
            let line = line_of(&text, at);
            let Some(known) = self.0.get(page.trim_start_matches("../")) else {
                findings.push(source.at(line, &format!("`{name}` has no sections"), "cite a page of docs"));
                continue;
            };
            for section in list.into_iter().filter(|section| !known.contains(section)) {
                findings.push(source.at(
                    line,
                    &format!("{page} has no §{section}"),
                    "cite a section that is there",
                ));
            }
        }
        findings
    }
}

/// The numbers of headings such as `## 4. Actions` and `### 3.1 Ball path`.
fn numbered(text: &str) -> BTreeSet<String> {
    let headings = text.lines().filter_map(|line| line.strip_prefix("##"));
    let numbers = headings.filter_map(|line| line.trim_start_matches('#').split_whitespace().next());
    let numbers = numbers.map(|number| number.trim_end_matches('.').to_owned());
    numbers.filter(|number| number.starts_with(|first: char| first.is_ascii_digit())).collect()
}

/// The sections listed after a page's name: ` §3.1, §4 and §5–§7`; `None` where none is cited.
fn cited_list(after: &str) -> Option<Vec<String>> {
    // The remainder of a link or of code around the name.
    let mut rest = after.trim_start_matches(['`', ')']);
    if let Some(link) = rest.strip_prefix("](") {
        rest = link.split_once(')')?.1;
    }
    rest = rest.trim_start_matches([' ', NEWLINE]).strip_prefix('§')?;
    let mut list = Vec::new();
    loop {
        let end = rest.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(rest.len());
        list.push(rest[..end].trim_end_matches('.').to_owned());
        rest = &rest[end..];
        let between = [", §", " and §", "–§", ",\u{1}§", "\u{1}and §", " and\u{1}§"];
        match between.into_iter().find_map(|between| rest.strip_prefix(between)) {
            Some(next) => rest = next,
            None => return Some(list),
        }
    }
}

/// The marks of docs/papers.md: R1, D24.
pub(crate) struct Marks(BTreeSet<String>);

impl Marks {
    pub(crate) fn read() -> Self {
        let rows = page("docs/papers.md").text;
        let marks = rows.lines().filter_map(|line| line.strip_prefix("| ")?.split(' ').next());
        Self(marks.filter(|label| is_mark(label)).map(str::to_owned).collect())
    }

    /// Marks in comments that do not exist on the page.
    pub(crate) fn dangling(&self, source: &Source) -> Vec<Finding> {
        let mut findings = Vec::new();
        for (number, line) in (1..).zip(source.text.lines()) {
            let Some((_, comment)) = line.split_once("//") else { continue };
            let words = comment.split(|c: char| !c.is_alphanumeric() && c != '_');
            for mark in words.filter(|label| is_mark(label)).filter(|label| !self.0.contains(*label)) {
                let fix = "docs/papers.md has them all; a pin or a domain is written otherwise";
                findings.push(source.at(number, &format!("no mark `{mark}`"), fix));
            }
        }
        findings
    }
}

fn is_mark(label: &str) -> bool {
    label.strip_prefix(['R', 'D']).is_some_and(|number| {
        (1..=2).contains(&number.len()) && number.bytes().all(|byte| byte.is_ascii_digit())
    })
}

/// Citations of files outside the repository.
pub(crate) fn outside(source: &Source) -> Vec<Finding> {
    let fix = "cite a section of docs, or say it here";
    let mut findings = Vec::new();
    for (number, line) in (1..).zip(source.text.lines()) {
        for label in OUTSIDE {
            let whole = line.match_indices(label).any(|(at, _)| {
                let letter = |c: char| c.is_alphanumeric();
                !line[..at].ends_with(letter) && !line[at + label.len()..].starts_with(letter)
            });
            if whole {
                findings.push(source.at(number, &format!("`{label}`"), fix));
            }
        }
        let numbered = |label: &str| {
            line.match_indices(label)
                .any(|(at, _)| line[at + label.len()..].starts_with(|c: char| c.is_ascii_digit()))
        };
        if ISSUES.into_iter().any(numbered) {
            findings.push(source.at(number, "an issue by its number", fix));
        }
    }
    findings
}

/// Written in parts, so that the check does not find this file.
const OUTSIDE: [&str; 4] = [
    concat!("DES", "IGN"),
    concat!("papers-check", "list"),
    concat!("check", "list"),
    concat!("shared/", "reference"),
];
const ISSUES: [&str; 3] = [concat!("issue", " "), concat!("Issue", " "), concat!("issue", " #")];

pub(crate) fn page(path: &str) -> Source {
    Source::read(&root().join(path))
}

/// The text with comment lines joined, so that a citation may break at a line's end.
fn joined(source: &Source) -> String {
    let mut text = String::with_capacity(source.text.len());
    for line in source.text.lines() {
        let bare = line.trim_start();
        let comment = ["//! ", "/// ", "// ", "# "].into_iter().find_map(|sign| bare.strip_prefix(sign));
        if let Some(description) = comment.filter(|_| !text.is_empty() && !is_document(source)) {
            text.push(NEWLINE);
            text.push_str(description);
        } else {
            text.push('\n');
            text.push_str(line);
        }
    }
    text
}

/// Line number, from 1; the text of [`joined`] starts with a line's end unless a comment opens the file.
fn line_of(text: &str, at: usize) -> usize {
    text[..at].matches(['\n', NEWLINE]).count().max(1)
}

fn is_path(c: char) -> bool {
    c.is_ascii_alphanumeric() || matches!(c, '_' | '-' | '.' | '/')
}

/// Marks the end of a line within a comment.
const NEWLINE: char = '\u{1}';

#[cfg(test)]
mod tests {
    use super::*;

    fn source(text: &str) -> Source {
        Source { path: "x.rs".into(), text: text.into() }
    }

    fn lines(findings: &[Finding]) -> Vec<usize> {
        findings.iter().map(|finding| finding.line).collect()
    }

    #[test]
    fn a_section_that_is_not_there_is_found_in_lists_ranges_and_broken_lines() {
        let sections = Sections(BTreeMap::from([(
            "docs/a\u{2e}md".to_owned(),
            numbered("# A\n## 1. One\n### 1.1 Part\n## 2. Two\n"),
        )]));
        let text = "// docs/a\u{2e}md §1, §1.1 and §2.\nlet x = 1; // docs/a\u{2e}md §1–§3\n/// (docs/a\u{2e}md §2,\n/// §4)\n// docs/b\u{2e}md §1\n";
        assert_eq!(lines(&sections.dangling(&source(text))), [2, 3, 5]);
        let linked = source("[a\u{2e}md §2](a\u{2e}md#2-two), [a\u{2e}md](a\u{2e}md) §7, a\u{2e}md alone\n");
        assert_eq!(sections.dangling(&linked).len(), 1);
    }

    #[test]
    fn a_mark_that_is_not_there_is_found_and_other_words_are_none() {
        let marks = Marks(BTreeSet::from(["R1".to_owned(), "D24".to_owned()]));
        let text = "// (docs/papers.md R1, D24)\nlet r99 = PD12; // pin PD12, R100\n/// R2 (D3)\n";
        assert_eq!(lines(&marks.dangling(&source(text))), [3, 3]);
    }

    #[test]
    fn what_is_not_in_the_repository_is_found() {
        let text = [concat!("// DES", "IGN §2"), "DESIGNATED", concat!("see iss", "ue 17"), "no issue"];
        assert_eq!(lines(&outside(&source(&text.join("\n")))), [1, 3]);
    }
}
