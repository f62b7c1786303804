//! `plot`: plots of several panels. Beside each other on a page, stacked on a phone, in one file for a paper.

use maud::{Markup, PreEscaped, html};

use crate::{Anchor, Font, Svg, Theme, width, wrapped};

/// A plot of several panels.
#[derive(Debug)]
pub struct Figure {
    /// Name of its file, without extension; its id on a page.
    pub name: String,
    /// The heading.
    pub title: String,
    /// The legend.
    pub keys: Vec<Key>,
    /// The parts, row by row.
    pub panels: Vec<Panel>,
}

/// An SVG with the name of its file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FigureFile {
    /// Name such as `table-1-outcomes`, without extension.
    pub name: String,
    /// The file's text.
    pub svg: String,
}

/// A part of a plot, [`PANEL_WIDTH`] wide.
#[derive(Debug)]
pub struct Panel {
    /// The heading.
    pub title: String,
    /// The drawing right of and below the origin, px.
    pub svg: Svg,
    /// Height of the drawing, px.
    pub height: f64,
}

/// Entry of a legend: a sign and its meaning.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Key {
    /// The meaning.
    pub label: String,
    /// Colour of the sign.
    pub color: &'static str,
    /// Filled if true, else hollow.
    pub is_filled: bool,
    /// Form of the sign.
    pub shape: Shape,
}

/// Sign with which a number is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// A bar from zero.
    Bar,
    /// A dot on its interval.
    Dot,
}

impl Figure {
    /// All panels in one file, two in a row.
    pub fn file(&self) -> FigureFile {
        let colors = Theme::Light.colors();
        let mut svg = Svg::default();
        let columns = if self.panels.len() == 1 { 1 } else { 2 };
        let right = (PANEL_WIDTH + PANEL_GAP) * columns as f64 - PANEL_GAP;
        let heading = Font { size: 17.0, fill: colors.ink, bold: true, halo: None };
        let mut down = 6.0;
        for line in wrapped(&self.title, heading.size, right) {
            down -= 21.0;
            svg.text([0.0, down], &line, Anchor::Start, heading);
        }
        down -= 24.0;
        let (mut across, font) = (0.0, Font { size: 13.0, fill: colors.ink, bold: false, halo: None });
        for key in &self.keys {
            let key_width = 40.0 + width(&key.label, font.size);
            if across > 0.0 && across + key_width > right {
                (across, down) = (0.0, down - 22.0);
            }
            svg.inset(&key.sign(), [across, down + 9.0]);
            svg.text([across + 28.0, down], &key.label, Anchor::Start, font);
            across += key_width;
        }
        down -= 14.0;
        for row in self.panels.chunks(columns) {
            for (column, panel) in row.iter().enumerate() {
                svg.inset(&panel.with_title(), [column as f64 * (PANEL_WIDTH + PANEL_GAP), down]);
            }
            down -= row.iter().map(|panel| panel.height + TITLE_HEIGHT).fold(0.0, f64::max) + 12.0;
        }
        let (lower, upper) = ([-FIGURE_MARGIN, down - 4.0], [right + FIGURE_MARGIN, FIGURE_MARGIN]);
        let svg = svg.finish(lower, upper, 1.0, colors.paper, &self.title);
        FigureFile { name: self.name.clone(), svg }
    }

    /// The plot as part of a [page](crate::Page).
    pub fn html(&self) -> Markup {
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
        let mut svg = Svg::default();
        let font = Font { size: 14.0, fill: Theme::Light.colors().ink, bold: true, halo: None };
        svg.text([0.0, -17.0], &self.title, Anchor::Start, font);
        svg.inset(&self.svg, [0.0, -TITLE_HEIGHT]);
        svg
    }

    fn svg(&self) -> String {
        let lower = [0.0, -self.height - TITLE_HEIGHT];
        self.with_title().finish(lower, [PANEL_WIDTH, 0.0], 1.0, Theme::Light.colors().paper, &self.title)
    }
}

impl Key {
    fn sign(&self) -> Svg {
        let mut svg = Svg::default();
        let style = mark_style(self.color, self.is_filled);
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

/// Style of a bar or dot, filled or hollow.
pub fn mark_style(color: &str, is_filled: bool) -> String {
    let fill = if is_filled { color } else { Theme::Light.colors().paper };
    format!(r#"fill="{fill}" stroke="{color}" stroke-width="1.4""#)
}

/// Draws an interval from `low` to `high` at height `y`, px.
pub fn whisker(svg: &mut Svg, [low, high]: [f64; 2], y: f64) {
    let style = format!(r#"stroke="{}" stroke-width="1.1""#, Theme::Light.colors().ink);
    svg.line([low, y], [high, y], &style);
    for end in [low, high] {
        svg.line([end, y - 2.5], [end, y + 2.5], &style);
    }
}

/// Width of a panel, px: two beside each other on a page, one on a phone with readable letters.
pub const PANEL_WIDTH: f64 = 440.0;
/// Height of a panel's title, px.
const TITLE_HEIGHT: f64 = 26.0;
/// Gap between panels, px.
const PANEL_GAP: f64 = 28.0;
/// Margin around a figure, px.
const FIGURE_MARGIN: f64 = 14.0;
