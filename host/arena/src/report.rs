//! `report`: result of a trial. The fields of `onetwo trial --json` in their order
//! (docs/case-format.md §5.2); s, counts.

use std::collections::BTreeMap;

use hil_sim::{Configuration, Scenario, TrialOutcome};
use serde::{Serialize, Serializer};

use crate::cycles::{CycleSeen, shot_label};
use crate::names::{CaseNames, letter, symmetry};

/// A trial's result. Fields may be added at the end, never renamed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TrialReport {
    /// 1 to 4, or `random`.
    #[serde(serialize_with = "serialize_scenario")]
    pub scenario: Scenario,
    /// Configuration of the opponents: `dg` or `2d`.
    pub opponents: Configuration,
    /// Approach of the attackers: `cbr` or `reactive`.
    pub approach: &'static str,
    /// Back end of the robots' computers: `native` or `qemu`.
    pub backend: &'static str,
    /// Random seed of the trial.
    pub seed: u64,
    /// End of the trial. Against two defenders `goal` is a ball in the penalty area (paper §5.2.2: "to
    /// goal").
    pub outcome: TrialOutcome,
    /// Seconds from kick-off to its end.
    pub time_s: f64,
    /// Number of the opponents' possessions.
    pub possession: Possession,
    /// Number of each attacker's backups.
    pub backups: Backups,
    /// The robot that last touched a ball that went out: `attackers`, `defender`, `midfield` or `goalie`;
    /// null for every other outcome.
    pub out_by: Option<&'static str>,
    /// Results of the retrievals.
    pub cases: CaseCounts,
    /// Every retrieve–reuse cycle, in order.
    pub cycles: Vec<CycleReport>,
    /// Equal for equal trials (docs/architecture.md §2.5).
    pub trace_hash: String,
    /// The named settings of retrieval (docs/case-format.md §3.2).
    pub settings: BTreeMap<&'static str, String>,
    /// Start of a case's actions: `dependent` or `independent`.
    pub positioning: &'static str,
    /// Hash of the case base, 8 hexadecimal digits.
    pub case_base: String,
    /// Time that the attackers played without a case, and why; null for approaches without cases.
    pub default: Option<DefaultReport>,
    /// Time by what it was spent on, s.
    pub activity: ActivityReport,
}

/// Number of each opponent's possessions (paper §5.1.4; docs/papers.md R33); 0 where it does not play.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Possession {
    /// Number of the defender's possessions.
    pub defender: u32,
    /// Number of the midfield defender's possessions.
    pub midfield: u32,
}

/// Backing up by attacker: `{"A": 3, "B": 16}`.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Backups(pub Vec<u32>);

impl Serialize for Backups {
    fn serialize<S: Serializer>(&self, s: S) -> Result<S::Ok, S::Error> {
        s.collect_map(self.0.iter().enumerate().map(|(i, count)| (letter(i), count)))
    }
}

/// Results of the retrievals (docs/papers.md R37).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct CaseCounts {
    /// Cases for one robot.
    pub individual: u32,
    /// Cases for several robots.
    pub cooperative: u32,
    /// Cycles in which no case fitted.
    pub none: u32,
}

impl CaseCounts {
    /// Counts of these cycles.
    pub fn of(cycles: &[CycleSeen]) -> Self {
        let mut counts = Self::default();
        for cycle in cycles {
            match &cycle.play {
                Some(play) if play.robots.len() > 1 => counts.cooperative += 1,
                Some(_) => counts.individual += 1,
                None => counts.none += u32::from(cycle.no_case),
            }
        }
        counts
    }
}

/// One retrieve–reuse cycle of the team.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CycleReport {
    /// Id of the cycle, `counter.proposer`.
    pub cycle: String,
    /// Number of the coordinator.
    pub coordinator: u8,
    /// `region/name`; null where no case was found.
    pub case: Option<String>,
    /// Symmetry of the stored case.
    pub symmetry: Option<&'static str>,
    /// Robot number of the case (from 1) with robot id.
    pub r#match: Option<BTreeMap<usize, u8>>,
    /// Seconds from kick-off at which its first beacon was received.
    pub start_s: f64,
    /// Seconds from kick-off at which it was over.
    pub end_s: f64,
    /// `finished`, `no-case`, why it was aborted (`ball-out-of-scope`, …), `superseded` or `trial-over`.
    pub end: &'static str,
    /// The rule of its last shot at goal: `leg` (as retrieval checked it), `likelier-shot`,
    /// `waited-for-gap`, `pushed-on`, `out-of-time` or `pressed`; null where it did not come to one.
    pub shot: Option<&'static str>,
}

