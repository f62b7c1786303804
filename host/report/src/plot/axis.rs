//! `axis`: horizontal plot axis. A horizontal axis with round numbers, its unit at its end.

use figures::{Anchor, Font, Svg, Theme};

/// A horizontal axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Axis {
    low: f64,
    high: f64,
    step: f64,
    left: f64,
    right: f64,
}

impl Axis {
    /// From 0 to a round number over `high`, between two places of the panel, px.
    pub(crate) fn up_to(high: f64, left: f64, right: f64) -> Self {
        Self::between(0.0, high, left, right)
    }

    /// Between round numbers that hold both.
    pub(crate) fn between(low: f64, high: f64, left: f64, right: f64) -> Self {
        let span = if high - low > 0.0 { high - low } else { 1.0 };
        let rough = span / TICKS;
        let decade = 10_f64.powf(rough.log10().floor());
        let step =
            [1.0, 2.0, 2.5, 5.0, 10.0].into_iter().map(|part| part * decade).find(|step| *step >= rough);
        let step = step.unwrap_or(10.0 * decade);
        let (low, high) = ((low / step).floor() * step, (high / step).ceil() * step);
        Self { low, high: if high > low { high } else { low + step }, step, left, right }
    }

    /// Position of a value, px; beyond the ends, at the end.
    pub(crate) fn place(&self, value: f64) -> f64 {
        let share = ((value - self.low) / (self.high - self.low)).clamp(0.0, 1.0);
        self.left + share * (self.right - self.left)
    }

    /// Faint lines from `top` down to `bottom` (px, up is positive), numbers below, the unit below them.
    pub(crate) fn draw(&self, svg: &mut Svg, top: f64, bottom: f64, unit: &str) {
        let colors = Theme::Light.colors();
        let font = Font { size: 12.0, fill: colors.faint, bold: false, halo: None };
        let whole = |scale: f64| ((self.step * scale).round() - self.step * scale).abs() < 1e-9;
        let decimals = [1.0, 10.0, 100.0].into_iter().position(whole).unwrap_or(2);
        let ticks = ((self.high - self.low) / self.step).round() as u32;
        for tick in 0..=ticks {
            let value = self.low + f64::from(tick) * self.step;
            let x = self.place(value);
            let zero = value.abs() < self.step * 1e-6;
            let (stroke, width) = if zero { (colors.faint, 1.2) } else { (GRID, 1.0) };
            svg.line([x, top], [x, bottom], format!(r#"stroke="{stroke}" stroke-width="{width}""#));
            let text = crate::numbers::plain(value, decimals);
            svg.text([x, bottom - 15.0], &text, Anchor::Middle, font);
        }
        svg.text([self.right, bottom - 31.0], unit, Anchor::End, font);
    }
}

/// About the number of intervals of an axis.
const TICKS: f64 = 6.0;
/// Height of the axis below `bottom`, px.
pub(crate) const BELOW: f64 = 36.0;
/// Colour of grid lines, less prominent than the data.
pub(crate) const GRID: &str = "#dadada";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_axis_ends_at_round_numbers_and_holds_its_values() {
        let axis = Axis::up_to(58.7, 100.0, 400.0);
        // 58.7 / 6 = 9.8, so steps of 10, up to 60.
        assert_eq!((axis.high, axis.step), (60.0, 10.0));
        assert_eq!([axis.place(0.0), axis.place(30.0), axis.place(99.0)], [100.0, 250.0, 400.0]);
        // 12.2 / 6 = 2.03, so steps of 2.5.
        let axis = Axis::between(-3.2, 9.0, 0.0, 140.0);
        assert_eq!((axis.low, axis.high, axis.step), (-5.0, 10.0, 2.5));
        let nothing = Axis::up_to(0.0, 0.0, 10.0);
        assert!(nothing.high > nothing.low && nothing.place(0.0) == 0.0);
    }
}
