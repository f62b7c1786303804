//! `failure`: why a case, a problem or a library cannot be asked for, counted or drawn, with the remedy.

use std::io;
use std::path::PathBuf;

use arena::cases::problem::Malformed;
use case_tools::coverage::CellsError;
use casebase::SettingError;
use foreign::printable_path;
use thiserror::Error;

/// A case that was asked for and is not there, or does not fit.
#[derive(Debug, Error)]
pub(super) enum NoCase {
    /// A name or id that the library lacks.
    #[error("no case {asked:?} in {league}; {}", remedy(near.as_deref(), *stored))]
    Unknown {
        /// The name or id as given.
        asked: String,
        /// The league of the library.
        league: String,
        /// Number of stored cases.
        stored: usize,
        /// A similar name.
        near: Option<String>,
    },
    /// The name of no authored case, and of no region.
    #[error("no case {asked:?} in {league}; take a region/name that `onetwo cases list` prints, or a region")]
    UnknownName {
        /// The name as given.
        asked: String,
        /// The league of the library.
        league: String,
    },
    /// A figure of the retrieved case was requested, and no case fits.
    #[error("no case fits the problem; name a case to see why, or ask `onetwo cases explain`")]
    NoneFits,
    /// A case to be drawn under a problem that defends the other goal.
    #[error("{0} defends the other goal than the problem; take the id of its copy from `onetwo cases list`")]
    OtherGoal(String),
    /// A library without a case has nothing to count.
    #[error("the library {0} holds no case; add one at <region>/<name>.toml")]
    EmptyLibrary(String),
}

fn remedy(near: Option<&str>, stored: usize) -> String {
    let near = near.map_or_else(String::new, |near| format!("did you mean {near}? Else "));
    match stored.checked_sub(1) {
        Some(last) => {
            format!("{near}take an id, 0 to {last}, or a region/name that `onetwo cases list` prints")
        }
        None => format!("{near}the library holds no case"),
    }
}

/// Why a problem to draw cannot be read.
#[derive(Debug, Error)]
pub(super) enum ProblemError {
    /// A file that cannot be read.
    #[error("cannot read {}: {error}", printable_path(.0), error = .1)]
    Unreadable(PathBuf, io::Error),
    /// Longer than this many bytes.
    #[error("--problem: more than {0} bytes; give one problem")]
    TooLong(usize),
    /// A text that is no problem.
    #[error("--problem: {0}")]
    Malformed(Malformed),
}

/// Why problems cannot be counted.
#[derive(Debug, Error)]
pub(super) enum SurveyError {
    /// `--cell` with this edge, mm.
    #[error("--cell {0}: {1}")]
    Cell(i32, CellsError),
    /// The retrieval refuses scopes a fifth larger.
    #[error("with scopes a fifth larger, thr: {0}")]
    Wider(SettingError),
    /// The retrieval refuses the library's own settings.
    #[error("{0}")]
    Setting(SettingError),
    /// The filters leave no problem.
    #[error("no problem is left to ask; leave --defending out, or draw more")]
    NothingLeft,
    /// `--from` with this file.
    #[error("--from {}: {error}", printable_path(.0), error = .1)]
    From(PathBuf, FromError),
}

/// Why a file of problems is refused.
#[derive(Debug, Error)]
pub(super) enum FromError {
    /// The file cannot be read.
    #[error("{0}")]
    Unreadable(io::Error),
    /// Lines that are no problem or too many.
    #[error("{first}{}", and_more(*more))]
    Faulty {
        /// The first of them.
        first: LineFault,
        /// Number of others.
        more: u64,
    },
    /// No line in it.
    #[error("no problem in it; one line each, as `cases retrieve` takes them")]
    Empty,
}

fn and_more(lines: u64) -> String {
    if lines > 0 { format!("; and {lines} more lines") } else { String::new() }
}

/// A fault of a line.
#[derive(Debug, Error)]
pub(super) enum LineFault {
    /// Place and reason of a fault.
    #[error("{0}")]
    Malformed(String),
    /// More than this many problems.
    #[error("more than {0} problems; split the file")]
    TooMany(usize),
}
