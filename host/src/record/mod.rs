//! `record`: recording of a match and its use: the league's log file and a trace of every input and packet,
//! written on a thread of its own, read back, and compared with a host's decisions on the same inputs.

mod background;
mod case_table;
pub mod header;
pub mod recheck;
mod recorder;
pub mod trace;

pub use background::BackgroundRecorder;
pub use recorder::Recorder;
