//! `work`: units of trials.

use std::collections::BTreeMap;

use arena::{Profile, TrialConfig};
use brain::Approach;
use geometry::{Angle, Field, Point, Pose};
use hil_sim::{Configuration, Fnv, Layout, OpponentRole, Placed, Scenario, SimulationError};
use serde::{Deserialize, Serialize};

use crate::evaluation::Planned;
use crate::learning::player::{PlayError, Playable};
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
        /// Places of ball and robots.
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

impl Playable for Unit<'_> {
    type Played = LearningTrial;

    fn key(&self) -> u64 {
        let mut hash = Fnv::default();
        hash.add(&self.variant.hash.to_le_bytes());
        // Plain data without maps of float keys: it always serialises.
        hash.add(&serde_json::to_vec(&self.work).unwrap_or_default());
        hash.value()
    }

    fn play(&self, seed: u64) -> Result<Vec<LearningTrial>, PlayError> {
        self.run(seed).map_err(PlayError::Simulation)
    }

    fn counts(&self, played: &[LearningTrial]) -> u64 {
        played.len() as u64
    }
}

impl Unit<'_> {
    fn run(&self, seed: u64) -> Result<Vec<LearningTrial>, SimulationError> {
        match &self.work {
            Work::Starts { stream, indices, record } => {
                let plan = StartPlan::new(seed, *stream);
                let starts = indices.iter().filter_map(|index| plan.get(*index));
                starts
                    .map(|Planned { cell, seed, .. }| {
                        let config = TrialConfig::new(cell.scenario, cell.configuration, cell.approach, seed);
                        play(&cell.profile.apply(self.with_library(config)), *record)
                    })
                    .collect()
            }
            Work::Situation { situation, profile, two_defenders, first, trials } => {
                let configuration =
                    if *two_defenders { Configuration::TwoDefenders } else { Configuration::DefenderGoalie };
                let layout = layout(situation, configuration);
                let numbers = (0..*trials).map(|number| first.saturating_add(number));
                numbers
                    .map(|number| {
                        let mut hash = Fnv::default();
                        hash.add(&seed.to_le_bytes());
                        hash.add(&u32::to_le_bytes(number));
                        let seed = hash.value() >> 16;
                        let config = TrialConfig::new(Scenario::Random, configuration, Approach::Cases, seed);
                        let config = TrialConfig { layout: Some(layout.clone()), ..config };
                        play(&profile.apply(self.with_library(config)), false)
                    })
                    .collect()
            }
        }
    }

    /// A trial with the unit's library and its settings of retrieval.
    fn with_library<'t>(&'t self, config: TrialConfig<'static>) -> TrialConfig<'t> {
        TrialConfig {
            settings: self.variant.settings.clone(),
            ..config.with_library(self.variant.base(), self.variant.case_names())
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
