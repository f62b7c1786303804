//! `description`: match results as Markdown tables. Markdown tables, for terminals and documents alike: ours
//! beside the paper's Tables 1 and 2 (Biswas et al. 2014 §6), passes, fouls, and what each part is worth.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use super::case_table::case_tables;
use super::comparison::MatchComparison;
use super::effect::{Change, Effect};
use super::match_team::MatchTeam;
use super::outcome::{Estimate, Outcome};
use super::paper::{PAPER, PAPER_PASSES};
use super::passes::{Passes, Share};
use super::plan::Pairing;
use arena::attack::PossessionEnd as E;

/// All tables; `ours` are the passes of our team.
pub fn markdown(outcomes: &[Outcome], effects: &[Effect], ours: &Passes) -> String {
    let mut text = String::new();
    worth(&mut text, effects);
    standings(&mut text, outcomes);
    scores(&mut text, outcomes);
    play(&mut text, outcomes);
    attack(&mut text, outcomes);
    text += &case_tables(outcomes);
    passes(&mut text, outcomes);
    planned(&mut text, outcomes);
    calibration(&mut text, ours);
    fouls(&mut text, outcomes);
    text.trim_start().to_owned()
}

/// Writing to a String cannot fail.
macro_rules! print {
    ($text:expr, $($description:tt)*) => {{ let _ = writeln!($text, $($description)*); }};
}

/// Whether these are our matches against others, as the paper's tables are.
fn as_the_papers(outcomes: &[Outcome]) -> bool {
    let ours = MatchTeam::ours().team;
    outcomes.iter().all(|o| o.own.team == ours && o.opponent.team != ours)
}

fn worth(text: &mut String, effects: &[Effect]) {
    if effects.is_empty() {
        return;
    }
    *text += "\n| part | with it | without | matches | goals a match, difference | p | shots a match, difference | p | offence ratio | p | attack ratio | p |\n\
              |---|---|---|---|---|---|---|---|---|---|---|---|\n";
    for e in effects {
        let cells = [e.goals, e.shots, e.offence_ratio, e.attack_ratio].map(changed).join(" | ");
        print!(text, "| {} | {} | {} | {} | {cells} |", e.part, e.with, e.without, e.matches);
    }
}

/// The table of the same matches by two programs, case bases or settings.
pub fn comparison_table(found: &[MatchComparison]) -> String {
    let mut text = String::from(
        "| team | against | matches | goals before | goals now | goals a match, difference | p | smallest effect seen | shots a match, difference | p |\n\
         |---|---|---|---|---|---|---|---|---|---|\n",
    );
    for b in found {
        let teams = b.pairing.map_or_else(
            || "all | all".to_owned(),
            |Pairing { own, opponent }| format!("{own} | {opponent}"),
        );
        let ([for_before, against_before], [for_now, against_now]) = (b.goals_before, b.goals_after);
        let smallest = b.detectable_goals.map_or_else(|| "–".to_owned(), |goals| format!("{goals:.2}"));
        let [goals, shots] = [b.goals, b.shots].map(|change| changed(Some(change)));
        print!(
            text,
            "| {teams} | {} | {for_before} : {against_before} | {for_now} : {against_now} | {goals} | {smallest} | {shots} |",
            b.goals.matches
        );
    }
    text
}

