//! `table`: effects of parts as a Markdown table.

use std::fmt::Write as _;

use super::SceneEffect;
use crate::statistics::wilson;

/// One row an effect; below it, for the planner, how often its passes were followed by a shot.
pub fn scene_table(effects: &[SceneEffect]) -> String {
    let mut text = String::from(
        "| scene | against | part | measure | pairs | with | without | difference | 95 % | p | smallest effect seen |\n\
         |---|---|---|---|---|---|---|---|---|---|---|\n",
    );
    let percent = |value: f64| format!("{:.1}", 100.0 * value);
    for effect in effects {
        let interval = effect
            .interval
            .map_or(String::new(), |[low, high]| format!("{:+.1} to {:+.1}", 100.0 * low, 100.0 * high));
        // Writing to a String cannot fail.
        let _ = writeln!(
            text,
            "| {} | {} | {} | {} | {} | {} | {} | {:+.1} | {interval} | {} | {} |",
            effect.kind.label(),
            effect.opponent.map_or("all".to_owned(), |opponent| opponent.to_string()),
            effect.part,
            effect.measure.label(),
            effect.pairs,
            percent(effect.with),
            percent(effect.without),
            100.0 * (effect.with - effect.without),
            effect.p.map_or(String::new(), |p| format!("{p:.2e}")),
            effect.detectable.map_or(String::new(), percent),
        );
    }
    text.push_str("\nIn hundredths of a scene: 1.0 is one more in a hundred scenes.\n");
    let planned = effects.iter().filter(|effect| effect.measure == super::SceneMeasure::Shot);
    for effect in planned.filter(|effect| effect.planned[0] > 0 && effect.part == "coerce") {
        let count = effect.planned_with_shot();
        let interval = wilson(count, 0.95).map_or(String::new(), |interval| {
            format!(" ({:.0} to {:.0} %)", 100.0 * interval.low, 100.0 * interval.high)
        });
        let against = effect.opponent.map_or("all".to_owned(), |opponent| opponent.to_string());
        let _ = writeln!(
            text,
            "\nPlanned passes against {against}: {}; with a shot {} = {:.0} %{interval}.",
            count.of,
            count.hits,
            100.0 * count.share().unwrap_or(0.0)
        );
    }
    text
}
