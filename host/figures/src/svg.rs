//! `svg`: SVG elements appended to a growing string; the only code that flips y.
//!
//! Figures of the field have coordinates in mm with y up, text beside the field included; charts in px. The
//! viewBox is in the same unit.

use std::fmt::{Display, Write as _};

/// A point: mm or px, +y up.
pub type At = [f64; 2];

/// An SVG under construction.
#[derive(Debug, Default)]
pub struct Svg {
    body: String,
}

/// Position of a text's anchor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    /// The text starts at its anchor (SVG `start`).
    Start,
    /// The text is centred on its anchor (SVG `middle`).
    Middle,
    /// The text ends at its anchor (SVG `end`).
    End,
}

/// Style of a text.
#[derive(Clone, Copy, Debug)]
pub struct Font<'a> {
    /// Font size in the unit of the figure: mm on fields, px in charts.
    pub size: f64,
    /// Colour of the letters, as SVG writes it.
    pub fill: &'a str,
    /// Bold letters if true, else the normal weight.
    pub bold: bool,
    /// A line of this colour around the letters, so that they can be read over anything.
    pub halo: Option<&'a str>,
}

impl Svg {
    /// A rectangle between two opposite corners; `style` is SVG attributes, here and below.
    pub fn rect(&mut self, [x, y]: At, [to_x, to_y]: At, style: impl Display) {
        let (left, top, width, height) = (x.min(to_x), -y.max(to_y), (to_x - x).abs(), (to_y - y).abs());
        self.element(format_args!(
            r#"<rect x="{left:.1}" y="{top:.1}" width="{width:.1}" height="{height:.1}" {style}/>"#
        ));
    }

