//! `dots`: dot plots of means: possessions and times with Student's intervals; a panel a measure.

use figures::numbers::plain;
use figures::{Dot, DotRow, Figure, Panel, Shape, dot_axis, dot_panel};
use study::evaluation::Measure;

use super::{Entry, entries, keys, scenarios};
use crate::columns::interval;
use crate::{Report, labels};

/// Means of a table.
pub(super) fn figure(report: &Report<'_>, table: u8, measures: &[Measure]) -> Figure {
    let all: Vec<Entry<'_>> =
        scenarios(report, table).into_iter().flat_map(|s| entries(report, table, s)).collect();
    let panels = measures.iter().filter_map(|measure| of_measure(report, table, *measure));
    let against = if matches!(table, 4 | 5) { "two defenders" } else { "a defender and a goalie" };
    let robots = if table == 6 { ", robots" } else { "" };
    let what = if measures.contains(&Measure::Time) { "possession and time" } else { "possession" };
    Figure {
        name: format!("table-{table}-means"),
        title: format!("Means of {what} against {against}{robots}, with 95 % intervals"),
        keys: keys(all.into_iter(), Shape::Dot),
        panels: panels.collect(),
    }
}

/// The panel of a measure; `None` where it was not measured.
fn of_measure(report: &Report<'_>, table: u8, measure: Measure) -> Option<Panel> {
    let rows = scenarios(report, table).into_iter().map(|scenario| {
        let dots = entries(report, table, scenario).into_iter().filter_map(|entry| dot(measure, entry));
        DotRow { name: labels::scenario(scenario), dots: dots.collect() }
    });
    let rows: Vec<_> = rows.collect();
    let ends =
        rows.iter().flat_map(|row| &row.dots).map(|dot| dot.interval.map_or(dot.value, |(_, high)| high));
    let high = ends.fold(None, |high: Option<f64>, end| Some(high.map_or(end, |high| high.max(end))))?;
    let (title, unit) = title_and_unit(measure, table);
    Some(dot_panel(title.to_owned(), unit, &rows, &dot_axis(0.0, high)))
}

fn dot(measure: Measure, Entry { row, ours }: Entry<'_>) -> Option<Dot> {
    let value = measure.value(row)?;
    Some(Dot {
        color: labels::color(row.approach),
        is_filled: ours,
        value,
        interval: interval(measure, row).map(|interval| (interval.low, interval.high)),
        text: plain(value, if measure == Measure::Time { 1 } else { 2 }),
    })
}

const fn title_and_unit(measure: Measure, table: u8) -> (&'static str, &'static str) {
    match (measure, table) {
        (Measure::Time, 5) => ("Time of trials that did not run out of it", "s"),
        (Measure::Time, _) => ("Time of a trial", "s"),
        (Measure::MidfieldPossession, _) => ("The midfield defender had the ball", "times a trial"),
        _ => ("The defender had the ball", "times a trial"),
    }
}
