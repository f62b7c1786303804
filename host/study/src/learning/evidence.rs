//! `evidence`: outcome statistics of cases, as whole numbers that merge in any order, and Beta posteriors of
//! them.
//!
//! A record counts the plays of one case in one symmetry, ring of the ball's scope, pattern of opponents and
//! area of the field, in one library and world. It lies beside a library as `evidence.jsonl`, a record a
//! line, and never in case files. Older libraries' records decay when they are read, not when they are
//! stored.

use std::collections::BTreeMap;

use arena::Profile;
use casebase::{FieldMm, PointMm, Scope};
use serde::{Deserialize, Serialize};

use crate::learning::trial::{LearningTrial, Situation, TrialDecision};
use crate::learning::variant::Variant;

/// Part of the ball's scope (Ros & Arcos 2007): the inner one stands, the outer one moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ScopeRing {
    /// The inner half of the scope's area.
    Security,
    /// The outer half.
    Risk,
}

/// Key of a record.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct EvidenceKey {
    /// Hash of the library's files, 16 hexadecimal digits.
    pub library: String,
    /// Name of the trials' world as [`world_of_trials`] gives it; of a match its world's name, `field` on a
    /// real one.
    pub world: String,
    /// `region/name`; empty where no case was played.
    pub case: String,
    /// Symmetry of the stored case, 0 to 3.
    pub symmetry: u8,
    /// Ring of the ball's scope.
    pub ring: ScopeRing,
    /// Opponent scopes of the case that held an opponent, and all of them: `1/2`.
    pub pattern: String,
    /// Opponents of the trial: `dg` or `2d`; of a match their number in the problem: `6`.
    pub opponents: String,
    /// Area of the ball in the direction of attack, 0 to 11: six strips along the field, middle and wings.
    pub area: u8,
}

/// Name of the world of trials: its hash, 8 hexadecimal digits, with `/robots` behind it where they are
/// played as by the paper's robots.
pub fn world_of_trials(profile: Profile) -> String {
    let end = if profile == Profile::Robots { "/robots" } else { "" };
    hil_sim::world_hash() + end
}

/// Counts of a record.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct EvidenceCounts {
    /// Plays.
    pub plays: u64,
    /// Plays in trials that ended with the ball in or close to the goal; in matches those that a goal
    /// followed in the play's window (`arena::ledger`).
    pub to_goal: u64,
    /// Plays by their ends.
    pub ends: BTreeMap<String, u64>,
}

/// A decision of play, with what became of it.
#[derive(Clone, Copy, Debug)]
pub struct CasePlay<'p> {
    /// The situation it was made in.
    pub situation: &'p Situation,
    /// Id of the case played; none if no case was.
    pub case: Option<u16>,
    /// Whether it counts as to goal.
    pub to_goal: bool,
    /// End of the play, as [`arena::CycleEnd::label`] names it.
    pub end: Option<&'p str>,
}

/// Records by key.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Evidence(pub BTreeMap<EvidenceKey, EvidenceCounts>);

/// A Beta posterior of a share, from the uniform prior.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Posterior {
    /// Successes and 1.
    pub alpha: f64,
    /// Failures and 1.
    pub beta: f64,
}

impl Default for Posterior {
    fn default() -> Self {
        Self { alpha: 1.0, beta: 1.0 }
    }
}

impl Posterior {
    /// Adds decayed counts.
    pub fn add(&mut self, counts: &EvidenceCounts, weight: f64) {
        self.alpha += weight * counts.to_goal as f64;
        self.beta += weight * (counts.plays - counts.to_goal.min(counts.plays)) as f64;
    }

    /// Mean of the distribution.
    pub fn mean(&self) -> f64 {
        self.alpha / (self.alpha + self.beta)
    }

    /// Decayed number of plays.
    pub fn plays(&self) -> f64 {
        self.alpha + self.beta - 2.0
    }
}

