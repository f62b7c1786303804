//! `markdown`: the report's part of the documentation. The tables in few columns, the claims, the figures;
//! between two markers of a file.

use std::fmt;
use std::fmt::Write as _;

use study::evaluation::{Claim, Judgement, JudgementLine};

use crate::facts::HASH;
use crate::table::{Cell, LineKind, Table, tables};
use crate::{Report, description, map, table};

/// Tables, claims and figures as Markdown.
pub(crate) fn markdown(report: &Report<'_>, pictures: &str) -> String {
    let mut text = String::new();
    let facts = || report.facts.iter().flat_map(|facts| &facts.entries);
    let known =
        [("program", "onetwo"), ("plan.seed", "seed"), ("seed", "seed"), ("world", "world"), (HASH, HASH)];
    let verdict_text = known.into_iter().filter_map(|(name, label)| {
        let (_, value) = facts().find(|(own, _)| own == name)?;
        Some(format!("{label} {value}"))
    });
    let verdict_text: Vec<_> = verdict_text.collect();
    if !verdict_text.is_empty() {
        let _ = writeln!(text, "Played by {}.\n", verdict_text.join(", "));
    }
    let figures = crate::plot::figures(report);
    for figure in figures.iter().filter(|figure| figure.table == 0) {
        let _ = writeln!(text, "![{}]({pictures}{}.svg)\n", figure.title, figure.name);
    }
    for table in tables(report) {
        let number = table.number;
        let _ = writeln!(text, "### Table {number}: {}\n", description::table(number));
        let world = facts().find(|(name, _)| name == "world").map(|(_, world)| format!(" World {world}."));
        let _ = writeln!(text, "{}{}\n", description::note(number), world.unwrap_or_default());
        own(&mut text, &table);
        against(&mut text, &table);
        for figure in figures.iter().filter(|figure| figure.table == number) {
            let _ = writeln!(text, "![{}]({pictures}{}.svg)\n", figure.title, figure.name);
        }
    }
    for picture in
        map::sheets(report.maps).into_iter().filter(|picture| INCLUDED.contains(&picture.name.as_str()))
    {
        let _ = writeln!(text, "![Passes and ends; where the ball was]({pictures}{}.svg)\n", picture.name);
    }
    if !report.claims.is_empty() {
        claims(&mut text, report.claims);
    }
    if !report.lines.is_empty() {
        lines(&mut text, report.lines);
    }
    text
}

/// Ours, the paper's in italics behind it.
fn own(text: &mut String, table: &Table) {
    let heads = table.columns.iter().map(|column| format!("{} ({})", column.head, column.unit));
    head(text, &["scenario", "attackers", "trials"], heads);
    for block in &table.blocks {
        let mut lines = block.lines.iter().peekable();
        while let Some(line) = lines.next() {
            let LineKind::Ours(trials) = line.kind else { continue };
            let paper = lines.next_if(|line| matches!(line.kind, LineKind::Paper(_)));
            let less = lines.next_if(|line| line.kind == LineKind::Difference);
            let scenario = description::scenario(block.scenario);
            let _ = write!(text, "| {scenario} | {} | {trials} |", description::approach(line.approach));
            for (i, cell) in line.cells.iter().enumerate() {
                let printed = paper.and_then(|line| line.cells.get(i)).filter(|cell| !cell.value.is_empty());
                let printed = printed.map_or(String::new(), |cell| format!(" *{}*", cell.value));
                let marks = less.and_then(|line| line.cells.get(i)).map_or("", |cell| cell.marks);
                let _ = write!(text, " {}{}{printed} |", cell.value, escaped(marks));
            }
            text.push('\n');
        }
    }
    text.push('\n');
}

/// One approach less another, the paper's in italics behind it.
fn against(text: &mut String, table: &Table) {
    let pair = |line: &&table::Line| matches!(line.kind, LineKind::Against(..));
    let tested = |line: &table::Line| line.cells.iter().any(|cell| !cell.beside.is_empty());
    if !table.blocks.iter().flat_map(|block| &block.lines).filter(pair).any(tested) {
        return;
    }
    let heads = table.columns.iter().map(|column| format!("{} ({})", column.head, column.unit));
    head(text, &["scenario", "difference", "trials"], heads);
    for block in &table.blocks {
        let mut lines = block.lines.iter().peekable();
        while let Some(line) = lines.next() {
            if !pair(&line) {
                continue;
            }
            let trials = line.trials().unwrap_or_default();
            let paper = lines.next_if(|line| matches!(line.kind, LineKind::PaperAgainst(_)));
            let _ =
                write!(text, "| {} | {} | {trials} |", description::scenario(block.scenario), line.label());
            let both = |cell: &Cell| format!("{}{}", cell.value, escaped(cell.marks));
            for (i, cell) in line.cells.iter().enumerate() {
                let printed = paper.and_then(|line| line.cells.get(i)).filter(|cell| !cell.value.is_empty());
                let printed = printed.map_or(String::new(), |cell| format!(" *{}*", both(cell)));
                let _ = write!(text, " {}{printed} |", both(cell));
            }
            text.push('\n');
        }
    }
    text.push('\n');
}