/// Standings over all matches of each team, where one plays several opponents.
fn standings(text: &mut String, outcomes: &[Outcome]) {
    let mut teams: Vec<(MatchTeam, [u32; 3], [u32; 2])> = Vec::new();
    for o in outcomes {
        let [won, drawn, lost] = o.won_drawn_lost;
        let [goals, against] = o.goals;
        for (who, ends, goals) in [
            (o.own, [won, drawn, lost], [goals, against]),
            (o.opponent, [lost, drawn, won], [against, goals]),
        ] {
            let known = teams.iter().position(|(team, ..)| *team == who).unwrap_or(teams.len());
            if known == teams.len() {
                teams.push((who, [0; 3], [0; 2]));
            }
            for (sum, n) in teams[known].1.iter_mut().zip(ends) {
                *sum += n;
            }
            for (sum, n) in teams[known].2.iter_mut().zip(goals) {
                *sum += n;
            }
        }
    }
    // Each against each: the number of pairs is that of a round robin.
    if teams.len() < 3 || outcomes.len() != teams.len() * (teams.len() - 1) / 2 {
        return;
    }
    let points = |[won, drawn, _]: [u32; 3]| 3 * won + drawn;
    // The sort keeps the plan's order among equals.
    teams.sort_by_key(|(_, ends, [goals, against])| {
        std::cmp::Reverse((points(*ends), i64::from(*goals) - i64::from(*against)))
    });
    *text += "\n| team | matches | won, drawn, lost | goals | points |\n|---|---|---|---|---|\n";
    for (team, [won, drawn, lost], [goals, against]) in teams {
        let (matches, points) = (won + drawn + lost, points([won, drawn, lost]));
        print!(text, "| {team} | {matches} | {won}, {drawn}, {lost} | {goals} : {against} | {points} |");
    }
}

fn scores(text: &mut String, outcomes: &[Outcome]) {
    *text += "\n| team | against | matches | won, drawn, lost | goals | goals a match | against a match | p | offence ratio | attack ratio | of all shots |\n\
              |---|---|---|---|---|---|---|---|---|---|---|\n";
    for o in outcomes {
        let [won, drawn, lost] = o.won_drawn_lost;
        let [goals, against] = o.goals;
        let cells = [o.goals_for, o.goals_against].map(estimate_text).join(" | ");
        let ratios = [o.offence_ratio, o.attack_ratio].map(estimate_text).join(" | ");
        let all = o.attack_ratio_of_all.map_or_else(|| "–".to_owned(), |ratio| format!("{ratio:.2}"));
        print!(
            text,
            "| {} | {} | {} | {won}, {drawn}, {lost} | {goals} : {against} | {cells} | {} | {ratios} | {all} |",
            o.own,
            o.opponent,
            o.matches,
            chance(o.goals_p),
        );
    }
    if as_the_papers(outcomes) {
        for game in PAPER {
            let [goals, against] = game.goals;
            print!(
                text,
                "| the paper's, Table 2 | Team {} ({}) | 1 | | {goals} : {against} | | | | {:.2} | {:.2} | {:.2} |",
                game.opponent,
                game.stage,
                game.offence_ratio,
                game.attack_ratio,
                game.attack_ratio
            );
        }
    }
}

fn play(text: &mut String, outcomes: &[Outcome]) {
    *text += "\n| team | against | shots | theirs | chances | theirs | possession | passes that arrived | theirs | balls lost | theirs | ball in play |\n\
              |---|---|---|---|---|---|---|---|---|---|---|---|\n";
    for o in outcomes {
        let [shots, chances] = [o.shots, o.chances].map(|both| both.map(estimate_text).join(" | "));
        let [passes, losses] = [o.passes, o.losses].map(|both| both.map(estimate_text).join(" | "));
        let [possession, in_play] = [o.possession, o.ball_in_play].map(estimate_text);
        print!(
            text,
            "| {} | {} | {shots} | {chances} | {possession} | {passes} | {losses} | {in_play} |",
            o.own,
            o.opponent
        );
    }
}

/// How possessions end, where kicks go and what shots are worth, from the true world.
fn attack(text: &mut String, outcomes: &[Outcome]) {
    let rows: Vec<_> = outcomes
        .iter()
        .flat_map(|o| {
            [(o.own, o.opponent, &o.attack[0]), (o.opponent, o.own, &o.attack[1])]
                .map(|side| (side, o.matches))
        })
        .map(|((team, against, counts), matches)| AttackRow { team, against, counts, matches })
        .collect();
    *text += &attack_table(&rows);
}

