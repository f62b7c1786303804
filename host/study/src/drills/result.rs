//! `result`: shares of the tries of each drill, with intervals, as JSON and as a table.

use figures::{Row, Table, row};
use serde::Serialize;

use super::{DrillKind, DrillPlan, DrillRow, NextTouch};
use crate::statistics::{Count, wilson};

/// A number of tries, with the interval of their share.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Proportion {
    /// Share of the tries, 0 to 1.
    pub share: f64,
    /// Wilson's 95 % interval of the share.
    pub interval: [f64; 2],
}

/// Result of one drill.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DrillResult {
    /// The drill.
    pub drill: DrillKind,
    /// The world.
    pub world: String,
    /// Seed of the plan.
    pub seed: u64,
    /// Number of tries.
    pub tries: u32,
    /// Those in which ours did what the drill asks.
    pub succeeded: u32,
    /// Those in which one of ours had the ball after ours had kicked it.
    pub to_mate: u32,
    /// Those in which one of theirs had it then.
    pub to_opponent: u32,
    /// Those with a shot at our goal.
    pub shots_against: u32,
    /// Goals against.
    pub goals_against: u32,
    /// Share and interval of `succeeded`.
    pub succeeded_share: Proportion,
    /// Share and interval of `to_mate`.
    pub to_mate_share: Proportion,
    /// Share and interval of `to_opponent`.
    pub to_opponent_share: Proportion,
    /// Share and interval of `goals_against`.
    pub goals_against_share: Proportion,
    /// Median time until ours touched the ball, of tries in which they did, s.
    pub touched_median_s: Option<f64>,
}

/// Results in the order of the plan's drills.
pub fn drill_results(plan: &DrillPlan, rows: &[DrillRow]) -> Vec<DrillResult> {
    plan.drills.iter().map(|drill| result(plan, *drill, rows)).collect()
}

fn result(plan: &DrillPlan, drill: DrillKind, rows: &[DrillRow]) -> DrillResult {
    let rows: Vec<_> = rows.iter().filter(|row| row.drill == drill).collect();
    let tries = rows.len() as u32;
    let count = |counts: &dyn Fn(&DrillRow) -> bool| rows.iter().filter(|row| counts(row)).count() as u32;
    let succeeded = count(&DrillRow::succeeded);
    let to_mate = count(&|row| row.next_touch == NextTouch::Mate);
    let to_opponent = count(&|row| row.next_touch == NextTouch::Opponent);
    let shots_against = count(&|row| row.shot_against);
    let goals_against = count(&|row| row.goal_against);
    let mut touched: Vec<f64> = rows.iter().filter_map(|row| row.touched_s).collect();
    touched.sort_by(f64::total_cmp);
    let share = |hits| proportion(Count { hits, of: tries });
    DrillResult {
        drill,
        world: plan.world.to_string(),
        seed: plan.seed,
        tries,
        succeeded,
        to_mate,
        to_opponent,
        shots_against,
        goals_against,
        succeeded_share: share(succeeded),
        to_mate_share: share(to_mate),
        to_opponent_share: share(to_opponent),
        goals_against_share: share(goals_against),
        touched_median_s: touched.get(touched.len() / 2).copied(),
    }
}

fn proportion(count: Count) -> Proportion {
    let interval = wilson(count, 0.95).map_or([0.0, 1.0], |interval| [interval.low, interval.high]);
    Proportion { share: count.share().unwrap_or(0.0), interval }
}

/// One row a drill, shares in percent.
pub fn drill_table(results: &[DrillResult]) -> String {
    let heads = "drill | tries | succeeded | to a mate | to an opponent | shots against | goals against | median time to touch";
    Table::of_texts(heads).with_rows(results.iter().map(result_row)).markdown()
}

fn result_row(result: &DrillResult) -> Row {
    row![
        result.drill.label(),
        result.tries,
        percent(result.succeeded_share),
        percent(result.to_mate_share),
        percent(result.to_opponent_share),
        result.shots_against,
        percent(result.goals_against_share),
        result.touched_median_s.map_or(String::new(), |time| format!("{time:.2} s")),
    ]
}

fn percent(of: Proportion) -> String {
    let [low, high] = of.interval.map(|end| 100.0 * end);
    format!("{:.1} ({low:.1} to {high:.1}) %", 100.0 * of.share)
}
