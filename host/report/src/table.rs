//! `table`: the paper's tables beside ours: our rows, the paper's, their difference; then one approach
//! against another.
//!
//! The same lines become HTML here and Markdown in `markdown`. A difference carries Holm's p over the
//! scenarios of its table.

use brain::Approach;
use figures::numbers::{p, plain, printed, signed};
use figures::{Cell, Column, Row, Table};
use hil_sim::Scenario;
use maud::{Markup, html};
use study::evaluation::{Comparison, TableRow};
use study::statistics::stars;

use crate::columns::{ColumnValue, MeasureColumn, columns};
use crate::{Report, labels};

/// One of the paper's tables, beside ours.
#[derive(Debug)]
pub(crate) struct PaperTable {
    pub(crate) number: u8,
    pub(crate) columns: Vec<MeasureColumn>,
    pub(crate) blocks: Vec<Block>,
}

/// The lines of a scenario.
#[derive(Debug)]
pub(crate) struct Block {
    pub(crate) scenario: Scenario,
    pub(crate) lines: Vec<Line>,
}

#[derive(Debug)]
pub(crate) struct Line {
    pub(crate) kind: LineKind,
    /// The approach of the numbers; of two, the first.
    pub(crate) approach: Approach,
    /// Value and stars; as detail its interval, spread or p.
    pub(crate) cells: Vec<Cell>,
}

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

/// All tables that have rows of ours.
pub(crate) fn tables(report: &Report<'_>) -> Vec<PaperTable> {
    (1..=6).filter_map(|number| PaperTable::new(number, report)).collect()
}

impl PaperTable {
    fn new(number: u8, report: &Report<'_>) -> Option<Self> {
        let ours: Vec<_> = report.rows.iter().filter(|row| row.table == number).collect();
        let paper: Vec<_> = report.paper.iter().filter(|row| row.table == number).collect();
        let all: Vec<_> = ours.iter().chain(&paper).copied().collect();
        let columns = columns(number, &all);
        let mut blocks: Vec<Block> = Vec::new();
        for row in &ours {
            let scenario = row.scenario;
            if blocks.iter().any(|block| block.scenario == scenario) {
                continue;
            }
            let [ours, paper] = [&ours, &paper].map(|rows| of_scenario(rows, scenario));
            let source = Source { report, ours, paper };
            blocks.push(Block { scenario, lines: source.lines(number, scenario, &columns) });
        }
        (!blocks.is_empty()).then_some(Self { number, columns, blocks })
    }

    pub(crate) fn html(&self) -> Markup {
        let numbers = self.columns.iter().map(|column| Column::number(column.head, column.unit));
        let mut table = Table::new([Column::name("scenario, attackers")].into_iter().chain(numbers));
        for block in &self.blocks {
            table.push(Row::heading(labels::scenario(block.scenario)));
            table.rows.extend(block.lines.iter().map(Line::row));
        }
        table.html(&format!("Table {}", self.number), "")
    }
}

fn of_scenario(rows: &[&TableRow], scenario: Scenario) -> Vec<TableRow> {
    rows.iter().filter(|row| row.scenario == scenario).map(|row| (*row).clone()).collect()
}

/// The rows of a scenario.
struct Source<'a> {
    report: &'a Report<'a>,
    ours: Vec<TableRow>,
    paper: Vec<TableRow>,
}

