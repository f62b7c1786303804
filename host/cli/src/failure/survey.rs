//! `survey`: why problems cannot be read, drawn or counted, for `cases coverage`, `check`, `render` and the
//! like.

use std::fmt;
use std::io;
use std::path::PathBuf;

use arena::cases::problem::Malformed;
use case_tools::coverage::CellsError;
use casebase::SettingError;

use crate::output::printable_path;

/// Why a problem to draw cannot be read.
#[derive(Debug)]
pub(crate) enum ProblemError {
    /// Its file cannot be read.
    Unreadable(PathBuf, io::Error),
    /// Longer than this many bytes.
    TooLong(usize),
    /// It is no problem.
    Malformed(Malformed),
}

impl fmt::Display for ProblemError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unreadable(file, error) => write!(f, "cannot read {}: {error}", printable_path(file)),
            Self::TooLong(most) => write!(f, "--problem: more than {most} bytes; give one problem"),
            Self::Malformed(error) => write!(f, "--problem: {error}"),
        }
    }
}

/// Why problems cannot be counted.
#[derive(Debug)]
pub(crate) enum SurveyError {
    /// `--cell` with this edge, mm.
    Cell(i32, CellsError),
    /// The retrieval refuses scopes a fifth larger.
    Wider(SettingError),
    /// The retrieval refuses the library's own settings.
    Setting(SettingError),
    /// The filters leave no problem.
    NothingLeft,
    /// `--from` with this file.
    From(PathBuf, FromError),
}

impl fmt::Display for SurveyError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Cell(edge, error) => write!(f, "--cell {edge}: {error}"),
            Self::Wider(error) => write!(f, "with scopes a fifth larger, thr: {error}"),
            Self::Setting(error) => write!(f, "{error}"),
            Self::NothingLeft => {
                f.write_str("no problem is left to ask; leave --defending out, or draw more")
            }
            Self::From(file, error) => write!(f, "--from {}: {error}", printable_path(file)),
        }
    }
}

/// Why a file of problems is refused.
#[derive(Debug)]
pub(crate) enum FromError {
    /// It cannot be read.
    Unreadable(io::Error),
    /// Lines that are no problem or too many.
    Faulty {
        /// The first of them.
        first: LineFault,
        /// Number of others.
        more: u64,
    },
    /// No line in it.
    Empty,
}

/// What is wrong with a line.
#[derive(Debug)]
pub(crate) enum LineFault {
    /// It is no problem: where and why.
    Malformed(String),
    /// More than this many problems.
    TooMany(usize),
}

impl fmt::Display for FromError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unreadable(error) => write!(f, "{error}"),
            Self::Faulty { first, more } => {
                match first {
                    LineFault::Malformed(error) => f.write_str(error)?,
                    LineFault::TooMany(most) => write!(f, "more than {most} problems; split the file")?,
                }
                if *more > 0 { write!(f, "; and {more} more lines") } else { Ok(()) }
            }
            Self::Empty => f.write_str("no problem in it; one line each, as `cases retrieve` takes them"),
        }
    }
}
