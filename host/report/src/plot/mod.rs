//! `plot`: plots and their arrangement as figures. One panel a scenario or measure; beside each other on a
//! page, stacked on a phone, in one file for a paper.
//!
//! Everywhere: ours is filled, the paper's is hollow, an approach keeps its colour, whiskers are 95 %
//! intervals.

mod axis;
mod bars;
mod dots;
mod effects;
mod rows;
mod uses;

use arena::evaluation::{Measure, TableRow};
use brain::Approach;
use figures::{Anchor, Font, Svg, Theme};
use hil_sim::Scenario;
use maud::{Markup, PreEscaped, html};

pub(crate) use axis::GRID;
pub(crate) use rows::{Dot, Row, axis, panel};

use crate::{Picture, Report, description};

/// A plot of several panels.
#[derive(Debug)]
pub(crate) struct Figure {
    /// The table whose numbers it plots; 0 for all.
    pub(crate) table: u8,
    pub(crate) name: String,
    pub(crate) title: String,
    pub(crate) keys: Vec<Key>,
    pub(crate) panels: Vec<Panel>,
}

/// A part of a plot: what lies right of and below the origin, px.
#[derive(Debug)]
pub(crate) struct Panel {
    pub(crate) title: String,
    pub(crate) svg: Svg,
    pub(crate) height: f64,
}

/// Entry of the legend: meaning of a sign.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Key {
    pub(crate) label: String,
    pub(crate) color: &'static str,
    pub(crate) filled: bool,
    pub(crate) shape: Shape,
}

/// Sign that a number is drawn with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Shape {
    Bar,
    Dot,
}

/// All figures, in the order of the tables.
pub(crate) fn figures(report: &Report<'_>) -> Vec<Figure> {
    let mut figures = vec![effects::figure(report)];
    for table in [1, 4, 6] {
        figures.push(bars::outcomes(report, table));
        figures.push(match table {
            1 => dots::figure(report, 1, &[Measure::Possession, Measure::Time]),
            4 => dots::figure(report, 5, &[Measure::MidfieldPossession, Measure::Possession, Measure::Time]),
            _ => dots::figure(report, 6, &[Measure::Possession]),
        });
    }
    figures.extend([bars::backing_up(report), bars::cases(report), uses::figure(report)]);
    figures.retain(|figure| !figure.panels.is_empty());
    figures.sort_by_key(|figure| figure.table);
    figures
}

/// Approach of a number, ours or the paper's.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Entry<'a> {
    pub(crate) row: &'a TableRow,
    pub(crate) ours: bool,
}

/// The rows of a table and scenario: by approach, ours before the paper's. Of ours with several numbers of
/// trials, the row with most.
pub(crate) fn entries<'a>(report: &Report<'a>, table: u8, scenario: Scenario) -> Vec<Entry<'a>> {
    let own = |row: &&TableRow| (row.table, row.scenario) == (table, scenario);
    let mut entries: Vec<Entry<'a>> = Vec::new();
    for row in report.rows.iter().filter(own) {
        match entries.iter_mut().find(|entry| entry.row.approach == row.approach) {
            Some(entry) if entry.row.trials < row.trials => entry.row = row,
            Some(_) => {}
            None => entries.push(Entry { row, ours: true }),
        }
    }
    let with_paper = entries.into_iter().flat_map(|entry| {
        let same = |row: &&TableRow| own(row) && row.approach == entry.row.approach;
        let paper = report.paper.iter().find(same).map(|row| Entry { row, ours: false });
        [Some(entry), paper].into_iter().flatten()
    });
    with_paper.collect()
}

/// The scenarios of a table, in the order of its rows.
pub(crate) fn scenarios(report: &Report<'_>, table: u8) -> Vec<Scenario> {
    let mut scenarios = Vec::new();
    for row in report.rows.iter().filter(|row| row.table == table) {
        if !scenarios.contains(&row.scenario) {
            scenarios.push(row.scenario);
        }
    }
    scenarios
}

/// What the entries' colours and fills mean, each once.
pub(crate) fn keys<'a>(entries: impl Iterator<Item = Entry<'a>>, shape: Shape) -> Vec<Key> {
    let mut keys: Vec<Key> = Vec::new();
    for Entry { row, ours } in entries {
        let own = description::approach(row.approach);
        let label = if ours { own.to_owned() } else { format!("{own}, the paper’s") };
        let key = Key { label, color: description::color(row.approach), filled: ours, shape };
        if !keys.contains(&key) {
            keys.push(key);
        }
    }
    keys
}

