//! `axis`: axes of charts, horizontal or vertical, with grid lines at round numbers. Places in px, up is
//! positive.

use crate::numbers::plain;
use crate::{Anchor, Font, Svg, Theme};

/// A linear or logarithmic axis between two places of a chart.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    ends: [f64; 2],
    places: [f64; 2],
    is_logarithmic: bool,
    ticks: Vec<f64>,
    /// Decimals of every number; `None` for as many as each needs.
    decimals: Option<usize>,
}

impl Axis {
    /// Between round numbers that hold `low` and `high`, in about six parts of 1, 2, 2.5 or 5 times a
    /// power of ten.
    pub fn linear([low, high]: [f64; 2], places: [f64; 2]) -> Self {
        Self::in_intervals([low, high], places, INTERVALS)
    }

    /// A linear axis in about `intervals` parts.
    pub fn in_intervals([low, high]: [f64; 2], places: [f64; 2], intervals: f64) -> Self {
        let span = if high - low > 0.0 { high - low } else { 1.0 };
        let rough = span / intervals;
        let decade = 10_f64.powf(rough.log10().floor());
        let steps = [1.0, 2.0, 2.5, 5.0].map(|part| part * decade);
        let step = steps.into_iter().find(|step| *step >= rough).unwrap_or(10.0 * decade);
        let (first, last) = ((low / step).floor() * step, (high / step).ceil() * step);
        let last = if last > first { last } else { first + step };
        let parts = ((last - first) / step).round() as u32;
        let is_whole = |scale: f64| ((step * scale).round() - step * scale).abs() < 1e-9;
        Self {
            ends: [first, last],
            places,
            is_logarithmic: false,
            ticks: (0..=parts).map(|part| first + f64::from(part) * step).collect(),
            decimals: Some([1.0, 10.0, 100.0].into_iter().position(is_whole).unwrap_or(2)),
        }
    }

    /// An axis of ratios, on which 2 and 1/2 are as far from 1, between positive `ends` with numbers at
    /// `ticks`.
    pub fn logarithmic(ends: [f64; 2], places: [f64; 2], ticks: &[f64]) -> Self {
        Self { ends, places, is_logarithmic: true, ticks: ticks.to_vec(), decimals: None }
    }

    /// Position of a value, px; beyond the ends, at the end.
    pub fn place(&self, value: f64) -> f64 {
        let [low, high] = self.ends;
        let share = if self.is_logarithmic {
            (value.max(low) / low).ln() / (high / low).ln()
        } else {
            (value - low) / (high - low)
        };
        self.places[0] + share.clamp(0.0, 1.0) * (self.places[1] - self.places[0])
    }

    /// Horizontal: grid lines from `top` down to `bottom`, numbers below them, the unit below these.
    pub fn draw_below(&self, svg: &mut Svg, top: f64, bottom: f64, unit: &str) {
        for tick in &self.ticks {
            let x = self.place(*tick);
            svg.line([x, top], [x, bottom], self.grid_line(*tick));
            svg.text([x, bottom - 15.0], &self.number(*tick), Anchor::Middle, font());
        }
        if !unit.is_empty() {
            svg.text([self.places[1], bottom - 31.0], unit, Anchor::End, font());
        }
    }

    /// Vertical: grid lines from `left` to `right`, numbers left of them.
    pub fn draw_beside(&self, svg: &mut Svg, left: f64, right: f64) {
        for tick in &self.ticks {
            let y = self.place(*tick);
            svg.line([left, y], [right, y], self.grid_line(*tick));
            svg.text([left - 8.0, y - 4.0], &self.number(*tick), Anchor::End, font());
        }
    }

    /// Stroke of a grid line; heavier at 0, and at 1 of ratios.
    fn grid_line(&self, tick: f64) -> String {
        let middle = if self.is_logarithmic { 1.0 } else { 0.0 };
        let is_middle = (tick - middle).abs() < 1e-9 * (self.ends[1] - self.ends[0]);
        let (stroke, width) = if is_middle { (Theme::Light.colors().faint, 1.2) } else { (GRID_COLOR, 1.0) };
        format!(r#"stroke="{stroke}" stroke-width="{width}""#)
    }

    fn number(&self, tick: f64) -> String {
        self.decimals.map_or_else(|| tick.to_string(), |decimals| plain(tick, decimals))
    }
}

/// Font of numbers and unit.
fn font() -> Font<'static> {
    Font { size: 12.0, fill: Theme::Light.colors().faint, bold: false, halo: None }
}

/// Number of parts of an axis, about.
const INTERVALS: f64 = 6.0;
/// Height that numbers and unit of a horizontal axis take below it, px.
pub const AXIS_HEIGHT: f64 = 36.0;
/// Colour of grid lines, less prominent than the data.
pub const GRID_COLOR: &str = "#dadada";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_axis_ends_at_round_numbers_and_holds_its_values() {
        let axis = Axis::linear([0.0, 58.7], [100.0, 400.0]);
        // 58.7 / 6 = 9.8, so steps of 10, up to 60.
        assert_eq!((axis.ends, axis.ticks.len()), ([0.0, 60.0], 7));
        assert_eq!([axis.place(0.0), axis.place(30.0), axis.place(99.0)], [100.0, 250.0, 400.0]);
        // 12.2 / 6 = 2.03, so steps of 2.5.
        let axis = Axis::linear([-3.2, 9.0], [0.0, 140.0]);
        assert_eq!((axis.ends, axis.ticks.len()), ([-5.0, 10.0], 7));
        let nothing = Axis::linear([0.0; 2], [0.0, 10.0]);
        assert!(nothing.ends[1] > nothing.ends[0] && nothing.place(0.0) == 0.0);
    }

    #[test]
    fn an_axis_has_as_many_parts_as_asked_for_or_fewer() {
        for (most, step, parts) in
            [(62.3, 20.0, 4), (26.4, 10.0, 3), (111.4, 25.0, 5), (1.0, 0.2, 5), (50.0, 10.0, 5)]
        {
            let axis = Axis::in_intervals([0.0, most], [0.0, 1.0], 5.0);
            assert_eq!((axis.ticks[1], axis.ticks.len() - 1), (step, parts), "{most}");
        }
    }

    #[test]
    fn ratios_are_as_far_from_one_as_their_inverses() {
        let axis = Axis::logarithmic([0.25, 4.0], [0.0, 100.0], &[0.5, 1.0, 2.0]);
        assert!((axis.place(1.0) - 50.0).abs() < 1e-9);
        assert!((axis.place(0.5) - 25.0).abs() < 1e-9 && (axis.place(2.0) - 75.0).abs() < 1e-9);
        assert_eq!([axis.place(0.0), axis.place(100.0)], [0.0, 100.0]);
        assert_eq!(axis.number(0.5), "0.5");
    }
}
