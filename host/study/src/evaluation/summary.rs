//! `summary`: the paper's tables as text for terminals: ours, the paper's in brackets, and under each
//! scenario the differences between the approaches.
//!
//! Stars are p after Holm's correction over the scenarios: * < 0.05, ** < 0.01, *** < 0.001. After a bracket
//! they mean that ours differs from the paper's; in a line of differences, that the approaches differ.

use figures::{Cell, Row, Table, row};
use hil_sim::Scenario;

use super::comparison::{Comparison, Measure};
use super::paper::paper;
use super::results::Results;
use super::tables::{Extent, TableRow};
use crate::statistics::stars;
use arena::approach_label;

struct Column {
    title: &'static str,
    value: fn(&TableRow) -> Option<f64>,
    decimals: usize,
    measure: Option<Measure>,
}

impl Column {
    const fn share(measure: Measure, title: &'static str, value: fn(&TableRow) -> Option<f64>) -> Self {
        Self { title, value, decimals: 1, measure: Some(measure) }
    }

    const fn mean(measure: Measure, title: &'static str, value: fn(&TableRow) -> Option<f64>) -> Self {
        Self { title, value, decimals: 2, measure: Some(measure) }
    }

    const fn plain(title: &'static str, decimals: usize, value: fn(&TableRow) -> Option<f64>) -> Self {
        Self { title, value, decimals, measure: None }
    }
}

/// Title and columns of the paper's table with this number.
fn layout(table: u8) -> (&'static str, Vec<Column>) {
    let goal = || Column::share(Measure::Goal, "goal %", |row| row.goal);
    let close = || Column::share(Measure::Close, "close %", |row| row.close);
    let block = || Column::share(Measure::Block, "block %", |row| row.block);
    let out = || Column::share(Measure::Out, "out %", |row| row.out);
    let to_goal = || Column::share(Measure::ToGoal, "to goal %", |row| row.to_goal);
    let defender = || Column::mean(Measure::Possession, "defender", |row| row.possession_mean);
    let midfield = || Column::mean(Measure::MidfieldPossession, "midfield", |row| row.possession2_mean);
    let time = || Column::mean(Measure::Time, "time s", |row| row.time_mean);
    let duel = || Column::plain("duel %", 0, |row| row.duel_time);
    let put_out = |title, value| Column::plain(title, 0, value);
    match table {
        1 => (
            "defender and goalie",
            vec![goal(), close(), block(), out(), to_goal(), defender(), time(), duel()],
        ),
        2 => (
            "backing up, a trial",
            vec![
                Column::plain("A", 2, |row| row.backups_a),
                Column::plain("B", 2, |row| row.backups_b),
                Column::plain("B %", 0, |row| share(row.backups_b?, row.backups_a?)),
            ],
        ),
        3 => (
            "cases used, a trial",
            vec![
                Column::plain("one robot", 2, |row| row.individual),
                Column::plain("several", 2, |row| row.cooperative),
                Column::plain("several %", 0, |row| share(row.cooperative?, row.individual?)),
                Column::plain("none", 2, |row| row.none),
                Column::plain("default %", 1, |row| row.default_time),
            ],
        ),
        4 => (
            "two defenders, at most 60 s",
            vec![to_goal(), out(), Column::share(Measure::Timeout, "timeout %", |row| row.timeout), duel()],
        ),
        5 => ("two defenders, without those that ran out of time", vec![midfield(), defender(), time()]),
        _ => (
            "as the paper's robots: noise, 5 s stops",
            vec![
                goal(),
                close(),
                block(),
                out(),
                to_goal(),
                put_out("by them", |row| row.out_by_opponents.map(f64::from)),
                put_out("by us", |row| row.out_by_attackers.map(f64::from)),
                defender(),
                duel(),
            ],
        ),
    }
}

/// Percent of the first in the sum.
fn share(first: f64, second: f64) -> Option<f64> {
    (first + second > 0.0).then(|| 100.0 * first / (first + second))
}

/// All tables, ours beside the paper's.
pub fn summary(results: &Results) -> String {
    let mut text = String::new();
    for (table, sample) in (1..=6).map(|table| (table, Extent::Paper)).chain([(6, Extent::Large)]) {
        let of = |row: &&TableRow| (row.table, row.sample) == (table, sample);
        let rows: Vec<_> = results.tables.iter().filter(of).collect();
        if !rows.is_empty() {
            text += &table_text(results, table, sample, &rows);
        }
    }
    text
}

