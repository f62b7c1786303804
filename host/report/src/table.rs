//! `table`: lines of the report's tables. Ours, the paper's, their difference; then one approach against
//! another.
//!
//! The same model becomes HTML here and Markdown in `markdown`. A difference carries Holm's p over the
//! scenarios of its table.

use brain::Approach;
use hil_sim::Scenario;
use maud::{Markup, html};
use study::evaluation::{Comparison, TableRow};

use crate::columns::{Column, Kind, columns};
use crate::{Report, description, numbers};

/// One of the paper's tables, beside ours.
#[derive(Debug)]
pub(crate) struct Table {
    pub(crate) number: u8,
    pub(crate) columns: Vec<Column>,
    pub(crate) blocks: Vec<Block>,
}

/// A scenario of it.
#[derive(Debug)]
pub(crate) struct Block {
    pub(crate) scenario: Scenario,
    pub(crate) lines: Vec<Line>,
}

/// A line of it.
#[derive(Debug)]
pub(crate) struct Line {
    pub(crate) kind: LineKind,
    /// Its approach; of two, the first.
    pub(crate) approach: Approach,
    pub(crate) cells: Vec<Cell>,
}

/// Contents of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum LineKind {
    /// Our numbers, of this number of trials.
    Ours(u32),
    /// The paper's, of this number.
    Paper(u32),
    /// Ours less the paper's.
    Difference,
    /// Ours less our other approach's, of these numbers of trials.
    Against(Approach, [u32; 2]),
    /// The paper's less its other approach's.
    PaperAgainst(Approach),
}

/// Contents of a table's cell.
#[derive(Clone, Debug, Default)]
pub(crate) struct Cell {
    /// The number.
    pub(crate) value: String,
    /// Stars of its p.
    pub(crate) marks: &'static str,
    /// Its interval, spread or p.
    pub(crate) beside: String,
    /// Number of decimals that it has less than its neighbours.
    lacks: usize,
}

/// All tables that have rows of ours.
pub(crate) fn tables(report: &Report<'_>) -> Vec<Table> {
    (1..=6).filter_map(|number| Table::new(number, report)).collect()
}

impl Table {
    fn new(number: u8, report: &Report<'_>) -> Option<Self> {
        let ours: Vec<_> = report.rows.iter().filter(|row| row.table == number).collect();
        let paper: Vec<_> = report.paper.iter().filter(|row| row.table == number).collect();
        let all: Vec<_> = ours.iter().chain(&paper).copied().collect();
        let columns = columns(number, &all);
        let mut scenarios: Vec<Scenario> = Vec::new();
        for row in &ours {
            if !scenarios.contains(&row.scenario) {
                scenarios.push(row.scenario);
            }
        }
        let of = |rows: &[&TableRow], scenario| -> Vec<TableRow> {
            rows.iter().filter(|row| row.scenario == scenario).map(|row| (*row).clone()).collect()
        };
        let blocks = scenarios.into_iter().map(|scenario| {
            let source = Source { report, ours: of(&ours, scenario), paper: of(&paper, scenario) };
            Block { scenario, lines: source.lines(number, scenario, &columns) }
        });
        let blocks: Vec<_> = blocks.collect();
        (!blocks.is_empty()).then_some(Self { number, columns, blocks })
    }

    /// As HTML.
    pub(crate) fn html(&self) -> Markup {
        html! {
            div.scroll tabindex="0" role="region" aria-label={ "Table " (self.number) } {
                table {
                    thead { tr {
                        th.name scope="col" { "scenario, attackers" }
                        @for column in &self.columns {
                            th scope="col" { (column.head) span.unit { (column.unit) } }
                        }
                    } }
                    @for block in &self.blocks {
                        tbody {
                            tr.block { th scope="rowgroup" colspan=(self.columns.len() + 1) {
                                span { (description::scenario(block.scenario)) }
                            } }
                            @for line in &block.lines { (line.html()) }
                        }
                    }
                }
            }
        }
    }
}

/// The rows of a scenario.
struct Source<'a> {
    report: &'a Report<'a>,
    ours: Vec<TableRow>,
    paper: Vec<TableRow>,
}

impl Source<'_> {
    fn lines(&self, table: u8, scenario: Scenario, columns: &[Column]) -> Vec<Line> {
        let mut lines = Vec::new();
        let mut before = None;
        for row in by_approach(&self.ours) {
            let approach = row.approach;
            let line = |kind, cells| Line { kind, approach, cells };
            let own = columns.iter().map(|column| measured(column, row, false)).collect();
            lines.push(line(LineKind::Ours(row.trials), own));
            let Some(paper) = self.paper.iter().find(|paper| paper.approach == approach) else { continue };
            // It is already below ours with another number of trials.
            if before.replace(approach) != Some(approach) {
                let printed = columns.iter().map(|column| measured(column, paper, true)).collect();
                lines.push(line(LineKind::Paper(paper.trials), printed));
            }
            let comparisons = self.report.with_paper;
            let less = columns.iter().map(|column| less(column, row, paper, comparisons)).collect();
            lines.push(line(LineKind::Difference, less));
        }
        for (first, second) in pairs(self.report.between, table, scenario) {
            for (ours, rows, comparisons) in
                [(true, &self.ours, self.report.between), (false, &self.paper, self.report.papers_between)]
            {
                let of = |approach| rows.iter().filter(move |row: &&TableRow| row.approach == approach);
                for a in of(first) {
                    // Where a table has rows of several numbers of trials, rows of equal numbers are
                    // compared.
                    let mut others = of(second);
                    let alike = others.clone().find(|b| b.trials == a.trials);
                    let Some(b) = alike.or_else(|| others.next()) else { continue };
                    let cells = columns.iter().map(|column| less(column, a, b, comparisons)).collect();
                    let kind = if ours {
                        LineKind::Against(second, [a.trials, b.trials])
                    } else {
                        LineKind::PaperAgainst(second)
                    };
                    lines.push(Line { kind, approach: first, cells });
                }
            }
        }
        lines
    }
}