/// A line of `evidence.jsonl`.
#[derive(Debug, Serialize, Deserialize)]
struct Record {
    #[serde(flatten)]
    key: EvidenceKey,
    #[serde(flatten)]
    counts: EvidenceCounts,
}

impl Evidence {
    /// Adds the decisions of a trial played with `variant` against `opponents`.
    pub fn add(&mut self, variant: &Variant, world: &str, opponents: &str, trial: &LearningTrial) {
        for decision in &trial.decisions {
            let labels = arena::CycleEnd::LABELS;
            let end = decision.end.and_then(|end| labels.get(usize::from(end)).copied());
            let TrialDecision { situation, case, .. } = decision;
            let play = CasePlay { situation, case: *case, to_goal: trial.to_goal(), end };
            self.add_play(variant, world, opponents, &play);
        }
    }

    /// Adds one decision of any play with `variant`.
    pub fn add_play(&mut self, variant: &Variant, world: &str, opponents: &str, play: &CasePlay<'_>) {
        let base = variant.base();
        let case = play.case.and_then(|id| base.case(protocol::CaseId(id)));
        let [x, y] = play.situation.ball;
        let ball = PointMm { x, y };
        let (name, symmetry, ring, pattern) = case.map_or_else(
            || (String::new(), 0, ScopeRing::Security, "0/0".to_owned()),
            |case| {
                let scope = case.ball_scope();
                let outer = exponent(ball, case.ball(), scope) > 0.5;
                let ring = if outer { ScopeRing::Risk } else { ScopeRing::Security };
                let shift = case.shift(ball);
                let scopes: Vec<_> = case.opponents().collect();
                let held = scopes.iter().filter(|(at, scope)| {
                    let centre = at.plus(shift);
                    let near = |[x, y]: &[i32; 2]| exponent(PointMm { x: *x, y: *y }, centre, *scope) < 1.0;
                    play.situation.opponents.iter().any(near)
                });
                let pattern = format!("{}/{}", held.count(), scopes.len());
                (variant.names()[case.authored()].clone(), case.symmetry() as u8, ring, pattern)
            },
        );
        let key = EvidenceKey {
            library: format!("{:016x}", variant.hash),
            world: world.to_owned(),
            case: name,
            symmetry,
            ring,
            pattern,
            opponents: opponents.to_owned(),
            area: area(play.situation, &base.field()),
        };
        let counts = self.0.entry(key).or_default();
        counts.plays += 1;
        counts.to_goal += u64::from(play.to_goal);
        if let Some(end) = play.end {
            *counts.ends.entry(end.to_owned()).or_default() += 1;
        }
    }

    /// The sum of both; they must be of different trials.
    #[must_use]
    pub fn merge(mut self, other: Self) -> Self {
        for (key, counts) in other.0 {
            let own = self.0.entry(key).or_default();
            own.plays += counts.plays;
            own.to_goal += counts.to_goal;
            for (end, count) in counts.ends {
                *own.ends.entry(end).or_default() += count;
            }
        }
        self
    }

    /// The text of `evidence.jsonl`.
    pub fn to_jsonl(&self) -> String {
        let line = |(key, counts): (&EvidenceKey, &EvidenceCounts)| {
            let record = Record { key: key.clone(), counts: counts.clone() };
            // Strings and whole numbers: it always serialises.
            serde_json::to_string(&record).unwrap_or_default() + "\n"
        };
        self.0.iter().map(line).collect()
    }

    /// Reads such a text, without the plays in it; an error names its line.
    pub fn from_jsonl(text: &str) -> Result<Self, String> {
        let mut evidence = Self::default();
        let counts = |line: &str| !line.trim().is_empty() && !line.starts_with(PLAY_LINE);
        for (number, line) in (1..).zip(text.lines()).filter(|(_, line)| counts(line)) {
            let record: Record =
                serde_json::from_str(line).map_err(|error| format!("line {number}: {error}"))?;
            if record.counts.to_goal > record.counts.plays {
                return Err(format!("line {number}: more goals than plays; collect the evidence again"));
            }
            let most = record.counts.ends.values().max().copied().unwrap_or(0).max(record.counts.plays);
            if most > PLAYS_MAX {
                return Err(format!("line {number}: {most} plays are none; collect the evidence again"));
            }
            evidence = evidence.merge(Self(BTreeMap::from([(record.key, record.counts)])));
        }
        Ok(evidence)
    }
}

