//! `ablation`: ablations: what each part of the approach is worth. Case-based attackers with one thing
//! changed, on the seeds of the unchanged ones.
//!
//! Trials of equal seed start alike and draw the same random numbers while they stay alike, so they are
//! compared in pairs: McNemar's exact test for shares, the paired t for means; the unpaired tests stand
//! beside them. Over the arms, p is corrected by Holm.

use std::fmt::Write as _;

use brain::Positioning;
use casebase::RetrievalSettings;
use hil_sim::{Configuration, Scenario, TrialOutcome};
use serde::Serialize;

use super::row::TrialRow;
use super::tables::rounded;
use crate::statistics::{
    Count, PairedMeans, PairedShares, Test, holm_by_family, stars, two_proportions, welch,
};
use arena::Setup;

/// One change to the team.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Arm {
    /// Short name, as `--arm` and the tables have it.
    pub name: &'static str,
    /// Flags that give the same team in `onetwo trial` and `onetwo evaluate`.
    pub flags: &'static str,
    /// Description of the change.
    pub what: &'static str,
    #[serde(skip)]
    change: Change,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Change {
    Nothing,
    Independent,
    Set(&'static str, &'static str),
    NoSymmetry,
    NoOpponents,
    /// Packet loss, percent.
    Loss(u8),
    OneRetriever,
}

impl Arm {
    const fn new(name: &'static str, flags: &'static str, what: &'static str, change: Change) -> Self {
        Self { name, flags, what, change }
    }

    /// The set-up of the team with this change.
    pub fn setup(&self) -> Setup {
        let mut setup = Setup::default();
        match self.change {
            Change::Nothing => {}
            Change::Independent => setup.positioning = Positioning::Independent,
            Change::Set(name, value) => {
                let set = setup.settings.set(name, value);
                debug_assert!(
                    set.is_ok() && setup.settings != RetrievalSettings::default(),
                    "{name}={value}"
                );
            }
            Change::NoSymmetry => setup.symmetry = false,
            Change::NoOpponents => setup.opponents = false,
            Change::Loss(percent) => setup.loss = f32::from(percent) / 100.0,
            Change::OneRetriever => setup.retrievers = 1,
        }
        setup
    }

    /// Whether it is the unchanged team.
    pub fn is_default(&self) -> bool {
        self.change == Change::Nothing
    }
}

macro_rules! set {
    ($name:literal, $setting:literal, $value:literal, $what:literal) => {
        Arm::new($name, concat!("--set ", $setting, "=", $value), $what, Change::Set($setting, $value))
    };
}

/// All arms, the unchanged team first.
pub const ARMS: &[Arm] = &[
    Arm::new("default", "", "the paper's team, as it is by default", Change::Nothing),
    Arm::new(
        "independent",
        "--positioning independent",
        "robots wait for each other (§4.2)",
        Change::Independent,
    ),
    set!("teammates-first", "ranking", "teammates,conditions,interval-cost", "order of ranking (§3.4)"),
    set!("teammates-cost", "ranking", "teammates,interval-cost,conditions", "order of ranking (§3.4)"),
    set!("conditions-cost", "ranking", "conditions,interval-cost,teammates", "order of ranking (§3.4)"),
    set!("cost-conditions", "ranking", "interval-cost,conditions,teammates", "order of ranking (§3.4)"),
    set!("cost-teammates", "ranking", "interval-cost,teammates,conditions", "order of ranking (§3.4)"),
    Arm::new(
        "no-symmetry",
        "--no-symmetry",
        "authored cases alone, no mirror images (§2.4)",
        Change::NoSymmetry,
    ),
    Arm::new("no-opponents", "--no-opponents", "cases know no opponents (§3.3.2)", Change::NoOpponents),
    Arm::new("loss-10", "--loss 0.1", "10 % of messages lost", Change::Loss(10)),
    Arm::new("loss-20", "--loss 0.2", "20 % of messages lost", Change::Loss(20)),
    Arm::new("loss-30", "--loss 0.3", "30 % of messages lost", Change::Loss(30)),
    Arm::new("loss-50", "--loss 0.5", "50 % of messages lost", Change::Loss(50)),
    set!("thr_c-1000", "thr_c", "1000", "robots go at most 1.0 m to their places (§3.2)"),
    set!("thr_c-2000", "thr_c", "2000", "at most 2.0 m"),
    set!("thr_c-none", "thr_c", "100000", "however far it is"),
    set!("cost-max", "cost", "max", "cost is the longest way, not the sum (§3.2)"),
    set!("fuzzy-path", "free_path", "fuzzy", "the freer path wins before interval and cost (§3.3.1)"),
    Arm::new("one-retriever", "--retrievers 1", "only one robot retrieves (§4.1)", Change::OneRetriever),
    set!(
        "constrained",
        "correspondence",
        "constrained",
        "thr_c limits the search for a correspondence (§3.2)"
    ),
    set!("scopes-absolute", "scopes", "absolute", "opponents' scopes do not move with the ball (§3.3.2)"),
    set!("clamp", "out_of_field", "clamp", "adapted places are moved into the field"),
    set!("reject", "out_of_field", "reject", "no case with an adapted place outside the field"),
];

