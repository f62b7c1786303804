//! `profile`: the two worlds of Ros et al. 2009: their simulator and their robots.

use protocol::Duration;
use serde::{Deserialize, Serialize};

use crate::trial::TrialConfig;

geometry::labels! {
    /// The world trials are played in.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
    #[serde(rename_all = "lowercase")]
    pub enum Profile {
        /// The paper's simulator: noiseless perception (§5.2).
        Simulated = "simulated",
        /// The paper's robots: noise in perception, 5 s of standing still after every cycle (§5.3;
        /// docs/papers.md R40).
        Robots = "robots",
    }
}

impl Profile {
    /// The same trial in this world.
    pub fn apply(self, config: TrialConfig<'_>) -> TrialConfig<'_> {
        match self {
            Self::Simulated => config,
            Self::Robots => {
                TrialConfig { noise: config.parameters.noise, pause_after_cycle: PAUSE_OF_ROBOTS, ..config }
            }
        }
    }
}

/// Time that the paper's robots stood still after every cycle (§5.3).
const PAUSE_OF_ROBOTS: Duration = Duration::millis(5000);
