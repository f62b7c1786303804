//! `error`: errors of an evaluation, and how to fix them.

use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

use foreign::printable;
use hil_sim::SimulationError;

use super::difference::{Difference, in_words};
use super::plan::Shard;
use arena::game::GameError;

/// Why an evaluation stopped, or could not be merged.
#[derive(Debug)]
pub enum EvaluationError {
    /// A file could not be read or written.
    File {
        /// Path of the file.
        file: PathBuf,
        /// The operating system's error.
        error: io::Error,
    },
    /// A line of a file is not of this evaluation's trials.
    Row {
        /// Path of the file.
        file: PathBuf,
        /// Its line, from 1.
        line: usize,
        /// The error in it.
        what: String,
    },
    /// The file is of another evaluation.
    Another {
        /// Path of the file.
        file: PathBuf,
        /// The file it was to be merged with; none where it was to be continued.
        merged: Option<PathBuf>,
        /// The settings that differ, with the file's value first.
        differences: Vec<Difference>,
    },
    /// The directory holds other matches than those that it is compared with.
    OtherMatches {
        /// Path of the directory.
        directory: PathBuf,
        /// What differs, with the directory's value first.
        differences: Vec<Difference>,
    },
    /// Another process writes to the file.
    InUse(PathBuf),
    /// No file to merge was given.
    Nothing,
    /// The team `strategy` plays, and no command of its strategy is given.
    NoStrategy,
    /// The files contain a trial twice, with different results.
    Unlike {
        /// Its number in the plan, from 0.
        trial: usize,
    },
    /// Trials of the plan are missing in all files.
    Missing {
        /// Number of missing trials.
        trials: usize,
        /// Number of planned trials.
        of: usize,
        /// Number of the first missing one.
        first: usize,
        /// The shards that lack them; empty where the files' names do not tell.
        shards: Vec<LackingShard>,
    },
    /// A trial could not be played.
    Trial {
        /// Its number in the plan, from 0.
        trial: usize,
        /// The simulator's error that ended it.
        error: SimulationError,
    },
    /// A match could not be played.
    Match {
        /// Its number in the plan, from 0.
        number: usize,
        /// The match's error that ended it.
        error: GameError,
    },
    /// Trials could not be written as CSV.
    Csv(csv::Error),
    /// The caller stopped it; finished trials are kept.
    Stopped,
}

/// A shard that is not played to its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LackingShard {
    /// The shard.
    pub shard: Shard,
    /// Number of its missing trials.
    pub trials: usize,
    /// Number of its planned trials.
    pub of: usize,
}

impl fmt::Display for LackingShard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { shard, trials, of } = self;
        write!(f, "--shard {shard}: {} lacks {trials} of {of} trials", shard.file_name())
    }
}

impl EvaluationError {
    /// The error of this file.
    pub(super) fn file(path: &Path) -> impl Fn(io::Error) -> Self + use<> {
        let file = path.to_owned();
        move |error| Self::File { file: file.clone(), error }
    }
}

impl From<csv::Error> for EvaluationError {
    fn from(error: csv::Error) -> Self {
        Self::Csv(error)
    }
}

/// A file's name in printable form.
fn printable_path(file: &Path) -> String {
    printable(&file.to_string_lossy()).into_owned()
}

impl fmt::Display for EvaluationError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File { file, error } => write!(f, "{}: {error}", printable_path(file)),
            Self::Row { file, line, what } => {
                let what = printable(what);
                write!(
                    f,
                    "{}:{line}: {what}; remove the line, or start in an empty directory",
                    printable_path(file)
                )
            }
            Self::OtherMatches { directory, differences } => write!(
                f,
                "{}: holds other matches: {}; compare matches of one seed, league, world, length and list of \
                 opponents",
                printable_path(directory),
                in_words(differences)
            ),
            Self::Another { file, merged, differences } => {
                let (file, differences) = (printable_path(file), in_words(differences));
                match merged {
                    Some(other) => write!(
                        f,
                        "{file}: is not of the evaluation of {}: {differences}; merge shards of one program, \
                         library, world and plan: play this one again in an empty directory",
                        printable_path(other)
                    ),
                    None => write!(
                        f,
                        "{file}: holds trials of another evaluation: {differences}; name an empty directory, \
                         start again with --fresh, or give the options it was begun with"
                    ),
                }
            }
            Self::InUse(file) => {
                write!(f, "{}: another process writes to it; wait for it, or stop it", printable_path(file))
            }
            Self::Nothing => f.write_str("no trials there; name the folders that shards were written to"),
            Self::NoStrategy => f.write_str("the team `strategy` needs --strategy COMMAND, its program"),
            Self::Unlike { trial } => write!(
                f,
                "trial {trial} is there twice and ended differently: the shards were not played by the same program"
            ),
            Self::Missing { trials, of, first, shards } => {
                write!(
                    f,
                    "{trials} of {of} trials are missing, the first is {first}; play the shards that lack them \
                     again with the options and the directory of the others: they go on where they stopped"
                )?;
                shards.iter().try_for_each(|shard| write!(f, "\n  {shard}"))
            }
            Self::Trial { trial, error } => write!(f, "trial {trial}: {error}"),
            Self::Match { number, error } => write!(f, "match {number}: {error}"),
            Self::Csv(error) => write!(f, "trials as CSV: {error}"),
            Self::Stopped => f.write_str("stopped; the same command goes on from here"),
        }
    }
}

impl std::error::Error for EvaluationError {}
