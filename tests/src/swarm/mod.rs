//! `swarm`: swarm test: a team stays safe under many faults at once, and plays again afterwards. A swarm of
//! runs, each with faults of its own (docs/architecture.md §5.4, §6.2).
//!
//! A seed is a run: [`plan`] draws who plays and what goes wrong, `legged` and `wheels` play it with native brains,
//! [`adversary`] tampers with radios and [`computer`] with sensors and clocks. What is promised is watched from outside:
//! [`crate::invariants`] for the team's cycles, [`guard`] for each robot's body, by what an [`honest`] listener may
//! believe. `cargo xtask swarm --seeds 10000` runs many; one that fails prints the line that repeats it.

pub mod adversary;
pub mod computer;
pub mod guard;
pub mod honest;
mod legged;
pub mod matches;
pub mod plan;
mod runs;
mod script;
mod team;
mod wheels;

use std::fmt;

use plan::{Plan, Squad};
use protocol::RobotId;

pub use runs::{Runs, watch, watch_matches, words};

/// What came of a run in which every promise was kept.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Runs.
    pub runs: u32,
    /// Cycles seen.
    pub cycles: u32,
    /// Gameplays among them.
    pub gameplays: u32,
    /// Times at which two gameplays ran at once.
    pub overlaps: u32,
    /// Packets handed to robots.
    pub packets: u64,
    /// Packets among them that an honest listener does not believe.
    pub unbelievable: u64,
    /// Steps in which a robot on wheels had to brake and did.
    pub brakings: u64,
    /// Gameplays that all their robots finished, and that somebody stopped.
    pub finished: u32,
    /// See there.
    pub stopped: u32,
    /// Times at which a robot on wheels that was armed stopped for want of its host, and all time it stood for that, ms.
    pub false_stops: u32,
    /// See there.
    pub stood_ms: u64,
    /// Times from the end of a gameplay to a newer cycle that all robots know: how many, and their sum, ms.
    pub gaps: u32,
    /// See there.
    pub gaps_ms: u64,
    /// The longest time from healing to a team that plays, ms.
    pub slowest_ms: u32,
}

impl Tally {
    /// Both together.
    #[must_use]
    pub fn with(self, other: Self) -> Self {
        Self {
            runs: self.runs + other.runs,
            cycles: self.cycles + other.cycles,
            gameplays: self.gameplays + other.gameplays,
            overlaps: self.overlaps + other.overlaps,
            packets: self.packets + other.packets,
            unbelievable: self.unbelievable + other.unbelievable,
            brakings: self.brakings + other.brakings,
            finished: self.finished + other.finished,
            stopped: self.stopped + other.stopped,
            false_stops: self.false_stops + other.false_stops,
            stood_ms: self.stood_ms + other.stood_ms,
            gaps: self.gaps + other.gaps,
            gaps_ms: self.gaps_ms + other.gaps_ms,
            slowest_ms: self.slowest_ms.max(other.slowest_ms),
        }
    }
}

/// A broken promise.
#[derive(Clone, Debug, PartialEq)]
pub enum Broken {
    /// A robot's body.
    Body(RobotId, guard::Danger),
    /// The team's cycles.
    Team(String),
    /// Somebody who does not play was made coordinator or got a part, as that robot says.
    Ghost(RobotId, RobotId),
    /// A second after healing the team does not play: what is known of it.
    Dead(String),
    /// A second after healing that robot still brakes.
    Lame(RobotId),
}

/// A broken promise, and when, ms.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// When.
    pub ms: u32,
    /// What.
    pub broken: Broken,
}

impl fmt::Display for Found {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "at {} ms: ", self.ms)?;
        match &self.broken {
            Broken::Body(robot, danger) => write!(f, "robot {robot}: {danger}"),
            Broken::Team(what) => f.write_str(what),
            Broken::Ghost(robot, ghost) => {
                write!(f, "robot {robot} counts on robot {ghost}, which does not play")
            }
            Broken::Dead(what) => write!(f, "a second after healing the team does not play: {what}"),
            Broken::Lame(robot) => write!(f, "a second after healing robot {robot} still brakes"),
        }
    }
}

/// Plays the run of that seed.
pub fn run(seed: u64) -> Result<Tally, Found> {
    play(Plan::drawn(seed))
}

/// Plays the run of that plan.
pub fn play(plan: Plan) -> Result<Tally, Found> {
    match plan.squad {
        Squad::Legged => legged::run(plan),
        Squad::Wheels => wheels::run(plan),
    }
}
