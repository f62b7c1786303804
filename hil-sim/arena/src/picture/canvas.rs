//! How do metres of the field become shapes of an SVG? A list of shapes under a growing string; y points up on the field.

use std::fmt::{Display, Write as _};

use geometry::{Field, Point};

/// A place on the picture, px from its upper left corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Px {
    pub(super) x: f32,
    pub(super) y: f32,
}

impl Px {
    pub(super) const fn new(x: f32, y: f32) -> Self {
        Self { x, y }
    }

    pub(super) fn moved(self, dx: f32, dy: f32) -> Self {
        Self { x: self.x + dx, y: self.y + dy }
    }

    pub(super) fn distance(self, other: Self) -> f32 {
        geometry::math::hypot(self.x - other.x, self.y - other.y)
    }
}

/// Pixels per metre.
pub(super) const SCALE: f32 = 160.0;

/// An SVG under construction.
pub(super) struct Canvas {
    body: String,
    /// Where the field's centre is.
    origin: Px,
}

impl Canvas {
    pub(super) fn new(origin: Px) -> Self {
        Self { body: String::new(), origin }
    }

    /// Where a point of the field is on the picture.
    pub(super) fn place(&self, point: Point<Field>) -> Px {
        self.origin.moved(point.x() * SCALE, -point.y() * SCALE)
    }

    /// A rectangle; `style` is SVG attributes.
    pub(super) fn rect(&mut self, corner: Px, width: f32, height: f32, style: impl Display) {
        let Px { x, y } = corner;
        let _ = writeln!(
            self.body,
            r#"<rect x="{x:.1}" y="{y:.1}" width="{width:.1}" height="{height:.1}" {style}/>"#
        );
    }

    pub(super) fn circle(&mut self, center: Px, radius: f32, style: impl Display) {
        let Px { x, y } = center;
        let _ = writeln!(self.body, r#"<circle cx="{x:.1}" cy="{y:.1}" r="{radius:.1}" {style}/>"#);
    }

    pub(super) fn line(&mut self, from: Px, to: Px, style: impl Display) {
        self.path(&[from, to], style);
    }

    /// Straight stretches through `points`; nothing for fewer than two.
    pub(super) fn path(&mut self, points: &[Px], style: impl Display) {
        if points.len() < 2 {
            return;
        }
        let mut d = String::new();
        for (i, p) in points.iter().enumerate() {
            let _ = write!(d, "{}{:.1} {:.1}", if i == 0 { "M" } else { "L" }, p.x, p.y);
        }
        let _ = writeln!(self.body, r#"<path d="{d}" fill="none" {style}/>"#);
    }

    /// A filled arrowhead of that length whose tip is at `tip`.
    pub(super) fn arrowhead(&mut self, tip: Px, (dx, dy): (f32, f32), length: f32, color: &str) {
        let norm = geometry::math::hypot(dx, dy);
        if norm <= 0.0 {
            return;
        }
        let (ux, uy) = (dx / norm, dy / norm);
        let back = tip.moved(-ux * length, -uy * length);
        let half = length * 0.45;
        let (a, b) = (back.moved(-uy * half, ux * half), back.moved(uy * half, -ux * half));
        let _ = writeln!(
            self.body,
            r#"<path d="M{:.1} {:.1}L{:.1} {:.1}L{:.1} {:.1}Z" fill="{color}" stroke="white" stroke-width="1"/>"#,
            tip.x, tip.y, a.x, a.y, b.x, b.y
        );
    }

    /// Text whose anchor and size are in `style`.
    pub(super) fn text(&mut self, at: Px, text: &str, style: impl Display) {
        let escaped = text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
        let Px { x, y } = at;
        let _ = writeln!(self.body, r#"<text x="{x:.1}" y="{y:.1}" {style}>{escaped}</text>"#);
    }

    /// The whole picture.
    pub(super) fn finish(self, width: f32, height: f32, title: &str) -> String {
        let title = title.replace('&', "&amp;").replace('<', "&lt;");
        format!(
            concat!(
                r#"<svg xmlns="http://www.w3.org/2000/svg" width="{w:.0}" height="{h:.0}" viewBox="0 0 {w:.0} {h:.0}" "#,
                r#"font-family="Helvetica, Arial, 'DejaVu Sans', sans-serif">"#,
                "\n<title>{title}</title>\n",
                r#"<rect width="{w:.0}" height="{h:.0}" fill="white"/>"#,
                "\n{body}</svg>\n"
            ),
            w = width,
            h = height,
            title = title,
            body = self.body
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn up_on_the_field_is_up_on_the_picture() {
        let canvas = Canvas::new(Px::new(500.0, 400.0));
        assert_eq!(canvas.place(Point::new(1.0, 0.5)), Px::new(660.0, 320.0));
    }

    #[test]
    fn names_from_outside_cannot_break_the_picture() {
        let mut canvas = Canvas::new(Px::new(0.0, 0.0));
        canvas.text(Px::new(0.0, 0.0), "a<b & c>d", "");
        let svg = canvas.finish(10.0, 10.0, "x & <y");
        assert!(svg.contains("a&lt;b &amp; c&gt;d") && svg.contains("<title>x &amp; &lt;y</title>"));
    }
}
