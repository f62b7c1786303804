//! `paper`: the paper's measurements. Its Tables 1 to 6 as rows like ours (`host/study/data`, whose README
//! names every source).

use std::collections::HashMap;
use std::sync::LazyLock;

use brain::Approach;
use hil_sim::Scenario;

use super::tables::TableRow;
use arena::approach_from_label;

/// The paper's rows, by table and scenario. Percentages and means as printed; Table 6's from its 30 trials a
/// row.
pub fn paper() -> &'static [TableRow] {
    &ROWS
}

static ROWS: LazyLock<Vec<TableRow>> =
    LazyLock::new(|| FILES.into_iter().flat_map(|(table, text)| read(table, text)).collect());

/// A line of a file by the names of its columns.
struct Line(HashMap<String, String>);

impl Line {
    fn text(&self, column: &str) -> Option<&str> {
        self.0.get(column).map(String::as_str)
    }

    fn number(&self, column: &str) -> Option<f64> {
        self.text(column)?.parse().ok()
    }
}

fn read(table: u8, text: &str) -> Vec<TableRow> {
    let mut rows: Vec<TableRow> = Vec::new();
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let lines: Result<Vec<_>, _> = reader.deserialize().collect();
    for line in lines.expect("the files are committed, and tests read them").into_iter().map(Line) {
        let scenario = line.text("scenario").and_then(Scenario::from_label).expect("a scenario a line");
        // Tables 2 and 3 are of one approach each, and name none.
        let default = if table == 2 { Approach::Reactive } else { Approach::Cases };
        let approach = line.text("approach").and_then(approach_from_label).unwrap_or(default);
        let known = rows.iter_mut().position(|row| (row.scenario, row.approach) == (scenario, approach));
        let place = known.unwrap_or_else(|| {
            rows.push(TableRow::empty(table, scenario, approach));
            rows.len() - 1
        });
        fill(&mut rows[place], &line);
    }
    rows
}

fn fill(row: &mut TableRow, line: &Line) {
    let trials = line.number("trials").or(line.number("trials_without_timeout_derived"));
    // Tables 2 and 3 are of Table 1's trials.
    row.trials = trials.map_or(TRIALS_OF_TABLE_1, |trials| trials as u32);
    let share = |percent: &str, count: &str| {
        let exact = line.number(count).map(|hits| 100.0 * hits / f64::from(row.trials));
        exact.or(line.number(percent))
    };
    row.goal = share("goal_pct", "goal_n_derived");
    row.close = share("close_pct", "close_n_derived");
    row.block = share("block_pct", "block_n_derived");
    row.out = share("out_pct", "out_n_derived");
    row.timeout = line.number("timeout_pct");
    row.to_goal = match (line.number("goal_n_derived"), line.number("close_n_derived")) {
        (Some(goal), Some(close)) => Some(100.0 * (goal + close) / f64::from(row.trials)),
        _ => line.number("to_goal_pct"),
    };
    row.possession_mean = line.number("defender_possession_avg");
    row.possession_sd = line.number("defender_possession_stdev");
    row.possession2_mean = line.number("midfield_possession_avg");
    row.possession2_sd = line.number("midfield_possession_stdev");
    row.time_mean = line.number("time_s");
    row.out_by_attackers = line.number("out_by_attackers").map(|count| count as u32);
    row.out_by_opponents = line.number("out_by_defender").map(|count| count as u32);
    match line.text("robot") {
        Some("A") => row.backups_a = line.number("backups_avg"),
        Some("B") => row.backups_b = line.number("backups_avg"),
        _ => {}
    }
    match line.text("case_type") {
        Some("individualistic") => row.individual = line.number("cases_avg"),
        Some("cooperative") => row.cooperative = line.number("cases_avg"),
        _ => {}
    }
}

