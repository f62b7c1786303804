//! `case_table`: what became of every case in matches, as Markdown tables, one a team.

use std::fmt::Write as _;

use super::match_team::MatchTeam;
use super::outcome::Outcome;
use arena::ledger::{CaseLine, CaseTable, FOLLOWED};

/// Tables of what became of every case, over all matches of the teams that play cases.
pub(super) fn case_tables(outcomes: &[Outcome]) -> String {
    let mut teams: Vec<(MatchTeam, CaseTable)> = Vec::new();
    for (team, table) in outcomes.iter().flat_map(|o| [(o.own, &o.cases[0]), (o.opponent, &o.cases[1])]) {
        match teams.iter_mut().find(|(known, _)| *known == team) {
            Some((_, sum)) => sum.merge(table),
            None => teams.push((team, table.clone())),
        }
    }
    let played = teams.iter().filter(|(_, table)| table.retrieved + table.no_case > 0);
    played.map(|(team, table)| case_table(*team, table)).collect()
}

/// The Markdown table of a team's cases: how often retrieved, how their plays ended, and what followed.
pub fn case_table(team: MatchTeam, table: &CaseTable) -> String {
    // Writing to a String cannot fail.
    let mut text = format!(
        "\n| case of {team} | retrieved | finished | other ends | passes | arrived | then a goal | shot | loss | out | stop | opponents |\n\
         |---|---|---|---|---|---|---|---|---|---|---|---|\n"
    );
    for CaseLine { case, all, by_opponents } in &table.cases {
        let mut others: Vec<_> = all.ends.iter().filter(|(end, _)| *end != "finished").collect();
        others.sort_by_key(|(_, n)| std::cmp::Reverse(**n));
        let others: Vec<_> = others.into_iter().map(|(end, n)| format!("{n} {end}")).collect();
        let then = FOLLOWED[..FOLLOWED.len() - 1].iter().map(|what| all.followed(*what).to_string());
        let opponents = by_opponents.iter().map(|(n, tally)| format!("{n}: {}", tally.retrieved));
        let _ = writeln!(
            text,
            "| {case} | {} | {} | {} | {} | {} | {} | {} |",
            all.retrieved,
            all.finished,
            others.join(", "),
            all.passes,
            all.passes_arrived,
            then.collect::<Vec<_>>().join(" | "),
            opponents.collect::<Vec<_>>().join(", ")
        );
    }
    let opponents = table.no_case_by_opponents.iter().map(|(n, count)| format!("{n}: {count}"));
    let because = table.no_case_because.iter().map(|(because, n)| format!("{n} {because}"));
    let _ = writeln!(
        text,
        "| no case | {} | | {} | | | | | | | | {} |",
        table.no_case,
        because.collect::<Vec<_>>().join(", "),
        opponents.collect::<Vec<_>>().join(", ")
    );
    situations(team, table, &mut text);
    text
}

/// The team's possessions by how they began: how many were played by a case, and what came of them.
fn situations(team: MatchTeam, table: &CaseTable, text: &mut String) {
    // Writing to a String cannot fail.
    let _ = write!(
        text,
        "\n| possessions of {team} | number | with a case | plays | finished | ball left the scope | reassigned | a goal | shot | loss | out | stop |\n\
         |---|---|---|---|---|---|---|---|---|---|---|---|\n"
    );
    for (situation, tally) in &table.by_situation {
        let ends = ["finished", "ball-out-of-scope", "reassigned"];
        let ends = ends.map(|end| tally.ends.get(end).copied().unwrap_or(0));
        let then = FOLLOWED[..FOLLOWED.len() - 1].iter().map(|what| tally.followed_by.get(what.label()));
        let counts = [tally.possessions, tally.with_case, tally.plays].into_iter().chain(ends);
        let counts = counts.chain(then.map(|n| n.copied().unwrap_or(0)));
        let counts: Vec<_> = counts.map(|n| n.to_string()).collect();
        let _ = writeln!(text, "| {situation} | {} |", counts.join(" | "));
    }
}
