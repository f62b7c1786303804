//! `table`: tables. Columns and rows, written as text, as Markdown or as HTML.
//!
//! | cell | text | Markdown | HTML |
//! |---|---|---|---|
//! | value | aligned in its column | escaped | escaped |
//! | marks | behind `beside` | behind the value | raised |
//! | `beside` | behind the value | behind the value, in italics | small, below |
//! | `detail` | – | – | small, below |

use std::fmt::{Display, Write as _};

use maud::{Markup, html};

/// A table, with as many cells in each row as it has columns.
#[derive(Clone, Debug, Default)]
pub struct Table {
    /// The columns, from the left.
    pub columns: Vec<Column>,
    /// The rows, from the top.
    pub rows: Vec<Row>,
}

/// A column of a table.
#[derive(Clone, Debug)]
pub struct Column {
    /// The heading; may be empty.
    pub head: String,
    /// The unit of the values: in brackets behind the heading, in HTML below it; empty without one.
    pub unit: &'static str,
    /// The alignment, and the role in HTML.
    pub kind: ColumnKind,
}

/// Alignment of a column, and its role in HTML.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColumnKind {
    /// Name of the row: to the left; heads the row in HTML.
    Name,
    /// Numbers: to the right.
    Number,
    /// Text: to the left.
    Text,
}

/// A row of a table.
#[derive(Clone, Debug, Default)]
pub struct Row {
    /// The contents, one a column; of a [heading](Row::heading) one in all.
    pub cells: Vec<Cell>,
    /// Class in HTML; empty without one.
    pub class: &'static str,
    /// Style in HTML; empty without one.
    pub style: String,
    /// True if this row heads the rows below it.
    pub is_heading: bool,
}

/// Contents of a cell.
#[derive(Clone, Debug, Default)]
pub struct Cell {
    /// Text in bold letters before the value (Markdown alone).
    pub strong: &'static str,
    /// The number or text; `None` where nothing belongs.
    pub value: Option<String>,
    /// Stars of significance; may be empty.
    pub marks: &'static str,
    /// A second number beside the value; may be empty.
    pub beside: String,
    /// More text, as HTML, on pages alone; may be empty.
    pub detail: String,
    /// Number of decimals that the value has less than its neighbours.
    pub missing_decimals: usize,
}

/// A row of cells, each from a [`Cell`] or from a value that can be displayed; values are borrowed.
#[macro_export]
macro_rules! row {
    ($($cell:expr),* $(,)?) => { $crate::Row::from(vec![$($crate::Cell::from(&$cell)),*]) };
}

impl Column {
    /// Names of rows.
    pub fn name(head: &str) -> Self {
        Self { head: head.to_owned(), unit: "", kind: ColumnKind::Name }
    }

    /// Numbers in a unit, which may be empty.
    pub fn number(head: &str, unit: &'static str) -> Self {
        Self { head: head.to_owned(), unit, kind: ColumnKind::Number }
    }

    /// Texts.
    pub fn text(head: &str) -> Self {
        Self { head: head.to_owned(), unit: "", kind: ColumnKind::Text }
    }

    fn head_and_unit(&self) -> String {
        if self.unit.is_empty() { self.head.clone() } else { format!("{} ({})", self.head, self.unit) }
    }
}

impl Cell {
    /// A cell in which nothing belongs.
    pub const GAP: Self = Self {
        strong: "",
        value: None,
        marks: "",
        beside: String::new(),
        detail: String::new(),
        missing_decimals: 0,
    };

    /// A text behind one in bold letters.
    pub fn verdict(strong: &'static str, text: impl Display) -> Self {
        Self { strong, ..Self::from(text) }
    }

    /// `value` with its stars.
    pub fn marked(value: impl Display, marks: &'static str) -> Self {
        Self { marks, ..Self::from(value) }
    }

    /// The cell with a second number beside its value.
    #[must_use]
    pub fn beside(self, beside: impl Display) -> Self {
        Self { beside: beside.to_string(), ..self }
    }

    /// The cell with more text on pages.
    #[must_use]
    pub fn detail(self, detail: Markup) -> Self {
        Self { detail: detail.into_string(), ..self }
    }

    fn value(&self) -> &str {
        self.value.as_deref().unwrap_or_default()
    }