impl Source<'_> {
    fn lines(&self, table: u8, scenario: Scenario, columns: &[MeasureColumn]) -> Vec<Line> {
        let mut lines = Vec::new();
        let mut before = None;
        for row in by_approach(&self.ours) {
            let approach = row.approach;
            let own = columns.iter().map(|column| measured(column, row, false)).collect();
            lines.push(Line { kind: LineKind::Ours(row.trials), approach, cells: own });
            let Some(paper) = self.paper.iter().find(|paper| paper.approach == approach) else { continue };
            // It is already below ours with another number of trials.
            if before.replace(approach) != Some(approach) {
                let cells = columns.iter().map(|column| measured(column, paper, true)).collect();
                lines.push(Line { kind: LineKind::Paper(paper.trials), approach, cells });
            }
            let comparisons = self.report.with_paper;
            let cells = columns.iter().map(|column| less(column, row, paper, comparisons)).collect();
            lines.push(Line { kind: LineKind::Difference, approach, cells });
        }
        for (first, second) in pairs(self.report.between, table, scenario) {
            for (ours, rows, comparisons) in
                [(true, &self.ours, self.report.between), (false, &self.paper, self.report.papers_between)]
            {
                for a in rows.iter().filter(|row| row.approach == first) {
                    // Where a table has rows of several numbers of trials, rows of equal numbers are
                    // compared.
                    let mut others = rows.iter().filter(|row| row.approach == second);
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
        let pair = labels::oriented((c.first_approach, c.second_approach));
        if !pairs.contains(&pair) {
            pairs.push(pair);
        }
    }
    pairs
}

/// A row's own number; a share of the paper's has no more digits than it prints.
fn measured(column: &MeasureColumn, row: &TableRow, is_paper: bool) -> Cell {
    let Some(value) = column.value(row) else { return Cell::from("") };
    let decimals = column.decimals;
    let beside = if column.is_share() {
        let interval = column.interval(row);
        interval.map(|i| format!("{}–{}", plain(i.low, decimals), plain(i.high, decimals)))
    } else {
        column.spread(row).map(|sd| format!("sd {}", plain(sd, decimals)))
    };
    let is_rounded = is_paper && column.is_share();
    let value = if is_rounded { printed(value, decimals) } else { plain(value, decimals) };
    let missing_decimals = if value.contains('.') { 0 } else { decimals };
    Cell { missing_decimals, ..with_detail(value, "", beside) }
}

/// The first row's number less the second's, with its test if there is one.
fn less(column: &MeasureColumn, first: &TableRow, second: &TableRow, comparisons: &[Comparison]) -> Cell {
    let (Some(a), Some(b)) = (column.value(first), column.value(second)) else { return Cell::from("") };
    // Counts depend on the number of trials: only equal numbers can be compared.
    if column.is_count() && first.trials != second.trials {
        return Cell::from("");
    }
    let p_holm = tested(column, first, second, comparisons).and_then(|comparison| comparison.p_holm);
    with_detail(signed(a - b, column.decimals), stars(p_holm), p_holm.map(p))
}

/// A value with its stars; its interval or p for a page.
pub(crate) fn with_detail(value: String, marks: &'static str, detail: Option<String>) -> Cell {
    let cell = Cell::marked(value, marks);
    match detail {
        Some(detail) => cell.detail(html! { (detail) }),
        None => cell,
    }
}

/// The comparison of these two rows, in either order.
fn tested<'c>(
    column: &MeasureColumn,
    first: &TableRow,
    second: &TableRow,
    comparisons: &'c [Comparison],
) -> Option<&'c Comparison> {
    let ColumnValue::Measured(measure) = column.value else { return None };
    let (a, b) = (measure.value(first)?, measure.value(second)?);
    comparisons.iter().find(|c| {
        let own = (c.first_approach, c.second_approach, c.first, c.second);
        let turned = (c.second_approach, c.first_approach, c.second, c.first);
        (c.table, c.scenario, c.measure) == (first.table, first.scenario, measure)
            && [own, turned].contains(&(first.approach, second.approach, a, b))
    })
}

impl Line {
    fn row(&self) -> Row {
        let mut name = Cell::from(self.label());
        if let Some(trials) = self.trials() {
            name = name.detail(html! { (trials) " trials" });
        }
        let style = labels::css(self.approach);
        Row { class: self.class(), style, ..Row::from(vec![name]).with(self.cells.iter().cloned()) }
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

    pub(crate) fn trials(&self) -> Option<String> {
        match self.kind {
            LineKind::Ours(trials) | LineKind::Paper(trials) => Some(trials.to_string()),
            LineKind::Against(_, [first, second]) if first == second => Some(first.to_string()),
            LineKind::Against(_, [first, second]) => Some(format!("{first} and {second}")),
            LineKind::Difference | LineKind::PaperAgainst(_) => None,
        }
    }

    pub(crate) fn label(&self) -> String {
        let own = labels::approach(self.approach);
        match self.kind {
            LineKind::Ours(_) => own.to_owned(),
            LineKind::Paper(_) => "paper".to_owned(),
            LineKind::Difference => "ours − paper".to_owned(),
            LineKind::Against(other, _) => format!("{own} − {}", labels::approach(other)),
            LineKind::PaperAgainst(_) => "paper’s".to_owned(),
        }
    }
}
