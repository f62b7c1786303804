//! Which approach is better, and is that sure? Differences in points with Newcombe's intervals, ours beside the paper's.

use arena::evaluation::{Measure, TableRow};
use brain::Approach;
use drawing::{Anchor, Font, Svg, Theme};
use hil_sim::Scenario;

use super::axis::{Axis, BELOW, GRID};
use super::{Figure, Key, PANEL, Panel, Shape, entries, scenarios, style};
use crate::columns::difference;
use crate::table::pairs;
use crate::{Report, numbers, words};

/// A difference to be drawn.
struct Effect {
    first: Approach,
    second: Approach,
    ours: bool,
    value: f64,
    low: f64,
    high: f64,
}

/// To goal and out of Tables 1, 4 and 6.
pub(super) fn figure(report: &Report<'_>) -> Figure {
    let mut keys: Vec<Key> = Vec::new();
    let mut groups = Vec::new();
    for table in [1, 4, 6] {
        for measure in [Measure::ToGoal, Measure::Out] {
            let rows: Vec<_> = scenarios(report, table)
                .into_iter()
                .map(|scenario| (scenario, effects(report, table, scenario, measure)))
                .filter(|(_, effects)| !effects.is_empty())
                .collect();
            for effect in rows.iter().flat_map(|(_, effects)| effects) {
                let key = effect.key();
                if !keys.contains(&key) {
                    keys.push(key);
                }
            }
            if !rows.is_empty() {
                groups.push((table, measure, rows));
            }
        }
    }
    let all = || groups.iter().flat_map(|(_, _, rows)| rows.iter().flat_map(|(_, effects)| effects));
    let low = all().map(|effect| effect.low).fold(0.0, f64::min);
    let high = all().map(|effect| effect.high).fold(0.0, f64::max);
    // Room for the numbers beside the whiskers.
    let room = (high - low) * 0.14;
    let axis = Axis::between(low - room, high + room, LEFT, PANEL - RIGHT);
    let panels = groups.iter().map(|(table, measure, rows)| panel(*table, *measure, rows, axis)).collect();
    let title = "What one approach has more or less than another, with 95 % intervals".to_owned();
    Figure { table: 0, name: "differences".to_owned(), title, keys, panels }
}

/// The paper's pair, and what goes beyond it against the paper's own approach.
fn effects(report: &Report<'_>, table: u8, scenario: Scenario, measure: Measure) -> Vec<Effect> {
    let entries = entries(report, table, scenario);
    let mut effects: Vec<Effect> = Vec::new();
    for (first, second) in pairs(report.between, table, scenario) {
        // One difference an approach: its colour tells it.
        if effects.iter().any(|effect| effect.first == first) {
            continue;
        }
        for ours in [true, false] {
            let row = |approach| -> Option<&TableRow> {
                let entry = entries.iter().find(|e| e.ours == ours && e.row.approach == approach)?;
                Some(entry.row)
            };
            let Some((a, b)) = row(first).zip(row(second)) else { continue };
            let (Some(x), Some(y)) = (measure.value(a), measure.value(b)) else { continue };
            let Some(reach) = difference(measure, a, b) else { continue };
            effects.push(Effect { first, second, ours, value: x - y, low: reach.low, high: reach.high });
        }
    }
    effects
}

impl Effect {
    fn key(&self) -> Key {
        let pair = format!("{} − {}", words::approach(self.first), words::approach(self.second));
        let word = if self.ours { pair } else { format!("{pair}, the paper’s") };
        Key { word, color: words::color(self.first), filled: self.ours, shape: Shape::Dot }
    }
}

fn panel(table: u8, measure: Measure, rows: &[(Scenario, Vec<Effect>)], axis: Axis) -> Panel {
    let colors = Theme::Light.colors();
    let mut svg = Svg::default();
    let height: f64 = rows.iter().map(|(_, effects)| effects.len() as f64 * DOT + BETWEEN).sum();
    axis.draw(&mut svg, 0.0, -height, "percentage points");
    let font = Font { size: 13.0, fill: colors.ink, bold: false, halo: None };
    let mut top = 0.0;
    for (scenario, effects) in rows {
        let group = effects.len() as f64 * DOT + BETWEEN;
        let name = words::scenario(*scenario);
        svg.text([LEFT - 10.0, top - group * 0.5 - 4.5], &name, Anchor::End, font);
        if top < 0.0 {
            svg.line([0.0, top], [PANEL - RIGHT, top], format!(r#"stroke="{GRID}" stroke-width="1""#));
        }
        for (j, effect) in effects.iter().enumerate() {
            let y = top - BETWEEN * 0.5 - DOT * (j as f64 + 0.5);
            let color = words::color(effect.first);
            let (low, high) = (axis.place(effect.low), axis.place(effect.high));
            svg.line([low, y], [high, y], format!(r#"stroke="{color}" stroke-width="1.8""#));
            svg.circle([axis.place(effect.value), y], 4.2, style(effect.first, effect.ours));
            let fill = if effect.ours { colors.ink } else { colors.faint };
            let font = Font { size: 10.5, fill, bold: effect.ours, halo: Some(colors.paper) };
            // Away from zero, whose line would cross it.
            let (x, anchor) =
                if effect.value < 0.0 { (low - 6.0, Anchor::End) } else { (high + 6.0, Anchor::Start) };
            svg.text([x, y - 3.8], &numbers::signed(effect.value, 1), anchor, font);
        }
        top -= group;
    }
    let what = if measure == Measure::Out { "Out" } else { "To goal" };
    let against = match table {
        1 => "a defender and a goalie",
        4 => "two defenders",
        _ => "a defender and a goalie, robots",
    };
    Panel { title: format!("{what}, against {against}"), svg, height: height + BELOW }
}

/// Where the axis begins, px: after the scenarios' names.
const LEFT: f64 = 150.0;
/// Room for the axis' last number, px.
const RIGHT: f64 = 14.0;
/// Height of a difference with the gap to the next, px.
const DOT: f64 = 13.0;
/// Between scenarios, px.
const BETWEEN: f64 = 12.0;
