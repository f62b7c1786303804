//! `failure`: why a verb fails, and how to fix it. Exit code 1 (docs/case-format.md §5); wrong usage is
//! clap's.
//!
//! Every module has the type of its own errors beside it; `?` turns any of them into a [`Failure`].

use std::error::Error;
use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

use arena::cases::LibraryError;
use case_tools::Finding;
use foreign::printable_path;

/// A failure, as it is printed after `error:`.
#[derive(Debug)]
pub(crate) enum Failure {
    /// A recording that is not written.
    Recording {
        /// `stem` of what could not be begun; none where what was begun is not whole.
        stem: Option<PathBuf>,
        error: io::Error,
    },
    /// A Markdown file without a place for figures.
    Markdown {
        file: PathBuf,
        error: report::MarkerError,
    },
    Threads(rayon::ThreadPoolBuildError),
    /// The list of refused changes beside a library cannot be read.
    Refusals(String),
    Input(io::Error),
    Output(io::Error),
    /// An error with a text of its own.
    Other(Box<dyn Error + Send + Sync>),
}

impl Failure {
    pub(crate) fn faulty_library(directory: impl Into<PathBuf>, findings: Vec<Finding>) -> Self {
        LibraryError::Faulty { directory: directory.into(), findings }.into()
    }

    pub(crate) fn missing_directory(directory: &Path) -> Self {
        LibraryError::NoDirectory(directory.to_owned()).into()
    }

    /// True if a reader of stdout has closed it: it has read enough, and nothing failed.
    pub(crate) fn is_closed_stdout(&self) -> bool {
        matches!(self, Self::Output(error) if error.kind() == io::ErrorKind::BrokenPipe)
    }
}

impl<E: Error + Send + Sync + 'static> From<E> for Failure {
    fn from(error: E) -> Self {
        Self::Other(Box::new(error))
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Recording { stem: Some(stem), error } => {
                write!(f, "cannot keep the recording: {}: {error}", printable_path(stem))
            }
            Self::Recording { stem: None, error } => {
                write!(f, "cannot keep the recording: it is not whole: {error}")
            }
            Self::Markdown { file, error } => write!(f, "{}: {error}", printable_path(file)),
            Self::Threads(error) => write!(f, "cannot start threads: {error}; try --jobs 1"),
            Self::Refusals(what) => f.write_str(what),
            Self::Input(error) => write!(f, "cannot read stdin: {error}"),
            Self::Output(error) => write!(f, "cannot write stdout: {error}"),
            Self::Other(error) => error.fmt(f),
        }
    }
}
