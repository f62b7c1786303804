//! `recorded`: why a recording cannot be read, or what it lacks, for `onetwo replay`.

use std::fmt;
use std::io;

use host::record::header::HeaderError;
use host::record::trace::TraceError;
use host::shell::key::KeyError;
use ssl::log::LogError;

/// What is wrong with a recording, and how to fix it. The file is named by the failure.
#[derive(Debug)]
pub(crate) enum RecordedError {
    /// It cannot be opened.
    Open(io::Error),
    /// It is no trace.
    Trace(TraceError),
    /// The trace's header cannot be used.
    Header(HeaderError),
    /// It is no log.
    Log(LogError),
    /// The team's key cannot be used.
    Key(KeyError),
    /// It was sealed with a key, and none is given.
    NoKey,
    /// A log was to be checked as a trace.
    NoTrace,
    /// A log was asked for the decisions of robots.
    NoDecisions,
    /// The league of the log has no rules.
    NoRules,
    /// A log without a message.
    Empty,
    /// It is cut or damaged: where.
    Damaged(String),
    /// The moment or event is not in it.
    NotThere(Missing),
    /// It cannot be compared with another trace: why, and what to do.
    Unlike(String),
    /// Its cases or its field are of another league than the library.
    OtherLeague {
        /// The recording's league.
        recorded: String,
        /// The library's.
        library: String,
    },
    /// Its robots had another case base than the library's.
    OtherLibrary {
        /// Hash of theirs.
        recorded: u32,
        /// Hash of the library's.
        library: u32,
    },
    /// It is nothing that evidence or plays are collected from.
    NoRecording,
}

/// A moment that a recording lacks.
#[derive(Debug)]
pub(crate) struct Missing {
    /// What was asked for.
    pub(crate) asked: Asked,
    /// Where it is cut or damaged, if it is.
    pub(crate) damage: Option<String>,
}

/// What was asked for.
#[derive(Debug)]
pub(crate) enum Asked {
    /// A time after a trace's end, and the end; s.
    TraceTime(f64, f64),
    /// An event of a trace.
    TraceEvent {
        /// How many there are.
        met: u32,
        /// Its name.
        name: String,
        /// Which of them was asked for.
        nth: u32,
        /// Where the trace ends, s.
        end: f64,
    },
    /// A time after a log's end, and the log's length; s.
    LogTime(f64, f64),
    /// An event of a log.
    LogEvent {
        /// How many there are.
        met: u32,
        /// Its name.
        name: String,
        /// Which of them was asked for.
        nth: u32,
        /// The names of those that it has.
        known: Vec<String>,
    },
}

impl fmt::Display for Asked {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TraceTime(at, end) => write!(f, "{at} s is after its end; it ends at {end:.3} s"),
            Self::TraceEvent { met, name, nth, end } => {
                write!(f, "{met} `{name}` in it, not {nth}; it ends at {end:.3} s")
            }
            Self::LogTime(at, end) => write!(f, "it ends after {end:.3} s, before {at} s"),
            Self::LogEvent { met, name, nth, known } => {
                let known = if known.is_empty() { "no event".to_owned() } else { known.join(", ") };
                write!(f, "{met} `{name}` in it, not {nth}; it has: {known}")
            }
        }
    }
}

impl fmt::Display for RecordedError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Open(error) => write!(f, "{error}"),
            Self::Trace(error) => write!(f, "{error}"),
            Self::Header(error) => write!(f, "{error}"),
            Self::Log(error) => write!(f, "{error}"),
            Self::Key(error) => write!(f, "{error}"),
            Self::NoKey => f.write_str(
                "its frames were sealed with the team's key, which no recording holds: add --key-file FILE",
            ),
            Self::NoTrace => f.write_str(
                "no trace, and only a trace can be checked: give the NAME.trace that `--record NAME` wrote",
            ),
            Self::NoDecisions => f.write_str(
                "no trace, and only a trace holds what robots decided: give the NAME.trace that `--record NAME` wrote",
            ),
            Self::NoRules => f.write_str("its league has no rules of the Small Size League"),
            Self::Empty => f.write_str("holds no message"),
            Self::OtherLeague { recorded, library } => write!(
                f,
                "a recording of {recorded}, and the library is of {library}: give the library that its robots \
                 played, with --library DIR or --league NAME of `onetwo cases evidence` or `cases draft`; `cases \
                 learn` learns the four-legged league alone, from `onetwo trial --record`"
            ),
            Self::OtherLibrary { recorded, library } => write!(
                f,
                "its robots had case base {recorded:08x}, the library is {library:08x}, so their cases have no \
                 names here: collect with `onetwo cases evidence --library DIR` of their library, and give what it \
                 writes"
            ),
            Self::NoRecording => f.write_str(
                "neither evidence.jsonl, nor what `trial --record` wrote, nor a trace (.trace), nor a league log \
                 (.log, .log.gz)",
            ),
            Self::Damaged(place) | Self::Unlike(place) => f.write_str(place),
            Self::NotThere(Missing { asked, damage: None }) => write!(f, "{asked}"),
            Self::NotThere(Missing { asked, damage: Some(damage) }) => {
                write!(f, "{asked}; the file is damaged: {damage}")
            }
        }
    }
}