impl CycleReport {
    /// The report of a cycle of a trial that lasted until `time` seconds.
    pub(crate) fn new(cycle: &CycleSeen, names: &CaseNames, time: f32) -> Self {
        let play = cycle.play.as_ref();
        let (end_s, end) = cycle.end.map_or((time, "trial-over"), |(at, end)| (at, end.label()));
        Self {
            cycle: cycle.id.to_string(),
            coordinator: cycle.coordinator.number(),
            case: play.map(|play| names.of(play.case)),
            symmetry: play.map(|play| symmetry(play.case)),
            r#match: play.map(|play| play.robots.iter().zip(1..).map(|(id, i)| (i, id.number())).collect()),
            start_s: in_seconds(cycle.start),
            end_s: in_seconds(end_s),
            end,
            shot: shot_label(cycle.shot),
        }
    }
}

/// A trial's default behaviour.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct DefaultReport {
    /// Duration, s.
    pub time_s: f64,
    /// Number of spells.
    pub spells: u32,
    /// Causes, by decision; a spell has one every quarter of a second or so.
    pub causes: Causes,
}

/// Seconds of a trial by activity; their sum is its duration.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct ActivityReport {
    /// All robots stand still after a cycle, as the paper's (§5.3).
    pub pause: f64,
    /// A robot of each team is within reach of a ball that does not get away.
    pub duel: f64,
    /// An attacker holds the ball, without an opponent within reach: carries, turns, waits, kicks.
    pub held: f64,
    /// An opponent holds it, without an attacker within reach.
    pub theirs: f64,
    /// The ball rolls.
    pub rolls: f64,
    /// The ball rests within an attacker's reach: last steps, turns about it, grabs.
    pub at_ball: f64,
    /// The ball rests out of the attackers' reach: they walk to it.
    pub walk: f64,
}

/// Number of times that no case fitted, by the farthest that any case came.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Causes {
    /// The ball lay in no case's scope: a hole in the case base.
    pub ball: u32,
    /// Too few robots for every case whose scope held the ball.
    pub robots: u32,
    /// A robot would have had too far to go: the paper's only cause.
    pub thr_c: u32,
    /// An opponent stood in the ball's path.
    pub path: u32,
    /// A case fitted, but could not start: another robot held the ball, or robots saw it otherwise.
    pub held: u32,
}

/// Whole milliseconds as a number that prints as such.
pub(crate) fn in_seconds(time: f32) -> f64 {
    f64::from(geometry::math::round_to_i32(time * 1000.0)) / 1000.0
}

/// Serialises a scenario: 1 to 4 as a number, others by label.
#[allow(clippy::trivially_copy_pass_by_ref, reason = "serde's signature")]
pub fn serialize_scenario<S: Serializer>(scenario: &Scenario, s: S) -> Result<S::Ok, S::Error> {
    match scenario.label().parse::<u8>() {
        Ok(number) => s.serialize_u8(number),
        Err(_) => s.serialize_str(scenario.label()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_as_people_write_them() {
        assert_eq!(serde_json::to_string(&in_seconds(23.44)).unwrap(), "23.44");
        assert_eq!(serde_json::to_string(&Backups(vec![3, 16])).unwrap(), r#"{"A":3,"B":16}"#);
        let json = |s| serde_json::to_string(&Label(s)).unwrap();
        assert_eq!(
            (json(Scenario::LeftSide), json(Scenario::Random)),
            ("2".to_owned(), "\"random\"".to_owned())
        );
    }

    /// A scenario as a report writes it.
    #[derive(Serialize)]
    struct Label(#[serde(serialize_with = "serialize_scenario")] Scenario);
}
