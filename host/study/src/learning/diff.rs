//! `diff`: what differs between two libraries, as one unified diff of their case files.

use std::collections::BTreeSet;

use case_tools::Files;
use similar::TextDiff;

/// The unified diff from one library to the other, file by file in the order of names; empty where none
/// differs. `patch -p1` in a copy of the library's directory makes the other of it.
pub fn diff(before: &Files, after: &Files) -> String {
    let names: BTreeSet<&str> =
        before.cases.iter().chain(&after.cases).map(|file| file.name.as_str()).collect();
    let text = |files: &'_ Files, name: &str| {
        files.cases.iter().find(|file| file.name == name).map(|file| file.text.clone())
    };
    let mut diff = String::new();
    for name in names {
        let (old, new) = (text(before, name), text(after, name));
        let head = |side: &str, text: &Option<String>| match text {
            Some(_) => format!("{side}/{name}.toml"),
            None => "/dev/null".to_owned(),
        };
        let (from, to) = (head("a", &old), head("b", &new));
        let lines = TextDiff::from_lines(old.as_deref().unwrap_or(""), new.as_deref().unwrap_or(""));
        diff.push_str(&lines.unified_diff().header(&from, &to).to_string());
    }
    diff
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_change_a_new_file_and_a_deleted_one_are_told_apart() {
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
