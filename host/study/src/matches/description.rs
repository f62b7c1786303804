//! `description`: match results as Markdown tables, for terminals and documents alike: ours beside the
//! paper's Tables 1 and 2 (Biswas et al. 2014 §6), passes, fouls, and what each part is worth.

use std::cmp::Reverse;
use std::collections::BTreeMap;
use std::fmt::Write as _;

use figures::{Cell, Row, Table, row};

use super::case_table::case_tables;
use super::comparison::MatchComparison;
use super::effect::{Change, Effect};
use super::match_team::MatchTeam;
use super::outcome::{Estimate, Outcome};
use super::paper::{PAPER, PAPER_PASSES};
use super::passes::{Passes, Share};
use arena::attack::PossessionEnd as E;

/// All tables; `ours` are the passes of our team.
pub fn markdown(outcomes: &[Outcome], effects: &[Effect], ours: &Passes) -> String {
    let first = [worth(effects), standings(outcomes), Some(scores(outcomes)), Some(play(outcomes))];
    let last = [passes(outcomes), planned(outcomes), calibration(ours), fouls(outcomes)];
    let mut text: String = first.into_iter().flatten().map(|table| below(&table)).collect();
    text += &attack(outcomes);
    text += &case_tables(outcomes);
    text.extend(last.iter().map(below));
    text.trim_start().to_owned()
}

/// A line for each pair of teams, and how far the number of matches carries.
pub fn summary(outcomes: &[Outcome]) -> String {
    let mut text = String::new();
    for o in outcomes {
        let ([won, drawn, lost], goals) = (o.won_drawn_lost, score(o.goals));
        // Writing to a String cannot fail.
        let _ = writeln!(
            text,
            "{} against {}: {won} won, {drawn} drawn, {lost} lost, goals {goals}",
            o.own, o.opponent
        );
    }
    let fewest = outcomes.iter().map(|o| o.matches).min().unwrap_or_default();
    if fewest < MATCHES_TO_JUDGE {
        let _ = writeln!(
            text,
            "{fewest} matches of a pair are few: intervals say how little is known; judge by {MATCHES_TO_JUDGE} or more (--matches)"
        );
    }
    text
}

/// Matches of a pair by which two programs are judged: with fewer, half a goal a match is chance.
const MATCHES_TO_JUDGE: u32 = 20;

fn below(table: &Table) -> String {
    format!("\n{}", table.markdown())
}

/// Whether these are our matches against others, as the paper's tables are.
fn as_the_papers(outcomes: &[Outcome]) -> bool {
    let ours = MatchTeam::ours().team;
    outcomes.iter().all(|o| o.own.team == ours && o.opponent.team != ours)
}

/// What each part of our play is worth; `None` without effects.
fn worth(effects: &[Effect]) -> Option<Table> {
    let mut table = Table::of_texts(
        "part | with it | without | matches | goals a match, difference | p | shots a match, difference | p | offence ratio | p | attack ratio | p",
    );
    for e in effects {
        let changes = [e.goals, e.shots, e.offence_ratio, e.attack_ratio].map(change_and_p);
        table.push(row![e.part, e.with, e.without, e.matches].with(changes.into_iter().flatten()));
    }
    (!effects.is_empty()).then_some(table)
}

/// The table of the same matches by two programs, case bases or settings.
pub fn comparison_table(found: &[MatchComparison]) -> Table {
    let mut table = Table::of_texts(
        "team | against | matches | goals before | goals now | goals a match, difference | p | smallest effect seen | shots a match, difference | p",
    );
    for b in found {
        let [own, opponent] = b.pairing.map_or_else(
            || ["all", "all"].map(str::to_owned),
            |pairing| [pairing.own, pairing.opponent].map(|team| team.to_string()),
        );
        let smallest = b.detectable_goals.map_or_else(|| "–".to_owned(), |goals| format!("{goals:.2}"));
        let row = row![own, opponent, b.goals.matches, score(b.goals_before), score(b.goals_after)];
        let row = row.with(change_and_p(Some(b.goals))).with([smallest]);
        table.push(row.with(change_and_p(Some(b.shots))));
    }
    table
}

