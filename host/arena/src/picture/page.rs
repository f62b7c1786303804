//! `page`: mapping from field to sheet coordinates. Pixels from the sheet's upper left corner, drawn with the
//! project's one writer.

use figures::{Anchor, At, Font, Svg, Theme, draw_field};
use geometry::{Field, Point};
use rules::League;

/// A place on the sheet, px from its upper left corner.
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

    /// Converts to the writer's coordinates: y up.
    fn at(self) -> At {
        [f64::from(self.x), -f64::from(self.y)]
    }
}

/// Pixels per metre.
pub(super) const SCALE: f32 = 160.0;

/// A sheet under construction.
pub(super) struct Page {
    svg: Svg,
    /// Place of the field's centre.
    origin: Px,
}

impl Page {
    /// Sheet with the four-legged field on it.
    pub(super) fn new(origin: Px) -> Self {
        let colors = Theme::Light.colors();
        let mut field = Svg::default();
        draw_field(&mut field, &case_library::four_legged().field(), colors);
        let radius = f64::from(League::FourLegged.field().center_radius) * 1000.0;
        field.circle(
            [0.0, 0.0],
            radius,
            format!(r#"fill="none" stroke="{}" stroke-width="25""#, colors.line),
        );
        let mut svg = Svg::default();
        let (Px { x, y }, px_per_mm) = (origin, SCALE / 1000.0);
        svg.group(&field, format!(r#"transform="translate({x} {y}) scale({px_per_mm})""#));
        Self { svg, origin }
    }

    pub(super) fn place(&self, point: Point<Field>) -> Px {
        self.origin.moved(point.x() * SCALE, -point.y() * SCALE)
    }

    /// A rectangle; `style` is SVG attributes.
    pub(super) fn rect(&mut self, corner: Px, width: f32, height: f32, style: &str) {
        self.svg.rect(corner.at(), corner.moved(width, height).at(), style);
    }

    pub(super) fn circle(&mut self, center: Px, radius: f32, style: &str) {
        self.svg.circle(center.at(), f64::from(radius), style);
    }

    pub(super) fn line(&mut self, from: Px, to: Px, style: &str) {
        self.svg.line(from.at(), to.at(), style);
    }

    /// Straight stretches through `points`; nothing for fewer than two.
    pub(super) fn path(&mut self, points: &[Px], style: &str) {
        let places: Vec<_> = points.iter().map(|point| point.at()).collect();
        self.svg.polyline(&places, style);
    }

    /// A filled arrowhead of this length whose tip is at `tip`.
    pub(super) fn arrowhead(&mut self, tip: Px, (dx, dy): (f32, f32), length: f32, color: &str) {
        let norm = geometry::math::hypot(dx, dy);
        if norm > 0.0 {
            let along = [f64::from(dx / norm), -f64::from(dy / norm)];
            self.svg.arrowhead(tip.at(), along, f64::from(length), color);
        }
    }

    pub(super) fn text(&mut self, at: Px, text: &str, anchor: Anchor, font: Font<'_>) {
        self.svg.text(at.at(), text, anchor, font);
    }

    pub(super) fn finish(self, width: f32, height: f32, title: &str) -> String {
        let (right, bottom) = (f64::from(width), -f64::from(height));
        self.svg.finish([0.0, bottom], [right, 0.0], 1.0, Theme::Light.colors().paper, title)
    }
}

pub(super) const fn font(size: f64, fill: &str) -> Font<'_> {
    Font { size, fill, bold: false, halo: None }
}

pub(super) const fn bold(size: f64, fill: &str) -> Font<'_> {
    Font { size, fill, bold: true, halo: None }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn up_on_the_field_is_up_on_the_snapshot() {
        let page = Page::new(Px::new(500.0, 400.0));
        assert_eq!(page.place(Point::new(1.0, 0.5)), Px::new(660.0, 320.0));
        assert_eq!(Px::new(660.0, 320.0).at(), [660.0, -320.0]);
    }
}
