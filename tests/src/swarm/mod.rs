//! `swarm`: swarm test: a team stays safe under many faults at once, and plays again afterwards. A swarm of
//! runs, each with faults of its own (docs/architecture.md §5.4, §6.2).
//!
//! A seed is a run: [`plan`] draws robots and faults, `legged` and `wheels` play it with native brains,
//! [`adversary`] tampers with radios and [`computer`] with sensors and clocks. The promised properties are
//! checked from outside: [`crate::invariants`] for the team's cycles, [`guard`] for each robot's body, by the
//! messages that an [`honest`] receiver may accept. `cargo xtask swarm --seeds 10000` runs many; one that
//! fails prints the line that repeats it.

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

pub use runs::{Runs, report, watch, watch_matches};

/// Results of a run without violations.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counters {
    /// Number of runs added.
    pub runs: u32,
    /// Number of cycles, over all runs.
    pub cycles: u32,
    /// Number of gameplays among them.
    pub gameplays: u32,
    /// Number of times that two gameplays ran at once.
    pub overlaps: u32,
    /// Number of packets delivered to robots.
    pub packets: u64,
    /// Number of those that an honest receiver does not accept.
    pub unbelievable: u64,
    /// Number of steps in which a robot on wheels had to brake and did.
    pub brakings: u64,
    /// Number of gameplays that all their robots finished.
    pub finished: u32,
    /// Number of gameplays that a robot stopped.
    pub stopped: u32,
    /// Number of times that an armed robot on wheels stopped for lack of its host.
    pub false_stops: u32,
    /// Total time of those stops, ms.
    pub stood_ms: u64,
    /// Number of intervals from the end of a gameplay to a newer cycle that all robots know.
    pub gaps: u32,
    /// Sum of these intervals, ms.
    pub gaps_ms: u64,
    /// The longest time from healing to a team that plays, ms.
    pub slowest_ms: u32,
}

impl Counters {
    /// The sum of both.
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

/// A violated property, by what violates it.
#[derive(Clone, Debug, PartialEq)]
pub enum Broken {
    /// By a robot's body.
    Body(RobotId, guard::Danger),
    /// By the team's cycles.
    Team(String),
    /// A robot that does not play was made coordinator or got a part, according to the other robot.
    Ghost(RobotId, RobotId),
    /// A second after healing the team does not play: its known state.
    Dead(String),
    /// A second after healing that robot still brakes.
    Lame(RobotId),
}

/// A violated property, with its time.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// Time since the run's start, ms.
    pub ms: u32,
    /// The property and its evidence.
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
pub fn run(seed: u64) -> Result<Counters, Found> {
    play(Plan::drawn(seed))
}

/// Plays the run of that plan.
pub fn play(plan: Plan) -> Result<Counters, Found> {
    match plan.squad {
        Squad::Legged => legged::run(plan),
        Squad::Wheels => wheels::run(plan),
    }
}
