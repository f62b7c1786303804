//! `row`: one row of `trials.csv`: which trial it was, and every measure of the paper (§5.1.4, §5.2.1, §5.4).
//!
//! Rows stand in the order of the plan, so that equal evaluations are equal files, for any number of
//! processes.

use brain::Approach;
use hil_sim::{Configuration, Scenario, TrialOutcome};
use serde::{Deserialize, Serialize};

use super::identity::Identity;
use super::labels;
use super::plan::Planned;
use crate::store::{Difference, Row};
use arena::{CycleReport, DefaultReport, Profile, TrialReport};

/// Identity and measures of one trial.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TrialRow {
    /// Number in the plan, from 0.
    pub trial: usize,
    /// World of the trial: `simulated` or `robots`.
    pub profile: Profile,
    /// Opponents of the trial: `dg` or `2d`.
    pub configuration: Configuration,
    /// 1 to 4, or `random`.
    #[serde(with = "labels::scenario")]
    pub scenario: Scenario,
    /// Approach of the attackers: `cbr` or `reactive`.
    #[serde(with = "labels::approach")]
    pub approach: Approach,
    /// Seed that replays it.
    pub seed: u64,
    /// End of the trial; against two defenders `goal` is the paper's "to goal".
    pub outcome: TrialOutcome,
    /// Seconds from kick-off to its end.
    pub time_s: f64,
    /// Times that the defender had the ball.
    pub possession_defender: u32,
    /// Times that the midfield defender had it.
    pub possession_midfield: u32,
    /// Times that robot A backed up.
    pub backups_a: u32,
    /// Times that robot B backed up.
    pub backups_b: u32,
    /// The robot that put the ball out; empty for every other outcome.
    pub out_by: Option<String>,
    /// Number of cases for one robot.
    pub individual: u32,
    /// Number of cases for several robots.
    pub cooperative: u32,
    /// Number of retrievals without a case.
    pub none: u32,
    /// Seconds of default behaviour; empty, as the next six, where no cases are played.
    pub default_s: Option<f64>,
    /// Number of spells of default behaviour.
    pub default_spells: Option<u32>,
    /// Retrievals that failed because the ball lay in no scope.
    pub no_case_ball: Option<u32>,
    /// Retrievals that failed because there were too few robots.
    pub no_case_robots: Option<u32>,
    /// Retrievals that failed because a robot had too far to go.
    pub no_case_thr_c: Option<u32>,
    /// Retrievals that failed because an opponent stood in the path.
    pub no_case_path: Option<u32>,
    /// Retrievals that failed because the case could not start.
    pub no_case_held: Option<u32>,
    /// Equal for equal trials.
    pub trace_hash: String,
    /// The cases played, in order: `region/name:how-it-ended`, a blank between two.
    pub plays: String,
    /// Seconds in which all robots stood still after a cycle.
    pub pause_s: f64,
    /// Seconds in which a robot of each team was within reach of a ball that did not get away.
    pub duel_s: f64,
    /// Seconds in which an attacker held the ball, without an opponent within reach.
    pub held_s: f64,
    /// Seconds in which an opponent held it, without an attacker within reach.
    pub theirs_s: f64,
    /// Seconds in which it rolled.
    pub rolls_s: f64,
    /// Seconds in which it rested within an attacker's reach.
    pub at_ball_s: f64,
    /// Seconds in which it rested out of the attackers' reach.
    pub walk_s: f64,
}

impl TrialRow {
    pub(super) fn new(planned: &Planned, report: &TrialReport) -> Self {
        let backups = |robot: usize| report.backups.0.get(robot).copied().unwrap_or_default();
        let default = report.default;
        let cause = |of: fn(&DefaultReport) -> u32| default.as_ref().map(of);
        Self {
            trial: planned.number,
            profile: planned.cell.profile,
            configuration: planned.cell.configuration,
            scenario: planned.cell.scenario,
            approach: planned.cell.approach,
            seed: planned.seed,
            outcome: report.outcome,
            time_s: report.time_s,
            possession_defender: report.possession.defender,
            possession_midfield: report.possession.midfield,
            backups_a: backups(0),
            backups_b: backups(1),
            out_by: report.out_by.map(str::to_owned),
            individual: report.cases.individual,
            cooperative: report.cases.cooperative,
            none: report.cases.none,
            default_s: default.map(|default| default.time_s),
            default_spells: cause(|default| default.spells),
            no_case_ball: cause(|default| default.causes.ball),
            no_case_robots: cause(|default| default.causes.robots),
            no_case_thr_c: cause(|default| default.causes.thr_c),
            no_case_path: cause(|default| default.causes.path),
            no_case_held: cause(|default| default.causes.held),
            trace_hash: report.trace_hash.clone(),
            plays: plays(&report.cycles),
            pause_s: report.activity.pause,
            duel_s: report.activity.duel,
            held_s: report.activity.held,
            theirs_s: report.activity.theirs,
            rolls_s: report.activity.rolls,
            at_ball_s: report.activity.at_ball,
            walk_s: report.activity.walk,
        }
    }

    pub(super) fn is_of(&self, planned: &Planned) -> bool {
        let cell = &planned.cell;
        let own = (self.profile, self.configuration, self.scenario, self.approach);
        (self.trial, self.seed) == (planned.number, planned.seed)
            && own == (cell.profile, cell.configuration, cell.scenario, cell.approach)
    }

    /// The paper's "to goal": goal or close; against two defenders, in the penalty area.
    pub fn to_goal(&self) -> bool {
        matches!(self.outcome, TrialOutcome::Goal | TrialOutcome::Close)
    }
}

impl Row for TrialRow {
    type Identity = Identity;
    const MARK: &'static str = "# onetwo trials 1 ";
    fn number(&self) -> usize {
        self.trial
    }
    fn is_planned(&self, identity: &Identity) -> bool {
        identity.plan.get(self.trial).is_some_and(|planned| self.is_of(&planned))
    }
    fn planned(identity: &Identity) -> usize {
        identity.plan.len()
    }
    fn differences(own: &Identity, other: &Identity) -> Vec<Difference> {
        own.differences(other)
    }
}

/// Case and end of every cycle that had a case.
fn plays(cycles: &[CycleReport]) -> String {
    let played = cycles.iter().filter_map(|cycle| Some(format!("{}:{}", cycle.case.as_deref()?, cycle.end)));
    played.collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// A trial of case-based attackers, for tests.
    pub(crate) fn row() -> TrialRow {
        TrialRow {
            trial: 0,
            profile: Profile::Simulated,
            configuration: Configuration::DefenderGoalie,
            scenario: Scenario::LeftSide,
            approach: Approach::Cases,
            seed: 1,
            outcome: TrialOutcome::Goal,
            time_s: 10.0,
            possession_defender: 2,
            possession_midfield: 1,
            backups_a: 3,
            backups_b: 16,
            out_by: None,
            individual: 3,
            cooperative: 5,
            none: 1,
            default_s: Some(2.0),
            default_spells: Some(1),
            no_case_ball: Some(0),
            no_case_robots: Some(0),
            no_case_thr_c: Some(1),
            no_case_path: Some(0),
            no_case_held: Some(0),
            trace_hash: String::new(),
            plays: String::new(),
            pause_s: 0.0,
            duel_s: 2.5,
            held_s: 2.0,
            theirs_s: 0.5,
            rolls_s: 1.0,
            at_ball_s: 1.0,
            walk_s: 3.0,
        }
    }
}
