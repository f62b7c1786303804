//! `work`: units of trials, and who plays them. Learning asks for units; how many threads, processes and
//! interrupted runs it took to play them has no effect on what it learns.

use std::collections::BTreeMap;
use std::fmt;

use crate::evaluation::Planned;
use arena::Profile;
use arena::TrialConfig;
use arena::game::GameError;
use brain::Approach;
use foreign::printable;
use geometry::{Angle, Field, Point, Pose};
use hil_sim::{Configuration, Fnv, Layout, OpponentRole, Placed, Scenario, SimulationError};
use serde::{Deserialize, Serialize};

use crate::learning::starts::{StartPlan, StartStream};
use crate::learning::trial::{LearningTrial, Situation, play};
use crate::learning::variant::Variant;

/// Starts of a unit: few enough that all threads have work in small steps.
pub(crate) const BATCH: u32 = 16;

/// The trials of a unit.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Work {
    /// Starts of a stream, by index.
    Starts {
        /// The stream.
        stream: StartStream,
        /// Their indices.
        indices: Vec<u32>,
        /// Whether decisions are recorded.
        record: bool,
    },
    /// A situation, played from standing robots.
    Situation {
        /// Where everything stands.
        situation: Situation,
        /// The world that it is played in.
        profile: Profile,
        /// Whether the opponents are two defenders.
        two_defenders: bool,
        /// Number of the first trial's seed.
        first: u32,
        /// Number of trials, with the seeds from there on.
        trials: u32,
    },
}

/// A library and trials to play with it.
#[derive(Clone, Debug)]
pub struct Unit<'a> {
    /// The library.
    pub variant: &'a Variant,
    /// The trials.
    pub work: Work,
}

/// Plays units, or knows what became of them.
pub trait Player {
    /// The trials of every unit, in order.
    fn play(&mut self, units: &[Unit<'_>]) -> Result<Vec<Vec<LearningTrial>>, PlayError>;
}

/// Why units were not played.
#[derive(Debug)]
pub enum PlayError {
    /// The simulator cannot go on.
    Simulation(SimulationError),
    /// A match cannot go on.
    Match(GameError),
    /// The journal cannot be read or written.
    Journal(std::io::Error),
    /// The journal is of another run: other settings, library or world.
    OtherRun {
        /// The journal.
        file: String,
        /// What differs, with the journal's value first.
        differences: String,
    },
    /// A line of a journal is no unit.
    Damaged {
        /// The journal.
        file: String,
        /// Where the line begins, bytes.
        at: u64,
        /// The error in it.
        what: String,
    },
    /// Stopped by hand; what is finished is kept.
    Stopped,
}

impl fmt::Display for PlayError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Simulation(error) => write!(f, "a trial cannot be played: {error}"),
            Self::Match(error) => write!(f, "a match cannot be played: {error}"),
            Self::Journal(error) => {
                write!(f, "the journal of trials cannot be kept: {error}; make the output directory writable")
            }
            Self::OtherRun { file, differences } => {
                let (file, differences) = (printable(file), printable(differences));
                write!(f, "{file} is of another run: {differences}; take another --out")
            }
            Self::Damaged { file, at, what } => write!(
                f,
                "{}: the line at byte {at} is no unit of trials: {}; remove the file, its units are played again",
                printable(file),
                printable(what)
            ),
            Self::Stopped => f.write_str("stopped; the same command goes on from here"),
        }
    }
}

impl std::error::Error for PlayError {}

impl Unit<'_> {
    /// The unit's name in journals: equal for equal trials.
    pub fn key(&self) -> u64 {
        let mut hash = Fnv::default();
        hash.add(&self.variant.hash.to_le_bytes());
        // Plain data without maps of float keys: it always serialises.
        hash.add(&serde_json::to_vec(&self.work).unwrap_or_default());
        hash.value()
    }

    /// Number of its trials.
    pub fn trials(&self) -> u32 {
        match &self.work {
            Work::Starts { indices, .. } => indices.len() as u32,
            Work::Situation { trials, .. } => *trials,
        }
    }

    /// Plays the unit.
    pub fn play(&self, seed: u64) -> Result<Vec<LearningTrial>, SimulationError> {
        let (base, names) = (self.variant.base(), self.variant.case_names());
        let with_variant = |config: TrialConfig<'static>| TrialConfig {
            settings: self.variant.settings.clone(),
            ..config.with_library(base, names.clone())
        };
        match &self.work {
            Work::Starts { stream, indices, record } => {
                let plan = StartPlan::new(seed, *stream);
                let starts = indices.iter().filter_map(|index| plan.get(*index));
                let trial = |Planned { cell, seed, .. }: Planned| {
                    let config = TrialConfig::new(cell.scenario, cell.configuration, cell.approach, seed);
                    play(&cell.profile.apply(with_variant(config)), *record)
                };
                starts.map(trial).collect()
            }
            Work::Situation { situation, profile, two_defenders, first, trials } => {
                let configuration =
                    if *two_defenders { Configuration::TwoDefenders } else { Configuration::DefenderGoalie };
                let layout = layout(situation, configuration);
                let trial = |number| {
                    let mut hash = Fnv::default();
                    hash.add(&seed.to_le_bytes());
                    hash.add(&u32::to_le_bytes(number));
                    let config = TrialConfig::new(
                        Scenario::Random,
                        configuration,
                        Approach::Cases,
                        hash.value() >> 16,
                    );
                    let config = TrialConfig { layout: Some(layout.clone()), ..config };
                    play(&profile.apply(with_variant(config)), false)
                };
                (0..*trials).map(|number| trial(first.saturating_add(number))).collect()
            }
        }
    }
}

/// The start positions of a situation: attackers face the ball, and the opponent nearer to its own goal has
/// the role nearer to it.
fn layout(situation: &Situation, configuration: Configuration) -> Layout {
    let place = |[x, y]: [i32; 2]| Point::<Field>::new(x as f32 / 1000.0, y as f32 / 1000.0);
    let ball = place(situation.ball);
    let mut attackers: BTreeMap<u8, [i32; 2]> = situation.teammates.iter().copied().collect();
    let attackers = (1..=2).filter_map(|id| attackers.remove(&id)).map(|at| {
        let position = place(at);
        let heading = if at == situation.ball { Angle::ZERO } else { position.direction_to(ball) };
        Pose { position, heading }
    });
    let roles = match configuration {
        Configuration::DefenderGoalie => [OpponentRole::Defender, OpponentRole::Goalie],
        Configuration::TwoDefenders => [OpponentRole::Midfield, OpponentRole::Defender],
    };
    let mut opponents = situation.opponents.clone();
    opponents.sort_unstable();
    let opponents = roles.into_iter().zip(opponents).map(|(role, at)| Placed::at_home(role, place(at), ball));
    Layout { ball, attackers: attackers.collect(), opponents: opponents.collect() }
}
