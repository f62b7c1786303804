//! `match_team`: team configuration in a match. A team, and of the second paper's tactics those that its host
//! plays: an ablation is a team (docs/papers.md D24).

use std::collections::BTreeSet;
use std::fmt;
use std::str::FromStr;

use brain::Approach;
use host::strategy::{ROUND_1, Tactics, Team};

/// A team with its tactics, written as one label: `zone`, `ours`, `ours-without-second-level`,
/// `ours-without-cases`, `ours-with-coerce+pass-ahead`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MatchTeam {
    /// Strategy of its open play.
    pub team: Team,
    /// Tactics of the second paper that its host plays.
    pub tactics: Tactics,
    /// Whether its robots retrieve and play cases (the first paper); else they play reactively where the
    /// host leaves the play to them.
    pub cases: bool,
    /// Whether the strategy in another program gives its orders ([`super::MatchPlan::strategy`]).
    pub strategy: bool,
}

impl MatchTeam {
    /// Our team with the default tactics.
    pub fn ours() -> Self {
        Self::from(Team::Ours)
    }

    /// Our team with [`Tactics::ROUND_1`]: a reference opponent.
    pub fn round_1() -> Self {
        Self { tactics: Tactics::ROUND_1, ..Self::ours() }
    }

    /// The team of a strategy in another program.
    pub fn strategy() -> Self {
        Self { strategy: true, ..Self::ours() }
    }

    /// Our team once for each part of the second paper, and once for the cases: without it where it is on by
    /// default and with it where it is not.
    pub fn ablations() -> Vec<Self> {
        let defaults = Self::ours().parts();
        let flipped = |part: &String| {
            let mut parts = defaults.clone();
            if !parts.remove(part) {
                parts.insert(part.clone());
            }
            Self::of_parts(parts).ok()
        };
        Self::all_parts().iter().filter_map(flipped).collect()
    }

    /// Approach of its robots: cases, or reactive behaviour.
    pub fn approach(self) -> Approach {
        if self.cases { Approach::Cases } else { Approach::Reactive }
    }

    /// Tactics of its host: a host whose robots play no cases proposes none.
    pub fn host_tactics(self) -> Tactics {
        Tactics { bridge: self.tactics.bridge && self.cases, ..self.tactics }
    }

    /// Parses its label; the error lists the accepted ones.
    pub fn parse(label: &str) -> Result<Self, String> {
        let wrong = || {
            let teams = Team::ALL.map(Team::label).join(", ");
            format!(
                "no team `{label}`; take {teams}, {ROUND_1}, {STRATEGY}, or ours with other tactics: ours-with-A+B, ours-without-A+B, \
                 of {}",
                joined(&Self::all_parts(), ", ")
            )
        };
        if label == ROUND_1 {
            return Ok(Self::round_1());
        }
        if label == STRATEGY {
            return Ok(Self::strategy());
        }
        let Some(changes) = label.strip_prefix("ours-") else {
            return Team::from_label(label).map(Self::from).ok_or_else(wrong);
        };
        let mut parts = Self::ours().parts();
        let (with, without) = match changes.split_once("without-") {
            Some((with, without)) => (with.trim_end_matches('-'), Some(without)),
            None => (changes, None),
        };
        if !with.is_empty() || without.is_none() {
            let with = with.strip_prefix("with-").ok_or_else(wrong)?;
            parts.extend(with.split('+').map(str::to_owned));
        }
        for part in without.into_iter().flat_map(|without| without.split('+')) {
            // The parts after `without` are checked too: a typing error must not be read as the default team.
            Self::of_parts(BTreeSet::from([part.to_owned()])).map_err(|_| wrong())?;
            parts.remove(part);
        }
        Self::of_parts(parts).map_err(|_| wrong())
    }

    /// The parts by which this one differs from the other, joined by `+`, and whether it is this one that has
    /// them; `None` where each has what the other lacks, and between equals and different teams.
    pub fn part_beside(self, other: Self) -> Option<(String, bool)> {
        let (more, less) = (self.beyond(other), other.beyond(self));
        match (&more[..], &less[..]) {
            ([], []) => None,
            (_, []) => Some((more.join("+"), true)),
            ([], _) => Some((less.join("+"), false)),
            _ => None,
        }
    }

    /// The parts that this one plays and the other does not; empty between different teams.
    fn beyond(self, other: Self) -> Vec<String> {
        if (self.team, self.strategy) != (other.team, other.strategy) {
            return Vec::new();
        }
        self.parts().difference(&other.parts()).cloned().collect()
    }

    /// Names of the enabled parts, from [`Tactics::description`] and [`CASES`]: a part that is added there is
    /// listed here too.
    fn parts(self) -> BTreeSet<String> {
        let names = self.tactics.description();
        let tactics = names.split(',').filter(|name| *name != "none");
        tactics.chain(self.cases.then_some(CASES)).map(str::to_owned).collect()
    }