    fn markdown(&self) -> String {
        let Some(value) = &self.value else { return " ".to_owned() };
        let strong = if self.strong.is_empty() { String::new() } else { format!("**{}**", self.strong) };
        let beside =
            if self.beside.is_empty() { String::new() } else { format!(" *{}*", escaped(&self.beside)) };
        format!(" {strong}{}{}{beside} ", escaped(value), escaped(self.marks))
    }

    fn html(&self) -> Markup {
        html! {
            (self.value())
            // Decimals are aligned.
            @if self.missing_decimals > 0 {
                span.pad aria-hidden="true" { "." ("0".repeat(self.missing_decimals)) }
            }
            @if !self.marks.is_empty() { sup { (self.marks) } }
            @if !self.beside.is_empty() { small { (self.beside) } }
            @if !self.detail.is_empty() { small { (maud::PreEscaped(&self.detail)) } }
        }
    }
}

impl<T: Display> From<T> for Cell {
    fn from(value: T) -> Self {
        Self { value: Some(value.to_string()), ..Self::GAP }
    }
}

impl From<&Cell> for Cell {
    fn from(cell: &Cell) -> Self {
        cell.clone()
    }
}

impl From<Vec<Cell>> for Row {
    fn from(cells: Vec<Cell>) -> Self {
        Self { cells, ..Self::default() }
    }
}

impl Row {
    /// A row that heads those below it, across all columns.
    pub fn heading(text: impl Display) -> Self {
        Self { cells: vec![Cell::from(text)], is_heading: true, ..Self::default() }
    }

    /// The row with more cells behind its own.
    #[must_use]
    pub fn with<C: Into<Cell>>(mut self, cells: impl IntoIterator<Item = C>) -> Self {
        self.cells.extend(cells.into_iter().map(Into::into));
        self
    }
}

impl Table {
    /// A table without rows.
    pub fn new(columns: impl IntoIterator<Item = Column>) -> Self {
        Self { columns: columns.into_iter().collect(), rows: Vec::new() }
    }

    /// A table without rows whose columns are all to the left; `heads` as in Markdown: `"team | goals"`.
    pub fn of_texts(heads: &str) -> Self {
        Self::new(heads.split('|').map(|head| Column::text(head.trim())))
    }

    /// Adds a row below the others.
    pub fn push(&mut self, row: Row) {
        self.rows.push(row);
    }

    /// The table with these rows.
    #[must_use]
    pub fn with_rows(mut self, rows: impl IntoIterator<Item = Row>) -> Self {
        self.rows.extend(rows);
        self
    }

    /// Lines of aligned columns, two spaces before each.
    pub fn text(&self) -> String {
        let heads = self.columns.iter().map(|column| Cell::from(column.head_and_unit()));
        let head = Row::from(heads.collect::<Vec<_>>());
        let rows: Vec<Vec<(&str, String)>> =
            [&head].into_iter().chain(&self.rows).map(|row| row.cells.iter().map(halves).collect()).collect();
        let mut text = String::new();
        let widths: Vec<_> = (0..self.columns.len()).map(|column| widths(&rows, column)).collect();
        for row in &rows {
            let mut line = String::new();
            for ((column, (value, rest)), &(left, right)) in self.columns.iter().zip(row).zip(&widths) {
                // Writing to a String cannot fail.
                let _ = match column.kind {
                    ColumnKind::Number => write!(line, "  {value:>left$} {rest:right$}"),
                    ColumnKind::Name | ColumnKind::Text => write!(line, "  {value:left$}"),
                };
            }
            text += line.trim_end();
            text.push('\n');
        }
        text
    }

    /// A Markdown table.
    pub fn markdown(&self) -> String {
        let mut text = String::new();
        for column in &self.columns {
            let head = column.head_and_unit();
            text += "| ";
            if !head.is_empty() {
                text += &head;
                text += " ";
            }
        }
        text += "|\n";
        for column in &self.columns {
            text += if column.kind == ColumnKind::Number { "|---:" } else { "|---" };
        }
        text += "|\n";
        for row in &self.rows {
            for cell in &row.cells {
                text.push('|');
                text += &cell.markdown();
            }
            text += "|\n";
        }
        text
    }

