//! `setup`: team configuration of an evaluation. All settings of a team that an evaluation may change: one
//! value for all its trials.

use brain::Positioning;
use casebase::RetrievalSettings;
use hil_sim::AirSettings;

use crate::trial::TrialConfig;

/// A team's set-up. The default is the paper's.
#[derive(Clone, Debug, PartialEq)]
pub struct Setup {
    /// Settings of case retrieval (docs/case-format.md §3.2).
    pub settings: RetrievalSettings,
    /// Start of a case's actions.
    pub positioning: Positioning,
    /// Number of the two robots that may retrieve (paper §4.1).
    pub retrievers: usize,
    /// Share of packets that a receiver does not get.
    pub loss: f32,
    /// Whether cases are mirrored (paper §2.4); without it only authored ones are known.
    pub symmetry: bool,
    /// Whether cases contain opponents (paper §2.1).
    pub opponents: bool,
    /// Whether opponents stop too where robots pause after a cycle (paper §5.3).
    pub opponents_pause: bool,
}

impl Default for Setup {
    fn default() -> Self {
        Self {
            settings: RetrievalSettings::default(),
            positioning: Positioning::default(),
            retrievers: ROBOTS,
            loss: 0.0,
            symmetry: true,
            opponents: true,
            opponents_pause: true,
        }
    }
}

impl Setup {
    /// The same trial with this set-up; `symmetry` and `opponents` must be applied when the library is
    /// opened.
    pub fn apply<'a>(&self, config: TrialConfig<'a>) -> TrialConfig<'a> {
        TrialConfig {
            settings: self.settings.clone(),
            positioning: self.positioning,
            retrievers: self.retrievers.min(config.robots),
            air: AirSettings::with_loss(self.loss),
            opponents_pause: self.opponents_pause,
            ..config
        }
    }
}

/// Number of attackers of every trial of an evaluation, as the paper's.
pub const ROBOTS: usize = 2;