/// Trials of each row of Table 1.
const TRIALS_OF_TABLE_1: u32 = 500;
const FILES: [(u8, &str); 6] = [
    (1, include_str!("../../data/ros_table1_dg_simulation.csv")),
    (2, include_str!("../../data/ros_table2_reactive_backing_up.csv")),
    (3, include_str!("../../data/ros_table3_cbr_case_types.csv")),
    (4, include_str!("../../data/ros_table4_2d_simulation.csv")),
    (5, include_str!("../../data/ros_table5_2d_possession_time.csv")),
    (6, include_str!("../../data/ros_table6_real_robots.csv")),
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evaluation::comparison::{Measure, compare};
    use crate::statistics::wilson;

    /// `T1 DG sim` → 1.
    fn table_of(name: &str) -> u8 {
        name[1..2].parse().unwrap()
    }

    fn lines(text: &str) -> Vec<Line> {
        csv::Reader::from_reader(text.as_bytes()).deserialize().map(|line| Line(line.unwrap())).collect()
    }

    #[test]
    fn all_rows_of_the_paper_are_there_and_add_up() {
        let trials = |table| {
            let rows = paper().iter().filter(|row| row.table == table);
            (rows.clone().count(), rows.map(|row| row.trials).sum::<u32>())
        };
        assert_eq!([1, 4, 6].map(trials), [(8, 4000), (8, 1600), (4, 120)]);
        assert_eq!([2, 3, 5].map(|table| trials(table).0), [4, 4, 8]);
        for row in paper().iter().filter(|row| matches!(row.table, 1 | 4 | 6)) {
            let sum: f64 = if row.table == 4 {
                [row.to_goal, row.out, row.timeout].into_iter().flatten().sum()
            } else {
                [row.to_goal, row.block, row.out].into_iter().flatten().sum()
            };
            assert!((sum - 100.0).abs() < 1e-9, "{row:?}");
        }
        let row = |table, approach| {
            let mut rows =
                paper().iter().filter(|row| row.table == table && row.scenario == Scenario::LeftSide);
            rows.find(|row| row.approach == approach).unwrap()
        };
        assert_eq!(
            (row(2, Approach::Reactive).backups_a, row(2, Approach::Reactive).backups_b),
            (Some(7.2), Some(26.2))
        );
        assert_eq!(
            (row(3, Approach::Cases).individual, row(3, Approach::Cases).cooperative),
            (Some(4.1), Some(6.0))
        );
    }

    #[test]
    fn wilsons_intervals_of_the_papers_shares_are_those_computed_apart() {
        let mut checked = 0;
        for line in lines(include_str!("../../data/derived_wilson95.csv")) {
            let scenario = line.text("scenario").and_then(Scenario::from_label);
            let approach = line.text("approach").and_then(approach_from_label);
            let measure = line.text("measure").and_then(Measure::from_label).unwrap();
            let table = table_of(line.text("table").unwrap());
            let row = paper().iter().find(|row| {
                row.table == table && Some(row.scenario) == scenario && Some(row.approach) == approach
            });
            let count = measure.count(row.unwrap()).unwrap();
            assert_eq!(Some(f64::from(count.of)), line.number("n"));
            let interval = wilson(count, 0.95).unwrap();
            let near = |value: f64, column| (100.0 * value - line.number(column).unwrap()).abs() <= 0.0501;
            assert!(near(interval.low, "lo95") && near(interval.high, "hi95"), "{interval:?} {:?}", line.0);
            checked += 1;
        }
        assert_eq!(checked, 40 + 24 + 16);
    }

    #[test]
    fn tests_of_the_papers_shares_are_those_computed_apart() {
        let comparisons = compare(paper(), Approach::Cases, Approach::Reactive);
        let mut checked = 0;
        for line in lines(include_str!("../../data/derived_cbr_vs_reactive_z.csv")) {
            let scenario = line.text("scenario").and_then(Scenario::from_label);
            let measure = line.text("measure").and_then(Measure::from_label).unwrap();
            let table = table_of(line.text("table").unwrap());
            let own = comparisons.iter().find(|comparison| {
                comparison.table == table
                    && Some(comparison.scenario) == scenario
                    && comparison.measure == measure
            });
            let test = own.unwrap().test.unwrap();
            let (z, p) = (line.number("z").unwrap(), line.number("p_two_sided").unwrap());
            assert!((test.statistic - z).abs() <= 0.0051, "{test:?} {:?}", line.0);
            // Two digits are printed.
            assert!((test.p - p).abs() <= 0.051 * p, "{test:?} {:?}", line.0);
            checked += 1;
        }
        assert_eq!(checked, 20 + 12 + 10);
    }
}
