//! `finding`: findings: what is wrong with a description, where, and how to mend it; as those of case files.

use std::fmt;

use foreign::{excerpt, printable};

/// Maximum length of a message, characters: it may quote the file.
const MESSAGE_LEN: usize = 400;

/// A fault or doubt about a description.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding {
    /// Code of its kind.
    pub code: &'static str,
    /// Severity: an error refuses the description.
    pub severity: Severity,
    /// Path of the file, as given.
    pub file: String,
    /// Line in the file, from 1.
    pub line: u32,
    /// Description of the fault, one sentence with the key.
    pub message: String,
    /// Advice how to fix it.
    pub hint: String,
}

/// Severity of a finding.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// The description is refused.
    Error,
    /// Doubtful; the description can be used.
    Warning,
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { code, severity, file, line, message, hint } = self;
        let severity = match severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
        };
        let (file, message, hint) = (printable(file), excerpt(message, MESSAGE_LEN), printable(hint));
        write!(f, "{file}:{line}: {severity}[{code}]: {message}; {hint}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_finding_is_one_line_with_file_line_kind_words_and_hint() {
        let finding = Finding {
            code: "bad-value",
            severity: Severity::Error,
            file: "my\n.toml".into(),
            line: 3,
            message: "body.radius is \u{1b}".into(),
            hint: "give 0.04 to 0.09 m".into(),
        };
        let text = finding.to_string();
        assert_eq!(text, "my\\n.toml:3: error[bad-value]: body.radius is \\u001b; give 0.04 to 0.09 m");
    }
}
