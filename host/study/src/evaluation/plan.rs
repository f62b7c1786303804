//! `plan`: the trials of an evaluation. Cells of (profile, opponents, scenario, approach), trials numbered
//! through, a seed each.
//!
//! Common random numbers: the k-th trial of every approach has the same seed, so that approaches draw the
//! same random numbers. A seed is enough to play a trial again alone: `onetwo trial --scenario S --opponents
//! O --approach A --seed N`.

use brain::Approach;
use hil_sim::{Configuration, Fnv, Scenario};
use serde::{Deserialize, Serialize};

use super::labels;
use crate::store::Shard;
use arena::{APPROACHES, Profile};

/// Trials that differ only in their seed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct EvaluationCell {
    /// The world that the trials are played in.
    pub profile: Profile,
    /// The opponents: defender and goalie, or two defenders.
    pub configuration: Configuration,
    /// Start positions of ball and robots.
    #[serde(with = "labels::scenario")]
    pub scenario: Scenario,
    /// Approach of the attackers.
    #[serde(with = "labels::approach")]
    pub approach: Approach,
    /// Number of trials in the cell.
    pub trials: u32,
}

/// All trials of an evaluation.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct EvaluationPlan {
    /// Seed from which the trials' seeds are derived.
    pub seed: u64,
    /// The cells, in the order of trials.
    pub cells: Vec<EvaluationCell>,
}

/// A trial of a plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Planned {
    /// Number in the plan, from 0.
    pub number: usize,
    /// The cell to which it belongs.
    pub cell: EvaluationCell,
    /// Seed of the trial; the same for the k-th trial of every approach.
    pub seed: u64,
}

impl EvaluationPlan {
    /// The paper's trials: 500 a cell against defender and goalie, 200 against two defenders; and those of
    /// its robots, 500 a cell, of which the first 30 are as many as the paper's.
    pub fn paper(seed: u64) -> Self {
        Self::of(seed, &Scenario::PAPER, [500, 200, 500])
    }

    /// Enough trials to distinguish 3 percent of 30 from chance, random starts among them; on seeds of their
    /// own.
    pub fn judge(seed: u64) -> Self {
        let scenarios: Vec<_> = Scenario::PAPER.into_iter().chain([Scenario::Random]).collect();
        Self::of(seed, &scenarios, [5000; 3])
    }

    /// Case-based attackers in the paper's eight simulated cells: the reference for ablations.
    pub fn ablation(seed: u64) -> Self {
        Self::of(seed, &Scenario::PAPER, [200; 3])
            .only(|cell| cell.profile == Profile::Simulated && cell.approach == Approach::Cases)
    }

    /// Trials a cell: against defender and goalie, against two defenders, as the paper's robots.
    fn of(seed: u64, scenarios: &[Scenario], [dg, two, robots]: [u32; 3]) -> Self {
        let mut plan = Self { seed, cells: Vec::new() };
        plan.add(Profile::Simulated, Configuration::DefenderGoalie, scenarios, dg);
        plan.add(Profile::Simulated, Configuration::TwoDefenders, scenarios, two);
        plan.add(Profile::Robots, Configuration::DefenderGoalie, &PLAYED_BY_ROBOTS, robots);
        plan
    }

    fn add(&mut self, profile: Profile, configuration: Configuration, scenarios: &[Scenario], trials: u32) {
        for &scenario in scenarios {
            let cell = |approach| EvaluationCell { profile, configuration, scenario, approach, trials };
            self.cells.extend(APPROACHES.map(cell));
        }
    }

    /// Adds random starts in this world after the other cells, as many trials as their configuration's there.
    pub fn with_random(mut self, profile: Profile) -> Self {
        for configuration in [Configuration::DefenderGoalie, Configuration::TwoDefenders] {
            let alike =
                |cell: &&EvaluationCell| (cell.profile, cell.configuration) == (profile, configuration);
            if let Some(trials) = self.cells.iter().find(alike).map(|cell| cell.trials) {
                self.add(profile, configuration, &[Scenario::Random], trials);
            }
        }
        self
    }

    /// Keeps only the cells for which `wanted` is true.
    pub fn only(mut self, wanted: impl Fn(&EvaluationCell) -> bool) -> Self {
        self.cells.retain(wanted);
        self
    }

    /// The same cells with this number of trials each.
    pub fn with_trials(mut self, trials: u32) -> Self {
        for cell in &mut self.cells {
            cell.trials = trials;
        }
        self
    }

    /// Number of trials, over all cells.
    pub fn len(&self) -> usize {
        self.cells.iter().map(|cell| cell.trials as usize).sum()
    }

