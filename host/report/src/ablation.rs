//! `ablation`: report of the ablations: a page, a plot and a Markdown table of what every change does, one
//! line an arm.

use brain::Approach;
use figures::numbers::{p, plain, signed};
use figures::{
    Cell, Column, Dot, DotRow, Figure, FigureFile, Key, Page, Panel, Row, Shape, Table, dot_axis, dot_panel,
    row,
};
use maud::{Markup, html};
use study::evaluation::{Arm, Effect};
use study::statistics::{Count, newcombe, stars};

use crate::columns::CONFIDENCE;
use crate::page::{facts, style};
use crate::table::with_detail;
use crate::{Facts, labels};

/// Inputs of an ablation's page.
#[derive(Clone, Copy, Debug)]
pub struct Ablation<'a> {
    /// The changes, in the order of lines.
    pub arms: &'a [Arm],
    /// Their effects, in every cell and over all.
    pub effects: &'a [Effect],
    /// All settings that the trials depend on.
    pub facts: &'a [Facts],
}

/// A measure as it is shown.
struct MeasureStyle {
    /// Name in files.
    name: &'static str,
    head: &'static str,
    unit: &'static str,
    decimals: usize,
    is_share: bool,
}

impl Ablation<'_> {
    /// The plot as a file.
    pub fn figure_file(&self) -> FigureFile {
        self.figure().file()
    }

    /// The whole page as one HTML document, plot included.
    pub fn html(&self) -> String {
        let main = html! {
            section id="all" { h2 { "Over all cells" } (self.table(None)) (self.figure().html()) }
            section id="cells" {
                h2 { "In every cell" }
                @for cell in self.cells() {
                    details { summary { "Scenario " (cell.1) ", " (cell.0) } (self.table(Some(cell))) }
                }
            }
            (facts(self.facts))
        };
        let header = html! { p.lead { (self.lead()) } p.note { (NOTE) } };
        Page { title: TITLE, style: style(), header, main }.html()
    }

    /// The effects over all cells as Markdown; the plot is named relative to `figures_directory`.
    pub fn markdown(&self, figures_directory: &str) -> String {
        let mut table = Table::new(columns());
        for (arm, effects) in self.lines(None) {
            let cells = effects.into_iter().map(|cell| Cell { detail: String::new(), ..cell });
            table.push(row![arm.name].with(cells).with([arm.what]));
        }
        format!(
            "{} {NOTE}\n\n{}\n![{PLOT_TITLE}]({figures_directory}ablations.svg)\n",
            self.lead(),
            table.markdown()
        )
    }

    fn lead(&self) -> String {
        let trials = self.of(None).next().map_or(0, |effect| effect.trials);
        format!(
            "Case-based attackers with one thing changed, in {trials} trials of the paper’s eight cells an arm."
        )
    }

    /// The effects in a cell, or over all.
    fn of<'a>(&'a self, cell: Option<Place<'a>>) -> impl Iterator<Item = &'a Effect> + Clone {
        self.effects.iter().filter(move |effect| place(effect) == cell)
    }

    fn cells(&self) -> Vec<Place<'_>> {
        let mut cells = Vec::new();
        for place in self.effects.iter().filter_map(place) {
            if !cells.contains(&place) {
                cells.push(place);
            }
        }
        cells
    }

    /// The unchanged team's numbers, then every arm's differences.
    fn lines(&self, cell: Option<Place<'_>>) -> Vec<(&Arm, Vec<Cell>)> {
        let lines = self.arms.iter().map(|arm| {
            let cells = MEASURES.iter().map(|measure| self.cell(arm, measure, cell)).collect::<Option<_>>();
            Some((arm, cells?))
        });
        lines.flatten().collect()
    }

    /// Number of the unchanged team, or an arm's difference to it with p.
    fn cell(&self, arm: &Arm, measure: &MeasureStyle, cell: Option<Place<'_>>) -> Option<Cell> {
        let mut effects =
            self.effects.iter().filter(|effect| place(effect) == cell && effect.measure == measure.name);
        let effect = effects.find(|effect| arm.is_default() || effect.arm == arm.name)?;
        if arm.is_default() {
            return Some(Cell::from(plain(effect.default, measure.decimals)));
        }
        let value = signed(effect.difference, measure.decimals);
        Some(with_detail(value, stars(effect.p_holm), effect.p_holm.map(p)))
    }

    fn table(&self, cell: Option<Place<'_>>) -> Markup {
        let mut table = Table::new(columns());
        for (arm, cells) in self.lines(cell) {
            let mut what = Cell::from(arm.what);
            if !arm.flags.is_empty() {
                what = what.detail(html! { code { (arm.flags) } });
            }
            let class = if arm.is_default() { "ours" } else { "difference" };
            let style = labels::css(Approach::Cases);
            table.push(Row { class, style, ..row![arm.name].with(cells).with([what]) });
        }
        table.html("Effects", "")
    }

    fn figure(&self) -> Figure {
        Figure {
            name: "ablations".to_owned(),
            title: PLOT_TITLE.to_owned(),
            keys: vec![key("differs (p < 0.05 after Holm)", true), key("no more than chance", false)],
            panels: MEASURES.iter().filter_map(|measure| self.panel(measure)).collect(),
        }
    }

    /// Every arm's difference in a measure over all cells.
    fn panel(&self, measure: &MeasureStyle) -> Option<Panel> {
        let effects = self.of(None).filter(|effect| effect.measure == measure.name);
        let rows: Vec<_> = effects
            .map(|effect| DotRow { name: effect.arm.to_owned(), dots: vec![dot(effect, measure)] })
            .collect();
        let (mut low, mut high) = (0.0_f64, 0.0_f64);
        for dot in rows.iter().flat_map(|row| &row.dots) {
            let (from, to) = dot.interval.unwrap_or((dot.value, dot.value));
            (low, high) = (low.min(from), high.max(to));
        }
        let axis = dot_axis(low - (high - low) * 0.2, high);
        let unit = if measure.is_share { "percentage points" } else { measure.unit };
        (!rows.is_empty()).then(|| dot_panel(measure.head.to_owned(), unit, &rows, &axis))
    }
}

