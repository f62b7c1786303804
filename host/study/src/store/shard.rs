//! `shard`: a part of a plan that one process plays, and the names of its files.

use std::fmt;

/// Beginning and end of a file's name, around `2-of-3`.
pub(crate) type FileKind = (&'static str, &'static str);

const ROWS: FileKind = ("trials-", ".csv");

/// A part of a plan: every n-th trial, so that all parts take about the same time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    index: usize,
    of: usize,
}

impl Shard {
    /// The whole plan as one part.
    pub const WHOLE: Self = Self { index: 1, of: 1 };

    /// The part `index`, from 1, of `of` parts.
    pub fn new(index: usize, of: usize) -> Option<Self> {
        (1..=of).contains(&index).then_some(Self { index, of })
    }

    /// Parses the form `2/3`.
    pub fn from_label(label: &str) -> Option<Self> {
        let (index, of) = label.split_once('/')?;
        Self::new(index.parse().ok()?, of.parse().ok()?)
    }

    /// Whether the trial of this number belongs to it.
    pub fn has(self, number: usize) -> bool {
        number % self.of == self.index - 1
    }

    /// The part whose file has this name.
    pub fn from_file_name(name: &str) -> Option<Self> {
        Self::from_name_of(ROWS, name)
    }

    /// The part whose file of this kind has this name.
    pub(crate) fn from_name_of((prefix, suffix): FileKind, name: &str) -> Option<Self> {
        let (index, of) = name.strip_prefix(prefix)?.strip_suffix(suffix)?.split_once("-of-")?;
        Self::new(index.parse().ok()?, of.parse().ok()?)
    }

    /// Place among the parts of its plan, from 0.
    pub fn index(self) -> usize {
        self.index - 1
    }

    /// Number of parts of its plan.
    pub fn parts(self) -> usize {
        self.of
    }

    /// The name of its file of rows.
    pub fn file_name(self) -> String {
        self.name_of(ROWS)
    }

    pub(crate) fn name_of(self, (prefix, suffix): FileKind) -> String {
        format!("{prefix}{}-of-{}{suffix}", self.index, self.of)
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.index, self.of)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_and_file_names_give_the_shard_they_were_made_of() {
        assert_eq!(Shard::from_label("2/3"), Shard::new(2, 3));
        assert_eq!(Shard::from_file_name(&Shard::new(2, 3).unwrap().file_name()), Shard::new(2, 3));
        assert_eq!(Shard::from_file_name("trials.csv"), None);
        for label in ["0/3", "4/3", "1/0", "1", "a/b", ""] {
            assert_eq!(Shard::from_label(label), None, "{label}");
        }
    }
}