/// Effect of an arm on a measure.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Effect {
    /// Short name of the arm.
    pub arm: &'static str,
    /// `dg` or `2d`; null over all cells.
    pub configuration: Option<Configuration>,
    /// 1 to 4; null over all cells.
    pub scenario: Option<&'static str>,
    /// `to_goal`, `out`, `timeout` (percent); `possession` (all opponents'), `time` (s), `cases`, `default_s`
    /// a trial.
    pub measure: &'static str,
    /// Number of pairs of trials.
    pub trials: u32,
    /// Value of the unchanged team.
    pub default: f64,
    /// Value of the arm.
    pub value: f64,
    /// Value of the arm less that of the unchanged team.
    pub difference: f64,
    /// p of trials in pairs: McNemar's exact test, or the paired t.
    pub p_paired: Option<f64>,
    /// p as if trials were independent: z, or Welch's t.
    pub p_unpaired: Option<f64>,
    /// `p_paired` corrected over the arms.
    pub p_holm: Option<f64>,
}

/// The quantity that is measured in a trial.
enum Look {
    /// Whether it happened; in percent of trials.
    Share(fn(&TrialRow) -> bool),
    /// Amount; a mean over trials.
    Mean(fn(&TrialRow) -> f64),
}

const MEASURES: [(&str, Look); 7] = [
    ("to_goal", Look::Share(TrialRow::to_goal)),
    ("out", Look::Share(|row| row.outcome == TrialOutcome::Out)),
    ("timeout", Look::Share(|row| row.outcome == TrialOutcome::Timeout)),
    ("possession", Look::Mean(|row| f64::from(row.possession_defender + row.possession_midfield))),
    ("time", Look::Mean(|row| row.time_s)),
    ("cases", Look::Mean(|row| f64::from(row.individual + row.cooperative))),
    ("default_s", Look::Mean(|row| row.default_s.unwrap_or_default())),
];

/// The effects of arms on every cell and on all together; trials are paired by their number in the plan.
pub fn effects(default: &[TrialRow], arms: &[(Arm, Vec<TrialRow>)]) -> Vec<Effect> {
    let mut cells: Vec<Option<(Configuration, Scenario)>> = vec![None];
    for row in default {
        let cell = Some((row.configuration, row.scenario));
        if !cells.contains(&cell) {
            cells.push(cell);
        }
    }
    let mut effects = Vec::new();
    for (arm, rows) in arms {
        let pairs = rows.iter().zip(default).filter(|(own, default)| own.trial == default.trial);
        for cell in &cells {
            let of_cell = pairs
                .clone()
                .filter(|(_, row)| cell.is_none_or(|cell| cell == (row.configuration, row.scenario)));
            let of_cell: Vec<_> = of_cell.collect();
            effects.extend(MEASURES.iter().filter_map(|(measure, look)| {
                let difference = look.difference(&of_cell)?;
                Some(Effect {
                    arm: arm.name,
                    configuration: cell.map(|(configuration, _)| configuration),
                    scenario: cell.map(|(_, scenario)| scenario.label()),
                    measure,
                    trials: of_cell.len() as u32,
                    default: rounded(difference.default),
                    value: rounded(difference.value),
                    difference: rounded(difference.value - difference.default),
                    p_paired: difference.paired.map(|test| test.p),
                    p_unpaired: difference.unpaired.map(|test| test.p),
                    p_holm: None,
                })
            }));
        }
    }
    correct(&mut effects);
    effects
}

/// A measure of an arm and of the unchanged team, and the tests of their difference.
struct MeasuredDifference {
    default: f64,
    value: f64,
    paired: Option<Test>,
    unpaired: Option<Test>,
}

impl Look {
    /// Compares pairs of trials: the arm's, and the unchanged team's.
    fn difference(&self, pairs: &[(&TrialRow, &TrialRow)]) -> Option<MeasuredDifference> {
        if pairs.is_empty() {
            return None;
        }
        Some(match self {
            Self::Share(happened) => {
                let shares =
                    PairedShares::of(pairs.iter().map(|(arm, default)| (happened(arm), happened(default))));
                MeasuredDifference {
                    default: percent(shares.without),
                    value: percent(shares.with),
                    paired: shares.test(),
                    unpaired: two_proportions(shares.with, shares.without),
                }
            }
            Self::Mean(amount) => {
                let means =
                    PairedMeans::of(pairs.iter().map(|(arm, default)| (amount(arm), amount(default))))?;
                MeasuredDifference {
                    default: means.without.mean,
                    value: means.with.mean,
                    paired: means.test(),
                    unpaired: welch(means.with, means.without),
                }
            }
        })
    }
}