/// The colour of an approach filled or hollow.
pub(crate) fn style(approach: Approach, ours: bool) -> String {
    let (color, paper) = (description::color(approach), Theme::Light.colors().paper);
    let fill = if ours { color } else { paper };
    format!(r#"fill="{fill}" stroke="{color}" stroke-width="1.4""#)
}

impl Figure {
    /// One SVG of everything, for files.
    pub(crate) fn picture(&self) -> Picture {
        let colors = Theme::Light.colors();
        let mut svg = Svg::default();
        let columns = if self.panels.len() == 1 { 1 } else { 2 };
        let right = (PANEL + GAP) * columns as f64 - GAP;
        let heading = Font { size: 17.0, fill: colors.ink, bold: true, halo: None };
        let mut down = 6.0;
        for line in figures::wrapped(&self.title, heading.size, right) {
            down -= 21.0;
            svg.text([0.0, down], &line, Anchor::Start, heading);
        }
        down -= 24.0;
        let (mut across, font) = (0.0, Font { size: 13.0, fill: colors.ink, bold: false, halo: None });
        for key in &self.keys {
            let wide = 40.0 + figures::width(&key.label, font.size);
            if across > 0.0 && across + wide > right {
                (across, down) = (0.0, down - 22.0);
            }
            svg.inset(&key.sign(), [across, down + 9.0]);
            svg.text([across + 28.0, down], &key.label, Anchor::Start, font);
            across += wide;
        }
        down -= 14.0;
        for row in self.panels.chunks(columns) {
            for (column, panel) in row.iter().enumerate() {
                svg.inset(&panel.with_title(), [column as f64 * (PANEL + GAP), down]);
            }
            down -= row.iter().map(|panel| panel.height + TITLE).fold(0.0, f64::max) + 12.0;
        }
        let svg = svg.finish([-EDGE, down - 4.0], [right + EDGE, EDGE], 1.0, colors.paper, &self.title);
        Picture { name: self.name.clone(), svg }
    }

    /// As part of a page.
    pub(crate) fn html(&self) -> Markup {
        html! {
            figure id=(self.name) {
                figcaption { (self.title) }
                div.keys { @for key in &self.keys {
                    span.key { (PreEscaped(key.svg())) (key.label) }
                } }
                div.panels { @for panel in &self.panels { (PreEscaped(panel.svg())) } }
            }
        }
    }
}

impl Panel {
    fn with_title(&self) -> Svg {
        let colors = Theme::Light.colors();
        let mut svg = Svg::default();
        let font = Font { size: 14.0, fill: colors.ink, bold: true, halo: None };
        svg.text([0.0, -17.0], &self.title, Anchor::Start, font);
        svg.inset(&self.svg, [0.0, -TITLE]);
        svg
    }

    fn svg(&self) -> String {
        let paper = Theme::Light.colors().paper;
        let low = [0.0, -self.height - TITLE];
        self.with_title().finish(low, [PANEL, 0.0], 1.0, paper, &self.title)
    }
}

impl Key {
    fn sign(&self) -> Svg {
        let mut svg = Svg::default();
        let fill = if self.filled { self.color } else { Theme::Light.colors().paper };
        let style = format!(r#"fill="{fill}" stroke="{}" stroke-width="1.4""#, self.color);
        match self.shape {
            Shape::Bar => svg.rect([1.0, -1.0], [21.0, -9.0], style),
            Shape::Dot => {
                svg.line([1.0, -5.0], [21.0, -5.0], format!(r#"stroke="{}" stroke-width="1.6""#, self.color));
                svg.circle([11.0, -5.0], 4.0, style);
            }
        }
        svg
    }

    fn svg(&self) -> String {
        self.sign().finish([0.0, -10.0], [22.0, 0.0], 1.0, Theme::Light.colors().paper, &self.label)
    }
}

/// Width of a panel, px: two beside each other on a page, one on a phone with readable letters.
pub(crate) const PANEL: f64 = 440.0;
/// Height of a panel's title, px.
const TITLE: f64 = 26.0;
/// Gap between panels, px.
const GAP: f64 = 28.0;
/// Margin around a figure, px.
const EDGE: f64 = 14.0;
