//! `tables`: the rows of `tables.json` (docs/case-format.md §5.2): shares in percent, means per trial,
//! seconds.
//!
//! A row holds everything that was measured on its trials, whichever of it the paper's table prints; `null`
//! is what was not measured: against two defenders a trial ends at the penalty area (no goal, close, block),
//! there is a midfield defender only there, attackers that play by cases alone do not back up, and reactive
//! ones use none. Table 5 is Table 4 without the trials with a timeout, and gives no shares. Table 6 stands
//! there twice where more trials than the paper's 30 were played: of the first 30, and behind all other rows
//! of all. Standard deviations are those of a sample.

use brain::Approach;
use hil_sim::{Configuration, Scenario, TrialOutcome};
use serde::{Serialize, Serializer};

use super::comparison::Measure;
use super::labels;
use super::row::TrialRow;
use crate::statistics::{Interval, Sample, wilson};
use arena::Profile;

geometry::labels! {
    /// Sample that a row is of.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
    #[serde(rename_all = "lowercase")]
    pub enum Extent {
        /// The paper's: all of them, but of Table 6 the first 30.
        #[default]
        Paper = "paper",
        /// Table 6 alone: all of them, to show what 30 could not.
        Large = "large",
    }
}

/// A row of one of the paper's tables. Fields may be added at the end, never renamed.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct TableRow {
    /// The paper's table, `1` to `6`.
    #[serde(serialize_with = "table")]
    pub table: u8,
    /// Opponents of the trials: `dg` or `2d`.
    pub configuration: Configuration,
    /// 1 to 4, or `random`.
    #[serde(serialize_with = "arena::serialize_scenario")]
    pub scenario: Scenario,
    /// Approach of the attackers: `cbr` or `reactive`.
    #[serde(serialize_with = "labels::approach::serialize")]
    pub approach: Approach,
    /// Number of trials in the row.
    pub trials: u32,
    /// Goals, percent; the next five are in percent too.
    pub goal: Option<f64>,
    /// Out beside a goalpost.
    pub close: Option<f64>,
    /// Stopped or kicked by the goalie.
    pub block: Option<f64>,
    /// Ball out elsewhere than beside a goalpost.
    pub out: Option<f64>,
    /// Ended by timeout, without goal or ball out.
    pub timeout: Option<f64>,
    /// Goal or close; against two defenders, in the penalty area.
    pub to_goal: Option<f64>,
    /// Mean number of the defender's possessions.
    pub possession_mean: Option<f64>,
    /// Standard deviation of `possession_mean`.
    pub possession_sd: Option<f64>,
    /// Mean number of the midfield defender's possessions.
    pub possession2_mean: Option<f64>,
    /// Standard deviation of `possession2_mean`.
    pub possession2_sd: Option<f64>,
    /// Mean duration of a trial, s.
    pub time_mean: Option<f64>,
    /// Standard deviation of `time_mean`, s.
    pub time_sd: Option<f64>,
    /// Mean number of robot A's backups, a trial.
    pub backups_a: Option<f64>,
    /// Mean number of robot B's backups, a trial.
    pub backups_b: Option<f64>,
    /// Cases for one robot, a trial.
    pub individual: Option<f64>,
    /// Cases for several, a trial.
    pub cooperative: Option<f64>,
    /// Retrievals without a case, a trial.
    pub none: Option<f64>,
    /// Trials that attackers ended by putting the ball out.
    pub out_by_attackers: Option<u32>,
    /// Trials that opponents ended by putting the ball out.
    pub out_by_opponents: Option<u32>,
    /// Default behaviour, percent of all time.
    pub default_time: Option<f64>,
    /// Number of spells a trial.
    pub default_spells: Option<f64>,
    /// Failed retrievals a trial: the ball lay in no scope.
    pub none_ball: Option<f64>,
    /// Failed retrievals a trial: too few robots for any case.
    pub none_robots: Option<f64>,
    /// A robot had too far to go.
    pub none_thr_c: Option<f64>,
    /// An opponent stood in the path.
    pub none_path: Option<f64>,
    /// The case could not start.
    pub none_held: Option<f64>,
    /// Mean seconds of the trials that came to goal: the criterion by which rankings were chosen (paper
    /// §3.4).
    pub time_to_goal_mean: Option<f64>,
    /// Mean number of cases used in them.
    pub cases_to_goal_mean: Option<f64>,
    /// Standard deviation of `backups_a`.
    pub backups_a_sd: Option<f64>,
    /// Standard deviation of `backups_b`.
    pub backups_b_sd: Option<f64>,
    /// `paper`, or `large` for Table 6 of more than the paper's 30 trials.
    pub sample: Extent,
    /// Lower end of the 95 % interval (Wilson) of `goal`, percent; the next five pairs are alike.
    pub goal_low: Option<f64>,
    /// Upper end of `goal`'s.
    pub goal_high: Option<f64>,
    /// Lower end of `close`'s.
    pub close_low: Option<f64>,
    /// Upper end of `close`'s.
    pub close_high: Option<f64>,
    /// Lower end of `block`'s.
    pub block_low: Option<f64>,
    /// Upper end of `block`'s.
    pub block_high: Option<f64>,
    /// Lower end of `out`'s.
    pub out_low: Option<f64>,
    /// Upper end of `out`'s.
    pub out_high: Option<f64>,
    /// Lower end of `timeout`'s.
    pub timeout_low: Option<f64>,
    /// Upper end of `timeout`'s.
    pub timeout_high: Option<f64>,
    /// Lower end of `to_goal`'s.
    pub to_goal_low: Option<f64>,
    /// Upper end of `to_goal`'s.
    pub to_goal_high: Option<f64>,
    /// Duels, percent of all time (a robot of each team within reach of a ball that does not get away); the
    /// other six are percent of all time too, and all seven are 100.
    pub duel_time: Option<f64>,
    /// An attacker holds the ball, without an opponent within reach.
    pub held_time: Option<f64>,
    /// An opponent holds it, without an attacker within reach.
    pub theirs_time: Option<f64>,
    /// Share of the time in which the ball rolls.
    pub rolls_time: Option<f64>,
    /// Share in which it rests within an attacker's reach.
    pub at_ball_time: Option<f64>,
    /// Share in which it rests out of the attackers' reach.
    pub walk_time: Option<f64>,
    /// All robots stand still after a cycle.
    pub pause_time: Option<f64>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Mean {
    mean: Option<f64>,
    sd: Option<f64>,
}

