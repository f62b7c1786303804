//! `rows`: rows of dots with error bars. A scenario a row, the numbers beside the whiskers.

use brain::Approach;
use figures::{Anchor, Font, Svg, Theme};

use super::axis::{Axis, BELOW, GRID};
use super::{PANEL, Panel, style};
use crate::description;

/// A number with its interval.
#[derive(Clone, Debug)]
pub(crate) struct Dot {
    pub(crate) approach: Approach,
    pub(crate) ours: bool,
    pub(crate) value: f64,
    /// Its interval.
    pub(crate) reach: Option<(f64, f64)>,
    /// Its printed form.
    pub(crate) text: String,
}

/// Dots of one name.
#[derive(Clone, Debug)]
pub(crate) struct Row {
    pub(crate) name: String,
    pub(crate) dots: Vec<Dot>,
}

/// Rows below each other.
pub(crate) fn panel(title: String, unit: &str, rows: &[Row], axis: Axis) -> Panel {
    let colors = Theme::Light.colors();
    let mut svg = Svg::default();
    let height: f64 = rows.iter().map(|row| height(&row.dots)).sum();
    axis.draw(&mut svg, 0.0, -height, unit);
    let font = Font { size: 13.0, fill: colors.ink, bold: false, halo: None };
    let mut top = 0.0;
    for Row { name, dots } in rows {
        if top < 0.0 {
            svg.line([0.0, top], [PANEL - RIGHT, top], format!(r#"stroke="{GRID}" stroke-width="1""#));
        }
        let below = top - self::height(dots);
        svg.text([LEFT - 10.0, f64::midpoint(top, below) - 4.5], name, Anchor::End, font);
        for (i, dot) in dots.iter().enumerate() {
            dot.draw(&mut svg, axis, top - BETWEEN * 0.5 - DOT * (i as f64 + 0.5));
        }
        top = below;
    }
    Panel { title, svg, height: height + BELOW }
}

/// An axis that leaves space for names on the left and numbers on the right.
pub(crate) fn axis(low: f64, high: f64) -> Axis {
    Axis::between(low, high, LEFT, PANEL - RIGHT)
}

fn height(dots: &[Dot]) -> f64 {
    dots.len() as f64 * DOT + BETWEEN
}

impl Dot {
    fn draw(&self, svg: &mut Svg, axis: Axis, y: f64) {
        let colors = Theme::Light.colors();
        let at = axis.place(self.value);
        let (low, high) = self.reach.map_or((at, at), |(low, high)| (axis.place(low), axis.place(high)));
        let color = description::color(self.approach);
        if high > low {
            svg.line([low, y], [high, y], format!(r#"stroke="{color}" stroke-width="1.8""#));
        }
        svg.circle([at, y], RADIUS, style(self.approach, self.ours));
        let fill = if self.ours { colors.ink } else { colors.faint };
        let font = Font { size: 10.5, fill, bold: self.ours, halo: Some(colors.paper) };
        // Placed away from zero, whose line would cross it.
        let (x, anchor) = if self.value < 0.0 {
            (low.min(at - RADIUS) - GAP, Anchor::End)
        } else {
            (high.max(at + RADIUS) + GAP, Anchor::Start)
        };
        svg.text([x, y - 3.8], &self.text, anchor, font);
    }
}

/// Where the axis starts, px: after the scenarios' names.
const LEFT: f64 = 140.0;
/// Space for the numbers behind the last dot, px.
const RIGHT: f64 = 40.0;
/// Height of a dot with the gap to the next, px.
const DOT: f64 = 13.0;
/// Gap between scenarios, px.
const BETWEEN: f64 = 12.0;
const RADIUS: f64 = 4.2;
/// Gap between a number and the sign left of it, px.
const GAP: f64 = 4.0;