/// `12 : 3`.
fn score<N: std::fmt::Display>([goals, against]: [N; 2]) -> String {
    format!("{goals} : {against}")
}

/// `3, 1, 0`.
fn listed([won, drawn, lost]: [u32; 3]) -> String {
    format!("{won}, {drawn}, {lost}")
}

/// Results of one team in all its matches.
struct Standing {
    team: MatchTeam,
    won_drawn_lost: [u32; 3],
    goals: [u32; 2],
}

impl Standing {
    fn points(&self) -> u32 {
        let [won, drawn, _] = self.won_drawn_lost;
        3 * won + drawn
    }

    /// Adds the results of one pair to those of `team`.
    fn add(standings: &mut Vec<Self>, team: MatchTeam, won_drawn_lost: [u32; 3], goals: [u32; 2]) {
        let known = standings.iter().position(|standing| standing.team == team);
        let place = known.unwrap_or_else(|| {
            standings.push(Self { team, won_drawn_lost: [0; 3], goals: [0; 2] });
            standings.len() - 1
        });
        let standing = &mut standings[place];
        for (sum, n) in standing.won_drawn_lost.iter_mut().zip(won_drawn_lost) {
            *sum += n;
        }
        for (sum, n) in standing.goals.iter_mut().zip(goals) {
            *sum += n;
        }
    }
}

/// Standings over all matches of each team; `None` unless each plays against each.
fn standings(outcomes: &[Outcome]) -> Option<Table> {
    let mut teams: Vec<Standing> = Vec::new();
    for o in outcomes {
        let ([won, drawn, lost], [goals, against]) = (o.won_drawn_lost, o.goals);
        Standing::add(&mut teams, o.own, [won, drawn, lost], [goals, against]);
        Standing::add(&mut teams, o.opponent, [lost, drawn, won], [against, goals]);
    }
    // The number of pairs is that of a round robin.
    if teams.len() < 3 || outcomes.len() != teams.len() * (teams.len() - 1) / 2 {
        return None;
    }
    // The sort keeps the plan's order among equals.
    teams.sort_by_key(|standing| {
        let [goals, against] = standing.goals.map(i64::from);
        Reverse((standing.points(), goals - against))
    });
    let rows = teams.iter().map(|standing| {
        let matches: u32 = standing.won_drawn_lost.iter().sum();
        let (ends, goals) = (listed(standing.won_drawn_lost), score(standing.goals));
        row![standing.team, matches, ends, goals, standing.points()]
    });
    Some(Table::of_texts("team | matches | won, drawn, lost | goals | points").with_rows(rows))
}

fn scores(outcomes: &[Outcome]) -> Table {
    let mut table = Table::of_texts(
        "team | against | matches | won, drawn, lost | goals | goals a match | against a match | p | offence ratio | attack ratio | of all shots",
    );
    for o in outcomes {
        table.push(row![
            o.own,
            o.opponent,
            o.matches,
            listed(o.won_drawn_lost),
            score(o.goals),
            estimate_text(o.goals_for),
            estimate_text(o.goals_against),
            p_text(o.goals_p),
            estimate_text(o.offence_ratio),
            estimate_text(o.attack_ratio),
            o.attack_ratio_of_all.map_or_else(|| "–".to_owned(), |ratio| format!("{ratio:.2}")),
        ]);
    }
    if as_the_papers(outcomes) {
        for game in PAPER {
            let opponent = format!("Team {} ({})", game.opponent, game.stage);
            let [offence, attack] =
                [game.offence_ratio, game.attack_ratio].map(|ratio| format!("{ratio:.2}"));
            let row = row!["the paper's, Table 2", opponent, 1, Cell::GAP, score(game.goals)];
            table.push(row.with([Cell::GAP; 3]).with([offence, attack.clone(), attack]));
        }
    }
    table
}

