//! `bars`: bar charts of frequencies with their intervals: outcomes, backing up, cases; a panel a scenario.

use figures::numbers::plain;
use figures::{
    AXIS_HEIGHT, Anchor, Axis, Figure, Font, PANEL_WIDTH, Panel, Shape, Svg, Theme, mark_style, whisker,
};
use hil_sim::Scenario;
use study::evaluation::{Measure, TableRow};
use study::statistics::Interval;

use super::{Entry, entries, keys, scenarios};
use crate::columns::interval;
use crate::{Report, labels};

/// A measure of the bars: its label, its value, its interval.
type Bar = (&'static str, fn(&TableRow) -> Option<f64>, fn(&TableRow) -> Option<Interval>);

/// A chart of the same bars for each scenario of a table.
pub(super) struct BarChart {
    table: u8,
    name: &'static str,
    title: String,
    bars: Vec<Bar>,
    unit: &'static str,
    decimals: usize,
}

impl BarChart {
    pub(super) fn outcomes(table: u8) -> Self {
        let against = if table == 4 { "two defenders" } else { "a defender and a goalie" };
        let robots = if table == 6 { ", robots" } else { "" };
        Self {
            table,
            name: "outcomes",
            title: format!("How trials ended against {against}{robots}: share of trials with 95 % intervals"),
            bars: OUTCOME_BARS.to_vec(),
            unit: "% of trials",
            decimals: 0,
        }
    }

    /// Table 2.
    pub(super) fn backing_up() -> Self {
        Self {
            table: 2,
            name: "backing-up",
            title: "How often each reactive robot backed up".to_owned(),
            bars: BACKING_UP_BARS.to_vec(),
            unit: "times a trial",
            decimals: 1,
        }
    }

    /// Table 3.
    pub(super) fn cases() -> Self {
        Self {
            table: 3,
            name: "cases",
            title: "Cases used, by the number of robots they need".to_owned(),
            bars: CASE_BARS.to_vec(),
            unit: "cases a trial",
            decimals: 1,
        }
    }

    pub(super) fn figure(mut self, report: &Report<'_>) -> Figure {
        let scenarios = scenarios(report, self.table);
        let all: Vec<Entry<'_>> = scenarios.iter().flat_map(|s| entries(report, self.table, *s)).collect();
        // An outcome that never happens, to us or the paper, has no bar; one that is not measured has none
        // either.
        self.bars.retain(|(_, value, _)| all.iter().any(|entry| value(entry.row).is_some_and(|v| v > 0.0)));
        let ends = all.iter().flat_map(|entry| self.bars.iter().map(move |bar| end(bar, entry.row)));
        let axis = Axis::linear([0.0, ends.fold(0.0, f64::max)], [BARS_LEFT, PANEL_WIDTH - NUMBERS_WIDTH]);
        let panels = scenarios.into_iter().map(|scenario| self.panel(report, scenario, &axis));
        Figure {
            name: format!("table-{}-{}", self.table, self.name),
            title: self.title.clone(),
            keys: keys(all.iter().copied(), Shape::Bar),
            panels: if self.bars.is_empty() { Vec::new() } else { panels.collect() },
        }
    }

    fn panel(&self, report: &Report<'_>, scenario: Scenario, axis: &Axis) -> Panel {
        let colors = Theme::Light.colors();
        let entries = entries(report, self.table, scenario);
        let mut svg = Svg::default();
        let group = entries.len() as f64 * BAR_HEIGHT;
        let bottom = -(group + GROUP_GAP) * self.bars.len() as f64;
        axis.draw_below(&mut svg, 0.0, bottom, self.unit);
        let font = Font { size: 13.0, fill: colors.ink, bold: false, halo: None };
        for (i, (label, value, interval)) in self.bars.iter().enumerate() {
            let top = -(group + GROUP_GAP) * i as f64 - GROUP_GAP * 0.5;
            svg.text([BARS_LEFT - 8.0, top - group * 0.5 - 4.5], label, Anchor::End, font);
            for (j, entry) in entries.iter().enumerate() {
                let Some(share) = value(entry.row) else { continue };
                let (upper, lower) =
                    (top - BAR_HEIGHT * j as f64 - 1.0, top - BAR_HEIGHT * (j + 1) as f64 + 1.5);
                let (foot, end, middle) = (axis.place(0.0), axis.place(share), f64::midpoint(upper, lower));
                let style = mark_style(labels::color(entry.row.approach), entry.ours);
                svg.rect([foot, lower], [end, upper], style);
                let whiskers =
                    interval(entry.row).map(|Interval { low, high }| [axis.place(low), axis.place(high)]);
                if let Some(ends) = whiskers {
                    whisker(&mut svg, ends, middle);
                }
                let right = whiskers.map_or(end, |[_, high]| high) + 5.0;
                let fill = if entry.ours { colors.ink } else { colors.faint };
                let font = Font { size: 10.5, fill, bold: entry.ours, halo: Some(colors.paper) };
                svg.text([right, middle - 3.8], &plain(share, self.decimals), Anchor::Start, font);
            }
        }
        Panel { title: labels::scenario(scenario), svg, height: -bottom + AXIS_HEIGHT }
    }
}

/// Upper end of a bar with its interval.
fn end((_, value, interval): &Bar, row: &TableRow) -> f64 {
    interval(row).map_or(value(row).unwrap_or_default(), |interval| interval.high)
}

/// Left end of the bars, px.
const BARS_LEFT: f64 = 66.0;
/// Space for the numbers behind the longest bar, px.
const NUMBERS_WIDTH: f64 = 30.0;
/// Height of a bar with the gap to the next, px.
const BAR_HEIGHT: f64 = 12.5;
/// Gap between groups of bars, px.
const GROUP_GAP: f64 = 13.0;
const OUTCOME_BARS: [Bar; 6] = [
    ("goal", |row| row.goal, |row| interval(Measure::Goal, row)),
    ("close", |row| row.close, |row| interval(Measure::Close, row)),
    ("to goal", |row| row.to_goal, |row| interval(Measure::ToGoal, row)),
    ("block", |row| row.block, |row| interval(Measure::Block, row)),
    ("out", |row| row.out, |row| interval(Measure::Out, row)),
    ("timeout", |row| row.timeout, |row| interval(Measure::Timeout, row)),
];
const BACKING_UP_BARS: [Bar; 2] =
    [("robot A", |row| row.backups_a, |_| None), ("robot B", |row| row.backups_b, |_| None)];
const CASE_BARS: [Bar; 2] =
    [("for one", |row| row.individual, |_| None), ("for two", |row| row.cooperative, |_| None)];
