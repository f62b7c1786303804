//! `arena`: trials and matches of simulator and brains, their reports, text logs and figures. Runs on the PC.
//!
//! [`run`] plays one trial of Ros et al. 2009 and returns its [`TrialReport`] (docs/case-format.md §5.2). For
//! more than the report there is a [`Watcher`]: it gets every tick, as an observer at the field's edge with a
//! radio receiver would see it; [`TextLog`] writes it as text, [`Recording`] keeps what [`picture()`] draws.
//!
//! [`CaseTrial`] plays single cases from their own situation, many times, and reports whether a case does
//! what its author intended.
//!
//! [`cases`] opens a case library and answers questions to it.
//!
//! [`game`] plays matches of the Small Size League, a host and its robots on each side.
//!
//! [`ledger`] counts what became of every case that was played.
//!
//! [`Snapshot`] is a moment of the simulated field, kept to return to.
//!
//! [`successful_plays`] finds the plays of recordings that led to a shot or a goal.
//!
//! **Invariants.** Watching changes nothing; reports come from the true state and the radio, never from
//! inside a brain.
#![forbid(unsafe_code)]

mod activity;
pub mod attack;
mod backups;
mod case_trial;
pub mod cases;
mod cycles;
mod defaults;
pub mod game;
pub mod ledger;
mod names;
mod picture;
mod profile;
mod recording;
mod report;
mod setup;
mod snapshot;
mod story;
pub mod successful_plays;
mod trial;

pub use case_trial::{Attempt, AttemptError, CaseTrial, Opposition, Retrieved, Score, Tape, markdown};
pub use cycles::{CycleEnd, CycleEvent, CycleLog, CycleSeen};
pub use names::{CaseNames, Cast, letter};
pub use picture::picture;
pub use profile::Profile;
pub use recording::{RecordedKick, RecordedSample, Recording, Start};
pub use report::{
    ActivityReport, Backups, CaseCounts, Causes, CycleReport, DefaultReport, Possession, TrialReport,
    serialize_scenario,
};
pub use setup::{ROBOTS, Setup};
pub use snapshot::{BallState, RobotState, Snapshot, SnapshotError};
pub use story::TextLog;
pub use trial::{
    APPROACHES, Moment, TEAM, TrialConfig, Watcher, approach_from_label, approach_label, positioning_label,
    run,
};
