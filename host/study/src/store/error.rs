//! `error`: errors of an evaluation, and how to fix them.

use std::io;
use std::path::{Path, PathBuf};

use foreign::printable;
use hil_sim::SimulationError;

use super::difference::{Difference, in_words};
use super::shard::Shard;
use arena::game::GameError;

/// Error that stopped an experiment, or kept its files from being merged.
#[derive(Debug, thiserror::Error)]
pub enum EvaluationError {
    /// A file could not be read or written.
    #[error("{file}: {1}", file = printable_path(.0))]
    File(PathBuf, io::Error),
    /// A line of a file is not of this evaluation's trials.
    #[error(
        "{}:{line}: {}; remove the line, or start in an empty directory",
        printable_path(.file),
        printable(.what)
    )]
    Row {
        /// Path of the file.
        file: PathBuf,
        /// Line of the file, from 1.
        line: usize,
        /// The error in it.
        what: String,
    },
    /// The file is of another evaluation.
    #[error("{}", another(.file, .merged.as_deref(), .differences))]
    Another {
        /// Path of the file.
        file: PathBuf,
        /// The file it was to be merged with; none where it was to be continued.
        merged: Option<PathBuf>,
        /// The settings that differ, with the file's value first.
        differences: Vec<Difference>,
    },
    /// The directory holds other matches than those that it is compared with.
    #[error(
        "{}: holds other matches: {}; compare matches of one seed, league, world, length and list of opponents",
        printable_path(.directory),
        in_words(.differences)
    )]
    OtherMatches {
        /// Path of the directory.
        directory: PathBuf,
        /// Differences, with the directory's value first.
        differences: Vec<Difference>,
    },
    /// Another process writes to the file.
    #[error("{}: another process writes to it; wait for it, or stop it", printable_path(.0))]
    InUse(PathBuf),
    /// No file to merge was given.
    #[error("no trials there; name the folders that shards were written to")]
    Nothing,
    /// The team `strategy` plays, and no command of its strategy is given.
    #[error("the team `strategy` needs --strategy COMMAND, its program")]
    NoStrategy,
    /// The files contain the trial of this number twice, with different results.
    #[error("trial {0} is there twice and ended differently: the shards were not played by the same program")]
    Unlike(usize),
    /// Trials of the plan are missing in all files.
    #[error(
        "{trials} of {of} trials are missing, the first is {first}; play the shards that lack them again with the \
         options and the directory of the others: they go on where they stopped{}",
        lines(.shards)
    )]
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
    /// The trial of this number in the plan could not be played.
    #[error("trial {0}: {1}")]
    Trial(usize, SimulationError),
    /// The match of this number in the plan could not be played.
    #[error("match {0}: {1}")]
    Match(usize, GameError),
    /// Trials could not be written as CSV.
    #[error("trials as CSV: {0}")]
    Csv(#[from] csv::Error),
    /// The caller stopped it; finished trials are kept.
    #[error("stopped; the same command goes on from here")]
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

impl EvaluationError {
    pub(crate) fn file(path: &Path) -> impl Fn(io::Error) -> Self + use<> {
        let file = path.to_owned();
        move |error| Self::File(file.clone(), error)
    }
}

fn printable_path(file: &Path) -> String {
    printable(&file.to_string_lossy()).into_owned()
}

/// Message of [`EvaluationError::Another`].
fn another(file: &Path, merged: Option<&Path>, differences: &[Difference]) -> String {
    let (file, differences) = (printable_path(file), in_words(differences));
    match merged.map(printable_path) {
        Some(other) => format!(
            "{file}: is not of the evaluation of {other}: {differences}; merge shards of one program, library, world \
             and plan: play this one again in an empty directory"
        ),
        None => format!(
            "{file}: holds trials of another evaluation: {differences}; name an empty directory, start again with \
             --fresh, or give the options it was begun with"
        ),
    }
}

fn lines(shards: &[LackingShard]) -> String {
    let line = |LackingShard { shard, trials, of }: &LackingShard| {
        format!("\n  --shard {shard}: {} lacks {trials} of {of} trials", shard.file_name())
    };
    shards.iter().map(line).collect()
}
