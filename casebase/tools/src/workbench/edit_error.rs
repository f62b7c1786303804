//! `edit_error`: why a change of a case file is not made.

use std::fmt;

/// Why a change is not made.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum EditError {
    /// The text is no TOML.
    Syntax(String),
    /// The case has no such part.
    NoPart(String),
    /// A number is out of its range.
    Range(&'static str),
    /// There is no room for one more, or one has to stay.
    Count(&'static str),
}

impl fmt::Display for EditError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Syntax(message) => {
                write!(f, "the text is no TOML, mend it by hand: {}", foreign::excerpt(message, 300))
            }
            Self::NoPart(what) => {
                write!(f, "the case has no {}; take one that it shows", foreign::excerpt(what, 60))
            }
            Self::Range(reason) | Self::Count(reason) => f.write_str(reason),
        }
    }
}

impl std::error::Error for EditError {}
