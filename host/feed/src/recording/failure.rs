//! `failure`: why a recording cannot be read, or what it lacks, with the remedy.

use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

use foreign::{printable, printable_path};
use host::record::header::HeaderError;
use host::record::trace::TraceError;
use host::shell::key::KeyError;
use ssl::log::LogError;
use thiserror::Error;

/// A file, and what is wrong with it.
#[derive(Debug)]
pub struct RecordingFailure {
    /// The file.
    pub file: PathBuf,
    /// Fault and remedy.
    pub error: RecordedError,
}

/// Names the file of an error.
pub fn in_file<E: Into<RecordedError>>(file: &Path) -> impl Fn(E) -> RecordingFailure {
    move |error| RecordingFailure { file: file.to_owned(), error: error.into() }
}

impl fmt::Display for RecordingFailure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let file = printable_path(&self.file);
        // The reason may quote the file's own text.
        let reason = self.error.to_string();
        let reason = printable(&reason);
        // Some reasons name the file already.
        if reason.starts_with(&file) { f.write_str(&reason) } else { write!(f, "{file}: {reason}") }
    }
}

impl std::error::Error for RecordingFailure {}

/// A fault of a recording, with the remedy.
#[derive(Debug, Error)]
pub enum RecordedError {
    /// The file cannot be opened.
    #[error("{0}")]
    Open(io::Error),
    /// No trace.
    #[error(transparent)]
    Trace(#[from] TraceError),
    /// A trace whose header cannot be used.
    #[error(transparent)]
    Header(#[from] HeaderError),
    /// No log.
    #[error(transparent)]
    Log(#[from] LogError),
    /// The team's key cannot be used.
    #[error(transparent)]
    Key(#[from] KeyError),
    /// Frames sealed with a key, and none is given.
    #[error("its frames were sealed with the team's key, which no recording holds: add --key-file FILE")]
    NoKey,
    /// A log that was to be checked as a trace.
    #[error("no trace, and only a trace can be checked: give the NAME.trace that `--record NAME` wrote")]
    NoTrace,
    /// A log that was asked for the decisions of robots.
    #[error(
        "no trace, and only a trace holds what robots decided: give the NAME.trace that `--record NAME` wrote"
    )]
    NoDecisions,
    /// The league of the log has no rules.
    #[error("its league has no rules of the Small Size League")]
    NoRules,
    /// A log without a message.
    #[error("holds no message")]
    Empty,
    /// Place where the file is cut or damaged.
    #[error("{0}")]
    Damaged(String),
    /// What was counted in it and is of no use.
    #[error("{0}; the rest is told above")]
    Unused(String),
    /// A moment or event that the recording lacks.
    #[error("{asked}{}", and_damage(damage.as_deref()))]
    NotThere {
        /// The moment or event, and the recording's end.
        asked: String,
        /// Place where the recording is cut or damaged, if it is.
        damage: Option<String>,
    },
    /// Why no match can start from that moment, and what to do.
    #[error("{0}")]
    NoStart(String),
    /// Why it cannot be compared with another trace, and what to do.
    #[error("{0}")]
    Unlike(String),
    /// Cases or a field of another league than the library.
    #[error(
        "a recording of {recorded}, and the library is of {library}: give the library that its robots played, \
         with --library DIR or --league NAME of `onetwo cases evidence` or `cases draft`; `cases learn` learns \
         the four-legged league alone, from `onetwo trial --record`"
    )]
    OtherLeague {
        /// The recording's league.
        recorded: String,
        /// The library's.
        library: String,
    },
    /// Robots with another case base than the library's.
    #[error(
        "its robots had case base {recorded:08x}, the library is {library:08x}, so their cases have no names \
         here: collect with `onetwo cases evidence --library DIR` of their library, and give what it writes"
    )]
    OtherLibrary {
        /// Hash of theirs.
        recorded: u32,
        /// Hash of the library's.
        library: u32,
    },
    /// Nothing that evidence or plays are collected from.
    #[error(
        "neither evidence.jsonl, nor what `trial --record` wrote, nor a trace (.trace), nor a league log (.log, \
         .log.gz)"
    )]
    NoRecording,
}

fn and_damage(damage: Option<&str>) -> String {
    damage.map_or_else(String::new, |damage| format!("; the file is damaged: {damage}"))
}
