//! `recording`: recorded matches, read again: traces of ours, whose hosts decide again, and league log files
//! of any team (docs/architecture.md §7.4). s since the start of the file.

mod beside;
mod clock;
mod collect;
mod compare;
mod comparison;
mod decisions;
mod failure;
mod log_messages;
mod moment;
mod packets;
mod projector;
mod rows;
mod sheet;
mod start;
mod trace_file;
mod unlike;

pub use beside::Beside;
pub use clock::{ClockStep, LogClock, Rate};
pub use collect::{CollectError, OpenLibrary, collect};
pub use compare::{PlaySettings, comparable, compare};
pub use comparison::Report as ComparisonReport;
pub use decisions::{Decision, Decisions, problem_line};
pub use failure::{RecordedError, RecordingFailure, in_file};
pub use log_messages::LogMessages;
pub use moment::{Moment, Score};
pub use packets::{LeaguePacket, LeaguePackets};
pub use projector::{Projector, Shown};
pub use rows::{FieldSource, Row, Rows, columns};
pub use sheet::Sheet;
pub use start::start_from;
pub use trace_file::{TraceFile, begins_as_trace, hosts_of, record_label};

pub use crate::referee_event::{RefereeEvent, RefereeEventFinder, is_meant};

/// Reports of the reading of a recording.
pub trait ReadObserver {
    /// One more record was read.
    fn record(&self);
    /// A line for the operator.
    fn note(&self, line: &str);
}