    fn all_parts() -> BTreeSet<String> {
        Self { tactics: Tactics::ALL, ..Self::ours() }.parts()
    }

    /// Our team with these parts alone; the error names the one that does not exist.
    fn of_parts(mut parts: BTreeSet<String>) -> Result<Self, String> {
        let cases = parts.remove(CASES);
        let tactics = if parts.is_empty() { Tactics::NONE } else { Tactics::parse(&joined(&parts, ","))? };
        Ok(Self { team: Team::Ours, tactics, cases, strategy: false })
    }
}

impl From<Team> for MatchTeam {
    fn from(team: Team) -> Self {
        Self { team, tactics: Tactics::default(), cases: true, strategy: false }
    }
}

impl fmt::Display for MatchTeam {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.strategy {
            return f.write_str(STRATEGY);
        }
        if *self == Self::round_1() && *self != Self::ours() {
            return f.write_str(ROUND_1);
        }
        let (own, defaults) = (self.parts(), Self::ours().parts());
        let change = |parts: Vec<&String>| parts.into_iter().cloned().collect::<BTreeSet<_>>();
        f.write_str(self.team.label())?;
        for (label, parts) in [
            ("-with-", change(own.difference(&defaults).collect())),
            ("-without-", change(defaults.difference(&own).collect())),
        ] {
            if !parts.is_empty() {
                write!(f, "{label}{}", joined(&parts, "+"))?;
            }
        }
        Ok(())
    }
}

impl FromStr for MatchTeam {
    type Err = String;

    fn from_str(label: &str) -> Result<Self, String> {
        Self::parse(label)
    }
}

hil_sim::serde_by_text!(MatchTeam);

fn joined(parts: &BTreeSet<String>, between: &str) -> String {
    parts.iter().map(String::as_str).collect::<Vec<_>>().join(between)
}

/// The label of the team of a strategy in another program.
const STRATEGY: &str = "strategy";

/// The name of the first paper's part: cases.
const CASES: &str = "cases";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_team_is_parsed_from_the_label_it_is_printed_as() {
        let ablations = MatchTeam::ablations();
        assert_eq!(ablations.len(), MatchTeam::all_parts().len());
        let none = MatchTeam { tactics: Tactics::NONE, cases: false, ..MatchTeam::ours() };
        assert_eq!(MatchTeam::parse("strategy"), Ok(MatchTeam::strategy()));
        assert_eq!(MatchTeam::strategy().to_string(), "strategy");
        let all = MatchTeam { tactics: Tactics::ALL, ..MatchTeam::ours() };
        let teams = Team::ALL.map(MatchTeam::from);
        let round_1 = MatchTeam::round_1();
        for match_team in ablations.iter().chain(&teams).chain([&none, &all, &round_1]) {
            assert_eq!(MatchTeam::parse(&match_team.to_string()).as_ref(), Ok(match_team), "{match_team}");
        }
        assert_eq!(MatchTeam::parse(ROUND_1), Ok(round_1));
        assert!(ablations.iter().all(|ablation| *ablation != MatchTeam::ours()));
        assert!(MatchTeam::ours().beyond(none).contains(&"threats".to_owned()));
        assert_eq!(MatchTeam::ours().beyond(Team::Zone.into()), Vec::<String>::new());
    }

    #[test]
    fn a_label_names_the_parts_that_differ_from_the_default_team() {
        let changed = Tactics { second_level: !Tactics::default().second_level, ..Tactics::default() };
        let label = MatchTeam { tactics: changed, ..MatchTeam::ours() }.to_string();
        assert!(matches!(&*label, "ours-without-second-level" | "ours-with-second-level"), "{label}");
        let reactive = MatchTeam::parse("ours-without-cases").unwrap();
        assert_eq!(reactive, MatchTeam { cases: false, ..MatchTeam::ours() });
        assert_eq!(reactive.approach(), Approach::Reactive);
        assert_eq!(MatchTeam::ours().beyond(reactive), ["cases"]);
        let bridge = |label| MatchTeam::parse(label).unwrap().host_tactics().bridge;
        assert!(bridge("ours-with-bridge") && !bridge("ours-with-bridge-without-cases"));
        let both = MatchTeam::parse("ours-with-coerce-without-threats+second-level").unwrap();
        assert!(both.tactics.coerce && !both.tactics.threats && !both.tactics.second_level);
    }

    #[test]
    fn an_unknown_team_is_refused_with_the_list_of_known_ones() {
        for label in
            ["", "best", "ours-", "ours-with-", "ours-with-luck", "ours-without-luck", "zone-with-coerce"]
        {
            let reported = MatchTeam::parse(label).unwrap_err();
            assert!(reported.contains(&format!("`{label}`")) && reported.contains("reactive"), "{reported}");
            assert!(reported.contains("second-level"), "{reported}");
        }
    }
}
