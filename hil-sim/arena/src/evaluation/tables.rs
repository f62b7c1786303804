//! What do the trials come to? The rows of `tables.json` (DESIGN §8): shares in percent, means a trial, seconds.
//!
//! A row holds everything that was measured on its trials, whichever of it the paper's table prints; `null` is what was not
//! measured: against two defenders a trial ends at the penalty area (no goal, close, block), there is a midfield defender only
//! there, attackers led by cases alone do not back up, and reactive ones use none. Table 5 is Table 4 without the trials that ran
//! out of time, and gives no shares. Table 6 stands there twice where more trials than the paper's 30 were played: of the first
//! 30, and behind all other rows of all. Standard deviations are those of a sample.

use brain::Approach;
use hil_sim::{Configuration, Outcome, Scenario};
use serde::{Serialize, Serializer};

use super::plan::Profile;
use super::row::TrialRow;
use super::statistics::Sample;
use super::words;

/// Which of the trials a row is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Extent {
    /// The paper's: all of them, but of Table 6 the first 30.
    Paper,
    /// Table 6 alone: all of them, to say what 30 could not.
    Large,
}

impl Extent {
    /// Its word in files.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Paper => "paper",
            Self::Large => "large",
        }
    }
}

/// A row of one of the paper's tables. Fields may be added at the end, never renamed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TableRow {
    /// `1` to `6`.
    #[serde(serialize_with = "table")]
    pub table: u8,
    /// `dg` or `2d`.
    pub configuration: Configuration,
    /// 1 to 4, or `random`.
    #[serde(serialize_with = "crate::report::scenario")]
    pub scenario: Scenario,
    /// `cbr` or `reactive`.
    #[serde(serialize_with = "words::approach::serialize")]
    pub approach: Approach,
    /// How many.
    pub trials: u32,
    /// Percent; so the next five.
    pub goal: Option<f64>,
    /// Out beside a goalpost.
    pub close: Option<f64>,
    /// Stopped or kicked by the goalie.
    pub block: Option<f64>,
    /// Out elsewhere.
    pub out: Option<f64>,
    /// Time was up.
    pub timeout: Option<f64>,
    /// Goal or close; against two defenders, in the penalty area.
    pub to_goal: Option<f64>,
    /// How often the defender had the ball.
    pub possession_mean: Option<f64>,
    /// Its standard deviation.
    pub possession_sd: Option<f64>,
    /// How often the midfield defender had it.
    pub possession2_mean: Option<f64>,
    /// Its standard deviation.
    pub possession2_sd: Option<f64>,
    /// Seconds.
    pub time_mean: Option<f64>,
    /// Their standard deviation.
    pub time_sd: Option<f64>,
    /// How often robot A backed up, a trial.
    pub backups_a: Option<f64>,
    /// How often robot B did.
    pub backups_b: Option<f64>,
    /// Cases for one robot, a trial.
    pub individual: Option<f64>,
    /// Cases for several, a trial.
    pub cooperative: Option<f64>,
    /// Retrievals without a case, a trial.
    pub none: Option<f64>,
    /// Trials that attackers ended by putting the ball out.
    pub out_by_attackers: Option<u32>,
    /// Those that opponents did.
    pub out_by_opponents: Option<u32>,
    /// Default behaviour, percent of all time.
    pub default_time: Option<f64>,
    /// How many times it began, a trial.
    pub default_spells: Option<f64>,
    /// Why retrievals failed, a trial: the ball lay in no scope.
    pub none_ball: Option<f64>,
    /// Too few robots.
    pub none_robots: Option<f64>,
    /// Somebody had too far to go.
    pub none_thr_c: Option<f64>,
    /// An opponent stood in the way.
    pub none_path: Option<f64>,
    /// The case could not begin.
    pub none_held: Option<f64>,
    /// Seconds of the trials that came to goal: what rankings were chosen by (paper §3.4).
    pub time_to_goal_mean: Option<f64>,
    /// Cases used in them.
    pub cases_to_goal_mean: Option<f64>,
    /// Standard deviation of `backups_a`.
    pub backups_a_sd: Option<f64>,
    /// That of `backups_b`.
    pub backups_b_sd: Option<f64>,
    /// `paper`, or `large` for Table 6 of more than the paper's 30 trials.
    pub sample: Extent,
}

