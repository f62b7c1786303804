//! What is wrong with a library, where, and how is it mended? (DESIGN §4.1)

use std::fmt;
use std::path::PathBuf;

/// Something to mend in a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding {
    /// What kind of finding, for looking up.
    pub code: &'static str,
    /// Does it refuse the library?
    pub severity: Severity,
    /// The file.
    pub file: PathBuf,
    /// Its line, from 1.
    pub line: u32,
    /// What is wrong.
    pub message: String,
    /// What to do about it.
    pub mend: String,
}

/// How bad a finding is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// The library is refused.
    Error,
    /// Doubtful; the library serves.
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
        let Self { code, severity, file, line, message, mend } = self;
        write!(f, "{}:{line}: {severity}[{code}]: {message}; {mend}", file.display())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::codes::code;

    #[test]
    fn a_finding_reads_as_file_line_kind_words_and_mend() {
        let finding = Finding {
            code: code::BAD_SCOPE,
            severity: Severity::Error,
            file: PathBuf::from("lib/center/a.toml"),
            line: 3,
            message: "a scope radius is 0".into(),
            mend: "give mm above 0".into(),
        };
        let text = "lib/center/a.toml:3: error[bad-scope]: a scope radius is 0; give mm above 0";
        assert_eq!(finding.to_string(), text);
    }
}
