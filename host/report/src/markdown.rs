//! `markdown`: the report's part of the documentation: tables in few columns, claims, figures; and its place
//! between two markers of a file.

use std::fmt::Write as _;
use std::iter::Peekable;
use std::slice;

use figures::{Cell, Column, Figure, Row, Table, row};
use study::evaluation::{Claim, Judgement, JudgementLine};

use crate::facts::HASH;
use crate::table::{Line, LineKind, PaperTable, tables};
use crate::{Report, labels, map};

/// Tables, claims and figures as Markdown; figures lie in the directory `figures_directory`, with a slash at
/// its end.
pub(crate) fn markdown(report: &Report<'_>, figures_directory: &str) -> String {
    let mut text = String::new();
    let facts = || report.facts.iter().flat_map(|facts| &facts.entries);
    let known =
        [("program", "onetwo"), ("plan.seed", "seed"), ("seed", "seed"), ("world", "world"), (HASH, HASH)];
    let provenance = known.into_iter().filter_map(|(name, label)| {
        let (_, value) = facts().find(|(own, _)| own == name)?;
        Some(format!("{label} {value}"))
    });
    let provenance: Vec<_> = provenance.collect();
    // Writing to a String cannot fail.
    if !provenance.is_empty() {
        let _ = writeln!(text, "Played by {}.\n", provenance.join(", "));
    }
    let plots = crate::plot::plots(report);
    for (_, figure) in plots.iter().filter(|(table, _)| *table == 0) {
        text += &image(figure, figures_directory);
    }
    for table in tables(report) {
        let number = table.number;
        let _ = writeln!(text, "### Table {number}: {}\n", labels::table(number));
        let world = facts().find(|(name, _)| name == "world").map(|(_, world)| format!(" World {world}."));
        let _ = writeln!(text, "{}{}\n", labels::note(number), world.unwrap_or_default());
        for part in [Some(own(&table)), against(&table)].into_iter().flatten() {
            let _ = writeln!(text, "{}", part.markdown());
        }
        for (_, figure) in plots.iter().filter(|(table, _)| *table == number) {
            text += &image(figure, figures_directory);
        }
    }
    for file in map::sheets(report.maps).iter().filter(|file| INCLUDED_MAPS.contains(&file.name.as_str())) {
        let _ =
            writeln!(text, "![Passes and ends; where the ball was]({figures_directory}{}.svg)\n", file.name);
    }
    if !report.claims.is_empty() {
        let _ =
            writeln!(text, "### What the paper says, and what the numbers say\n\n{}", claims(report.claims));
    }
    if !report.lines.is_empty() {
        let title = "### The pattern of its results, and what is asked of ours";
        let _ = writeln!(text, "{title}\n\n{}", pattern(report.lines));
    }
    text
}

fn image(figure: &Figure, directory: &str) -> String {
    format!("![{}]({directory}{}.svg)\n\n", figure.title, figure.name)
}

/// Columns with these names of rows, then a table's measures.
fn columns(names: &[&str], table: &PaperTable) -> Vec<Column> {
    let names = names.iter().map(|name| Column::name(name));
    names.chain(table.columns.iter().map(|column| Column::number(column.head, column.unit))).collect()
}

/// Our numbers, with the paper's beside them.
fn own(table: &PaperTable) -> Table {
    let mut own = Table::new(columns(&["scenario", "attackers", "trials"], table));
    for block in &table.blocks {
        let mut lines = block.lines.iter().peekable();
        while let Some(line) = lines.next() {
            let LineKind::Ours(trials) = line.kind else { continue };
            let paper = lines.next_if(|line| matches!(line.kind, LineKind::Paper(_)));
            let less = lines.next_if(|line| line.kind == LineKind::Difference);
            let cells = line.cells.iter().enumerate().map(|(i, cell)| {
                let marks = less.and_then(|line| line.cells.get(i)).map_or("", |cell| cell.marks);
                let printed = paper.and_then(|line| line.cells[i].value.clone());
                Cell { value: cell.value.clone(), marks, ..Cell::GAP }.beside(printed.unwrap_or_default())
            });
            let row = row![labels::scenario(block.scenario), labels::approach(line.approach), trials];
            own.push(row.with(cells));
        }
    }
    own
}

/// One approach less another, with the paper's difference beside; `None` where nothing is tested.
fn against(table: &PaperTable) -> Option<Table> {
    let mut against = Table::new(columns(&["scenario", "difference", "trials"], table));
    let mut is_tested = false;
    for block in &table.blocks {
        let mut lines = block.lines.iter().peekable();
        while let Some(line) = lines.next() {
            if !matches!(line.kind, LineKind::Against(..)) {
                continue;
            }
            is_tested |= line.cells.iter().any(|cell| !cell.detail.is_empty());
            let trials = line.trials().unwrap_or_default();
            let row = row![labels::scenario(block.scenario), line.label(), trials];
            against.push(row.with(with_papers(line, &mut lines)));
        }
    }
    is_tested.then_some(against)
}

/// The cells of a line of ours; beside them the paper's, if its line follows.
fn with_papers(line: &Line, lines: &mut Peekable<slice::Iter<'_, Line>>) -> Vec<Cell> {
    let paper = lines.next_if(|line| matches!(line.kind, LineKind::PaperAgainst(_)));
    let mut cells = Vec::new();
    for (i, cell) in line.cells.iter().enumerate() {
        let printed = paper.and_then(|line| {
            let Cell { value, marks, .. } = &line.cells[i];
            value.as_ref().map(|value| format!("{value}{marks}"))
        });
        let own = Cell { value: cell.value.clone(), marks: cell.marks, ..Cell::GAP };
        cells.push(own.beside(printed.unwrap_or_default()));
    }
    cells
}

fn claims(claims: &[Claim]) -> String {
    let table = Table::of_texts("§ | claim | our trials | the paper’s own tables");
    let rows = claims.iter().map(|Claim { section, sentence, ours, ours_as_paper, paper, .. }| {
        let few = ours_as_paper.as_ref();
        let few = few.map(|few| format!(" (its first 30 trials: {})", few.verdict.label()));
        row![section, sentence, verdict(ours, &few.unwrap_or_default()), verdict(paper, "")]
    });
    table.with_rows(rows).markdown()
}

/// The verdict with its evidence, and what follows it.
fn verdict(judgement: &Judgement, rest: &str) -> Cell {
    let Judgement { verdict, evidence, .. } = judgement;
    let colon = if evidence.is_empty() { "" } else { ": " };
    Cell::verdict(verdict.label(), format!("{colon}{evidence}{rest}"))
}

fn pattern(lines: &[JudgementLine]) -> String {
    let rows = lines.iter().map(|JudgementLine { id, line, verdict, evidence }| -> Row {
        row![id, line, Cell::verdict(verdict.label(), ""), evidence]
    });
    Table::of_texts(" | line |  | the numbers").with_rows(rows).markdown()
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
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum MarkerError {
    /// The file has no such marker line.
    #[error("there is no line `{marker}`; figures stand between two such lines")]
    Missing {
        /// The whole line that is missing.
        marker: String,
    },
}

/// Maps in the documentation: the scenarios that the paper describes play by play (§5.3).
const INCLUDED_MAPS: [&str; 2] = ["maps-dg-3", "maps-dg-4"];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_text_between_the_markers_is_replaced() {
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
