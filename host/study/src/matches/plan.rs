//! `plan`: the matches of an evaluation. Each pair of teams plays equally often, with the same random seeds
//! for every pair, alternately as blue and as yellow.

use hil_sim::Fnv;
use hil_sim::small_size::worlds::WorldPlan;
use rules::League;
use serde::{Deserialize, Serialize};

use super::match_team::MatchTeam;

/// Two teams that play against each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Pairing {
    /// The team whose numbers come first.
    pub own: MatchTeam,
    /// The team that it plays against.
    pub opponent: MatchTeam,
}

/// Numbers the matches: pair by pair.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MatchPlan {
    /// Seed from which the matches' seeds are derived.
    pub seed: u64,
    /// Name of the league: field, robots and rules.
    pub league: String,
    /// The world of each match; the league's own where an older file does not name one.
    #[serde(default)]
    pub world: WorldPlan,
    /// Simulated seconds of a match.
    pub duration_s: f64,
    /// Pairs of teams, in the order of matches.
    pub pairings: Vec<Pairing>,
    /// Number of matches of each pair.
    pub matches: u32,
    /// The command of the strategy that gives the orders of the team `strategy`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub strategy: Option<String>,
    /// The league's game controller that runs every match, as `--game-controller` takes it; none: the
    /// internal referee.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub controller: Option<String>,
}

/// A match of a plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Planned {
    /// Number in the plan, from 0.
    pub number: usize,
    /// The pair of teams.
    pub pairing: Pairing,
    /// Whether the first of the pair plays blue.
    pub own_is_blue: bool,
    /// Seed that replays it.
    pub seed: u64,
}

impl Planned {
    /// The teams of blue and yellow, in this order.
    pub fn sides(&self) -> (MatchTeam, MatchTeam) {
        let Pairing { own, opponent } = self.pairing;
        if self.own_is_blue { (own, opponent) } else { (opponent, own) }
    }
}

impl MatchPlan {
    /// A team against each of these.
    pub fn against(own: MatchTeam, opponents: &[MatchTeam]) -> Vec<Pairing> {
        opponents.iter().map(|&opponent| Pairing { own, opponent }).collect()
    }

    /// Each of these against each other.
    pub fn round_robin(teams: &[MatchTeam]) -> Vec<Pairing> {
        let mut pairings = Vec::new();
        for (i, &own) in teams.iter().enumerate() {
            pairings.extend(teams[i + 1..].iter().map(|&opponent| Pairing { own, opponent }));
        }
        pairings
    }

    /// Number of matches, over all pairs.
    pub fn len(&self) -> usize {
        self.pairings.len() * self.matches as usize
    }

    /// Whether it has no matches.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The league itself; `None` if its name is unknown or it has no such matches.
    pub fn league(&self) -> Option<League> {
        [League::Ssl2013, League::DivisionB, League::DivisionA]
            .into_iter()
            .find(|league| league.name() == self.league)
    }

    /// The match with this number.
    pub fn get(&self, number: usize) -> Option<Planned> {
        let matches = self.matches as usize;
        let pairing = *self.pairings.get(number.checked_div(matches)?)?;
        let round = number % matches;
        Some(Planned { number, pairing, own_is_blue: round.is_multiple_of(2), seed: self.seed_of(round) })
    }

    /// The seed is independent of the pair: all draw the same random numbers.
    fn seed_of(&self, round: usize) -> u64 {
        let mut hash = Fnv::default();
        hash.add(&self.seed.to_le_bytes());
        hash.add(&(round as u64).to_le_bytes());
        let value = hash.value();
        (value ^ (value >> SEED_BITS)) & ((1 << SEED_BITS) - 1)
    }
}

/// Length of a seed, bits: exact for every reader of JSON (53 bits), and short to type.
const SEED_BITS: u32 = 48;

#[cfg(test)]
mod tests {
    use host::strategy::Team;

    use super::*;

    #[test]
    fn pairs_meet_as_often_on_both_sides_with_the_same_seeds() {
        let pairings = MatchPlan::round_robin(&[Team::Ours, Team::Reactive, Team::Zone].map(MatchTeam::from));
        assert_eq!(pairings.len(), 3);
        let plan = MatchPlan {
            seed: 1,
            league: "division-b".to_owned(),
            world: WorldPlan::RandomPerMatch,
            duration_s: 600.0,
            pairings,
            matches: 4,
            strategy: None,
            controller: None,
        };
        let all: Vec<_> = (0..plan.len()).filter_map(|number| plan.get(number)).collect();
        assert_eq!((all.len(), plan.get(12)), (12, None));
        assert_eq!(all.iter().filter(|planned| planned.own_is_blue).count(), 6);
        for round in 0..4 {
            assert_eq!(all[round].seed, all[round + 4].seed);
            assert_eq!(all[round].pairing.own, MatchTeam::ours());
        }
        assert_ne!(all[0].seed, all[1].seed);
        assert_eq!(all[1].sides(), (Team::Reactive.into(), MatchTeam::ours()));
    }
}