/// All tables of these trials, by table, then as the rows come; a table without trials is left out.
pub fn tables(rows: &[TrialRow]) -> Vec<TableRow> {
    let mut tables = Vec::new();
    let mut large = Vec::new();
    for table in 1..=6 {
        let mut groups: Vec<(Key, Vec<&TrialRow>)> = Vec::new();
        for row in rows.iter().filter(|row| belongs(table, row)) {
            let key = (row.scenario, row.approach);
            match groups.iter_mut().find(|(known, _)| *known == key) {
                Some((_, group)) => group.push(row),
                None => groups.push((key, vec![row])),
            }
        }
        for ((scenario, approach), group) in &groups {
            let empty = TableRow::empty(table, *scenario, *approach);
            let of_paper = if table == 6 { group.len().min(TRIALS_OF_ROBOTS) } else { group.len() };
            tables.push(empty.clone().filled(&group[..of_paper]));
            if of_paper < group.len() {
                large.push(TableRow { sample: Extent::Large, ..empty.filled(group) });
            }
        }
    }
    tables.extend(large);
    tables
}

const CONFIDENCE: f64 = 0.95;
/// Trials of the paper's robots a row of Table 6 (§5.3).
pub(super) const TRIALS_OF_ROBOTS: usize = 30;

type Key = (Scenario, Approach);

fn belongs(table: u8, row: &TrialRow) -> bool {
    row.configuration == opponents(table)
        && row.profile == if table == 6 { Profile::Robots } else { Profile::Simulated }
        && match table {
            2 => backs_up(row.approach),
            3 => plays_cases(row.approach),
            5 => row.outcome != TrialOutcome::Timeout,
            _ => true,
        }
}

/// Robots that play by cases alone do not back up (paper §5.2.1).
fn backs_up(approach: Approach) -> bool {
    approach != Approach::Cases
}

fn plays_cases(approach: Approach) -> bool {
    approach != Approach::Reactive
}

fn opponents(table: u8) -> Configuration {
    if matches!(table, 4 | 5) { Configuration::TwoDefenders } else { Configuration::DefenderGoalie }
}

impl TableRow {
    pub(super) fn empty(table: u8, scenario: Scenario, approach: Approach) -> Self {
        Self { table, configuration: opponents(table), scenario, approach, ..Self::default() }
    }

    fn filled(mut self, rows: &[&TrialRow]) -> Self {
        self.fill(rows);
        self
    }

