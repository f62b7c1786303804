//! `place`: the description that a build is for, by an environment variable.

use std::path::{Path, PathBuf};

use crate::built_in;

/// The environment variable with the description that is compiled: a built-in name, or a file. A relative
/// path starts at the workspace's root. Unset or empty: `ours`.
pub const VARIABLE: &str = "ONETWO_ROBOT";
/// Largest description that is read, bytes: ours has 5 kB.
const LEN_MAX: u64 = 1 << 20;

/// A description by its origin, not yet checked.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Chosen {
    /// A built-in name or a path, for findings and for [`VARIABLE`].
    pub source: String,
    /// Text of the description, TOML.
    pub text: String,
    /// The file that was read; none for a built-in one.
    pub file: Option<PathBuf>,
}

/// Error of a description that cannot be read.
#[derive(Debug, thiserror::Error)]
#[error(
    "the robot's description {} cannot be read: {error}; give a file, or one of {}",
    foreign::excerpt(&file.to_string_lossy(), 300),
    crate::BUILT_IN.map(|(name, _)| name).join(", ")
)]
pub struct Unreadable {
    /// File that was to be read.
    file: PathBuf,
    /// Error of the attempt.
    #[source]
    error: std::io::Error,
}

/// The description that `asked` names: a built-in name, or a file; relative paths start at `root`.
pub fn chosen(asked: &str, root: &Path) -> Result<Chosen, Unreadable> {
    let name = if asked.is_empty() { crate::BUILT_IN[0].0 } else { asked };
    if let Some(text) = built_in(name) {
        return Ok(Chosen { source: name.to_owned(), text: text.to_owned(), file: None });
    }
    let file = root.join(name);
    match foreign::read_text(&file, LEN_MAX) {
        Ok(text) => Ok(Chosen { source: name.to_owned(), text, file: Some(file) }),
        Err(error) => Err(Unreadable { file, error }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_is_built_in_and_anything_else_a_file_from_the_root() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        assert_eq!(chosen("", root).unwrap().source, "ours");
        let by_name = chosen("school", root).unwrap();
        let by_file = chosen("school.toml", root).unwrap();
        assert_eq!((&by_name.text, by_name.file.is_none()), (&by_file.text, true));
        assert_eq!(by_file.file, Some(root.join("school.toml")));
        let error = chosen("mine", root).unwrap_err().to_string();
        assert!(error.contains("mine") && error.contains("ours, wide, school"), "{error}");
    }
}
