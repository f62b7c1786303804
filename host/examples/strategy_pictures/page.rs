//! `page`: layout of the figures. Panels with a field of any league, robots, the ball, and areas of equal
//! value.
//!
//! Places are given in metres of the attack frame; the figure is in px with y up (`figures`).

use std::fmt::{Display, Write as _};

use figures::{Anchor, At, Colors, Font, Svg, Theme, field_lines};
use geometry::{Angle, Attack, Point};
use rules::FieldSpec;

/// Font size of sans-serif text, px.
pub(crate) const TEXT_SIZE_PX: f64 = 14.0;
/// Gap around and between panels, px.
pub(crate) const GAP_PX: f64 = 16.0;
/// Opponents' tactics, and everything else that needs four colours that readers with any colour vision can
/// distinguish (Okabe and Ito).
pub(crate) const BLUE: &str = "#0072b2";
pub(crate) const GREEN: &str = "#009e73";
pub(crate) const RED: &str = "#d55e00";
pub(crate) const PURPLE: &str = "#cc79a7";
/// Our robots, as in the paper's figures.
pub(crate) const YELLOW: &str = "#f0e442";

/// A part of the field on the page.
pub(crate) struct Panel {
    pub(crate) svg: Svg,
    pub(crate) colors: &'static Colors,
    field: FieldSpec,
    low: Point<Attack>,
    high: Point<Attack>,
    /// Lower left corner, px.
    corner: At,
    /// Scale, px per m.
    scale: f64,
}

