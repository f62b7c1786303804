//! `args`: the arguments that verbs share (docs/case-format.md §5); [`parsers`] reads the values of flags,
//! [`page`] has the page's.

pub(crate) mod page;
pub(crate) mod parsers;

use std::path::PathBuf;

use arena::cases::{Chosen, SettingFailure};
use casebase::SettingError;
use clap::Args;
use thiserror::Error;

use crate::Failure;

/// That many threads; as many as cores by default.
pub(crate) fn threads(jobs: Option<u16>) -> Result<rayon::ThreadPool, Failure> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(jobs.map_or(0, usize::from));
    pool.build().map_err(Failure::Threads)
}

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
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = parsers::assignment)]
    assignments: Vec<(String, String)>,
}

impl SettingsArgs {
    /// The assignments as given on the command line.
    pub(crate) fn given(&self) -> &[(String, String)] {
        &self.assignments
    }

    /// The defaults, changed as the command line orders; of two assignments to a name the later one counts.
    pub(crate) fn choose(&self) -> Result<Chosen, NoSuchSetting> {
        let given = self.assignments.iter().map(|(name, value)| (name.as_str(), value.as_str()));
        Chosen::of(given).map_err(NoSuchSetting)
    }
}

/// `--set` with a name or value that retrieval does not know.
#[derive(Debug, Error)]
#[error("--set {0}")]
pub(crate) struct NoSuchSetting(SettingFailure);

impl NoSuchSetting {
    /// Why `value` cannot be given to the setting `name`.
    pub(crate) fn new(name: &str, value: &str, error: SettingError) -> Self {
        Self(SettingFailure::new(name, value, error))
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