fn table_text(results: &Results, number: u8, sample: Extent, rows: &[&TableRow]) -> String {
    let (title, columns) = layout(number);
    let least = rows.iter().map(|row| row.trials).min().unwrap_or_default();
    let most = rows.iter().map(|row| row.trials).max().unwrap_or_default();
    let trials = if least == most { most.to_string() } else { format!("{least} to {most}") };
    let world = &results.identity.world;
    let heads = columns.iter().map(|column| figures::Column::number(column.title, ""));
    let names = ["", ""].map(figures::Column::name);
    let mut table = Table::new(names.into_iter().chain(heads));
    let mut scenarios: Vec<Scenario> = rows.iter().map(|row| row.scenario).collect();
    scenarios.dedup();
    for scenario in scenarios {
        for (place, row) in rows.iter().filter(|row| row.scenario == scenario).enumerate() {
            let name = if place == 0 { scenario.label() } else { "" };
            let names = row![name, approach_label(row.approach)];
            table.push(names.with(columns.iter().map(|column| cell(results, row, column))));
        }
        // Tables 2 and 3 have no compared measure.
        if columns.iter().any(|column| column.measure.is_some()) {
            let own = |c: &&Comparison| (c.table, c.sample, c.scenario) == (number, sample, scenario);
            let comparisons: Vec<_> = results.between_approaches.iter().filter(own).collect();
            table.rows.extend(differences(&comparisons, &columns));
        }
    }
    // The paper's sixth table, with its number of trials and with as many as were played.
    let sample = if sample == Extent::Large { ", all of them" } else { "" };
    format!(
        "Table {number}{sample}: {title}; {trials} trials a row, world {world}, in brackets the paper's\n{}\n",
        table.text()
    )
}

/// A line for each pair of approaches that is compared.
fn differences(comparisons: &[&Comparison], columns: &[Column]) -> Vec<Row> {
    let mut pairs: Vec<_> = comparisons.iter().map(|c| (c.first_approach, c.second_approach)).collect();
    pairs.dedup();
    let mut rows = Vec::new();
    for pair in pairs {
        let cells = columns.iter().map(|column| {
            let of_pair = |c: &&&Comparison| {
                (c.first_approach, c.second_approach) == pair && Some(c.measure) == column.measure
            };
            comparisons.iter().find(of_pair).map_or(Cell::GAP, |c| difference(c, column.decimals))
        });
        let name = format!("{} - {}", approach_label(pair.0), approach_label(pair.1));
        rows.push(row!["", name].with(cells));
    }
    rows
}

/// Ours, and the paper's in brackets.
fn cell(results: &Results, row: &TableRow, column: &Column) -> Cell {
    let number = |value: f64| format!("{value:.*}", column.decimals);
    let key = |row: &TableRow| (row.table, row.scenario, row.approach);
    let printed = paper().iter().find(|other| key(other) == key(row)).and_then(|other| (column.value)(other));
    let printed = printed.map_or_else(String::new, |value| {
        let text = number(value);
        let short = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
        format!("({short})")
    });
    let own = |c: &&Comparison| {
        (c.table, c.sample, c.scenario, c.first_approach)
            == (row.table, row.sample, row.scenario, row.approach)
            && Some(c.measure) == column.measure
    };
    let marks = results.with_paper.iter().find(own).map_or("", |c| stars(c.p_holm));
    let value = (column.value)(row).map_or_else(|| "-".to_owned(), number);
    Cell::marked(value, marks).beside(printed)
}

fn difference(comparison: &Comparison, decimals: usize) -> Cell {
    let value = comparison.first - comparison.second;
    Cell::marked(format!("{value:+.decimals$}"), stars(comparison.p_holm))
}

#[cfg(test)]
mod tests {
    use hil_sim::TrialOutcome;

    use super::*;
    use crate::evaluation::identity::tests::identity;
    use crate::evaluation::row::TrialRow;
    use crate::evaluation::row::tests::row;
    use brain::Approach;

    #[test]
    fn ours_is_beside_the_papers_with_the_stars_of_the_difference() {
        // 27 of 30 against the paper's 26 % of 500: surely more. cbr − reactive: 90 − 80 %, z = 1.08.
        let goals = |approach, goals: usize| {
            (0..30).map(move |i| {
                let outcome = if i < goals { TrialOutcome::Goal } else { TrialOutcome::Out };
                TrialRow { approach, outcome, time_s: 10.0, ..row() }
            })
        };
        let rows = goals(Approach::Cases, 27).chain(goals(Approach::Reactive, 24));
        let text = summary(&Results::new(identity(), rows.collect()).unwrap());
        let lines: Vec<_> = text.lines().collect();
        let world = hil_sim::world_hash();
        let title =
            format!("Table 1: defender and goalie; 30 trials a row, world {world}, in brackets the paper's");
        assert_eq!(lines[0], title);
        let fields = |line: &str| line.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
        assert_eq!(fields(lines[2])[..4], ["2", "cbr", "90.0", "(26)***"]);
        assert_eq!(fields(lines[3])[..3], ["reactive", "80.0", "(25)***"]);
        assert_eq!(fields(lines[4])[..5], ["cbr", "-", "reactive", "+10.0", "+0.0"]);
        assert_eq!(lines[2].find("90.0"), lines[3].find("80.0"), "{text}");
        assert!(text.contains("Table 2") && text.contains("Table 3") && !text.contains("Table 4"), "{text}");
    }
}