fn claims(text: &mut String, claims: &[Claim]) {
    text.push_str("### What the paper says, and what the numbers say\n\n");
    text.push_str("| § | claim | our trials | the paper’s own tables |\n|---|---|---|---|\n");
    for Claim { section, sentence, ours, ours_as_paper, paper, .. } in claims {
        let few =
            ours_as_paper.as_ref().map(|few| format!(" (its first 30 trials: {})", few.verdict.label()));
        let (claim, few) = (cell(sentence), few.unwrap_or_default());
        let _ =
            writeln!(text, "| {section} | {claim} | {}{few} | {} |", verdict_text(ours), verdict_text(paper));
    }
    text.push('\n');
}

fn verdict_text(judgement: &Judgement) -> String {
    let label = judgement.verdict.label();
    if judgement.evidence.is_empty() {
        return format!("**{label}**");
    }
    format!("**{label}**: {}", cell(&judgement.evidence))
}

fn lines(text: &mut String, lines: &[JudgementLine]) {
    text.push_str("### The pattern of its results, and what is asked of ours\n\n");
    text.push_str("| | line | | the numbers |\n|---|---|---|---|\n");
    for JudgementLine { id, line, verdict, evidence } in lines {
        let _ = writeln!(text, "| {id} | {} | **{}** | {} |", cell(line), verdict.label(), cell(evidence));
    }
    text.push('\n');
}

/// Text that stays in its cell.
fn cell(description: &str) -> String {
    description.replace('|', "\\|").replace('*', "\\*").replace('\n', " ")
}

/// A row of heads, the first ones to the left, numbers to the right.
fn head(text: &mut String, names: &[&str], numbers: impl Iterator<Item = String> + Clone) {
    for name in names.iter().map(ToString::to_string).chain(numbers.clone()) {
        let _ = write!(text, "| {name} ");
    }
    text.push_str("|\n");
    for _ in names {
        text.push_str("|---");
    }
    for _ in numbers {
        text.push_str("|---:");
    }
    text.push_str("|\n");
}

/// Asterisks escaped for Markdown.
fn escaped(marks: &str) -> String {
    marks.replace('*', "\\*")
}

/// Replaces everything between the markers of `name` in `text`: `<!-- NAME: written by `cargo xtask CHORE`
/// -->` and `<!-- end of NAME -->`.
pub fn between_markers(text: &str, task: &str, name: &str, generated: &str) -> Result<String, MarkerError> {
    let (begin, end) = markers(task, name);
    let missing = |marker: &str| MarkerError::Missing { marker: marker.to_owned() };
    let from = text.find(&begin).ok_or_else(|| missing(&begin))? + begin.len();
    let to = text[from..].find(&end).ok_or_else(|| missing(&end))? + from;
    Ok(format!("{}\n\n{}\n\n{}", &text[..from], generated.trim(), &text[to..]))
}

fn markers(task: &str, name: &str) -> (String, String) {
    (format!("<!-- {name}: written by `cargo xtask {task}` -->"), format!("<!-- end of {name} -->"))
}

/// A file lacks a marker.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum MarkerError {
    /// The file has no such marker line.
    Missing {
        /// The whole line that is missing.
        marker: String,
    },
}

impl fmt::Display for MarkerError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self::Missing { marker } = self;
        write!(f, "there is no line `{marker}`; figures stand between two such lines")
    }
}

impl std::error::Error for MarkerError {}

/// Maps in the documentation: the scenarios that the paper describes play by play (§5.3).
const INCLUDED: [&str; 2] = ["maps-dg-3", "maps-dg-4"];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_stands_between_the_markers_is_replaced() {
        let (begin, end) = markers("evaluation", "figures");
        let text = format!("before\n{begin}\nold\n{end}\nafter\n");
        let once = between_markers(&text, "evaluation", "figures", "new\n").unwrap();
        assert_eq!(once, format!("before\n{begin}\n\nnew\n\n{end}\nafter\n"));
        assert_eq!(between_markers(&once, "evaluation", "figures", "new\n").unwrap(), once);
        let missing = |marker: &str| Err(MarkerError::Missing { marker: marker.to_owned() });
        assert_eq!(between_markers("nothing", "evaluation", "figures", "new"), missing(&begin));
        assert_eq!(between_markers(&format!("{end}{begin}"), "evaluation", "figures", "new"), missing(&end));
        assert_eq!(
            between_markers(&text, "evaluation", "ablations", "new"),
            missing(&markers("evaluation", "ablations").0)
        );
    }
}