    /// Whether it has no trials.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The trial with this number.
    pub fn get(&self, number: usize) -> Option<Planned> {
        let mut within = number;
        for cell in &self.cells {
            let trials = cell.trials as usize;
            if within < trials {
                return Some(Planned { number, cell: *cell, seed: self.seed_of(*cell, within as u32) });
            }
            within -= trials;
        }
        None
    }

    /// The trials of a shard, in order.
    pub fn shard(&self, shard: Shard) -> impl Iterator<Item = Planned> + '_ {
        (0..self.len()).filter(move |number| shard.has(*number)).filter_map(|number| self.get(number))
    }

    /// The seed is independent of approach and profile: they draw the same random numbers.
    fn seed_of(&self, cell: EvaluationCell, trial: u32) -> u64 {
        let mut hash = Fnv::default();
        hash.add(&self.seed.to_le_bytes());
        hash.add(cell.configuration.label().as_bytes());
        hash.add(cell.scenario.label().as_bytes());
        hash.add(&trial.to_le_bytes());
        let value = hash.value();
        (value ^ (value >> SEED_BITS)) & ((1 << SEED_BITS) - 1)
    }
}

/// Scenarios of the paper's robots (§5.3), against defender and goalie.
const PLAYED_BY_ROBOTS: [Scenario; 2] = [Scenario::DefenderAhead, Scenario::DefenderClose];
/// Length of a seed, bits: exact for every reader of JSON (53 bits), and short to type.
const SEED_BITS: u32 = 48;

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn the_papers_plan_has_its_5600_simulated_trials() {
        let compared = |cell: &EvaluationCell| matches!(cell.approach, Approach::Cases | Approach::Reactive);
        let plan = EvaluationPlan::paper(1).only(compared);
        let of = |profile| {
            let cells = plan.cells.iter().filter(|cell| cell.profile == profile);
            cells.map(|cell| cell.trials).sum::<u32>()
        };
        assert_eq!((of(Profile::Simulated), of(Profile::Robots)), (5600, 4 * 500));
        assert_eq!((plan.len(), plan.get(7599).map(|trial| trial.number)), (7600, Some(7599)));
        assert_eq!(plan.get(7600), None);
    }

    #[test]
    fn random_starts_stand_behind_and_change_no_other_trial() {
        let with_random = |profile| EvaluationPlan::paper(1).with_random(profile);
        let (plan, random) = (EvaluationPlan::paper(1), with_random(Profile::Simulated));
        assert_eq!(random.cells[..plan.cells.len()], plan.cells);
        let added = &random.cells[plan.cells.len()..];
        assert!(added.iter().all(|cell| cell.scenario == Scenario::Random));
        assert_eq!(added.iter().map(|cell| cell.trials).sum::<u32>(), 700 * APPROACHES.len() as u32);
        let only_random = |plan: EvaluationPlan| plan.only(|cell| cell.scenario == Scenario::Random);
        assert_eq!(only_random(with_random(Profile::Simulated)).cells, added);
        let noisy = only_random(with_random(Profile::Robots)).cells;
        assert_eq!(noisy.len(), APPROACHES.len());
        assert!(noisy.iter().all(|cell| {
            (cell.profile, cell.configuration) == (Profile::Robots, Configuration::DefenderGoalie)
        }));
        let arms = EvaluationPlan::ablation(1);
        assert!(arms.cells.len() == 8 && arms.cells.iter().all(|cell| cell.approach == Approach::Cases));
    }

    #[test]
    fn approaches_meet_the_same_chances_and_nothing_else_does() {
        let plan = EvaluationPlan::paper(1);
        let seeds = |approach, profile| -> Vec<u64> {
            let trials = plan.shard(Shard::WHOLE);
            let own = trials.filter(|t| t.cell.approach == approach && t.cell.profile == profile);
            own.map(|trial| trial.seed).collect()
        };
        let cases = seeds(Approach::Cases, Profile::Simulated);
        assert_eq!(cases, seeds(Approach::Reactive, Profile::Simulated));
        assert_eq!(cases.iter().collect::<BTreeSet<_>>().len(), 2800, "of 4 × (500 + 200)");
        assert_ne!(plan.get(0).map(|t| t.seed), EvaluationPlan::paper(2).get(0).map(|t| t.seed));
    }

    #[test]
    fn shards_share_the_trials_among_them() {
        let plan = EvaluationPlan::paper(1).with_trials(3);
        let mut all: Vec<_> = (1..=4)
            .flat_map(|i| plan.shard(Shard::new(i, 4).unwrap()).map(|t| t.number).collect::<Vec<_>>())
            .collect();
        all.sort_unstable();
        assert_eq!(all, (0..plan.len()).collect::<Vec<_>>());
    }
}
