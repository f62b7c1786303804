//! `dots`: rows of dots with their intervals on one axis, the numbers beside the whiskers.

use crate::axis::{AXIS_HEIGHT, Axis, GRID_COLOR};
use crate::plot::{PANEL_WIDTH, Panel, mark_style};
use crate::{Anchor, Font, Svg, Theme};

/// A number with its interval.
#[derive(Clone, Debug)]
pub struct Dot {
    /// Colour of dot and interval.
    pub color: &'static str,
    /// Filled, with its number in bold letters, if true; else hollow.
    pub is_filled: bool,
    /// The number.
    pub value: f64,
    /// Ends of the interval, if it has one.
    pub interval: Option<(f64, f64)>,
    /// The number as it is printed.
    pub text: String,
}

/// Dots of one name.
#[derive(Clone, Debug)]
pub struct DotRow {
    /// The name, left of the axis.
    pub name: String,
    /// The dots, from the top.
    pub dots: Vec<Dot>,
}

/// Rows below each other, on an [axis](dot_axis) in this unit.
pub fn dot_panel(title: String, unit: &str, rows: &[DotRow], axis: &Axis) -> Panel {
    let colors = Theme::Light.colors();
    let mut svg = Svg::default();
    let height: f64 = rows.iter().map(DotRow::height).sum();
    axis.draw_below(&mut svg, 0.0, -height, unit);
    let font = Font { size: 13.0, fill: colors.ink, bold: false, halo: None };
    let mut top = 0.0;
    for row in rows {
        if top < 0.0 {
            let style = format!(r#"stroke="{GRID_COLOR}" stroke-width="1""#);
            svg.line([0.0, top], [PANEL_WIDTH - NUMBERS_WIDTH, top], style);
        }
        let below = top - row.height();
        svg.text([AXIS_LEFT - 10.0, f64::midpoint(top, below) - 4.5], &row.name, Anchor::End, font);
        for (i, dot) in row.dots.iter().enumerate() {
            dot.draw(&mut svg, axis, top - ROW_GAP * 0.5 - DOT_HEIGHT * (i as f64 + 0.5));
        }
        top = below;
    }
    Panel { title, svg, height: height + AXIS_HEIGHT }
}

/// An axis that leaves space for names on the left and numbers on the right.
pub fn dot_axis(low: f64, high: f64) -> Axis {
    Axis::linear([low, high], [AXIS_LEFT, PANEL_WIDTH - NUMBERS_WIDTH])
}

impl DotRow {
    fn height(&self) -> f64 {
        self.dots.len() as f64 * DOT_HEIGHT + ROW_GAP
    }
}

impl Dot {
    fn draw(&self, svg: &mut Svg, axis: &Axis, y: f64) {
        let colors = Theme::Light.colors();
        let at = axis.place(self.value);
        let (low, high) = self.interval.map_or((at, at), |(low, high)| (axis.place(low), axis.place(high)));
        if high > low {
            svg.line([low, y], [high, y], format!(r#"stroke="{}" stroke-width="1.8""#, self.color));
        }
        svg.circle([at, y], DOT_RADIUS, mark_style(self.color, self.is_filled));
        let fill = if self.is_filled { colors.ink } else { colors.faint };
        let font = Font { size: 10.5, fill, bold: self.is_filled, halo: Some(colors.paper) };
        // Placed away from zero, whose line would cross it.
        let (x, anchor) = if self.value < 0.0 {
            (low.min(at - DOT_RADIUS) - NUMBER_GAP, Anchor::End)
        } else {
            (high.max(at + DOT_RADIUS) + NUMBER_GAP, Anchor::Start)
        };
        svg.text([x, y - 3.8], &self.text, anchor, font);
    }
}

/// Left end of the axis, px: behind the rows' names.
const AXIS_LEFT: f64 = 140.0;
/// Space for the numbers behind the last dot, px.
const NUMBERS_WIDTH: f64 = 40.0;
/// Height of a dot with the gap to the next, px.
const DOT_HEIGHT: f64 = 13.0;
/// Gap between rows, px.
const ROW_GAP: f64 = 12.0;
/// Radius of a dot, px.
const DOT_RADIUS: f64 = 4.2;
/// Gap between a number and its dot or whisker, px.
const NUMBER_GAP: f64 = 4.0;
