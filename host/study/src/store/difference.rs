//! `difference`: what two evaluations differ in, with both values: why their files are not mixed.

use std::fmt;

use foreign::printable;

/// A setting in which two evaluations differ.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Difference {
    /// Name of the setting.
    pub what: &'static str,
    /// Value, or the hash of what is too long to print, in the first of both.
    pub own: String,
    /// The same in the second.
    pub other: String,
}

impl Difference {
    /// The difference in a setting, if the two values differ.
    pub(crate) fn of<T: PartialEq + ?Sized>(
        what: &'static str,
        (own, other): (&T, &T),
        text: impl Fn(&T) -> String,
    ) -> Option<Self> {
        (own != other).then(|| Self { what, own: text(own), other: text(other) })
    }
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}, not {}", self.what, printable(&self.own), printable(&self.other))
    }
}

/// Differences in a line: `seed 1, not 2; loss 0, not 0.1`.
pub fn in_words(differences: &[Difference]) -> String {
    let words: Vec<_> = differences.iter().map(Difference::to_string).collect();
    words.join("; ")
}
