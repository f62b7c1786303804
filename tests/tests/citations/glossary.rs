//! `glossary`: terms of docs/glossary.md and the names that carry them.

use std::collections::{BTreeMap, BTreeSet};

use match_tests::workspace::{Finding, Source, members, rust_sources};

use crate::prose::Quoted;

/// What each crate defines, by the crate's name in paths.
pub(crate) struct Names(BTreeMap<String, BTreeSet<String>>);

impl Names {
    pub(crate) fn read() -> Self {
        let sources = rust_sources();
        let of = |directory: &str| {
            let own = format!("{directory}/src/");
            let sources = sources.iter().filter(|source| source.path.starts_with(&own));
            sources.flat_map(|source| defined(&source.text)).collect()
        };
        Self(
            members()
                .into_iter()
                .map(|crate_| (crate_.name.replace('-', "_"), of(&crate_.directory)))
                .collect(),
        )
    }

    fn has(&self, path: &str) -> bool {
        let (name, rest) = path.split_once("::").unwrap_or((path, ""));
        let last = rest.rsplit("::").next().unwrap_or_default();
        let Some(known) = self.0.get(&name.replace('-', "_")) else { return false };
        rest.is_empty() || known.contains(last)
    }
}

fn defined(text: &str) -> impl Iterator<Item = String> {
    text.lines().filter_map(|line| {
        let mut words = line.split_whitespace().skip_while(|label| {
            label.starts_with("pub") || matches!(*label, "unsafe" | "async") || label.starts_with("#[")
        });
        let kind = words.next()?;
        let kinds = ["struct", "enum", "trait", "fn", "mod", "const", "static", "type"];
        let name = words.next().filter(|_| kinds.contains(&kind))?;
        let name = if name == "fn" { words.next()? } else { name };
        Some(name.split(|c: char| !c.is_alphanumeric() && c != '_').next()?.to_owned())
    })
}

/// Terms that occur twice or name nothing.
pub(crate) fn faults(source: &Source, names: &Names) -> Vec<Finding> {
    let mut seen = BTreeSet::new();
    let mut findings = Vec::new();
    for (number, line) in (1..).zip(source.text.lines()) {
        let cells: Vec<_> = line.split('|').map(str::trim).collect();
        let [_, term, _, code, _] = cells[..] else { continue };
        if term == "term" || term.starts_with('-') {
            continue;
        }
        if !seen.insert(term.to_owned()) {
            findings.push(source.at(number, &format!("`{term}` stands twice"), "one term, one row"));
        }
        for path in code.split('`').skip(1).step_by(2).filter(|path| !names.has(path)) {
            findings.push(source.at(
                number,
                &format!("no `{path}`"),
                "name the type or module that carries it",
            ));
        }
    }
    findings
}

/// Paths such as `casebase::Case` whose crate is ours and does not define their last name.
pub(crate) fn unknown(source: &Source, names: &Names) -> Vec<Finding> {
    let spans = Quoted::of(source).spans.into_iter();
    let is_path = |span: &String| {
        let plain = span.chars().all(|c| c.is_alphanumeric() || matches!(c, '_' | ':'));
        plain && span.split_once("::").is_some_and(|(name, _)| names.0.contains_key(name))
    };
    let paths = spans.filter(|(_, span)| is_path(span) && !names.has(span));
    paths.map(|(line, path)| source.at(line, &format!("no `{path}`"), "name what the crate has")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_term_twice_and_a_name_of_nothing_are_found() {
        let defines = defined("pub struct Case<'a> {\npub(crate) const fn of(x: u8) {\npub mod walk;\n");
        let names = Names(BTreeMap::from([("casebase".to_owned(), defines.collect())]));
        let text = "| term | meaning | in code |\n|---|---|---|\n| case | x | `casebase::Case` |\n| walk | x | `casebase::walk`, `casebase` |\n| case | x | – |\n| leg | x | `casebase::Leg` |\n| of | x | `case::of` |\n";
        let page = Source { path: "docs/glossary.md".into(), text: text.into() };
        let lines: Vec<_> = faults(&page, &names).iter().map(|finding| finding.line).collect();
        assert_eq!(lines, [5, 6, 7]);
        let text = "`casebase::Case`, `std::fmt`, `casebase::{walk, x}`\n`casebase::Leg`\n";
        let lines: Vec<_> = unknown(&Source { text: text.into(), ..page }, &names)
            .iter()
            .map(|finding| finding.line)
            .collect();
        assert_eq!(lines, [2]);
    }
}