fn columns() -> Vec<Column> {
    let measures = MEASURES.iter().map(|measure| Column::number(measure.head, measure.unit));
    [Column::name("arm")].into_iter().chain(measures).chain([Column::text("what is changed")]).collect()
}

fn dot(effect: &Effect, measure: &MeasureStyle) -> Dot {
    let text = format!("{} {}", signed(effect.difference, measure.decimals), stars(effect.p_holm));
    Dot {
        color: labels::color(Approach::Cases),
        is_filled: effect.p_holm.is_some_and(|p| p < 1.0 - CONFIDENCE),
        value: effect.difference,
        interval: measure.is_share.then(|| interval(effect)).flatten(),
        text,
    }
}

fn key(label: &str, is_filled: bool) -> Key {
    Key { label: label.to_owned(), color: labels::color(Approach::Cases), is_filled, shape: Shape::Dot }
}

/// Opponents and scenario of a cell.
type Place<'a> = (&'static str, &'a str);

/// The cell of an effect; `None` over all cells.
fn place(effect: &Effect) -> Option<Place<'_>> {
    Some((labels::opponents(effect.configuration?), effect.scenario?))
}

/// Newcombe's interval in points, as if the trials were not paired: wider than necessary.
fn interval(effect: &Effect) -> Option<(f64, f64)> {
    let count = |percent: f64| Count {
        hits: (percent / 100.0 * f64::from(effect.trials)).round() as u32,
        of: effect.trials,
    };
    let interval = newcombe(count(effect.value), count(effect.default), CONFIDENCE)?;
    Some((100.0 * interval.low, 100.0 * interval.high))
}

const TITLE: &str = "What each part of the case-based approach is worth";
const PLOT_TITLE: &str = "What each change does over all cells: the arm less the unchanged team";
const NOTE: &str = "Differences to the unchanged team. Trials of equal seed are compared in pairs: McNemar’s exact test for shares, the \
     paired t for means; p after Holm’s correction over the arms, * below 0.05, ** below 0.01, *** below 0.001. Whiskers are Newcombe’s \
     95 % intervals as if the trials were no pairs, so wider than need be; means have none.";
const MEASURES: [MeasureStyle; 7] = [
    MeasureStyle { name: "to_goal", head: "to goal", unit: "%", decimals: 1, is_share: true },
    MeasureStyle { name: "out", head: "out", unit: "%", decimals: 1, is_share: true },
    MeasureStyle { name: "timeout", head: "timeout", unit: "%", decimals: 1, is_share: true },
    MeasureStyle {
        name: "possession",
        head: "opponents’ possession",
        unit: "a trial",
        decimals: 2,
        is_share: false,
    },
    MeasureStyle { name: "time", head: "time", unit: "s", decimals: 1, is_share: false },
    MeasureStyle { name: "cases", head: "cases used", unit: "a trial", decimals: 2, is_share: false },
    MeasureStyle { name: "default_s", head: "time without a case", unit: "s", decimals: 1, is_share: false },
];

#[cfg(test)]
mod tests {
    use study::evaluation::ARMS;

    use super::*;

    fn effect(arm: &'static str, measure: &'static str, default: f64, value: f64) -> Effect {
        Effect {
            arm,
            configuration: None,
            scenario: None,
            measure,
            trials: 100,
            default,
            value,
            difference: value - default,
            p_paired: Some(0.004),
            p_unpaired: Some(0.02),
            p_holm: Some(0.008),
        }
    }

    #[test]
    fn a_row_has_the_differences_of_its_arm_and_what_it_changes() {
        let (arms, name) = (&ARMS[..2], ARMS[1].name);
        let effects: Vec<_> = MEASURES.iter().map(|measure| effect(name, measure.name, 30.0, 42.0)).collect();
        let facts =
            [Facts { title: "Program".to_owned(), entries: vec![("seed".to_owned(), "<1>".to_owned())] }];
        let ablation = Ablation { arms, effects: &effects, facts: &facts };
        let html = ablation.html();
        assert!(html.contains("30.0") && html.contains("+12.0<sup>**</sup>") && html.contains("p = 0.008"));
        assert!(html.contains(ARMS[1].flags) && html.contains("&lt;1&gt;"));
        let text = ablation.markdown("evaluation/");
        assert!(text.contains(&format!("| {name} | +12.0\\*\\* | +12.0\\*\\* |")), "{text}");
        assert!(text.contains("](evaluation/ablations.svg)"));
        // 42 against 30 of 100; Wilson's are 0.32798–0.51794 and 0.21895–0.39585, so 12 less 13.287 = 100
        // √(0.09202² + 0.09585²) and more 12.712 = 100 √(0.09794² + 0.08105²).
        let (low, high) = interval(&effects[0]).unwrap();
        assert!((low + 1.287).abs() < 1e-3 && (high - 24.712).abs() < 1e-3, "{low} {high}");
    }
}
