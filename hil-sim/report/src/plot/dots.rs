//! How much on average? Dots with Student's intervals: possessions and times; a panel a measure, scenarios below each other.

use arena::evaluation::Measure;
use drawing::{Anchor, Font, Svg, Theme};

use super::axis::{Axis, BELOW, GRID};
use super::{Entry, Figure, PANEL, Panel, Shape, entries, keys, scenarios, style};
use crate::columns::interval;
use crate::{Report, numbers, words};

/// Means of a table.
pub(super) fn figure(report: &Report<'_>, table: u8, measures: &[Measure]) -> Figure {
    let scenarios = scenarios(report, table);
    let all: Vec<Entry<'_>> = scenarios.iter().flat_map(|s| entries(report, table, *s)).collect();
    let panels = measures.iter().filter_map(|measure| {
        let ends = all.iter().filter_map(|entry| {
            let value = measure.value(entry.row)?;
            Some(interval(*measure, entry.row).map_or(value, |interval| interval.high))
        });
        let high = ends.fold(None, |high: Option<f64>, end| Some(high.map_or(end, |high| high.max(end))))?;
        let axis = Axis::up_to(high, LEFT, PANEL - RIGHT);
        let rows: Vec<_> = scenarios.iter().map(|s| (*s, entries(report, table, *s))).collect();
        Some(panel(*measure, table, &rows, axis))
    });
    let against = if matches!(table, 4 | 5) { "two defenders" } else { "a defender and a goalie" };
    let robots = if table == 6 { ", robots" } else { "" };
    let what = if measures.contains(&Measure::Time) { "possession and time" } else { "possession" };
    Figure {
        table,
        name: format!("table-{table}-means"),
        title: format!("Means of {what} against {against}{robots}, with 95 % intervals"),
        keys: keys(all.iter().copied(), Shape::Dot),
        panels: panels.collect(),
    }
}

fn panel(measure: Measure, table: u8, rows: &[(hil_sim::Scenario, Vec<Entry<'_>>)], axis: Axis) -> Panel {
    let colors = Theme::Light.colors();
    let mut svg = Svg::default();
    let height: f64 = rows.iter().map(|(_, entries)| entries.len() as f64 * DOT + BETWEEN).sum();
    let (title, unit) = words_of(measure, table);
    axis.draw(&mut svg, 0.0, -height, unit);
    let font = Font { size: 13.0, fill: colors.ink, bold: false, halo: None };
    let mut top = 0.0;
    for (scenario, entries) in rows {
        let group = entries.len() as f64 * DOT + BETWEEN;
        let name = words::scenario(*scenario);
        svg.text([LEFT - 10.0, top - group * 0.5 - 4.5], &name, Anchor::End, font);
        if top < 0.0 {
            svg.line([0.0, top], [PANEL - RIGHT, top], format!(r#"stroke="{GRID}" stroke-width="1""#));
        }
        for (j, entry) in entries.iter().enumerate() {
            let Some(mean) = measure.value(entry.row) else { continue };
            let y = top - BETWEEN * 0.5 - DOT * (j as f64 + 0.5);
            let mut right = axis.place(mean) + 6.0;
            if let Some(reach) = interval(measure, entry.row) {
                let (low, high) = (axis.place(reach.low), axis.place(reach.high));
                let color = words::color(entry.row.approach);
                svg.line([low, y], [high, y], format!(r#"stroke="{color}" stroke-width="1.8""#));
                right = right.max(high + 4.0);
            }
            svg.circle([axis.place(mean), y], 4.2, style(entry.row.approach, entry.ours));
            let fill = if entry.ours { colors.ink } else { colors.faint };
            let font = Font { size: 10.5, fill, bold: entry.ours, halo: Some(colors.paper) };
            let decimals = if measure == Measure::Time { 1 } else { 2 };
            svg.text([right + 2.0, y - 3.8], &numbers::plain(mean, decimals), Anchor::Start, font);
        }
        top -= group;
    }
    Panel { title: title.to_owned(), svg, height: height + BELOW }
}

/// A panel's title and its axis.
const fn words_of(measure: Measure, table: u8) -> (&'static str, &'static str) {
    match (measure, table) {
        (Measure::Time, 5) => ("Time of trials that did not run out of it", "s"),
        (Measure::Time, _) => ("Time of a trial", "s"),
        (Measure::MidfieldPossession, _) => ("The midfield defender had the ball", "times a trial"),
        _ => ("The defender had the ball", "times a trial"),
    }
}

/// Where the axis begins, px: after the scenarios' names.
const LEFT: f64 = 134.0;
/// Room for the numbers behind the last dot, px.
const RIGHT: f64 = 46.0;
/// Height of a dot with the gap to the next, px.
const DOT: f64 = 13.0;
/// Between scenarios, px.
const BETWEEN: f64 = 12.0;
