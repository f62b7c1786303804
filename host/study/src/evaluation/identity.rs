//! `identity`: all settings that the trials of an evaluation depend on, and what two of them differ in.

use std::collections::BTreeMap;

use hil_sim::{Fnv, Parameters};
use serde::{Deserialize, Serialize};

use super::plan::EvaluationPlan;
use crate::store::Difference;

/// Identity of the evaluation of a file: all settings that its trials depend on. Only equals are resumed or
/// merged.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Identity {
    /// Version and commit of the program.
    pub program: String,
    /// The case library: a league's name, or a directory.
    pub library: String,
    /// Hash of the case base, 8 hexadecimal digits.
    pub case_base: String,
    /// Authored cases of the library by name, in the order of ids.
    pub cases: Vec<String>,
    /// Whether cases are mirrored.
    pub symmetry: bool,
    /// Whether cases contain opponents.
    pub case_opponents: bool,
    /// The named settings of retrieval, name and value.
    pub settings: BTreeMap<String, String>,
    /// Start of a case's actions: `dependent` or `independent`.
    pub positioning: String,
    /// Number of the two robots that may retrieve.
    pub retrievers: usize,
    /// Share of packets that a receiver does not get.
    pub loss: f32,
    /// Whether opponents stop too where robots pause after a cycle.
    pub opponents_pause: bool,
    /// Hash of the world: its data and the version of its model, 8 hexadecimal digits.
    pub world: String,
    /// Parameters of the simulated world.
    pub parameters: Parameters,
    /// All trials of the evaluation, of all shards.
    pub plan: EvaluationPlan,
}

impl Identity {
    /// The settings in which the other differs; empty between equals.
    pub fn differences(&self, other: &Self) -> Vec<Difference> {
        let own = self;
        let shown = |value: &str| value.to_owned();
        let library =
            |identity: &Identity| (identity.case_base.clone(), identity.symmetry, identity.case_opponents);
        let world = |identity: &Identity| (identity.world.clone(), hash_of(&identity.parameters));
        let settings = |identity: &Identity| {
            let differing =
                |(name, _): &(&String, &String)| own.settings.get(*name) != other.settings.get(*name);
            let pairs = identity.settings.iter().filter(differing);
            pairs.map(|(name, value)| format!("{name}={value}")).collect::<Vec<_>>().join(" ")
        };
        let cells = |plan: &EvaluationPlan| plan.clone().with_trials(0).cells;
        let mut trials = None;
        if cells(&own.plan) == cells(&other.plan) {
            trials = Difference::of("number of trials", (&own.plan.cells, &other.plan.cells), |cells| {
                let mut counts: Vec<_> = cells.iter().map(|cell| cell.trials.to_string()).collect();
                counts.dedup();
                counts.join(" ")
            });
        }
        let differences = [
            Difference::of("program", (own.program.as_str(), other.program.as_str()), shown),
            Difference::of("cases", (&library(own), &library(other)), |(hash, symmetry, opponents)| {
                let reduced = [(*symmetry, ", not mirrored"), (*opponents, ", without opponents")];
                let reduced = reduced.into_iter().filter_map(|(kept, text)| (!kept).then_some(text));
                hash.clone() + &reduced.collect::<String>()
            }),
            Difference::of("settings", (settings(own).as_str(), settings(other).as_str()), shown),
            Difference::of("positioning", (own.positioning.as_str(), other.positioning.as_str()), shown),
            Difference::of("retrievers", (&own.retrievers, &other.retrievers), usize::to_string),
            Difference::of("loss", (&own.loss, &other.loss), f32::to_string),
            Difference::of(
                "pause of the opponents",
                (&own.opponents_pause, &other.opponents_pause),
                bool::to_string,
            ),
            Difference::of("world", (&world(own), &world(other)), |(world, parameters)| {
                format!("{world} (parameters {parameters})")
            }),
            Difference::of("seed", (&own.plan.seed, &other.plan.seed), u64::to_string),
            Difference::of(
                "scenarios, opponents or approaches",
                (&cells(&own.plan), &cells(&other.plan)),
                |cells| format!("{} cells (hash {})", cells.len(), hash_of(cells)),
            ),
            trials,
        ];
        differences.into_iter().flatten().collect()
    }
}

/// A hash to tell values apart, 8 hexadecimal digits.
fn hash_of<T: Serialize + ?Sized>(value: &T) -> String {
    let mut hash = Fnv::default();
    // Plain data without maps of float keys: it always serialises.
    hash.add(&serde_json::to_vec(value).unwrap_or_default());
    let value = hash.value();
    format!("{:08x}", (value ^ (value >> 32)) as u32)
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::store::in_words;

    pub(crate) fn identity() -> Identity {
        Identity {
            program: "test".to_owned(),
            library: "four-legged".to_owned(),
            case_base: "00000000".to_owned(),
            cases: vec!["back/clear".to_owned()],
            symmetry: true,
            case_opponents: true,
            settings: BTreeMap::from([("thr_c".to_owned(), "1500".to_owned())]),
            positioning: "dependent".to_owned(),
            retrievers: 2,
            loss: 0.1,
            opponents_pause: true,
            world: hil_sim::world_hash(),
            parameters: Parameters::four_legged().clone(),
            plan: EvaluationPlan::paper(1).with_trials(1),
        }
    }

    #[test]
    fn an_identity_is_read_as_it_was_written() {
        let own = identity();
        let json = serde_json::to_string(&own).unwrap();
        let read: Identity = serde_json::from_str(&json).unwrap();
        assert_eq!(read, own);
        assert_eq!(own.differences(&read), []);
    }

    #[test]
    fn every_setting_that_differs_is_named_with_both_values() {
        let own = identity();
        assert_eq!(own.differences(&own), []);
        let other = Identity { retrievers: 1, plan: own.plan.clone().with_trials(2), ..identity() };
        assert_eq!(in_words(&own.differences(&other)), "retrievers 2, not 1; number of trials 1, not 2");
        let other = Identity { case_base: "1".to_owned(), plan: EvaluationPlan::judge(3), ..identity() };
        let names: Vec<_> = own.differences(&other).iter().map(|difference| difference.what).collect();
        assert_eq!(names, ["cases", "seed", "scenarios, opponents or approaches"]);
        let other = Identity { symmetry: false, program: "0.3.0".to_owned(), ..identity() };
        assert_eq!(
            in_words(&own.differences(&other)),
            "program test, not 0.3.0; cases 00000000, not 00000000, not mirrored"
        );
        let settings = [("thr_c", "1400"), ("cost", "max")].map(|(name, value)| (name.into(), value.into()));
        let other = Identity { settings: settings.into(), ..identity() };
        assert_eq!(in_words(&own.differences(&other)), "settings thr_c=1500, not cost=max thr_c=1400");
    }

    #[test]
    fn another_world_has_another_hash() {
        let (own, mut heavier) = (identity(), identity());
        heavier.parameters.ball.deceleration += 0.01;
        let differences = own.differences(&heavier);
        assert_eq!(differences.len(), 1);
        assert!(differences[0].own.starts_with(&format!("{} (parameters ", own.world)), "{differences:?}");
        assert_ne!(differences[0].own, differences[0].other);
    }
}
