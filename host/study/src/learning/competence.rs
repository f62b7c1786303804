//! `competence`: what evidence says of each case: its posterior to-goal rate against what is usual where it
//! is played.

use std::collections::BTreeMap;

use hil_sim::Configuration;
use serde::Serialize;

use crate::learning::evidence::{Evidence, EvidenceKey, Posterior, ScopeRing};

/// Weight of a library's records for each later library.
const DECAY: f64 = 0.5;

/// A rate and what is usual in the same world and areas against the same opponents.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Standing {
    /// The rate.
    pub posterior: Posterior,
    /// Plays times usual rate, summed.
    usual: f64,
}

impl Standing {
    /// Decayed number of plays.
    pub fn plays(&self) -> f64 {
        self.posterior.plays()
    }

    /// Rate above what is usual there: its posterior mean less the usual one, shrunk towards 0 as the prior
    /// of 100 plays does.
    pub fn advantage(&self) -> f64 {
        let plays = self.plays();
        let goals = self.posterior.alpha - 1.0;
        (goals - self.usual) / (plays + PRIOR)
    }

    fn add(&mut self, counts: &crate::learning::evidence::EvidenceCounts, weight: f64, usual: f64) {
        self.posterior.add(counts, weight);
        self.usual += weight * counts.plays as f64 * usual;
    }
}

/// Sums of the evidence of a case.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct CaseStanding {
    /// All plays.
    pub all: Standing,
    /// Those with the ball in the inner half of the scope.
    pub security: Standing,
    /// Those with the ball in the outer half.
    pub risk: Standing,
    /// Those with an opponent in each of its scopes.
    pub met: Standing,
    /// Those with an empty opponent scope.
    pub unmet: Standing,
    /// Those against defender and goalie.
    pub goalie: Standing,
    /// Those against two defenders.
    pub no_goalie: Standing,
}

/// The standing of every case that was played; that of "no case" under the empty name. `libraries` are the
/// hashes of the libraries, oldest first.
pub fn standings(evidence: &Evidence, libraries: &[u64]) -> BTreeMap<String, CaseStanding> {
    let names: Vec<String> = libraries.iter().map(|hash| format!("{hash:016x}")).collect();
    let weight = |key: &EvidenceKey| {
        let age = names.iter().rev().position(|name| *name == key.library)?;
        Some((0..age).fold(1.0, |weight, _| weight * DECAY))
    };
    let mut areas: BTreeMap<(&str, &str, u8), Posterior> = BTreeMap::new();
    for (key, counts) in &evidence.0 {
        if let Some(weight) = weight(key) {
            areas.entry((&key.world, &key.opponents, key.area)).or_default().add(counts, weight);
        }
    }
    let mut standings: BTreeMap<String, CaseStanding> = BTreeMap::new();
    for (key, counts) in &evidence.0 {
        let Some(weight) = weight(key) else { continue };
        let usual =
            areas.get(&(key.world.as_str(), key.opponents.as_str(), key.area)).map_or(0.5, Posterior::mean);
        let standing = standings.entry(key.case.clone()).or_default();
        let ring = match key.ring {
            ScopeRing::Security => &mut standing.security,
            ScopeRing::Risk => &mut standing.risk,
        };
        ring.add(counts, weight, usual);
        standing.all.add(counts, weight, usual);
        let met = key.pattern.split_once('/').is_some_and(|(held, of)| held == of);
        let pattern = if met { &mut standing.met } else { &mut standing.unmet };
        pattern.add(counts, weight, usual);
        let goalie = key.opponents == Configuration::DefenderGoalie.label();
        let opponents = if goalie { &mut standing.goalie } else { &mut standing.no_goalie };
        opponents.add(counts, weight, usual);
    }
    standings
}

/// Plays that an advantage is shrunk by, an estimate: a hundred plays give half of what they show.
const PRIOR: f64 = 100.0;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::learning::evidence::EvidenceCounts;

    #[test]
    fn a_case_is_compared_with_what_is_usual_where_it_is_played() {
        let record = |case: &str, area, plays, to_goal, library: u64| {
            let key = EvidenceKey {
                library: format!("{library:016x}"),
                world: String::new(),
                case: case.to_owned(),
                symmetry: 0,
                ring: ScopeRing::Risk,
                pattern: "1/1".to_owned(),
                opponents: "dg".to_owned(),
                area,
            };
            Evidence(BTreeMap::from([(key, EvidenceCounts { plays, to_goal, ends: BTreeMap::new() })]))
        };
        // Two cases share an area and differ; a third plays where scoring is easy, and is merely usual there.
        let evidence = record("a/good", 1, 500, 300, 1)
            .merge(record("a/bad", 1, 500, 100, 1))
            .merge(record("b/easy", 9, 500, 400, 1));
        let of = |libraries: &[u64]| standings(&evidence, libraries);
        let found = of(&[1]);
        assert!(found["a/good"].risk.advantage() > 0.15);
        assert!(found["a/bad"].all.advantage() < -0.15);
        assert!(found["b/easy"].met.advantage().abs() < 0.01);
        assert_eq!(found["a/good"].security.plays(), 0.0);
        assert_eq!(of(&[1, 2])["a/good"].all.plays(), 250.0, "of the library before");
        assert!(of(&[2]).is_empty(), "of a library that is not asked for");
    }
}