/// Rows of an approach beside each other, approaches as they come.
fn by_approach(rows: &[TableRow]) -> Vec<&TableRow> {
    let mut approaches: Vec<Approach> = Vec::new();
    for row in rows {
        if !approaches.contains(&row.approach) {
            approaches.push(row.approach);
        }
    }
    let own = |approach| rows.iter().filter(move |row: &&TableRow| row.approach == approach);
    approaches.into_iter().flat_map(own).collect()
}

/// Pairs of approaches that are compared in that table and scenario.
pub(crate) fn pairs(comparisons: &[Comparison], table: u8, scenario: Scenario) -> Vec<(Approach, Approach)> {
    let mut pairs = Vec::new();
    for c in comparisons.iter().filter(|c| (c.table, c.scenario) == (table, scenario)) {
        let pair = description::oriented((c.first_approach, c.second_approach));
        if !pairs.contains(&pair) {
            pairs.push(pair);
        }
    }
    pairs
}

/// A row's own number; a share of the paper's has no more digits than it prints.
fn measured(column: &Column, row: &TableRow, paper: bool) -> Cell {
    let Some(value) = column.value(row) else { return Cell::default() };
    let decimals = column.decimals;
    let beside = if column.is_share() {
        let interval = column.interval(row);
        interval.map(|i| format!("{}–{}", numbers::plain(i.low, decimals), numbers::plain(i.high, decimals)))
    } else {
        column.spread(row).map(|sd| format!("sd {}", numbers::plain(sd, decimals)))
    };
    let whole = paper && column.is_share();
    let value = if whole { numbers::printed(value, decimals) } else { numbers::plain(value, decimals) };
    let lacks = if value.contains('.') { 0 } else { decimals };
    Cell { value, marks: "", beside: beside.unwrap_or_default(), lacks }
}

/// The first row's number less the second's, with its test if there is one.
fn less(column: &Column, first: &TableRow, second: &TableRow, comparisons: &[Comparison]) -> Cell {
    let (Some(a), Some(b)) = (column.value(first), column.value(second)) else { return Cell::default() };
    // Counts depend on the number of trials: only equal numbers can be compared.
    if column.is_count() && first.trials != second.trials {
        return Cell::default();
    }
    let value = numbers::signed(a - b, column.decimals);
    let p = tested(column, first, second, comparisons).and_then(|comparison| comparison.p_holm);
    let (marks, beside) = p.map_or(("", String::new()), |p| (numbers::marks(p), numbers::p(p)));
    Cell { value, marks, beside, lacks: 0 }
}

/// The comparison of these two rows, in either order.
fn tested<'c>(
    column: &Column,
    first: &TableRow,
    second: &TableRow,
    comparisons: &'c [Comparison],
) -> Option<&'c Comparison> {
    let Kind::Measured(measure) = column.kind else { return None };
    let (a, b) = (measure.value(first)?, measure.value(second)?);
    comparisons.iter().find(|c| {
        let own = (c.first_approach, c.second_approach, c.first, c.second);
        let turned = (c.second_approach, c.first_approach, c.second, c.first);
        (c.table, c.scenario, c.measure) == (first.table, first.scenario, measure)
            && [own, turned].contains(&(first.approach, second.approach, a, b))
    })
}

impl Line {
    fn html(&self) -> Markup {
        html! {
            tr class=(self.class()) {
                th.name scope="row" style=(description::css(self.approach)) {
                    (self.label())
                    @if let Some(trials) = self.trials() { small { (trials) " trials" } }
                }
                @for cell in &self.cells { td {
                    (cell.value)
                    // Decimals are aligned.
                    @if cell.lacks > 0 { span.pad aria-hidden="true" { "." ("0".repeat(cell.lacks)) } }
                    @if !cell.marks.is_empty() { sup { (cell.marks) } }
                    @if !cell.beside.is_empty() { small { (cell.beside) } }
                } }
            }
        }
    }

    const fn class(&self) -> &'static str {
        match self.kind {
            LineKind::Ours(_) => "ours",
            LineKind::Paper(_) => "paper",
            LineKind::Difference => "difference",
            LineKind::Against(..) => "against",
            LineKind::PaperAgainst(_) => "paper against",
        }
    }

    /// Its number of trials.
    pub(crate) fn trials(&self) -> Option<String> {
        match self.kind {
            LineKind::Ours(trials) | LineKind::Paper(trials) => Some(trials.to_string()),
            LineKind::Against(_, [first, second]) if first == second => Some(first.to_string()),
            LineKind::Against(_, [first, second]) => Some(format!("{first} and {second}")),
            LineKind::Difference | LineKind::PaperAgainst(_) => None,
        }
    }

    pub(crate) fn label(&self) -> String {
        let own = description::approach(self.approach);
        match self.kind {
            LineKind::Ours(_) => own.to_owned(),
            LineKind::Paper(_) => "paper".to_owned(),
            LineKind::Difference => "ours − paper".to_owned(),
            LineKind::Against(other, _) => format!("{own} − {}", description::approach(other)),
            LineKind::PaperAgainst(_) => "paper’s".to_owned(),
        }
    }
}
