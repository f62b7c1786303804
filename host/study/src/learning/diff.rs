//! `diff`: what differs between two libraries, as one unified diff of their case files.

use std::collections::BTreeSet;

use case_tools::Files;
use similar::TextDiff;

/// The unified diff from one library to the other, file by file in the order of names; empty where none
/// differs. `patch -p1` in a copy of the library's directory makes the other of it.
pub fn diff(before: &Files, after: &Files) -> String {
    let names: BTreeSet<&str> =
        before.cases.iter().chain(&after.cases).map(|file| file.name.as_str()).collect();
    let mut diff = String::new();
    for name in names {
        let (old, new) = (text_of(before, name), text_of(after, name));
        let lines = TextDiff::from_lines(old.unwrap_or(""), new.unwrap_or(""));
        let (from, to) = (head("a", name, old), head("b", name, new));
        diff.push_str(&lines.unified_diff().header(&from, &to).to_string());
    }
    diff
}

pub(crate) fn text_of<'f>(files: &'f Files, case: &str) -> Option<&'f str> {
    files.cases.iter().find(|file| file.name == case).map(|file| file.text.as_str())
}

/// Name of a file in the head of a difference, on this side.
fn head(side: &str, name: &str, text: Option<&str>) -> String {
    if text.is_some() { format!("{side}/{name}.toml") } else { "/dev/null".to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn changed_new_and_deleted_files_have_their_own_heads() {
        let before = Files::from_texts("l", "", &[("a/gone", "x\n"), ("a/kept", "k\n"), ("a/set", "1\n2\n")]);
        let after = Files::from_texts("l", "", &[("a/kept", "k\n"), ("a/new", "y\n"), ("a/set", "1\n3\n")]);
        assert_eq!(
            diff(&before, &after),
            "--- a/a/gone.toml\n+++ /dev/null\n@@ -1 +0,0 @@\n-x\n\
             --- /dev/null\n+++ b/a/new.toml\n@@ -0,0 +1 @@\n+y\n\
             --- a/a/set.toml\n+++ b/a/set.toml\n@@ -1,2 +1,2 @@\n 1\n-2\n+3\n"
        );
        assert_eq!(diff(&before, &before), "");
    }
}