fn percent(count: Count) -> f64 {
    100.0 * f64::from(count.hits) / f64::from(count.of)
}

/// Fills in [`Effect::p_holm`]: a family is a measure in a cell, over the arms.
fn correct(effects: &mut [Effect]) {
    let family =
        |effect: &Effect| (effect.measure, effect.configuration.map(Configuration::label), effect.scenario);
    let tests: Vec<_> = effects.iter().map(|effect| (family(effect), effect.p_paired)).collect();
    for (effect, p) in effects.iter_mut().zip(holm_by_family(&tests)) {
        effect.p_holm = p;
    }
}

/// The effects over all cells for a terminal, an arm a line.
pub fn ablation_table(effects: &[Effect]) -> String {
    let all: Vec<_> = effects.iter().filter(|effect| effect.scenario.is_none()).collect();
    let mut text = String::new();
    let Some(first) = all.first() else { return text };
    let _ = writeln!(
        text,
        "Case-based attackers with one thing changed; differences over all cells, {} pairs of trials an arm; stars: p after Holm",
        first.trials
    );
    let _ = write!(text, "  {:16}", "arm");
    for (measure, _) in &MEASURES {
        let _ = write!(text, "{measure:>11}   ");
    }
    text.truncate(text.trim_end().len());
    let _ = write!(text, "\n  {:16}", "default");
    for (measure, _) in &MEASURES {
        let value = all.iter().find(|effect| effect.measure == *measure).map_or(0.0, |effect| effect.default);
        let _ = write!(text, "{value:>11.2}   ");
    }
    text.truncate(text.trim_end().len());
    text.push('\n');
    for arm in ARMS.iter().filter(|arm| all.iter().any(|effect| effect.arm == arm.name)) {
        let _ = write!(text, "  {:16}", arm.name);
        for effect in all.iter().filter(|effect| effect.arm == arm.name) {
            let _ = write!(text, "{:>+11.2}{:3}", effect.difference, stars(effect.p_holm));
        }
        let _ = writeln!(text, "   {}", arm.what);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evaluation::row::tests::row;

    #[test]
    fn every_arm_but_the_first_changes_the_team_and_names_the_flags_for_it() {
        let mut names: Vec<_> = ARMS.iter().map(|arm| arm.name).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), ARMS.len());
        for (place, arm) in ARMS.iter().enumerate() {
            assert_eq!(arm.is_default(), place == 0);
            assert_eq!(arm.setup() == Setup::default(), place == 0, "{}", arm.name);
            assert_eq!(arm.flags.is_empty(), place == 0, "{}", arm.name);
        }
    }

    #[test]
    fn trials_are_compared_in_pairs() {
        // By manual calculation: 10 pairs; only the default goes to goal in 6 of them, only the arm in 1,
        // both in 2. McNemar: 2 · P(at most 1 of 7) = 2 · 8 / 128 = 0.125. Seconds: 1 more in every second
        // pair.
        let outcome = |goal| if goal { TrialOutcome::Goal } else { TrialOutcome::Out };
        let trial = |trial, goal, time_s| TrialRow { trial, outcome: outcome(goal), time_s, ..row() };
        let default: Vec<_> = (0..10).map(|i| trial(i, i < 8, 10.0)).collect();
        let arm = (0..10).map(|i| trial(i, i < 2 || i == 8, 10.0 + (i % 2) as f64)).collect();
        let effects = effects(&default, &[(ARMS[1], arm)]);
        let find = |measure, all| {
            effects.iter().find(|e| e.measure == measure && e.scenario.is_none() == all).unwrap()
        };
        for all in [true, false] {
            let goal = find("to_goal", all);
            assert_eq!((goal.default, goal.value, goal.difference, goal.trials), (80.0, 30.0, -50.0, 10));
            assert!((goal.p_paired.unwrap() - 0.125).abs() < 1e-12);
            assert_eq!(goal.p_holm, goal.p_paired, "one arm is no family");
            // Mean 0.5, sd 0.527046: t = 3, 9 degrees of freedom, p = 0.01496.
            let time = find("time", all);
            assert!((time.p_paired.unwrap() - 0.014956).abs() < 1e-5, "{time:?}");
        }
        assert_eq!(effects.len(), 2 * MEASURES.len());
        let table = ablation_table(&effects);
        assert!(table.contains("independent") && table.contains("-50.00"), "{table}");
    }
}
