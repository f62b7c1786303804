//! `starts`: streams of start situations for learning: training, validation and held-out starts that never
//! meet.
//!
//! Half of the starts are random ones, half the paper's four scenarios, against both kinds of opponents. A
//! start is named by stream and index, so that any trial can be played anywhere, in any order.

use arena::evaluation::{EvaluationCell, EvaluationPlan, Planned, Profile};
use brain::Approach;
use hil_sim::{Configuration, Scenario};
use serde::{Deserialize, Serialize};

/// What starts are used for.
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

/// Kinds of starts: opponents and scenario.
pub const CELLS: [(Configuration, Scenario); 10] = [
    (Configuration::DefenderGoalie, Scenario::Random),
    (Configuration::TwoDefenders, Scenario::Random),
    (Configuration::DefenderGoalie, Scenario::MiddleBack),
    (Configuration::DefenderGoalie, Scenario::LeftSide),
    (Configuration::DefenderGoalie, Scenario::DefenderAhead),
    (Configuration::DefenderGoalie, Scenario::DefenderClose),
    (Configuration::TwoDefenders, Scenario::MiddleBack),
    (Configuration::TwoDefenders, Scenario::LeftSide),
    (Configuration::TwoDefenders, Scenario::DefenderAhead),
    (Configuration::TwoDefenders, Scenario::DefenderClose),
];
/// Starts after which the kinds repeat.
const CYCLE: u32 = 16;

/// The kind, in [`CELLS`], of the start with this index, and its number within the kind.
pub fn cell(index: u32) -> (usize, u32) {
    let (cycle, slot) = (index / CYCLE, index % CYCLE);
    if slot.is_multiple_of(2) {
        // Eight random starts a cycle, four against each kind of opponents.
        ((slot / 2 % 2) as usize, cycle * 4 + slot / 4)
    } else {
        (2 + (slot / 2) as usize, cycle)
    }
}

/// The name of a kind, such as `dg random`.
pub fn cell_label(cell: usize) -> String {
    CELLS.get(cell).map_or_else(String::new, |(configuration, scenario)| {
        format!("{} {}", configuration.label(), scenario.label())
    })
}

/// The starts of a run with this seed.
#[derive(Clone, Debug)]
pub struct StartPlan(EvaluationPlan);

impl StartPlan {
    /// Starts of `stream`. Streams differ in high bits, so that no seed below 2^40 of another run or of an
    /// evaluation gives the same.
    pub fn new(seed: u64, stream: StartStream) -> Self {
        let cells = CELLS.map(|(configuration, scenario)| EvaluationCell {
            profile: Profile::Simulated,
            configuration,
            scenario,
            approach: Approach::Cases,
            trials: u32::MAX,
        });
        let number = 1 + stream as u64;
        Self(EvaluationPlan { seed: seed ^ (number << 48), cells: cells.to_vec() })
    }

    /// The start with this index.
    pub fn get(&self, index: u32) -> Option<Planned> {
        let (cell, within) = cell(index);
        self.0.get(cell * u32::MAX as usize + within as usize)
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn half_of_the_starts_are_random_and_no_two_are_the_same() {
        let mut seen = BTreeSet::new();
        let streams = [
            StartStream::Exploration,
            StartStream::Confirmation,
            StartStream::Validation,
            StartStream::HeldOut,
        ];
        for stream in streams {
            let plan = StartPlan::new(7, stream);
            let starts: Vec<_> = (0..160).filter_map(|index| plan.get(index)).collect();
            assert_eq!(starts.len(), 160);
            let random = starts.iter().filter(|start| start.cell.scenario == Scenario::Random).count();
            assert_eq!(random, 80);
            seen.extend(starts.iter().map(|start| start.seed));
            for (index, start) in (0..).zip(&starts) {
                let (configuration, scenario) = CELLS[cell(index).0];
                assert_eq!((start.cell.configuration, start.cell.scenario), (configuration, scenario));
            }
        }
        assert_eq!(seen.len(), 4 * 160);
    }
}
