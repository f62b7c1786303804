//! `finding`: what is wrong with a file from outside, where, and how to fix it: of case files
//! (docs/case-format.md §1.2) and descriptions of robots.

use std::fmt;
use std::path::PathBuf;

use crate::text::{excerpt, printable};

/// Maximum length of a message, characters: it may quote the file.
const MESSAGE_LEN: usize = 1000;

/// A fault or doubt about a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding {
    /// Code of its kind, for look-up.
    pub code: &'static str,
    /// Severity: an error refuses the file.
    pub severity: Severity,
    /// Path of the file at fault.
    pub file: PathBuf,
    /// Line in the file, from 1.
    pub line: u32,
    /// Description of the fault, one sentence.
    pub message: String,
    /// Advice how to fix it.
    pub hint: String,
}

/// Severity of a finding.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// The file, or the library that it is of, is refused.
    Error,
    /// Doubtful; it can be used.
    Warning,
}

impl fmt::Display for Severity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Error => "error",
            Self::Warning => "warning",
        })
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { code, severity, file, line, message, hint } = self;
        let file = file.to_string_lossy();
        // File names and contents are untrusted: a finding stays one line, and quotes its subject.
        let (file, message, hint) = (printable(&file), excerpt(message, MESSAGE_LEN), printable(hint));
        write!(f, "{file}:{line}: {severity}[{code}]: {message}; {hint}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_finding_reads_as_file_line_kind_words_and_hint() {
        let finding = Finding {
            code: "bad-scope",
            severity: Severity::Error,
            file: PathBuf::from("lib/center/a.toml"),
            line: 3,
            message: "a scope radius is 0".into(),
            hint: "give mm above 0".into(),
        };
        let text = "lib/center/a.toml:3: error[bad-scope]: a scope radius is 0; give mm above 0";
        assert_eq!(finding.to_string(), text);
    }

    #[test]
    fn a_finding_in_a_file_of_a_hostile_name_stays_one_line_without_control_characters() {
        let finding = Finding {
            code: "bad-scope",
            severity: Severity::Warning,
            file: PathBuf::from("lib/center/\u{1b}[2Ja\n.toml"),
            line: 1,
            message: "no robot `\u{1b}]0;x\u{7}`".into(),
            hint: "name one".into(),
        };
        let text = finding.to_string();
        assert!(!text.contains(char::is_control), "{text:?}");
        assert!(text.starts_with("lib/center/\\u001b[2Ja\\n.toml:1: warning"), "{text}");
    }
}