fn play(outcomes: &[Outcome]) -> Table {
    let mut table = Table::of_texts(
        "team | against | shots | theirs | chances | theirs | possession | passes that arrived | theirs | balls lost | theirs | ball in play",
    );
    for o in outcomes {
        let row = row![o.own, o.opponent].with(o.shots.map(estimate_text)).with(o.chances.map(estimate_text));
        let row = row.with([estimate_text(o.possession)]).with(o.passes.map(estimate_text));
        table.push(row.with(o.losses.map(estimate_text)).with([estimate_text(o.ball_in_play)]));
    }
    table
}

/// How possessions end, where kicks go and what shots are worth, from the true world.
fn attack(outcomes: &[Outcome]) -> String {
    let mut rows = Vec::new();
    for o in outcomes {
        for (team, against, counts) in [(o.own, o.opponent, &o.attack[0]), (o.opponent, o.own, &o.attack[1])]
        {
            rows.push(AttackRow { team, against, counts, matches: o.matches });
        }
    }
    attack_table(&rows)
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

/// The Markdown table of how possessions end, where kicks go and what shots are worth, below other text.
pub fn attack_table(rows: &[AttackRow<'_>]) -> String {
    let table = Table::of_texts(
        "team | against | possessions a match | goal | shot | kick to an opponent | tackle | left | out | stopped | kicks a match | reach the team | shots over 3 m/s a match | goal closed | half open | volleys | score | left balls a match",
    );
    below(&table.with_rows(rows.iter().map(|row| row![row.team, row.against].with(row.cells()))))
}

impl AttackRow<'_> {
    fn cells(&self) -> Vec<String> {
        let possessions = self.sum(|name| name.starts_with("end."));
        let ends = [E::Goal, E::Shot, E::KickToOpponent, E::Tackle, E::Left, E::Out, E::Referee];
        let kicks = self.sum(|name| name.starts_with("kick."));
        let reached = self.sum(|name| name.starts_with("kick.") && name.ends_with("/team"));
        let shots = self.count("shot.closed") + self.count("shot.partly-open") + self.count("shot.open");
        let of_shots = ["shot.closed", "shot.open", "shot.volley", "shot.goal"];
        let mut cells = vec![self.a_match(possessions)];
        cells.extend(ends.map(|end| percent(self.count(&format!("end.{}", end.label())), possessions)));
        cells.extend([self.a_match(kicks), percent(reached, kicks), self.a_match(shots)]);
        cells.extend(of_shots.map(|name| percent(self.count(name), shots)));
        cells.push(self.a_match(self.count("left-ball")));
        cells
    }

    fn count(&self, name: &str) -> u32 {
        self.counts.get(name).copied().unwrap_or(0)
    }

    fn sum(&self, is_counted: impl Fn(&str) -> bool) -> u32 {
        self.counts.iter().filter(|(name, _)| is_counted(name)).map(|(_, n)| *n).sum()
    }

    fn a_match(&self, count: u32) -> String {
        format!("{:.1}", f64::from(count) / f64::from(self.matches.max(1)))
    }
}

fn percent(part: u32, whole: u32) -> String {
    match whole {
        0 => "–".to_owned(),
        whole => format!("{:.0} %", 100.0 * f64::from(part) / f64::from(whole)),
    }
}

fn sides(outcomes: &[Outcome]) -> impl Iterator<Item = (MatchTeam, MatchTeam, &Passes)> {
    outcomes.iter().flat_map(|o| [(o.own, o.opponent, &o.restarts[0]), (o.opponent, o.own, &o.restarts[1])])
}

fn passes(outcomes: &[Outcome]) -> Table {
    let mut table = Table::of_texts(
        "passes of | against | kick | begun | kicked | arrived | share | by another mate | intercepted | missed | late | out",
    );
    for (team, against, passes) in sides(outcomes) {
        for kick in passes.kinds.iter().filter(|kick| kick.ordered > 0) {
            let (fates, arrived) = (&kick.fates, kick.arrived);
            let row = row![team, against, kick.kick, kick.ordered, arrived.of, arrived.hits, share(arrived)];
            let fates = [fates.by_teammate, fates.intercepted, fates.missed, fates.late, fates.out];
            table.push(row.with(fates));
        }
    }
    table
}

fn planned(outcomes: &[Outcome]) -> Table {
    let mut table = Table::of_texts(
        "planned free kicks of | against | matches | passes tried | arrived | share | coercing robots re-used | arrived",
    );
    let ours = MatchTeam::ours().team;
    // Beside the paper's also where no plan was made; else only for teams that plan.
    let all = as_the_papers(outcomes);
    for (team, against, passes) in sides(outcomes) {
        if team.team != ours || !(all || team.tactics.coerce || passes.cap.attempts > 0) {
            continue;
        }
        let (cap, arrived) = (&passes.cap, share(passes.cap_arrived));
        let row =
            row![team, against, matches_of(outcomes, team, against), cap.attempts, cap.successes, arrived];
        table.push(row.with([cap.reuses, cap.reuse_successes]));
    }
    if all {
        for row in PAPER_PASSES {
            let arrived = share(Share::new(row.successes, row.attempts));
            let opponent = format!("Team {}", row.opponent);
            let paper =
                row!["the paper's, Table 1", opponent, 1, row.attempts, row.successes, arrived, row.reuses];
            table.push(paper.with([Cell::GAP]));
        }
    }
    table
}

/// Number of matches of these teams, in either order.
fn matches_of(outcomes: &[Outcome], team: MatchTeam, against: MatchTeam) -> u32 {
    let pair =
        outcomes.iter().find(|o| [(o.own, o.opponent), (o.opponent, o.own)].contains(&(team, against)));
    pair.map_or(0, |o| o.matches)
}

fn calibration(ours: &Passes) -> Table {
    let mut table = Table::of_texts("P(we have it) | passes | predicted | had | share");
    for tenth in &ours.calibration {
        let from = tenth.tenth as f64 / 10.0;
        let range = format!("{from:.1} to {:.1}", from + 0.1);
        let predicted = format!("{:.2}", tenth.predicted);
        table.push(row![range, tenth.seen.of, predicted, tenth.seen.hits, share(tenth.seen)]);
    }
    if let Some(error) = ours.calibration_error {
        table.push(row!["mean distance"].with([Cell::GAP; 3]).with([format!("{error:.3}")]));
    }
    table
}

fn fouls(outcomes: &[Outcome]) -> Table {
    let rows = outcomes.iter().map(|o| -> Row {
        let [own, theirs] = [0, 1].map(|side: usize| {
            let kinds = o.fouls[side].iter().map(|(kind, n)| format!("{n} {}", kind.replace('_', " ")));
            kinds.collect::<Vec<_>>().join(", ")
        });
        row![o.own, o.opponent, own, theirs]
    });
    Table::of_texts("team | against | own fouls, all matches | theirs").with_rows(rows)
}

/// `1.32 (1.10 to 1.54)`.
fn estimate_text(estimate: Option<Estimate>) -> String {
    estimate.map_or_else(|| "–".to_owned(), |e| within(e.mean, e.low, e.high))
}

/// `0.32 (0.10 to 0.54)`.
fn share(share: Share) -> String {
    share.share.map_or_else(|| "–".to_owned(), |mean| within(mean, share.low, share.high))
}

fn change_and_p(change: Option<Change>) -> [String; 2] {
    let text = change.map_or_else(|| "–".to_owned(), |c| within(c.mean, c.low, c.high));
    [text, p_text(change.and_then(|change| change.p))]
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

fn p_text(p: Option<f64>) -> String {
    match p {
        None => "–".to_owned(),
        Some(p) if p < 0.001 => "< 0.001".to_owned(),
        Some(p) => format!("{p:.3}"),
    }
}
