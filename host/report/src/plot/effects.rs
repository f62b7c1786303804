//! `effects`: plot of the differences between approaches. Differences in points with Newcombe's intervals,
//! ours beside the paper's.

use brain::Approach;
use figures::numbers::signed;
use figures::{Dot, DotRow, Figure, Key, Shape, dot_axis, dot_panel};
use hil_sim::Scenario;
use study::evaluation::{Measure, TableRow};

use super::{entries, scenarios};
use crate::columns::difference;
use crate::table::pairs;
use crate::{Report, labels};

/// To goal and out of Tables 1, 4 and 6, all on one scale.
pub(super) fn figure(report: &Report<'_>) -> Figure {
    let mut keys: Vec<Key> = Vec::new();
    let mut groups: Vec<(String, Vec<DotRow>)> = Vec::new();
    for (table, against) in
        [(1, "a defender and a goalie"), (4, "two defenders"), (6, "a defender and a goalie, robots")]
    {
        for (measure, what) in [(Measure::ToGoal, "To goal"), (Measure::Out, "Out")] {
            let mut rows = Vec::new();
            for scenario in scenarios(report, table) {
                let effects = effects(report, table, scenario, measure);
                for (key, _) in &effects {
                    if !keys.contains(key) {
                        keys.push(key.clone());
                    }
                }
                if !effects.is_empty() {
                    let dots = effects.into_iter().map(|(_, dot)| dot).collect();
                    rows.push(DotRow { name: labels::scenario(scenario), dots });
                }
            }
            if !rows.is_empty() {
                groups.push((format!("{what}, against {against}"), rows));
            }
        }
    }
    let dots = || groups.iter().flat_map(|(_, rows)| rows).flat_map(|row| &row.dots);
    let intervals = || dots().filter_map(|dot| dot.interval);
    let low = intervals().map(|(low, _)| low).fold(0.0, f64::min);
    let high = intervals().map(|(_, high)| high).fold(0.0, f64::max);
    // Space for the numbers left of the whiskers; the panel has some on the right.
    let axis = dot_axis(low - (high - low) * 0.14, high);
    let panels = groups.into_iter().map(|(title, rows)| dot_panel(title, "percentage points", &rows, &axis));
    let title = "What one approach has more or less than another, with 95 % intervals".to_owned();
    Figure { name: "differences".to_owned(), title, keys, panels: panels.collect() }
}

/// The paper's pair, and approaches beyond it compared with the paper's own.
fn effects(report: &Report<'_>, table: u8, scenario: Scenario, measure: Measure) -> Vec<(Key, Dot)> {
    let entries = entries(report, table, scenario);
    let mut effects: Vec<(Key, Dot)> = Vec::new();
    for (first, second) in pairs(report.between, table, scenario) {
        // One difference an approach: identified by its colour.
        if effects.iter().any(|(_, dot)| dot.color == labels::color(first)) {
            continue;
        }
        for ours in [true, false] {
            let row = |approach| -> Option<&TableRow> {
                let entry = entries.iter().find(|e| e.ours == ours && e.row.approach == approach)?;
                Some(entry.row)
            };
            let Some((a, b)) = row(first).zip(row(second)) else { continue };
            let (Some(x), Some(y)) = (measure.value(a), measure.value(b)) else { continue };
            let Some(interval) = difference(measure, a, b) else { continue };
            let dot = Dot {
                color: labels::color(first),
                is_filled: ours,
                value: x - y,
                interval: Some((interval.low, interval.high)),
                text: signed(x - y, 1),
            };
            effects.push((key(first, second, ours), dot));
        }
    }
    effects
}

fn key(first: Approach, second: Approach, ours: bool) -> Key {
    let pair = format!("{} − {}", labels::approach(first), labels::approach(second));
    let label = if ours { pair } else { format!("{pair}, the paper’s") };
    Key { label, color: labels::color(first), is_filled: ours, shape: Shape::Dot }
}
