//! `versions`: page of two versions of a team that played the same matches: the difference, and every match.

use brain::Approach;
use figures::numbers::{p, plain, signed};
use figures::{Cell, Dot, DotRow, Figure, Key, Page, Panel, Shape, Table, dot_axis, dot_panel, row};
use maud::html;
use study::matches::{Change, MatchComparison, MatchRow, comparison_table};

use crate::columns::CONFIDENCE;
use crate::labels;
use crate::page::style;

/// Two versions of a team, and their matches in the order of the plan.
#[derive(Clone, Copy, Debug)]
pub struct Versions<'a> {
    /// What each is: a strategy's command, or program and cases.
    pub names: [&'a str; 2],
    /// The matches of each.
    pub rows: [&'a [MatchRow]; 2],
    /// The second less the first.
    pub found: &'a [MatchComparison],
}

impl Versions<'_> {
    /// The whole page as one HTML document, plot included.
    pub fn html(&self) -> String {
        let [a, b] = self.names;
        let header = html! {
            p.lead { "A is " code { (a) } ", B is " code { (b) } ": the same opponents, seeds and sides." }
            @if let Some(all) = self.found.last() { p.lead { (verdict(all)) } }
            p.note { (NOTE) }
        };
        let main = html! {
            section id="difference" { h2 { "The difference" } (self.figure().html()) (comparison_table(self.found).html("Difference", "")) }
            section id="matches" { h2 { "Every match" } (self.matches().html("Matches", "listed")) }
        };
        Page { title: TITLE, style: style(), header, main }.html()
    }

    fn figure(&self) -> Figure {
        let color = labels::color(Approach::Cases);
        let key =
            |label: &str, is_filled| Key { label: label.to_owned(), color, is_filled, shape: Shape::Dot };
        Figure {
            name: "versions".to_owned(),
            title: "B less A, a match; right of zero B has more".to_owned(),
            keys: vec![key("differs (p < 0.05)", true), key("no more than chance", false)],
            panels: vec![
                self.panel("goals ahead", |found| found.goals),
                self.panel("shots ahead", |found| found.shots),
            ],
        }
    }

    fn panel(&self, title: &str, of: fn(&MatchComparison) -> Change) -> Panel {
        let rows: Vec<_> = self
            .found
            .iter()
            .map(|found| DotRow { name: against(found), dots: vec![dot(of(found))] })
            .collect();
        let ends = rows.iter().flat_map(|row| &row.dots).flat_map(|dot| {
            let (low, high) = dot.interval.unwrap_or((dot.value, dot.value));
            [low, high]
        });
        let (low, high) = ends.fold((-1.0_f64, 1.0_f64), |(low, high), end| (low.min(end), high.max(end)));
        dot_panel(title.to_owned(), "a match", &rows, &dot_axis(low, high))
    }

    fn matches(&self) -> Table {
        let mut table = Table::of_texts("match | seed | against | we play | A | B | shots A | shots B");
        for (a, b) in self.rows[0].iter().zip(self.rows[1]) {
            let side = if b.own_is_blue { "blue" } else { "yellow" };
            let shots = [a, b].map(|of| format!("{} : {}", of.sides[0].shots, of.sides[1].shots));
            let goals = [a, b].map(|of| format!("{} : {}", of.sides[0].goals, of.sides[1].goals));
            let row = row![b.number, b.seed, b.opponent, side];
            table.push(row.with(goals.into_iter().chain(shots).map(Cell::from)));
        }
        table
    }
}

/// One sentence: which is better, or that so many matches cannot say.
fn verdict(found: &MatchComparison) -> String {
    let Change { mean, p: chance, matches, .. } = found.goals;
    let significance = chance.map_or_else(|| "one match says nothing".to_owned(), p);
    let difference = format!("{} goals a match over {matches} matches ({significance})", signed(mean, 2));
    if chance.is_some_and(|chance| chance < 1.0 - CONFIDENCE) {
        let better = if mean > 0.0 { "B" } else { "A" };
        return format!("{better} is better: B less A is {difference}.");
    }
    let smallest = found.detectable_goals.map_or_else(String::new, |goals| {
        format!(" So many matches find a difference of {} in 80 of 100 repetitions.", plain(goals, 2))
    });
    format!("No difference can be told: B less A is {difference}.{smallest}")
}

fn against(found: &MatchComparison) -> String {
    found.pairing.map_or_else(|| "all".to_owned(), |pairing| pairing.opponent.to_string())
}

fn dot(change: Change) -> Dot {
    Dot {
        color: labels::color(Approach::Cases),
        is_filled: change.p.is_some_and(|p| p < 1.0 - CONFIDENCE),
        value: change.mean,
        interval: change.low.zip(change.high),
        text: signed(change.mean, 2),
    }
}

const TITLE: &str = "Two versions of a team, match by match";
const NOTE: &str = "Matches of equal number are compared in pairs (paired t test, two-sided); whiskers are 95 % intervals. \
     onetwo play with a match's seed shows it.";

#[cfg(test)]
mod tests {
    use hil_sim::small_size::worlds::WorldPlan;
    use study::matches::{MatchPlan, MatchTeam, compare_matches};

    use super::*;

    fn row(number: usize, goals: u32) -> MatchRow {
        let mut row = MatchRow {
            number,
            own: MatchTeam::strategy(),
            opponent: MatchTeam::round_1(),
            own_is_blue: number.is_multiple_of(2),
            seed: 7 + number as u64,
            ball_in_play: 0.5,
            sides: Default::default(),
            trace_hash: String::new(),
        };
        row.sides[0].goals = goals;
        row
    }

    fn page(goals: [[u32; 4]; 2]) -> String {
        let [a, b] = goals.map(|goals| (0..).zip(goals).map(|(n, goals)| row(n, goals)).collect::<Vec<_>>());
        let plan = MatchPlan {
            seed: 1,
            league: "division-b".into(),
            world: WorldPlan::default(),
            duration_s: 1.0,
            pairings: MatchPlan::against(MatchTeam::strategy(), &[MatchTeam::round_1()]),
            matches: 4,
            strategy: None,
            controller: None,
        };
        let found = compare_matches(&plan, &a, &b);
        Versions { names: ["old.py", "new <2>.py"], rows: [&a, &b], found: &found }.html()
    }

    #[test]
    fn the_page_says_which_version_is_better_and_lists_every_match() {
        let better = page([[0, 1, 0, 1], [5, 6, 5, 7]]);
        assert!(better.contains("B is better: B less A is +5.25 goals a match over 4 matches"), "{better}");
        assert!(better.contains("new &lt;2&gt;.py") && better.contains("7 : 0"), "{better}");
        let equal = page([[0, 1, 2, 0], [1, 0, 0, 2]]);
        assert!(equal.contains("No difference can be told") && equal.contains("80 of 100"), "{equal}");
    }
}
