//! How do millimetres of the field become shapes of an SVG? Elements under a growing string; the one place where y turns.
//!
//! Everything is told in mm with y up, text beside the field included; the viewBox is in mm too.

use std::fmt::{Display, Write as _};

/// A place: mm, +y up.
pub(super) type At = [f64; 2];

/// An SVG under construction.
#[derive(Debug, Default)]
pub(super) struct Svg {
    body: String,
}

/// Where a text's anchor is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

/// How a text looks: size in mm, colour, weight.
#[derive(Clone, Copy, Debug)]
pub(super) struct Font<'a> {
    pub(super) size: f64,
    pub(super) fill: &'a str,
    pub(super) bold: bool,
    /// A line of this colour around the letters, so that they can be read over anything.
    pub(super) halo: Option<&'a str>,
}

impl Svg {
    /// A rectangle between two opposite corners; `style` is SVG attributes, here and below.
    pub(super) fn rect(&mut self, [x, y]: At, [to_x, to_y]: At, style: impl Display) {
        let (left, top, width, height) = (x.min(to_x), -y.max(to_y), (to_x - x).abs(), (to_y - y).abs());
        self.element(format_args!(
            r#"<rect x="{left:.1}" y="{top:.1}" width="{width:.1}" height="{height:.1}" {style}/>"#
        ));
    }

    pub(super) fn ellipse(&mut self, [x, y]: At, [rx, ry]: At, style: impl Display) {
        let y = -y;
        self.element(format_args!(r#"<ellipse cx="{x:.1}" cy="{y:.1}" rx="{rx:.1}" ry="{ry:.1}" {style}/>"#));
    }

    pub(super) fn circle(&mut self, at: At, radius: f64, style: impl Display) {
        self.ellipse(at, [radius, radius], style);
    }

    pub(super) fn line(&mut self, [x, y]: At, [to_x, to_y]: At, style: impl Display) {
        let (y, to_y) = (-y, -to_y);
        self.element(format_args!(
            r#"<line x1="{x:.1}" y1="{y:.1}" x2="{to_x:.1}" y2="{to_y:.1}" {style}/>"#
        ));
    }

    pub(super) fn polygon(&mut self, corners: &[At], style: impl Display) {
        let mut points = String::new();
        for [x, y] in corners {
            let gap = if points.is_empty() { "" } else { " " };
            let _ = write!(points, "{gap}{x:.1},{:.1}", -y);
        }
        self.element(format_args!(r#"<polygon points="{points}" {style}/>"#));
    }

    pub(super) fn text(&mut self, [x, y]: At, text: &str, anchor: Anchor, font: Font<'_>) {
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

    /// `inner` with its origin at `at`.
    pub(super) fn inset(&mut self, inner: &Self, [x, y]: At) {
        let (body, y) = (&inner.body, -y);
        self.element(format_args!("<g transform=\"translate({x:.1} {y:.1})\">\n{body}</g>"));
    }

    /// `inner` over what is there, as opaque as that.
    pub(super) fn group_with(&mut self, inner: &Self, opacity: &str) {
        let body = &inner.body;
        self.element(format_args!("<g opacity=\"{opacity}\">\n{body}</g>"));
    }

    /// The whole picture: what lies between the two corners, `px_per_mm` large on a screen.
    pub(super) fn finish(
        self,
        [left, bottom]: At,
        [right, top]: At,
        px_per_mm: f64,
        paper: &str,
        title: &str,
    ) -> String {
        let (width, height, y) = (right - left, top - bottom, -top);
        let (w, h) = (width * px_per_mm, height * px_per_mm);
        let (title, body) = (escaped(title), self.body);
        format!(
            concat!(
                r#"<svg xmlns="http://www.w3.org/2000/svg" width="{w:.0}" height="{h:.0}" "#,
                r#"viewBox="{left:.0} {y:.0} {width:.0} {height:.0}" font-family="{fonts}">"#,
                "\n<title>{title}</title>\n",
                r#"<rect x="{left:.0}" y="{y:.0}" width="{width:.0}" height="{height:.0}" fill="{paper}"/>"#,
                "\n{body}</svg>\n"
            ),
            w = w,
            h = h,
            left = left,
            y = y,
            width = width,
            height = height,
            fonts = FONTS,
            title = title,
            paper = paper,
            body = body
        )
    }

    fn element(&mut self, element: impl Display) {
        let _ = writeln!(self.body, "{element}");
    }
}

/// Text from outside cannot break the picture: XML's signs are escaped, what XML forbids is left out.
fn escaped(text: &str) -> String {
    let allowed = text.chars().filter(|c| !c.is_control() && !matches!(c, '\u{fffe}' | '\u{ffff}'));
    allowed.collect::<String>().replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

/// About how wide a text is, mm: the mean advance of a wide sans-serif.
pub(super) fn width(text: &str, size: f64) -> f64 {
    text.chars().count() as f64 * size * 0.57
}

/// `text` in lines of at most `room` mm.
pub(super) fn wrapped(text: &str, size: f64, room: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if width(line, size) + width(word, size) + size * 0.57 <= room => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

const FONTS: &str = "DejaVu Sans, Helvetica, Arial, sans-serif";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn up_on_the_field_is_up_on_the_picture() {
        let mut svg = Svg::default();
        svg.circle([100.0, 250.0], 30.0, "");
        assert!(svg.body.contains(r#"cx="100.0" cy="-250.0" rx="30.0""#), "{}", svg.body);
    }

    #[test]
    fn words_from_outside_cannot_break_the_picture() {
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
