//! How are outcomes told? Markdown tables, for terminals and documents alike: ours, the paper's, fouls.

use std::fmt::Write as _;

use super::outcome::{Estimate, Outcome};
use super::paper::{PAPER, PAPER_PASSES};

/// The outcomes, then the paper's tables.
pub fn markdown(outcomes: &[Outcome]) -> String {
    let mut text = String::from(
        "| team | against | matches | won, drawn, lost | goals | goals a match | against a match | p | offence ratio | attack ratio | of all shots |\n\
         |---|---|---|---|---|---|---|---|---|---|---|\n",
    );
    // Writing to a String cannot fail.
    for o in outcomes {
        let [won, drawn, lost] = o.won_drawn_lost;
        let [goals, against] = o.goals;
        let _ = writeln!(
            text,
            "| {} | {} | {} | {won}, {drawn}, {lost} | {goals} : {against} | {} | {} | {} | {} | {} | {} |",
            o.own.word(),
            o.opponent.word(),
            o.matches,
            told(o.goals_for),
            told(o.goals_against),
            o.goals_p.map_or_else(|| "–".to_owned(), |p| format!("{p:.3}")),
            told(o.offence_ratio),
            told(o.attack_ratio),
            o.attack_ratio_of_all.map_or_else(|| "–".to_owned(), |ratio| format!("{ratio:.2}")),
        );
    }
    text += "\n| team | against | shots | theirs | chances | theirs | possession | passes that arrived | theirs | balls lost | theirs | ball in play |\n\
             |---|---|---|---|---|---|---|---|---|---|---|---|\n";
    for o in outcomes {
        let _ = writeln!(
            text,
            "| {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |",
            o.own.word(),
            o.opponent.word(),
            told(o.shots[0]),
            told(o.shots[1]),
            told(o.chances[0]),
            told(o.chances[1]),
            told(o.possession),
            told(o.passes[0]),
            told(o.passes[1]),
            told(o.losses[0]),
            told(o.losses[1]),
            told(o.ball_in_play),
        );
    }
    text += "\n| team | against | own fouls, all matches | theirs |\n|---|---|---|---|\n";
    for o in outcomes {
        let [own, theirs] = [0, 1].map(|side: usize| {
            let kinds = o.fouls[side].iter().map(|(kind, n)| format!("{n} {}", kind.replace('_', " ")));
            kinds.collect::<Vec<_>>().join(", ")
        });
        let _ = writeln!(text, "| {} | {} | {own} | {theirs} |", o.own.word(), o.opponent.word());
    }
    text +=
        "\n| the paper's Table 2 | stage | goals | offence ratio | attack ratio |\n|---|---|---|---|---|\n";
    for game in PAPER {
        let [goals, against] = game.goals;
        let _ = writeln!(
            text,
            "| Team {} | {} | {goals} : {against} | {:.2} | {:.2} |",
            game.opponent, game.stage, game.offence_ratio, game.attack_ratio
        );
    }
    text +=
        "\n| the paper's Table 1 | passes tried | arrived | coercing robots re-used |\n|---|---|---|---|\n";
    for row in PAPER_PASSES {
        let _ = writeln!(
            text,
            "| Team {} | {} | {} | {} |",
            row.opponent, row.attempts, row.successes, row.reuses
        );
    }
    text
}

/// `1.32 (1.10 to 1.54)`.
fn told(estimate: Option<Estimate>) -> String {
    match estimate {
        None => "–".to_owned(),
        Some(Estimate { mean, low: Some(low), high: Some(high), .. }) => {
            format!("{mean:.2} ({low:.2} to {high:.2})")
        }
        Some(Estimate { mean, .. }) => format!("{mean:.2}"),
    }
}