/// One team's sums of [`AttackCounts::named`](arena::attack::AttackCounts::named) against another.
#[derive(Clone, Copy, Debug)]
pub struct AttackRow<'a> {
    /// The team whose counts these are.
    pub team: MatchTeam,
    /// The team that it played against.
    pub against: MatchTeam,
    /// The sums over all matches, by name.
    pub counts: &'a BTreeMap<String, u32>,
    /// Number of matches.
    pub matches: u32,
}

/// The Markdown table of how possessions end, where kicks go and what shots are worth.
pub fn attack_table(rows: &[AttackRow<'_>]) -> String {
    let mut text = "\n| team | against | possessions a match | goal | shot | kick to an opponent | tackle | left | out | stopped | kicks a match | reach the team | shots over 3 m/s a match | goal closed | half open | volleys | score | left balls a match |\n\
              |---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n".to_owned();
    for row in rows {
        print!(
            text,
            "| {} | {} | {} |",
            row.team,
            row.against,
            attack_cells(row.counts, row.matches).join(" | ")
        );
    }
    text
}

fn attack_cells(counts: &BTreeMap<String, u32>, matches: u32) -> Vec<String> {
    let sum = |which: &dyn Fn(&str) -> bool| {
        counts.iter().filter(|(name, _)| which(name)).map(|(_, n)| *n).sum::<u32>()
    };
    let of = |name: &str| counts.get(name).copied().unwrap_or(0);
    let a_match = |n: u32| format!("{:.1}", f64::from(n) / f64::from(matches.max(1)));
    let share = |part: u32, whole: u32| match whole {
        0 => "–".to_owned(),
        whole => format!("{:.0} %", 100.0 * f64::from(part) / f64::from(whole)),
    };
    let possessions = sum(&|name| name.starts_with("end."));
    let ends = [E::Goal, E::Shot, E::KickToOpponent, E::Tackle, E::Left, E::Out, E::Referee];
    let ends = ends.map(|end| share(of(&format!("end.{}", end.label())), possessions));
    let kicks = sum(&|name| name.starts_with("kick."));
    let reached = sum(&|name| name.starts_with("kick.") && name.ends_with("/team"));
    let shots = of("shot.closed") + of("shot.partly-open") + of("shot.open");
    let of_shots =
        ["shot.closed", "shot.open", "shot.volley", "shot.goal"].map(|name| share(of(name), shots));
    let mut cells = vec![a_match(possessions)];
    cells.extend(ends);
    cells.extend([a_match(kicks), share(reached, kicks), a_match(shots)]);
    cells.extend(of_shots);
    cells.push(a_match(of("left-ball")));
    cells
}

/// Each side of each pair, with its passes.
fn sides(outcomes: &[Outcome]) -> impl Iterator<Item = (MatchTeam, MatchTeam, &Passes)> {
    outcomes.iter().flat_map(|o| [(o.own, o.opponent, &o.restarts[0]), (o.opponent, o.own, &o.restarts[1])])
}

fn passes(text: &mut String, outcomes: &[Outcome]) {
    *text += "\n| passes of | against | kick | begun | kicked | arrived | share | by another mate | intercepted | missed | late | out |\n\
              |---|---|---|---|---|---|---|---|---|---|---|---|\n";
    for (who, against, passes) in sides(outcomes) {
        for kick in passes.kinds.iter().filter(|kick| kick.ordered > 0) {
            let (fates, arrived) = (&kick.fates, kick.arrived);
            print!(
                text,
                "| {who} | {against} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |",
                kick.kick,
                kick.ordered,
                arrived.of,
                arrived.hits,
                share(arrived),
                fates.by_teammate,
                fates.intercepted,
                fates.missed,
                fates.late,
                fates.out
            );
        }
    }
}

fn planned(text: &mut String, outcomes: &[Outcome]) {
    *text += "\n| planned free kicks of | against | matches | passes tried | arrived | share | coercing robots re-used | arrived |\n\
              |---|---|---|---|---|---|---|---|\n";
    let matches = |who: MatchTeam, against: MatchTeam| {
        let met = |o: &&Outcome| [(o.own, o.opponent), (o.opponent, o.own)].contains(&(who, against));
        outcomes.iter().find(met).map_or(0, |o| o.matches)
    };
    let ours = MatchTeam::ours().team;
    // Beside the paper's also where no plan was made; else only for teams that plan.
    let all = as_the_papers(outcomes);
    for (who, against, passes) in sides(outcomes) {
        if who.team != ours || !(all || who.tactics.coerce || passes.cap.attempts > 0) {
            continue;
        }
        let (cap, arrived) = (&passes.cap, share(passes.cap_arrived));
        print!(
            text,
            "| {who} | {against} | {} | {} | {} | {arrived} | {} | {} |",
            matches(who, against),
            cap.attempts,
            cap.successes,
            cap.reuses,
            cap.reuse_successes
        );
    }
    if all {
        for row in PAPER_PASSES {
            let arrived = share(Share::new(row.successes, row.attempts));
            print!(
                text,
                "| the paper's, Table 1 | Team {} | 1 | {} | {} | {arrived} | {} | |",
                row.opponent,
                row.attempts,
                row.successes,
                row.reuses
            );
        }
    }
}

fn calibration(text: &mut String, ours: &Passes) {
    *text += "\n| P(we have it) | passes | predicted | had | share |\n|---|---|---|---|---|\n";
    for tenth in &ours.calibration {
        let from = tenth.tenth as f64 / 10.0;
        print!(
            text,
            "| {from:.1} to {:.1} | {} | {:.2} | {} | {} |",
            from + 0.1,
            tenth.seen.of,
            tenth.predicted,
            tenth.seen.hits,
            share(tenth.seen)
        );
    }
    if let Some(error) = ours.calibration_error {
        print!(text, "| mean distance | | | | {error:.3} |");
    }
}

fn fouls(text: &mut String, outcomes: &[Outcome]) {
    *text += "\n| team | against | own fouls, all matches | theirs |\n|---|---|---|---|\n";
    for o in outcomes {
        let [own, theirs] = [0, 1].map(|side: usize| {
            let kinds = o.fouls[side].iter().map(|(kind, n)| format!("{n} {}", kind.replace('_', " ")));
            kinds.collect::<Vec<_>>().join(", ")
        });
        print!(text, "| {} | {} | {own} | {theirs} |", o.own, o.opponent);
    }
}

/// `1.32 (1.10 to 1.54)`.
fn estimate_text(estimate: Option<Estimate>) -> String {
    estimate.map_or_else(|| "–".to_owned(), |e| within(e.mean, e.low, e.high))
}

/// The same of a share.
fn share(share: Share) -> String {
    share.share.map_or_else(|| "–".to_owned(), |mean| within(mean, share.low, share.high))
}

/// The same with its p.
fn changed(change: Option<Change>) -> String {
    let description = change.map_or_else(|| "–".to_owned(), |c| within(c.mean, c.low, c.high));
    format!("{description} | {}", chance(change.and_then(|change| change.p)))
}

fn within(mean: f64, low: Option<f64>, high: Option<f64>) -> String {
    // Zero has no sign.
    let [mean, low, high] =
        [Some(mean), low, high].map(|end| end.map(|x| if x.abs() < 0.005 { 0.0 } else { x }));
    let mean = mean.unwrap_or_default();
    match (low, high) {
        (Some(low), Some(high)) => format!("{mean:.2} ({low:.2} to {high:.2})"),
        _ => format!("{mean:.2}"),
    }
}

fn chance(p: Option<f64>) -> String {
    match p {
        None => "–".to_owned(),
        Some(p) if p < 0.001 => "< 0.001".to_owned(),
        Some(p) => format!("{p:.3}"),
    }
}
