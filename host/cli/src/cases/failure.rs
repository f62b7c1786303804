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
    #[error("no case {asked:?} in {league}; {}", remedy(near.as_deref(), *stored))]
    Unknown { asked: String, league: String, stored: usize, near: Option<String> },
    #[error("no case {asked:?} in {league}; take a region/name that `onetwo cases list` prints, or a region")]
    UnknownName { asked: String, league: String },
    #[error("no case fits the problem; name a case to see why, or ask `onetwo cases explain`")]
    NoneFits,
    #[error(
        "{0} defends the other goal than the problem; take the id of its copy from `onetwo cases list --all`"
    )]
    OtherGoal(String),
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

#[derive(Debug, Error)]
pub(super) enum ProblemError {
    #[error("cannot read {}: {error}", printable_path(.0), error = .1)]
    Unreadable(PathBuf, io::Error),
    #[error("--problem: more than {0} bytes; give one problem")]
    TooLong(usize),
    #[error("--problem: {0}")]
    Malformed(Malformed),
}

#[derive(Debug, Error)]
pub(super) enum SurveyError {
    /// `--cell` with this edge, mm.
    #[error("--cell {0}: {1}")]
    Cell(i32, CellsError),
    #[error("with scopes a fifth larger, thr: {0}")]
    Wider(SettingError),
    #[error("{0}")]
    Setting(SettingError),
    #[error("no problem is left to ask; leave --defending out, or draw more")]
    NothingLeft,
    #[error("--from {}: {error}", printable_path(.0), error = .1)]
    From(PathBuf, FromError),
}

#[derive(Debug, Error)]
pub(super) enum FromError {
    #[error("{0}")]
    Unreadable(io::Error),
    #[error("{first}{}", and_more(*more))]
    Faulty { first: LineFault, more: u64 },
    #[error("no problem in it; one line each, as `cases retrieve` takes them")]
    Empty,
}

fn and_more(lines: u64) -> String {
    if lines > 0 { format!("; and {lines} more lines") } else { String::new() }
}

#[derive(Debug, Error)]
pub(super) enum LineFault {
    #[error("{0}")]
    Malformed(String),
    #[error("more than {0} problems; split the file")]
    TooMany(usize),
}