/// A mean with its spread.
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

/// The paper's robots played so many trials a row of Table 6 (§5.3).
pub(super) const TRIALS_OF_ROBOTS: usize = 30;

/// What tells rows of a table apart.
type Key = (Scenario, Approach);

fn belongs(table: u8, row: &TrialRow) -> bool {
    row.configuration == opponents(table)
        && row.profile == if table == 6 { Profile::Robots } else { Profile::Simulated }
        && match table {
            2 => backs_up(row.approach),
            3 => plays_cases(row.approach),
            5 => row.outcome != Outcome::Timeout,
            _ => true,
        }
}

/// Robots that are led by cases alone do not back up (paper §5.2.1).
fn backs_up(approach: Approach) -> bool {
    approach != Approach::Cases
}

fn plays_cases(approach: Approach) -> bool {
    approach != Approach::Reactive
}

/// Whom the attackers of a table play against.
fn opponents(table: u8) -> Configuration {
    if matches!(table, 4 | 5) { Configuration::TwoDefenders } else { Configuration::DefenderGoalie }
}

impl TableRow {
    /// Nothing was measured.
    pub(super) fn empty(table: u8, scenario: Scenario, approach: Approach) -> Self {
        Self {
            table,
            configuration: opponents(table),
            scenario,
            approach,
            trials: 0,
            goal: None,
            close: None,
            block: None,
            out: None,
            timeout: None,
            to_goal: None,
            possession_mean: None,
            possession_sd: None,
            possession2_mean: None,
            possession2_sd: None,
            time_mean: None,
            time_sd: None,
            backups_a: None,
            backups_b: None,
            individual: None,
            cooperative: None,
            none: None,
            out_by_attackers: None,
            out_by_opponents: None,
            default_time: None,
            default_spells: None,
            none_ball: None,
            none_robots: None,
            none_thr_c: None,
            none_path: None,
            none_held: None,
            time_to_goal_mean: None,
            cases_to_goal_mean: None,
            backups_a_sd: None,
            backups_b_sd: None,
            sample: Extent::Paper,
        }
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
            self.out = outcome(Outcome::Out);
            self.timeout = outcome(Outcome::Timeout);
            self.to_goal = share(&TrialRow::to_goal);
            let put_out = |attackers: bool| {
                let by = rows.iter().filter_map(|row| row.out_by.as_deref());
                Some(by.filter(|by| (*by == "attackers") == attackers).count() as u32)
            };
            (self.out_by_attackers, self.out_by_opponents) = (put_out(true), put_out(false));
        }
        let mean = |of: fn(&TrialRow) -> f64| Mean::of(rows.iter().map(|row| of(row)));
        if self.configuration == Configuration::DefenderGoalie {
            self.goal = outcome(Outcome::Goal);
            self.close = outcome(Outcome::Close);
            self.block = outcome(Outcome::Block);
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
        let to_goal = || rows.iter().filter(|row| row.to_goal());
        self.time_to_goal_mean = Mean::of(to_goal().map(|row| row.time_s)).mean;
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

/// To a ten-thousandth: more than any number of trials says, and it reads well.
pub(super) fn rounded(value: f64) -> f64 {
    (value * 1e4).round() / 1e4
}

#[allow(clippy::trivially_copy_pass_by_ref, reason = "serde's signature")]
fn table<S: Serializer>(table: &u8, s: S) -> Result<S::Ok, S::Error> {
    s.collect_str(table)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evaluation::row::tests::row;

    fn trial(approach: Approach, configuration: Configuration, outcome: Outcome, time_s: f64) -> TrialRow {
        let out_by = (outcome == Outcome::Out).then(|| "defender".to_owned());
        let of_all = TrialRow { configuration, approach, outcome, time_s, out_by, ..row() };
        if approach == Approach::Cases {
            return of_all;
        }
        TrialRow {
            individual: 0,
            cooperative: 0,
            none: 0,
            default_s: None,
            default_spells: None,
            no_case_ball: None,
            no_case_robots: None,
            no_case_thr_c: None,
            no_case_path: None,
            no_case_held: None,
            ..of_all
        }
    }

    #[test]
    fn a_row_has_the_fields_of_the_agreement_in_their_order() {
        let rows = [
            trial(Approach::Cases, Configuration::DefenderGoalie, Outcome::Goal, 10.0),
            trial(Approach::Cases, Configuration::DefenderGoalie, Outcome::Out, 30.0),
            trial(Approach::Cases, Configuration::DefenderGoalie, Outcome::Close, 20.0),
        ];
        let json = serde_json::to_string(&tables(&rows)[0]).unwrap();
        assert!(
            json.starts_with(
                "{\"table\":\"1\",\"configuration\":\"dg\",\"scenario\":2,\"approach\":\"cbr\",\"trials\":3,\
                 \"goal\":33.3333,\"close\":33.3333,\"block\":0.0,\"out\":33.3333,\"timeout\":0.0,\"to_goal\":66.6667,\
                 \"possession_mean\":2.0,\"possession_sd\":0.0,\"possession2_mean\":null,\"possession2_sd\":null,\
                 \"time_mean\":20.0,\"time_sd\":10.0,\"backups_a\":null,\"backups_b\":null,\"individual\":3.0,\
                 \"cooperative\":5.0,\"none\":1.0,\"out_by_attackers\":0,\"out_by_opponents\":1,\"default_time\":10.0,"
            ),
            "{json}"
        );
        assert!(json.contains("\"time_to_goal_mean\":15.0,\"cases_to_goal_mean\":8.0,"), "{json}");
        assert!(
            json.ends_with("\"backups_a_sd\":null,\"backups_b_sd\":null,\"sample\":\"paper\"}"),
            "{json}"
        );
    }

    #[test]
    fn every_trial_stands_in_the_tables_of_its_kind() {
        let (dg, two) = (Configuration::DefenderGoalie, Configuration::TwoDefenders);
        let mut robots = trial(Approach::Reactive, dg, Outcome::Block, 9.0);
        robots.profile = Profile::Robots;
        let rows = [
            trial(Approach::Cases, dg, Outcome::Goal, 10.0),
            trial(Approach::Reactive, dg, Outcome::Goal, 10.0),
            trial(Approach::Reactive, two, Outcome::Goal, 10.0),
            trial(Approach::Reactive, two, Outcome::Timeout, 60.0),
            robots,
        ];
        let tables = tables(&rows);
        let of: Vec<_> = tables.iter().map(|row| (row.table, row.approach, row.trials)).collect();
        let (cbr, reactive) = (Approach::Cases, Approach::Reactive);
        let expected = [
            (1, cbr, 1),
            (1, reactive, 1),
            (2, reactive, 1),
            (3, cbr, 1),
            (4, reactive, 2),
            (5, reactive, 1),
            (6, reactive, 1),
        ];
        assert_eq!(of, expected);
        let (four, five) = (&tables[4], &tables[5]);
        assert_eq!((four.to_goal, four.timeout, four.goal), (Some(50.0), Some(50.0), None));
        assert_eq!((five.to_goal, five.time_mean, five.possession2_mean), (None, Some(10.0), Some(1.0)));
        assert_eq!((tables[2].backups_b, tables[2].individual), (Some(16.0), None));
    }

    #[test]
    fn more_trials_of_robots_than_the_papers_are_told_apart() {
        let mut robots = trial(Approach::Cases, Configuration::DefenderGoalie, Outcome::Goal, 9.0);
        robots.profile = Profile::Robots;
        let out = TrialRow { outcome: Outcome::Out, ..robots.clone() };
        let rows = [vec![robots; 30], vec![out; 10]].concat();
        let shares: Vec<_> =
            tables(&rows).iter().map(|row| (row.table, row.sample, row.trials, row.goal)).collect();
        assert_eq!(shares, [(6, Extent::Paper, 30, Some(100.0)), (6, Extent::Large, 40, Some(75.0))]);
        assert_eq!(tables(&rows[..30]).len(), 1, "nothing more to say");
    }
}
