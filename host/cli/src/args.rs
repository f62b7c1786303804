//! `args`: command-line arguments. The arguments that verbs share (docs/case-format.md §5).

use std::path::PathBuf;

use arena::cases::Chosen;
use clap::Args;

use crate::Failure;

/// Which libraries: every built-in league unless a directory is given.
#[derive(Debug, Args)]
pub(crate) struct DirectoryArgs {
    /// Directory of one league's case files, read now: `league.toml` and `<region>/<name>.toml`.
    #[arg(long, value_name = "DIR")]
    pub(crate) library: Option<PathBuf>,
}

/// Which library, where exactly one is needed.
#[derive(Debug, Args)]
pub(crate) struct LibraryArgs {
    #[command(flatten)]
    pub(crate) directory: DirectoryArgs,
    /// A built-in league.
    #[arg(long, value_name = "NAME", default_value = "four-legged", conflicts_with = "library")]
    pub(crate) league: String,
}

/// Retrieval's named settings (docs/case-format.md §3.2).
#[derive(Debug, Args)]
pub(crate) struct SettingsArgs {
    /// Change a setting of retrieval; may be repeated.
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = assignment)]
    assignments: Vec<(String, String)>,
}

impl SettingsArgs {
    /// The assignments as given on the command line.
    pub(crate) fn given(&self) -> &[(String, String)] {
        &self.assignments
    }

    /// The defaults, changed as the command line orders; of two assignments to a name the later one counts.
    pub(crate) fn choose(&self) -> Result<Chosen, Failure> {
        let given = self.assignments.iter().map(|(name, value)| (name.as_str(), value.as_str()));
        Chosen::of(given).map_err(Failure::Setting)
    }
}

fn assignment(text: &str) -> Result<(String, String), String> {
    match text.split_once('=') {
        Some((name, value)) => Ok((name.trim().to_owned(), value.trim().to_owned())),
        None => Err("expected NAME=VALUE, such as thr_c=1200".to_owned()),
    }
}

/// The package's version and the commit it was built from: for files that must not be mixed.
pub(crate) const VERSION: &str = concat!(env!("CARGO_PKG_VERSION"), " (commit ", env!("ONETWO_COMMIT"), ")");

/// The same for people: the start of the commit's hash, and its date.
pub(crate) const SHORT_VERSION: &str = concat!(
    env!("CARGO_PKG_VERSION"),
    " (",
    env!("ONETWO_COMMIT_SHORT"),
    ", ",
    env!("ONETWO_COMMIT_DATE"),
    ")"
);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_assignment_is_split_at_its_first_equals_sign() {
        assert_eq!(assignment("a = b=c"), Ok(("a".to_owned(), "b=c".to_owned())));
        assert!(assignment("thr_c").is_err());
    }
}
