//! `edit_error`: why a change of a case file is not made.

/// Reason why a change is not made.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum EditError {
    /// The text is not TOML.
    #[error("the text is not TOML, correct it by hand: {}", foreign::excerpt(.0, 300))]
    Syntax(String),
    /// The case has no such part.
    #[error("the case has no {}; take one that it shows", foreign::excerpt(.0, 60))]
    NoPart(String),
    /// A number is out of its range.
    #[error("{0}")]
    Range(&'static str),
    /// The list has no room for one more, or one has to stay.
    #[error("{0}")]
    Count(&'static str),
}
