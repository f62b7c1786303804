//! `bars`: bar plots of frequencies. Bars with intervals: outcomes, backing up, cases; a panel a scenario.

use arena::evaluation::Measure;
use arena::evaluation::TableRow;
use arena::evaluation::statistics::Interval;
use figures::{Anchor, Font, Svg, Theme};

use super::axis::{Axis, BELOW};
use super::{Entry, Figure, PANEL, Panel, Shape, entries, keys, scenarios, style};
use crate::columns::interval;
use crate::{Report, description, numbers};

/// A measure of the bars: its label, its value, its interval.
type Bar = (&'static str, fn(&TableRow) -> Option<f64>, fn(&TableRow) -> Option<Interval>);

/// Outcomes of Table 1, 4 or 6.
pub(super) fn outcomes(report: &Report<'_>, table: u8) -> Figure {
    let all: [Bar; 6] = [
        ("goal", |row| row.goal, |row| interval(Measure::Goal, row)),
        ("close", |row| row.close, |row| interval(Measure::Close, row)),
        ("to goal", |row| row.to_goal, |row| interval(Measure::ToGoal, row)),
        ("block", |row| row.block, |row| interval(Measure::Block, row)),
        ("out", |row| row.out, |row| interval(Measure::Out, row)),
        ("timeout", |row| row.timeout, |row| interval(Measure::Timeout, row)),
    ];
    let against = if table == 4 { "two defenders" } else { "a defender and a goalie" };
    let robots = if table == 6 { ", robots" } else { "" };
    let title = format!("How trials ended against {against}{robots}: share of trials with 95 % intervals");
    figure(report, table, "outcomes", title, &all, "% of trials", 0)
}

/// Table 2.
pub(super) fn backing_up(report: &Report<'_>) -> Figure {
    let all: [Bar; 2] =
        [("robot A", |row| row.backups_a, |_| None), ("robot B", |row| row.backups_b, |_| None)];
    let title = "How often each reactive robot backed up".to_owned();
    figure(report, 2, "backing-up", title, &all, "times a trial", 1)
}

/// Table 3.
pub(super) fn cases(report: &Report<'_>) -> Figure {
    let all: [Bar; 2] =
        [("for one", |row| row.individual, |_| None), ("for two", |row| row.cooperative, |_| None)];
    let title = "Cases used, by the number of robots they need".to_owned();
    figure(report, 3, "cases", title, &all, "cases a trial", 1)
}

fn figure(
    report: &Report<'_>,
    table: u8,
    name: &str,
    title: String,
    bars: &[Bar],
    unit: &str,
    decimals: usize,
) -> Figure {
    let scenarios = scenarios(report, table);
    let all: Vec<Entry<'_>> = scenarios.iter().flat_map(|s| entries(report, table, *s)).collect();
    // An outcome that never happens, to us or the paper, has no bar; one that is not measured has none
    // either.
    let measured = |(_, value, _): &&Bar| all.iter().any(|entry| value(entry.row).is_some_and(|v| v > 0.0));
    let bars: Vec<Bar> = bars.iter().filter(measured).copied().collect();
    let ends = all.iter().flat_map(|entry| {
        bars.iter().map(|(_, value, interval)| {
            interval(entry.row).map_or(value(entry.row).unwrap_or_default(), |interval| interval.high)
        })
    });
    let high = ends.fold(0.0, f64::max);
    let axis = Axis::up_to(high, LEFT, PANEL - RIGHT);
    let panels = scenarios.into_iter().map(|scenario| {
        let entries = entries(report, table, scenario);
        panel(description::scenario(scenario), &entries, &bars, axis, unit, decimals)
    });
    Figure {
        table,
        name: format!("table-{table}-{name}"),
        title,
        keys: keys(all.iter().copied(), Shape::Bar),
        panels: if bars.is_empty() { Vec::new() } else { panels.collect() },
    }
}

fn panel(
    title: String,
    entries: &[Entry<'_>],
    bars: &[Bar],
    axis: Axis,
    unit: &str,
    decimals: usize,
) -> Panel {
    let colors = Theme::Light.colors();
    let mut svg = Svg::default();
    let group = entries.len() as f64 * BAR;
    let bottom = -(group + BETWEEN) * bars.len() as f64;
    axis.draw(&mut svg, 0.0, bottom, unit);
    let font = Font { size: 13.0, fill: colors.ink, bold: false, halo: None };
    for (i, (label, value, interval)) in bars.iter().enumerate() {
        let top = -(group + BETWEEN) * i as f64 - BETWEEN * 0.5;
        svg.text([LEFT - 8.0, top - group * 0.5 - 4.5], label, Anchor::End, font);
        for (j, entry) in entries.iter().enumerate() {
            let Some(share) = value(entry.row) else { continue };
            let (upper, lower) = (top - BAR * j as f64 - 1.0, top - BAR * (j + 1) as f64 + 1.5);
            let (foot, end, middle) = (axis.place(0.0), axis.place(share), f64::midpoint(upper, lower));
            svg.rect([foot, lower], [end, upper], style(entry.row.approach, entry.ours));
            let reach = interval(entry.row);
            if let Some(Interval { low, high }) = reach {
                whisker(&mut svg, axis.place(low), axis.place(high), middle);
            }
            let right = reach.map_or(end, |interval| axis.place(interval.high)) + 5.0;
            let text = numbers::plain(share, decimals);
            let fill = if entry.ours { colors.ink } else { colors.faint };
            let font = Font { size: 10.5, fill, bold: entry.ours, halo: Some(colors.paper) };
            svg.text([right, middle - 3.8], &text, Anchor::Start, font);
        }
    }
    Panel { title, svg, height: -bottom + BELOW }
}

/// Error bar from `low` to `high`.
pub(super) fn whisker(svg: &mut Svg, low: f64, high: f64, y: f64) {
    let style = format!(r#"stroke="{}" stroke-width="1.1""#, Theme::Light.colors().ink);
    svg.line([low, y], [high, y], &style);
    for end in [low, high] {
        svg.line([end, y - 2.5], [end, y + 2.5], &style);
    }
}

/// Where bars start, px.
const LEFT: f64 = 66.0;
/// Space for the numbers behind the longest bar, px.
const RIGHT: f64 = 30.0;
/// Height of a bar with the gap to the next, px.
const BAR: f64 = 12.5;
/// Gap between groups of bars, px.
const BETWEEN: f64 = 13.0;
