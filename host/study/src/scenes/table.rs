//! `table`: effects of parts as a Markdown table.

use std::fmt::Write as _;

use figures::{Row, Table, row};

use super::{SceneEffect, SceneMeasure};
use crate::statistics::wilson;

/// One row an effect; below it, for the planner, how often its passes were followed by a shot.
pub fn scene_table(effects: &[SceneEffect]) -> String {
    let table = Table::of_texts(
        "scene | against | part | measure | pairs | with | without | difference | 95 % | p | smallest effect seen",
    );
    let mut text = table.with_rows(effects.iter().map(effect_row)).markdown();
    text.push_str("\nIn hundredths of a scene: 1.0 is one more in a hundred scenes.\n");
    for effect in effects {
        if effect.measure != SceneMeasure::Shot || effect.planned[0] == 0 || effect.part != "coerce" {
            continue;
        }
        let count = effect.planned_with_shot();
        let interval = wilson(count, 0.95).map_or(String::new(), |interval| {
            format!(" ({:.0} to {:.0} %)", 100.0 * interval.low, 100.0 * interval.high)
        });
        // Writing to a String cannot fail.
        let _ = writeln!(
            text,
            "\nPlanned passes against {}: {}; with a shot {} = {:.0} %{interval}.",
            opponent(effect),
            count.of,
            count.hits,
            100.0 * count.share().unwrap_or(0.0)
        );
    }
    text
}

fn effect_row(effect: &SceneEffect) -> Row {
    row![
        effect.kind.label(),
        opponent(effect),
        effect.part,
        effect.measure.label(),
        effect.pairs,
        percent(effect.with),
        percent(effect.without),
        format!("{:+.1}", 100.0 * (effect.with - effect.without)),
        effect.interval.map_or(String::new(), |[low, high]| format!(
            "{:+.1} to {:+.1}",
            100.0 * low,
            100.0 * high
        )),
        effect.p.map_or(String::new(), |p| format!("{p:.2e}")),
        effect.detectable.map_or(String::new(), percent),
    ]
}

fn opponent(effect: &SceneEffect) -> String {
    effect.opponent.map_or("all".to_owned(), |opponent| opponent.to_string())
}

fn percent(share: f64) -> String {
    format!("{:.1}", 100.0 * share)
}
