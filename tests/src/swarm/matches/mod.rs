//! `matches`: whole matches of two teams of ours, with manual acts that give cards, change keepers, halt,
//! stop, restart, and move the ball, checked against the rules and the project's promised properties.
//! docs/architecture.md §5.4; s, m, field frame.
//!
//! A seed is a match: [`plan`] draws the manual acts, `run` plays it with both hosts, all brains, cameras,
//! radio and the simulator's own referee in one process, and checks every 10 ms from outside: [`keep_out`],
//! [`frozen`], halts and stops, and that the match goes on. `cargo xtask swarm --plan referee --seeds 1000`
//! plays many; one that fails prints the line that repeats it.

pub mod frozen;
pub mod keep_out;
pub mod plan;
mod run;

use std::collections::BTreeMap;
use std::fmt;
use std::fmt::Write as _;

use frozen::{Frozen, Must};
use protocol::Who;
use rules::{Colour, Phase};

pub use plan::Plan;
pub use run::{BLOCKED_LONGEST, config, play};

/// Length of a match, ms.
pub const LENGTH: u32 = 60_000;

/// A violated property, with its evidence.
#[derive(Clone, Debug, PartialEq)]
pub enum Broken {
    /// A robot stayed at a forbidden position.
    KeepOut(keep_out::Broken),
    /// A robot stands that has to move; with its host's order.
    Frozen(Frozen, String),
    /// A robot moves in HALT after 2 s.
    MovedInHalt(Who, f32),
    /// A robot is faster than 1.5 m/s in STOP after 2 s.
    FastInStop(Who, f32),
    /// The match stands: the obstacle that the referee reports.
    Blocked(hil_sim::small_size::referee::ReadyObstacle),
    /// It could not be played to its end.
    Ended(String),
}

impl Broken {
    /// Its kind, for counting.
    pub fn kind(&self, phase: Phase<Colour>) -> String {
        match self {
            Self::KeepOut(broken) => format!("keep-out {:?} in {}", broken.within.why, bare(phase)),
            Self::Frozen(frozen, _) => format!("frozen in {}", bare(phase) + must(frozen.must)),
            Self::MovedInHalt(..) => "moved in halt".into(),
            Self::FastInStop(..) => "fast in stop".into(),
            Self::Blocked(obstacle) => format!("blocked in {} by {}", bare(phase), obstacle.reason.label()),
            Self::Ended(_) => "not played".into(),
        }
    }
}

fn must(must: Must) -> &'static str {
    match must {
        Must::Leave => ", has to leave",
        Must::MakeWay => ", the referee waits for it",
        Must::GoTo(_) => ", has an order",
        Must::Play(_) => ", has to play the ball",
    }
}

fn bare(phase: Phase<Colour>) -> String {
    let name = format!("{phase:?}");
    name.split('(').next().unwrap_or_default().to_owned()
}

/// A violated property, with time and phase.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// Time since the match's start, ms.
    pub ms: u32,
    /// Phase in which it was found.
    pub phase: Phase<Colour>,
    /// The property and its evidence.
    pub broken: Broken,
}

impl Found {
    /// Its kind, for counting.
    pub fn kind(&self) -> String {
        self.broken.kind(self.phase)
    }
}

impl fmt::Display for Found {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:.2} s, {:?}: ", f64::from(self.ms) / 1000.0, self.phase)?;
        let name = |who: &Who| format!("{} {}", who.colour.label(), who.id);
        match &self.broken {
            Broken::KeepOut(keep_out::Broken { within, beyond }) => write!(
                f,
                "{} is {:.3} m within {:?}, {beyond:.2} s beyond its grace",
                name(&within.who),
                within.depth,
                within.why
            ),
            Broken::Frozen(Frozen { who, must, at }, order) => {
                write!(f, "{} stands at ({:.2}, {:.2}): {must:?}; {order}", name(who), at.x(), at.y())
            }
            Broken::MovedInHalt(who, speed) => write!(f, "{} moves at {speed:.2} m/s", name(who)),
            Broken::FastInStop(who, speed) => write!(f, "{} goes {speed:.2} m/s", name(who)),
            Broken::Blocked(obstacle) => write!(f, "the match stands: {obstacle}"),
            Broken::Ended(error) => f.write_str(error),
        }
    }
}

/// Results of a match.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Outcome {
    /// Every violation, oldest first.
    pub found: Vec<Found>,
    /// Seconds in which a team might play the ball.
    pub running_s: f32,
    /// Seconds in which the match stood for longer than the referee's patience.
    pub blocked_s: f32,
    /// Number of manual acts that were valid at their time.
    pub acts: u32,
    /// Number of robots taken off the field by hand.
    pub taken_off: u32,
    /// Numbers of penalties, kick-offs and free kicks that started, and of placements that succeeded and
    /// failed.
    pub begun: [u32; 5],
    /// Trace hash of the match.
    pub trace: String,
}

/// Results of many matches.
#[derive(Clone, Debug, Default)]
pub struct Sum {
    /// Number of matches played.
    pub matches: u32,
    /// Number of matches with each kind of violation.
    pub kinds: BTreeMap<String, u32>,
    /// The sum of all other numbers.
    pub all: Outcome,
}

impl Sum {
    /// Adds the result of one match.
    pub fn add(&mut self, outcome: &Outcome) {
        self.matches += 1;
        let mut kinds: Vec<String> = outcome.found.iter().map(Found::kind).collect();
        kinds.sort_unstable();
        kinds.dedup();
        for kind in kinds {
            *self.kinds.entry(kind).or_default() += 1;
        }
        self.all.running_s += outcome.running_s;
        self.all.blocked_s += outcome.blocked_s;
        self.all.acts += outcome.acts;
        self.all.taken_off += outcome.taken_off;
        for (all, one) in self.all.begun.iter_mut().zip(outcome.begun) {
            *all += one;
        }
    }
}

/// The lines that report a match with violations; the last one repeats it.
pub fn report(plan: &Plan, outcome: &Outcome) -> String {
    let mut lines = String::new();
    for found in &outcome.found {
        let _ = writeln!(lines, "seed {}: {found}", plan.seed);
    }
    format!("{lines}  {plan}\n  repeat: cargo xtask swarm --plan referee --first {} --seeds 1", plan.seed)
}