/// More plays than this of one record are a damaged number: a year of trials on a thousand cores.
const PLAYS_MAX: u64 = 1 << 40;

/// Start of the lines of `evidence.jsonl` that hold a successful play.
pub(crate) const PLAY_LINE: &str = "{\"play\":";

/// (Δx/τx)² + (Δy/τy)².
fn exponent(at: PointMm, centre: PointMm, scope: Scope) -> f64 {
    let part = |delta: i32, radius: i32| f64::from(delta) / f64::from(radius.max(1));
    let (x, y) = (part(at.x - centre.x, scope.x), part(at.y - centre.y, scope.y));
    x * x + y * y
}

/// The area of a situation's ball: sixths of the field's length, and its middle third or the wings.
fn area(situation: &Situation, field: &FieldMm) -> u8 {
    let [x, y] = situation.ball;
    let ahead = if situation.defending_positive { -x } else { x };
    let strip = ((ahead + field.length / 2) / (field.length / 6).max(1)).clamp(0, 5);
    (2 * strip + i32::from(y.abs() > field.width / 6)) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    fn record(case: &str, plays: u64, to_goal: u64) -> Evidence {
        let key = EvidenceKey {
            library: "a".to_owned(),
            world: "b".to_owned(),
            case: case.to_owned(),
            symmetry: 1,
            ring: ScopeRing::Risk,
            pattern: "1/2".to_owned(),
            opponents: "dg".to_owned(),
            area: 3,
        };
        let ends = BTreeMap::from([("finished".to_owned(), plays)]);
        Evidence(BTreeMap::from([(key, EvidenceCounts { plays, to_goal, ends })]))
    }

    #[test]
    fn evidence_merges_in_any_order_and_grouping() {
        let [a, b, c] = [record("x/y", 3, 1), record("x/y", 5, 5), record("x/z", 2, 0)];
        let one = a.clone().merge(b.clone()).merge(c.clone());
        assert_eq!(one, c.merge(b).merge(a.clone()));
        assert_eq!(one, a.merge(record("x/z", 2, 0).merge(record("x/y", 5, 5))));
        assert_eq!(one.0.values().map(|counts| counts.plays).collect::<Vec<_>>(), [8, 2]);
    }

    #[test]
    fn evidence_is_read_as_it_was_written_and_a_faulty_line_is_named() {
        let evidence = record("x/y", 3, 1).merge(record("x/z", 2, 0));
        let text = evidence.to_jsonl();
        assert_eq!(Evidence::from_jsonl(&text), Ok(evidence));
        let fault = Evidence::from_jsonl(&format!("{text}{{}}\n")).unwrap_err();
        assert!(fault.starts_with("line 3: "), "{fault}");
        let fault = Evidence::from_jsonl(&text.replace("\"to_goal\":1", "\"to_goal\":4")).unwrap_err();
        assert!(fault.starts_with("line 1: more goals"), "{fault}");
        let huge = text.replace("\"plays\":3", "\"plays\":18446744073709551615");
        assert!(Evidence::from_jsonl(&huge).unwrap_err().contains("are none"));
    }

    #[test]
    fn a_posterior_starts_uniform_and_old_plays_weigh_less() {
        let mut posterior = Posterior::default();
        assert_eq!(posterior.mean(), 0.5);
        let counts = EvidenceCounts { plays: 8, to_goal: 2, ends: BTreeMap::new() };
        posterior.add(&counts, 0.5);
        assert_eq!((posterior.alpha, posterior.beta, posterior.plays()), (2.0, 4.0, 4.0));
    }
}
