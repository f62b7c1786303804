//! `starts`: streams of start situations for learning: training, validation and held-out starts that never
//! meet.
//!
//! Two thirds are played as in the paper's simulator, half of them random starts and half the paper's four
//! scenarios, against both kinds of opponents; one third as by the paper's robots, half of them random starts
//! and half the scenarios that its robots played. A start is named by stream and index, so that any trial can
//! be played anywhere, in any order.

use crate::evaluation::{EvaluationCell, EvaluationPlan, Planned};
use arena::Profile;
use brain::Approach;
use hil_sim::{Configuration, Scenario};
use serde::{Deserialize, Serialize};

/// Use of starts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum StartStream {
    /// Evidence, proposals, and their first trials.
    Exploration,
    /// Tests that decide on a change.
    Confirmation,
    /// The check that an accepted change lowers no kind of start.
    Validation,
    /// The learning curve; never decides anything.
    HeldOut,
}

/// A kind of starts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StartKind {
    /// The world that they are played in.
    pub profile: Profile,
    /// The opponents.
    pub opponents: Configuration,
    /// Start positions.
    pub scenario: Scenario,
}

impl StartKind {
    const fn new(profile: Profile, opponents: Configuration, scenario: Scenario) -> Self {
        Self { profile, opponents, scenario }
    }

    /// Name, such as `dg random` or `robots dg 3`.
    pub fn label(self) -> String {
        let Self { profile, opponents, scenario } = self;
        let world = if profile == Profile::Robots { "robots " } else { "" };
        format!("{world}{} {}", opponents.label(), scenario.label())
    }
}

/// The kinds of starts.
pub const KINDS: [StartKind; 13] = {
    use Configuration::{DefenderGoalie, TwoDefenders};
    use Profile::{Robots, Simulated};
    use Scenario::{DefenderAhead, DefenderClose, LeftSide, MiddleBack, Random};
    [
        StartKind::new(Simulated, DefenderGoalie, Random),
        StartKind::new(Simulated, TwoDefenders, Random),
        StartKind::new(Simulated, DefenderGoalie, MiddleBack),
        StartKind::new(Simulated, DefenderGoalie, LeftSide),
        StartKind::new(Simulated, DefenderGoalie, DefenderAhead),
        StartKind::new(Simulated, DefenderGoalie, DefenderClose),
        StartKind::new(Simulated, TwoDefenders, MiddleBack),
        StartKind::new(Simulated, TwoDefenders, LeftSide),
        StartKind::new(Simulated, TwoDefenders, DefenderAhead),
        StartKind::new(Simulated, TwoDefenders, DefenderClose),
        StartKind::new(Robots, DefenderGoalie, Random),
        StartKind::new(Robots, DefenderGoalie, DefenderAhead),
        StartKind::new(Robots, DefenderGoalie, DefenderClose),
    ]
};

/// Kinds of successive starts, by number in [`KINDS`], after which they repeat.
const CYCLE: [usize; 24] = [0, 2, 10, 1, 3, 11, 0, 4, 10, 1, 5, 12, 0, 6, 10, 1, 7, 11, 0, 8, 10, 1, 9, 12];

/// The kind, in [`KINDS`], of the start with this index, and its number within the kind.
pub fn kind_of(index: u32) -> (usize, u32) {
    let (cycle, slot) = (index / CYCLE.len() as u32, index as usize % CYCLE.len());
    let kind = CYCLE[slot];
    let times = |slots: &[usize]| slots.iter().filter(|other| **other == kind).count() as u32;
    (kind, cycle * times(&CYCLE) + times(&CYCLE[..slot]))
}

geometry::labels! {
    /// The worlds that a run learns in.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum Worlds {
        /// The paper's simulator, noiseless.
        Simulated = "simulated",
        /// The paper's robots: noise, and a pause after every cycle.
        Robots = "robots",
        /// Both: a change may lower neither.
        Both = "both",
    }
}

impl Worlds {
    /// Whether starts of this kind are played.
    pub fn has(self, kind: StartKind) -> bool {
        match self {
            Self::Simulated => kind.profile == Profile::Simulated,
            Self::Robots => kind.profile == Profile::Robots,
            Self::Both => true,
        }
    }

    /// Indices of `count` starts from `from` on, of those that are played.
    pub fn indices(self, from: u32, count: u32) -> Vec<u32> {
        let own: Vec<u32> =
            (0..CYCLE.len() as u32).filter(|slot| self.has(KINDS[CYCLE[*slot as usize]])).collect();
        let (own_len, cycle) = (own.len() as u32, CYCLE.len() as u32);
        (from..from + count).map(|n| n / own_len * cycle + own[(n % own_len) as usize]).collect()
    }
}

/// The starts of a run with this seed.
#[derive(Clone, Debug)]
pub struct StartPlan(EvaluationPlan);

impl StartPlan {
    /// Starts of `stream`. Streams differ in high bits, so that no seed below 2^40 of another run or of an
    /// evaluation gives the same.
    pub fn new(seed: u64, stream: StartStream) -> Self {
        let cells = KINDS.map(|kind| EvaluationCell {
            profile: kind.profile,
            configuration: kind.opponents,
            scenario: kind.scenario,
            approach: Approach::Cases,
            trials: u32::MAX,
        });
        let number = 1 + stream as u64;
        Self(EvaluationPlan { seed: seed ^ (number << 48), cells: cells.to_vec() })
    }

    /// The start with this index.
    pub fn get(&self, index: u32) -> Option<Planned> {
        let (kind, within) = kind_of(index);
        self.0.get(kind * u32::MAX as usize + within as usize)
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn each_world_has_its_own_starts_in_order_and_both_have_all() {
        assert_eq!(Worlds::Both.indices(5, 60), (5..65).collect::<Vec<_>>());
        let [simulated, robots] =
            [Worlds::Simulated, Worlds::Robots].map(|worlds| worlds.indices(0, 800 / 5));
        for (indices, worlds) in [(&simulated, Worlds::Simulated), (&robots, Worlds::Robots)] {
            assert!(indices.iter().all(|index| worlds.has(KINDS[kind_of(*index).0])));
            assert!(indices.is_sorted_by(|a, b| a < b));
            assert_eq!(worlds.indices(30, 50), indices[30..80]);
        }
        let all: BTreeSet<u32> = simulated.iter().chain(&robots[..80]).copied().collect();
        assert_eq!(all, (0..240).collect(), "16 and 8 of 24");
    }

    #[test]
    fn half_of_the_starts_are_random_a_third_noisy_and_no_two_are_the_same() {
        let mut seen = BTreeSet::new();
        let streams = [
            StartStream::Exploration,
            StartStream::Confirmation,
            StartStream::Validation,
            StartStream::HeldOut,
        ];
        for stream in streams {
            let plan = StartPlan::new(7, stream);
            let starts: Vec<_> = (0..240).filter_map(|index| plan.get(index)).collect();
            assert_eq!(starts.len(), 240);
            let random = starts.iter().filter(|start| start.cell.scenario == Scenario::Random).count();
            let noisy = starts.iter().filter(|start| start.cell.profile == Profile::Robots).count();
            assert_eq!((random, noisy), (120, 80));
            // The same seed in both worlds gives the same start.
            seen.extend(starts.iter().map(|start| (start.cell.profile.label(), start.seed)));
            for (index, start) in (0..).zip(&starts) {
                let EvaluationCell { profile, configuration, scenario, .. } = start.cell;
                assert_eq!(StartKind::new(profile, configuration, scenario), KINDS[kind_of(index).0]);
            }
        }
        assert_eq!(seen.len(), 4 * 240);
    }
}
