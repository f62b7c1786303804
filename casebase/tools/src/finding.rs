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

/// The codes of all findings.
#[allow(missing_docs, reason = "each constant is the words of its code")]
pub mod code {
    pub const UNREADABLE: &str = "unreadable";
    pub const SYNTAX: &str = "syntax";
    pub const MISPLACED: &str = "misplaced";
    pub const NO_LEAGUE: &str = "no-league";
    pub const UNKNOWN_KEY: &str = "unknown-key";
    pub const MISSING_KEY: &str = "missing-key";
    pub const WRONG_TYPE: &str = "wrong-type";
    pub const BAD_VALUE: &str = "bad-value";
    pub const BAD_SCOPE: &str = "bad-scope";
    pub const BAD_DEFENDING: &str = "bad-defending";
    pub const NO_TEAMMATE: &str = "no-teammate";
    pub const TOO_MANY_TEAMMATES: &str = "too-many-teammates";
    pub const TOO_MANY_OPPONENTS: &str = "too-many-opponents";
    pub const TOO_MANY_ACTIONS: &str = "too-many-actions";
    pub const TOO_MANY_CASES: &str = "too-many-cases";
    pub const ROBOT_NUMBER: &str = "robot-number";
    pub const ONE_GETTER: &str = "one-getter";
    pub const NOT_HOLDING: &str = "not-holding";
    pub const PASS_UNANSWERED: &str = "pass-unanswered";
    pub const RECEIVE_UNANSWERED: &str = "receive-unanswered";
    pub const UNKNOWN_KICK: &str = "unknown-kick";
    pub const OUTSIDE_FIELD: &str = "outside-field";
    pub const NO_PARTNER: &str = "no-partner";
    pub const TOO_MANY_KICKS: &str = "too-many-kicks";
    // Warnings.
    pub const EMPTY: &str = "empty";
    pub const TWIN: &str = "twin";
    pub const SCOPE_IN_PATH: &str = "scope-in-path";
    pub const BIG_SCOPE: &str = "big-scope";
    pub const BEATEN: &str = "beaten";
    pub const POINT_OUTSIDE: &str = "point-outside";
    pub const BYSTANDER: &str = "bystander";
    pub const LEAVES_BALL: &str = "leaves-ball";
    pub const NEVER_REACHED: &str = "never-reached";
    pub const UNKNOWN_PRIMITIVE: &str = "unknown-primitive";
}

#[cfg(test)]
mod tests {
    use super::*;

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
