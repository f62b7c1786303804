//! `plot`: plots of the report, a panel a scenario or measure.
//!
//! Everywhere: ours is filled, the paper's is hollow, an approach keeps its colour, whiskers are 95 %
//! intervals.

mod bars;
mod dots;
mod effects;
mod uses;

use figures::{Figure, Key, Shape};
use hil_sim::Scenario;
use study::evaluation::{Measure, TableRow};

use crate::{Report, labels};
use bars::BarChart;

/// A plot, and the number of the table whose numbers it shows; 0 for all.
pub(crate) type TablePlot = (u8, Figure);

pub(crate) fn plots(report: &Report<'_>) -> Vec<TablePlot> {
    let mut plots = vec![
        (0, effects::figure(report)),
        (1, BarChart::outcomes(1).figure(report)),
        (1, dots::figure(report, 1, &[Measure::Possession, Measure::Time])),
        (2, BarChart::backing_up().figure(report)),
        (3, BarChart::cases().figure(report)),
        (3, uses::figure(report)),
        (4, BarChart::outcomes(4).figure(report)),
        (5, dots::figure(report, 5, &[Measure::MidfieldPossession, Measure::Possession, Measure::Time])),
        (6, BarChart::outcomes(6).figure(report)),
        (6, dots::figure(report, 6, &[Measure::Possession])),
    ];
    plots.retain(|(_, figure)| !figure.panels.is_empty());
    plots
}

/// A row of results, ours or the paper's.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Entry<'a> {
    pub(crate) row: &'a TableRow,
    pub(crate) ours: bool,
}

/// The rows of a table and scenario: by approach, ours before the paper's. Of ours with several numbers of
/// trials, the row with most.
pub(crate) fn entries<'a>(report: &Report<'a>, table: u8, scenario: Scenario) -> Vec<Entry<'a>> {
    let own = |row: &&TableRow| (row.table, row.scenario) == (table, scenario);
    let mut entries: Vec<Entry<'a>> = Vec::new();
    for row in report.rows.iter().filter(own) {
        match entries.iter_mut().find(|entry| entry.row.approach == row.approach) {
            Some(entry) if entry.row.trials < row.trials => entry.row = row,
            Some(_) => {}
            None => entries.push(Entry { row, ours: true }),
        }
    }
    let with_paper = entries.into_iter().flat_map(|entry| {
        let same = |row: &&TableRow| own(row) && row.approach == entry.row.approach;
        let paper = report.paper.iter().find(same).map(|row| Entry { row, ours: false });
        [Some(entry), paper].into_iter().flatten()
    });
    with_paper.collect()
}

/// The scenarios of a table, in the order of its rows.
pub(crate) fn scenarios(report: &Report<'_>, table: u8) -> Vec<Scenario> {
    let mut scenarios = Vec::new();
    for row in report.rows.iter().filter(|row| row.table == table) {
        if !scenarios.contains(&row.scenario) {
            scenarios.push(row.scenario);
        }
    }
    scenarios
}

/// Legend of the entries' colours and fills.
pub(crate) fn keys<'a>(entries: impl Iterator<Item = Entry<'a>>, shape: Shape) -> Vec<Key> {
    let mut keys: Vec<Key> = Vec::new();
    for Entry { row, ours } in entries {
        let own = labels::approach(row.approach);
        let label = if ours { own.to_owned() } else { format!("{own}, the paper’s") };
        let key = Key { label, color: labels::color(row.approach), is_filled: ours, shape };
        if !keys.contains(&key) {
            keys.push(key);
        }
    }
    keys
}