    /// An ellipse by its centre and radii.
    pub fn ellipse(&mut self, [x, y]: At, [rx, ry]: At, style: impl Display) {
        let y = -y;
        self.element(format_args!(r#"<ellipse cx="{x:.1}" cy="{y:.1}" rx="{rx:.1}" ry="{ry:.1}" {style}/>"#));
    }

    /// Appends a circle around `at`; `radius` in the figure's unit, `style` as SVG attributes.
    pub fn circle(&mut self, at: At, radius: f64, style: impl Display) {
        self.ellipse(at, [radius, radius], style);
    }

    /// Appends a straight line between two points; `style` as SVG attributes.
    pub fn line(&mut self, [x, y]: At, [to_x, to_y]: At, style: impl Display) {
        let (y, to_y) = (-y, -to_y);
        self.element(format_args!(
            r#"<line x1="{x:.1}" y1="{y:.1}" x2="{to_x:.1}" y2="{to_y:.1}" {style}/>"#
        ));
    }

    /// Straight segments through these points, not closed; nothing for fewer than two.
    pub fn polyline(&mut self, places: &[At], style: impl Display) {
        if places.len() > 1 {
            self.element(format_args!(r#"<polyline points="{}" fill="none" {style}/>"#, points(places)));
        }
    }

    /// An arrow whose head, of length `head` but no longer than the arrow, has its tip at `to`; nothing
    /// without a length.
    pub fn arrow(&mut self, from: At, to: At, head: f64, color: &str, line: impl Display) {
        let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
        let length = dx.hypot(dy);
        if length <= 0.0 {
            return;
        }
        let head = head.min(length);
        let (ux, uy) = (dx / length, dy / length);
        let back = [to[0] - ux * head, to[1] - uy * head];
        self.line(from, back, format_args!(r#"stroke="{color}" {line}"#));
        self.arrowhead(to, [ux, uy], head, color);
    }

    /// A filled head that points in the direction of the unit vector `along`, its tip at `to`.
    pub fn arrowhead(&mut self, to: At, [ux, uy]: At, head: f64, color: &str) {
        let (back, side) = ([to[0] - ux * head, to[1] - uy * head], head * 0.42);
        let corners =
            [to, [back[0] - uy * side, back[1] + ux * side], [back[0] + uy * side, back[1] - ux * side]];
        self.polygon(&corners, format_args!(r#"fill="{color}""#));
    }

    /// Appends a closed polygon through `corners`, in their order; `style` as SVG attributes.
    pub fn polygon(&mut self, corners: &[At], style: impl Display) {
        self.element(format_args!(r#"<polygon points="{}" {style}/>"#, points(corners)));
    }

    /// A line of text on the baseline at `at`.
    pub fn text(&mut self, [x, y]: At, text: &str, anchor: Anchor, font: Font<'_>) {
        let anchor = match anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        let (text, y, Font { size, fill, bold, halo }) = (escaped(text), -y, font);
        let weight = if bold { r#" font-weight="bold""# } else { "" };
        let halo = halo.map_or_else(String::new, |halo| {
            let width = size * 0.22;
            format!(
                r#" stroke="{halo}" stroke-width="{width:.1}" stroke-linejoin="round" paint-order="stroke""#
            )
        });
        self.element(format_args!(
            r#"<text x="{x:.1}" y="{y:.1}" font-size="{size:.0}" text-anchor="{anchor}" fill="{fill}"{weight}{halo}>{text}</text>"#
        ));
    }

    /// Appends `inner` with its origin at `at`.
    pub fn inset(&mut self, inner: &Self, [x, y]: At) {
        let (body, y) = (&inner.body, -y);
        self.element(format_args!("<g transform=\"translate({x:.1} {y:.1})\">\n{body}</g>"));
    }

    /// Appends `inner`, drawn with these attributes.
    pub fn group(&mut self, inner: &Self, style: impl Display) {
        let body = &inner.body;
        self.element(format_args!("<g {style}>\n{body}</g>"));
    }

    /// The whole figure: the rectangle between the two corners, with `px_per_unit` as its scale on a screen.
    pub fn finish(
        self,
        [left, bottom]: At,
        [right, top]: At,
        px_per_unit: f64,
        paper: &str,
        title: &str,
    ) -> String {
        let (width, height, y) = (right - left, top - bottom, -top);
        let (w, h) = (width * px_per_unit, height * px_per_unit);
        let (title, body) = (escaped(title), self.body);
        let size = format!(r#"width="{w:.0}" height="{h:.0}""#);
        let view = format!(r#"viewBox="{left:.0} {y:.0} {width:.0} {height:.0}""#);
        let background = format!(
            r#"<rect x="{left:.0}" y="{y:.0}" width="{width:.0}" height="{height:.0}" fill="{paper}"/>"#
        );
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" {size} {view} font-family=\"{FONT_FAMILIES}\">\n\
             <title>{title}</title>\n{background}\n{body}</svg>\n"
        )
    }

    /// One element without a function of its own; the caller escapes text from outside.
    pub fn element(&mut self, element: impl Display) {
        let _ = writeln!(self.body, "{element}");
    }
}

fn points(places: &[At]) -> String {
    let mut points = String::new();
    for [x, y] in places {
        let gap = if points.is_empty() { "" } else { " " };
        let _ = write!(points, "{gap}{x:.1},{:.1}", -y);
    }
    points
}

/// Escapes XML's special characters and leaves out those that XML forbids, so that text from outside cannot
/// break the figure.
fn escaped(text: &str) -> String {
    let allowed = text.chars().filter(|c| !c.is_control() && !matches!(c, '\u{fffe}' | '\u{ffff}'));
    allowed.collect::<String>().replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

/// Approximate width of a text, in the unit of its size: the mean advance of a wide sans-serif.
pub fn width(text: &str, size: f64) -> f64 {
    text.chars().count() as f64 * size * 0.57
}

/// `text` in lines of at most that width.
pub fn wrapped(text: &str, size: f64, room: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for label in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if width(line, size) + width(label, size) + size * 0.57 <= room => {
                line.push(' ');
                line.push_str(label);
            }
            _ => lines.push(label.to_owned()),
        }
    }
    lines
}

const FONT_FAMILIES: &str = "DejaVu Sans, Helvetica, Arial, sans-serif";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn up_on_the_field_is_up_on_the_figure() {
        let mut svg = Svg::default();
        svg.circle([100.0, 250.0], 30.0, "");
        assert!(svg.body.contains(r#"cx="100.0" cy="-250.0" rx="30.0""#), "{}", svg.body);
    }

    #[test]
    fn an_arrow_ends_at_its_tip() {
        let mut svg = Svg::default();
        svg.arrow([0.0, 0.0], [100.0, 0.0], 20.0, "red", "");
        // The head's foot is 20 back and 0.42 × 20 to either side.
        assert!(svg.body.contains(r#"x2="80.0" y2="-0.0""#), "{}", svg.body);
        assert!(svg.body.contains(r#"points="100.0,-0.0 80.0,-8.4 80.0,8.4""#), "{}", svg.body);
        let mut short = Svg::default();
        short.arrow([5.0, 5.0], [5.0, 5.0], 20.0, "red", "");
        assert_eq!(short.body, "");
    }

    #[test]
    fn text_from_outside_cannot_break_the_figure() {
        let mut svg = Svg::default();
        let font = Font { size: 10.0, fill: "black", bold: false, halo: None };
        svg.text([0.0, 0.0], "a<b & c>d\u{7}", Anchor::Start, font);
        assert!(svg.body.contains(">a&lt;b &amp; c&gt;d</text>"), "{}", svg.body);
    }

    #[test]
    fn a_long_text_is_wrapped_into_its_room() {
        // 0.57 × 10 mm a letter: ten letters fit into 58 mm.
        assert_eq!(wrapped("pass to the other side", 10.0, 58.0), ["pass to", "the other", "side"]);
    }
}