impl Panel {
    /// The part of the field between two corners, `scale` px a metre, with its lower left corner at `corner`.
    pub(crate) fn new(field: FieldSpec, [low, high]: [Point<Attack>; 2], corner: At, scale: f64) -> Self {
        let colors = Theme::Light.colors();
        let mut panel = Self { svg: Svg::default(), colors, field, low, high, corner, scale };
        let (from, to) = (panel.at(low), panel.at(high));
        panel.svg.rect(from, to, format_args!(r#"fill="{}""#, colors.surface));
        panel
    }

    /// The whole field with a margin.
    pub(crate) fn whole(field: FieldSpec, corner: At, scale: f64) -> Self {
        let (x, y) = (field.length * 0.5 + 0.3, field.width * 0.5 + 0.25);
        Self::new(field, [Point::new(-x, -y), Point::new(x, y)], corner, scale)
    }

    /// Width and height, px.
    pub(crate) fn size(&self) -> At {
        let size = self.high - self.low;
        [f64::from(size.x()) * self.scale, f64::from(size.y()) * self.scale]
    }

    /// A place on the page.
    pub(crate) fn at(&self, place: Point<Attack>) -> At {
        let off = place - self.low;
        [self.corner[0] + f64::from(off.x()) * self.scale, self.corner[1] + f64::from(off.y()) * self.scale]
    }

    /// Metres in px.
    pub(crate) fn px(&self, metres: f32) -> f64 {
        f64::from(metres) * self.scale
    }

    /// Draws lines, areas and goals.
    pub(crate) fn lines(&mut self) {
        let mut field = Svg::default();
        field_lines(&mut field, &self.field, self.colors, self.colors.line);
        // Down is positive in SVG.
        let [x, y] = self.at(Point::new(0.0, 0.0));
        let px_per_mm = self.scale * 1e-3;
        let mut placed = Svg::default();
        placed.group(&field, format_args!(r#"transform="translate({x:.1} {:.1}) scale({px_per_mm})""#, -y));
        self.clipped(&placed);
    }

    /// Parts beyond the panel are cut off.
    pub(crate) fn clipped(&mut self, inner: &Svg) {
        let name = format!("panel-{:.0}-{:.0}", self.corner[0], self.corner[1]);
        self.svg.element(format_args!(r#"<clipPath id="{name}">"#));
        let (low, high) = (self.at(self.low), self.at(self.high));
        self.svg.rect(low, high, "");
        self.svg.element("</clipPath>");
        self.svg.group(inner, format_args!(r#"clip-path="url(#{name})""#));
    }

    /// A robot of ours: a disc with its number.
    pub(crate) fn ours(&mut self, at: Point<Attack>, name: &str, fill: &str) {
        let (place, radius) = (self.at(at), self.px(0.09));
        let style = format!(r##"fill="{fill}" stroke="#1b1b1b" stroke-width="1.5""##);
        self.svg.circle(place, radius, style);
        self.label([place[0], place[1] - radius * 0.5], name, Anchor::Middle, radius * 1.4, self.colors.ink);
    }

    /// A robot of theirs: a square.
    pub(crate) fn theirs(&mut self, at: Point<Attack>, fill: &str, stroke: &str) {
        let ([x, y], r) = (self.at(at), self.px(0.08));
        self.svg.rect(
            [x - r, y - r],
            [x + r, y + r],
            format_args!(r#"fill="{fill}" stroke="{stroke}" stroke-width="1.8" rx="2""#),
        );
    }

    /// The ball, a little larger than it is.
    pub(crate) fn ball(&mut self, at: Point<Attack>) {
        let (place, radius) = (self.at(at), self.px(0.05));
        self.svg.circle(
            place,
            radius,
            format_args!(r##"fill="{}" stroke="#1b1b1b" stroke-width="1.2""##, self.colors.ball),
        );
    }

    /// An arrow between two places.
    pub(crate) fn arrow(&mut self, from: Point<Attack>, to: Point<Attack>, color: &str, style: impl Display) {
        let (from, to) = (self.at(from), self.at(to));
        self.svg.arrow(from, to, 11.0, color, style);
    }

    /// Text at a place of the page, px.
    pub(crate) fn label(&mut self, at: At, text: &str, anchor: Anchor, size: f64, fill: &str) {
        self.svg.text(at, text, anchor, Font { size, fill, bold: false, halo: None });
    }

    /// Text at a place of the field, readable over any background.
    pub(crate) fn note(&mut self, at: Point<Attack>, up: f64, text: &str, anchor: Anchor) {
        let ([x, y], ink) = (self.at(at), self.colors.ink);
        self.svg.text(
            [x, y + up],
            text,
            anchor,
            Font { size: TEXT_SIZE_PX - 2.0, fill: ink, bold: false, halo: Some("#ffffff") },
        );
    }

    /// The panel's title above it.
    pub(crate) fn title(&mut self, text: &str) {
        let ([x, y], ink) = (self.at(Point::new(self.low.x(), self.high.y())), self.colors.ink);
        self.svg.text(
            [x, y + 8.0],
            text,
            Anchor::Start,
            Font { size: TEXT_SIZE_PX, fill: ink, bold: true, halo: None },
        );
    }

    /// Fills the area where `value` is at least `level`: cells of `step` m, their borders straight between
    /// corners.
    pub(crate) fn area_above(
        &mut self,
        step: f32,
        level: f32,
        style: impl Display,
        value: impl Fn(Point<Attack>) -> f32,
    ) {
        let size = self.high - self.low;
        let (columns, rows) = ((size.x() / step).ceil() as usize, (size.y() / step).ceil() as usize);
        let corner = |c: usize, r: usize| {
            let x = (self.low.x() + c as f32 * step).min(self.high.x());
            Point::new(x, (self.low.y() + r as f32 * step).min(self.high.y()))
        };
        let above: Vec<Vec<f32>> =
            (0..=rows).map(|r| (0..=columns).map(|c| value(corner(c, r)) - level).collect()).collect();
        let mut path = String::new();
        let mut add = |corners: &[Point<Attack>]| {
            for (i, place) in corners.iter().enumerate() {
                let [x, y] = self.at(*place);
                let _ = write!(path, "{}{x:.1} {:.1}", if i == 0 { "M" } else { "L" }, -y);
            }
            path.push('Z');
        };
        for r in 0..rows {
            let mut run: Option<usize> = None;
            for c in 0..=columns {
                let cell = [(c, r), (c + 1, r), (c + 1, r + 1), (c, r + 1)];
                let heights = (c < columns).then(|| cell.map(|(c, r)| above[r][c]));
                let full = heights.is_some_and(|heights| heights.iter().all(|h| *h >= 0.0));
                match (run, full) {
                    (None, true) => run = Some(c),
                    (Some(from), false) => {
                        add(&[corner(from, r), corner(c, r), corner(c, r + 1), corner(from, r + 1)]);
                        run = None;
                    }
                    _ => {}
                }
                let Some(heights) = heights.filter(|heights| !full && heights.iter().any(|h| *h > 0.0))
                else {
                    continue;
                };
                let places = cell.map(|(c, r)| corner(c, r));
                let mut inside = Vec::new();
                for i in 0..4 {
                    let (a, b) = (heights[i], heights[(i + 1) % 4]);
                    if a >= 0.0 {
                        inside.push(places[i]);
                    }
                    if (a >= 0.0) != (b >= 0.0) {
                        inside.push(places[i] + (places[(i + 1) % 4] - places[i]) * (a / (a - b)));
                    }
                }
                add(&inside);
            }
        }
        if !path.is_empty() {
            self.svg.element(format_args!(r#"<path d="{path}" {style}/>"#));
        }
    }
}

/// The point at distance `by` from `from` in that direction, m.
pub(crate) fn polar(from: Point<Attack>, direction: Angle, by: f32) -> Point<Attack> {
    from + geometry::Vector::polar(by, direction)
}

/// Panels on one page, `size` px, with a legend's lines below.
pub(crate) fn finish(panels: &[&Svg], [width, height]: At, legend: &Svg, title: &str) -> String {
    let mut page = Svg::default();
    for panel in panels.iter().copied().chain([legend]) {
        page.group(panel, "");
    }
    page.finish([0.0, 0.0], [width, height], 1.0, Theme::Light.colors().paper, title)
}

/// Lines of text, px from the top down.
pub(crate) fn lines_of_text(svg: &mut Svg, [x, top]: At, room: f64, text: &str) {
    let fill = Theme::Light.colors().faint;
    for (i, line) in figures::wrapped(text, TEXT_SIZE_PX, room).iter().enumerate() {
        svg.text(
            [x, top - 19.0 * i as f64],
            line,
            Anchor::Start,
            Font { size: TEXT_SIZE_PX, fill, bold: false, halo: None },
        );
    }
}