    /// An HTML table that scrolls where the page is too narrow; `label` says what it contains, `class` is
    /// the table's, or empty.
    pub fn html(&self, label: &str, class: &str) -> Markup {
        html! {
            div.scroll tabindex="0" role="region" aria-label=(label) {
                table class=[(!class.is_empty()).then_some(class)] {
                    @if self.columns.iter().any(|column| !column.head.is_empty()) {
                        thead { tr { @for column in &self.columns {
                            th class=[column.kind.class()] scope="col" {
                                (column.head)
                                @if !column.unit.is_empty() { span.unit { (column.unit) } }
                            }
                        } } }
                    }
                    @for rows in self.rows.chunk_by(|_, next| !next.is_heading) {
                        tbody { @for row in rows { (self.html_row(row)) } }
                    }
                }
            }
        }
    }

    fn html_row(&self, row: &Row) -> Markup {
        if row.is_heading {
            let text = row.cells.first().map_or("", Cell::value);
            return html! {
                tr.block { th scope="rowgroup" colspan=(self.columns.len()) { span { (text) } } }
            };
        }
        let style = (!row.style.is_empty()).then_some(&row.style);
        html! {
            tr class=[(!row.class.is_empty()).then_some(row.class)] style=[style] {
                @for (column, cell) in self.columns.iter().zip(&row.cells) {
                    @match column.kind {
                        ColumnKind::Name => th.name scope="row" { (cell.html()) },
                        ColumnKind::Number => td { (cell.html()) },
                        ColumnKind::Text => td.label { (cell.html()) },
                    }
                }
            }
        }
    }
}

impl ColumnKind {
    const fn class(self) -> Option<&'static str> {
        match self {
            Self::Name => Some("name"),
            Self::Number => None,
            Self::Text => Some("label"),
        }
    }
}

/// The part of a cell that is aligned in its column, and the part behind it.
fn halves(cell: &Cell) -> (&str, String) {
    (cell.value(), format!("{}{}", cell.beside, cell.marks))
}

/// Widths of both halves of a column, in letters.
fn widths(rows: &[Vec<(&str, String)>], column: usize) -> (usize, usize) {
    let cells = rows.iter().filter_map(|row| row.get(column));
    cells.fold((0, 0), |(left, right), (value, rest)| {
        (left.max(value.chars().count()), right.max(rest.chars().count()))
    })
}

/// Text that stays in its cell.
fn escaped(text: &str) -> String {
    text.replace('|', "\\|").replace('*', "\\*").replace('\n', " ")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table() -> Table {
        let columns = [Column::name("team"), Column::number("goals", "a match"), Column::text("note")];
        let marked = Cell::marked("+12.5", "**").beside("(7)").detail(html! { "p = 0.008" });
        Table::new(columns).with_rows([row!["a|b", marked, Cell::GAP], row!["c", 3, "x < *y*"]])
    }

    #[test]
    fn text_aligns_values_and_what_stands_beside_them() {
        let text = table().text();
        let lines: Vec<_> = text.lines().collect();
        // The unit belongs to the heading.
        assert_eq!(lines[0], "  team  goals (a match)        note");
        assert_eq!(lines[1], "  a|b             +12.5 (7)**");
        assert_eq!(lines[2], "  c                   3        x < *y*");
    }

    #[test]
    fn markdown_keeps_text_in_its_cell() {
        let lines = "| team | goals (a match) | note |\n|---|---:|---|\n\
                     | a\\|b | +12.5\\*\\* *(7)* | |\n| c | 3 | x < \\*y\\* |\n";
        assert_eq!(table().markdown(), lines);
    }

    #[test]
    fn html_escapes_text_and_names_rows_and_columns() {
        let mut table = table();
        table.push(Row::heading("others"));
        table.push(Row { class: "ours", style: "color:red".to_owned(), ..row!["d", "", ""] });
        let html = table.html("Goals", "wide").into_string();
        assert!(
            html.contains(
                r#"aria-label="Goals"><table class="wide"><thead><tr><th class="name" scope="col">"#
            )
        );
        assert!(html.contains(r#"goals<span class="unit">a match</span>"#), "{html}");
        assert!(html.contains("<td>+12.5<sup>**</sup><small>(7)</small><small>p = 0.008</small></td>"));
        assert!(html.contains(r#"<td class="label">x &lt; *y*</td>"#));
        // A heading begins a group of rows.
        assert!(html.contains(r#"</tbody><tbody><tr class="block"><th scope="rowgroup" colspan="3">"#));
        assert!(html.contains(r#"<tr class="ours" style="color:red"><th class="name" scope="row">d</th>"#));
    }
}
