//! `links`: relative links and file names in documents and comments.

use std::path::{Component, Path, PathBuf};

use match_tests::workspace::{Finding, Source, root};

use crate::is_document;
use crate::prose::Quoted;

/// The repository's files; a test replaces them.
pub(crate) trait Lookup {
    /// The text of a file, empty for a directory or an image file; `None` where there is nothing.
    fn text(&self, path: &Path) -> Option<String>;
}

pub(crate) struct Files;

impl Lookup for Files {
    fn text(&self, path: &Path) -> Option<String> {
        let path = root().join(path);
        path.exists().then(|| std::fs::read_to_string(path).unwrap_or_default())
    }
}

/// Links of a document that lead to no file, or to no heading of their file.
pub(crate) fn dangling(source: &Source, files: &dyn Lookup) -> Vec<Finding> {
    let mut findings = Vec::new();
    for (number, line) in (1..).zip(source.text.lines()) {
        let targets = line.split("](").skip(1).filter_map(|rest| rest.split(')').next());
        for target in targets.filter(|target| !target.contains("://") && !target.starts_with("mailto:")) {
            let (file, anchor) = target.split_once('#').unwrap_or((target, ""));
            let directory = Path::new(&source.path).parent().unwrap_or(Path::new(""));
            let text = match file {
                "" => Some(source.text.clone()),
                file => files.text(&clean(&directory.join(file))),
            };
            let fault = match text {
                None => format!("links `{target}`, which is not there"),
                Some(text) if !anchor.is_empty() && !anchors(&text).any(|known| known == anchor) => {
                    format!("`{target}`: no heading leads to `#{anchor}`")
                }
                Some(_) => continue,
            };
            findings.push(source.at(number, &fault, "link what is there"));
        }
    }
    findings
}

/// The names that GitHub gives to headings: lower case, `-` for a space, no punctuation.
fn anchors(text: &str) -> impl Iterator<Item = String> {
    let headings = text.lines().filter(|line| line.starts_with('#'));
    headings.map(|line| {
        let title = line.trim_start_matches('#').trim().to_lowercase().replace(' ', "-");
        title.chars().filter(|c| c.is_alphanumeric() || matches!(c, '-' | '_')).collect()
    })
}

/// Without `.` and `..`.
fn clean(path: &Path) -> PathBuf {
    let mut clean = PathBuf::new();
    for part in path.components() {
        match part {
            Component::ParentDir => {
                clean.pop();
            }
            Component::Normal(name) => clean.push(name),
            _ => {}
        }
    }
    clean
}

/// Files named in code quotes, as `path` or `path: item`, that do not exist or lack the item. From the root,
/// or from the directory of the file that names them.
pub(crate) fn missing_files(source: &Source, files: &dyn Lookup) -> Vec<Finding> {
    let mut findings = Vec::new();
    for (number, quoted) in Quoted::of(source).spans {
        let (path, item) = quoted.split_once(": ").unwrap_or((&quoted, ""));
        if !names_a_file(path, is_document(source)) {
            continue;
        }
        let name = Path::new(path.trim_end_matches('/'));
        let directory = Path::new(&source.path).parent().unwrap_or(Path::new(""));
        match files.text(name).or_else(|| files.text(&directory.join(name))) {
            None => findings.push(source.at(number, &format!("`{path}` is not there"), "name what is")),
            Some(text) if !item.is_empty() && !text.contains(item) => {
                findings.push(source.at(number, &format!("{path} has no `{item}`"), "name what it has"));
            }
            Some(_) => {}
        }
    }
    findings
}

/// Whether it is a path from the root, in a document also from its own directory, written in full: no
/// pattern, no placeholder.
fn names_a_file(path: &str, in_document: bool) -> bool {
    let first = path.split('/').next().unwrap_or_default();
    path.contains('/')
        && (TOP.contains(&first) || in_document && OWN.contains(&first))
        && !path.contains("NAME")
        && path.chars().all(|c| c.is_ascii_alphanumeric() || matches!(c, '_' | '-' | '.' | '/'))
}

/// Opens with a title, a blank line, and text.
pub(crate) fn opens_with_a_summary(text: &str) -> bool {
    let mut lines = text.lines();
    let title = lines.next().is_some_and(|line| line.starts_with("# "));
    let blank = lines.next().is_some_and(str::is_empty);
    let description =
        lines.next().is_some_and(|line| line.starts_with(|c: char| c.is_alphanumeric() || c == '`'));
    title && blank && description
}

/// The repository's top directories, as starts of file paths.
const TOP: [&str; 11] = [
    "casebase", "docs", "firmware", "hil-sim", "host", "protocol", "robots", "tests", "xtask", ".ci",
    ".github",
];

/// A crate's directories, as starts of file paths in its README.
const OWN: [&str; 9] = ["bench", "benches", "data", "examples", "figures", "library", "src", "tools", "web"];

#[cfg(test)]
mod tests {
    use super::*;

    struct One;

    impl Lookup for One {
        fn text(&self, path: &Path) -> Option<String> {
            (path == Path::new("docs/a.md")).then(|| "# A\n\n## 1. It's 5 m\n".to_owned())
        }
    }

    fn page(text: &str) -> Source {
        Source { path: "docs/x.md".into(), text: text.into() }
    }

    #[test]
    fn a_link_to_nothing_and_to_no_heading_is_found() {
        let text =
            "[a](a.md) [b](../docs/a.md#1-its-5-m) [c](https://x)\n[d](b.md)\n[e](a.md#2)\n[f](#here)\n";
        let lines: Vec<_> = dangling(&page(text), &One).iter().map(|finding| finding.line).collect();
        assert_eq!(lines, [2, 3, 4]);
    }

    #[test]
    fn a_file_that_is_not_there_is_found_and_a_pattern_is_none() {
        let text = "`docs/a.md` `docs/a.md: It's` `docs/*.md` `a/b.md`\n`docs/c.md`\n`docs/a.md: fn x`\n";
        let lines: Vec<_> = missing_files(&page(text), &One).iter().map(|finding| finding.line).collect();
        assert_eq!(lines, [2, 3]);
    }

    #[test]
    fn a_page_without_a_summary_is_found() {
        assert!(opens_with_a_summary("# A\n\nWhat it is.\n"));
        for text in ["What.\n", "# A\nWhat.\n", "# A\n\n## 1. One\n", "# A\n\n- what\n", ""] {
            assert!(!opens_with_a_summary(text), "{text}");
        }
    }
}