    fn fill(&mut self, rows: &[&TrialRow]) {
        self.trials = rows.len() as u32;
        let share = |of: &dyn Fn(&TrialRow) -> bool| {
            let hits = rows.iter().filter(|row| of(row)).count();
            Some(rounded(100.0 * hits as f64 / rows.len() as f64))
        };
        let outcome = |outcome| share(&|row: &TrialRow| row.outcome == outcome);
        if self.table != 5 {
            self.out = outcome(TrialOutcome::Out);
            self.timeout = outcome(TrialOutcome::Timeout);
            self.to_goal = share(&TrialRow::to_goal);
            let put_out = |attackers: bool| {
                let by = rows.iter().filter_map(|row| row.out_by.as_deref());
                Some(by.filter(|by| (*by == "attackers") == attackers).count() as u32)
            };
            (self.out_by_attackers, self.out_by_opponents) = (put_out(true), put_out(false));
        }
        let mean = |of: fn(&TrialRow) -> f64| Mean::of(rows.iter().map(|row| of(row)));
        if self.configuration == Configuration::DefenderGoalie {
            self.goal = outcome(TrialOutcome::Goal);
            self.close = outcome(TrialOutcome::Close);
            self.block = outcome(TrialOutcome::Block);
        } else {
            let possession = mean(|row| f64::from(row.possession_midfield));
            (self.possession2_mean, self.possession2_sd) = (possession.mean, possession.sd);
        }
        let possession = mean(|row| f64::from(row.possession_defender));
        (self.possession_mean, self.possession_sd) = (possession.mean, possession.sd);
        let time = mean(|row| row.time_s);
        (self.time_mean, self.time_sd) = (time.mean, time.sd);
        if backs_up(self.approach) {
            let (a, b) = (mean(|row| f64::from(row.backups_a)), mean(|row| f64::from(row.backups_b)));
            (self.backups_a, self.backups_a_sd) = (a.mean, a.sd);
            (self.backups_b, self.backups_b_sd) = (b.mean, b.sd);
        }
        if plays_cases(self.approach) {
            self.fill_cases(rows);
        }
        self.fill_intervals();
        self.fill_activities(rows);
        let to_goal = || rows.iter().filter(|row| row.to_goal());
        self.time_to_goal_mean = Mean::of(to_goal().map(|row| row.time_s)).mean;
    }

    fn fill_intervals(&mut self) {
        let ends = |measure: Measure, row: &Self| {
            let interval = measure.count(row).and_then(|count| wilson(count, CONFIDENCE));
            interval.map(|Interval { low, high }| (rounded(100.0 * low), rounded(100.0 * high))).unzip()
        };
        (self.goal_low, self.goal_high) = ends(Measure::Goal, self);
        (self.close_low, self.close_high) = ends(Measure::Close, self);
        (self.block_low, self.block_high) = ends(Measure::Block, self);
        (self.out_low, self.out_high) = ends(Measure::Out, self);
        (self.timeout_low, self.timeout_high) = ends(Measure::Timeout, self);
        (self.to_goal_low, self.to_goal_high) = ends(Measure::ToGoal, self);
    }

    fn fill_activities(&mut self, rows: &[&TrialRow]) {
        let time: f64 = rows.iter().map(|row| row.time_s).sum();
        if time <= 0.0 {
            return;
        }
        let share = |of: fn(&TrialRow) -> f64| {
            Some(rounded(100.0 * rows.iter().map(|row| of(row)).sum::<f64>() / time))
        };
        self.duel_time = share(|row| row.duel_s);
        self.held_time = share(|row| row.held_s);
        self.theirs_time = share(|row| row.theirs_s);
        self.rolls_time = share(|row| row.rolls_s);
        self.at_ball_time = share(|row| row.at_ball_s);
        self.walk_time = share(|row| row.walk_s);
        self.pause_time = share(|row| row.pause_s);
    }

    fn fill_cases(&mut self, rows: &[&TrialRow]) {
        let mean = |of: fn(&TrialRow) -> Option<u32>| {
            Mean::of(rows.iter().map(|row| f64::from(of(row).unwrap_or_default()))).mean
        };
        self.individual = mean(|row| Some(row.individual));
        self.cooperative = mean(|row| Some(row.cooperative));
        self.none = mean(|row| Some(row.none));
        self.default_spells = mean(|row| row.default_spells);
        self.none_ball = mean(|row| row.no_case_ball);
        self.none_robots = mean(|row| row.no_case_robots);
        self.none_thr_c = mean(|row| row.no_case_thr_c);
        self.none_path = mean(|row| row.no_case_path);
        self.none_held = mean(|row| row.no_case_held);
        let time: f64 = rows.iter().map(|row| row.time_s).sum();
        let default: f64 = rows.iter().filter_map(|row| row.default_s).sum();
        self.default_time = (time > 0.0).then(|| rounded(100.0 * default / time));
        let used =
            rows.iter().filter(|row| row.to_goal()).map(|row| f64::from(row.individual + row.cooperative));
        self.cases_to_goal_mean = Mean::of(used).mean;
    }
}

impl Mean {
    fn of(values: impl Iterator<Item = f64> + Clone) -> Self {
        let sample = Sample::of(values);
        let sd = sample.and_then(|sample| sample.sd);
        Self { mean: sample.map(|sample| rounded(sample.mean)), sd: sd.map(rounded) }
    }
}

/// Rounds to a ten-thousandth: finer than the resolution of any number of trials, and short to read.
pub(super) fn rounded(value: f64) -> f64 {
    (value * 1e4).round() / 1e4
}

#[allow(clippy::trivially_copy_pass_by_ref, reason = "serde's signature")]
fn table<S: Serializer>(table: &u8, s: S) -> Result<S::Ok, S::Error> {
    s.collect_str(table)
}

#[cfg(test)]
mod tests;
