//! `calibration`: calibration plot of P(we have it): for each tenth of it, how many of the passes the team
//! had, with Wilson's 95 % interval; on the diagonal both agree (Biswas et al. 2014, equation 5). px, shares
//! from 0 to 1.

use figures::{Anchor, Axis, Font, Svg, Theme};

use super::passes::Passes;

/// Predicted against observed shares, as an SVG.
pub fn calibration_plot(passes: &Passes) -> String {
    let mut svg = Svg::default();
    let colors = Theme::Light.colors();
    let font = Font { size: 13.0, fill: colors.ink, bold: false, halo: None };
    let axis = Axis::linear([0.0, 1.0], [0.0, SIDE]);
    axis.draw_below(&mut svg, SIDE, 0.0, "");
    axis.draw_beside(&mut svg, 0.0, SIDE);
    let dashed = format!("stroke=\"{}\" stroke-width=\"1.5\" stroke-dasharray=\"6 4\"", colors.faint);
    svg.line([0.0, 0.0], [SIDE, SIDE], dashed);
    for tenth in &passes.calibration {
        let Some(seen) = tenth.seen.share else { continue };
        let x = axis.place(tenth.predicted);
        if let (Some(low), Some(high)) = (tenth.seen.low, tenth.seen.high) {
            let style = format!("stroke=\"{}\" stroke-width=\"2\"", colors.team);
            svg.line([x, axis.place(low)], [x, axis.place(high)], style);
        }
        svg.circle([x, axis.place(seen)], 4.5, format_args!("fill=\"{}\"", colors.team));
        // The number of passes above the axis of its tenth.
        let middle = axis.place((tenth.tenth as f64 + 0.5) / TENTHS);
        svg.text([middle, SIDE + 8.0], &tenth.seen.of.to_string(), Anchor::Middle, font);
    }
    svg.text([SIDE / 2.0, -42.0], "P(we have it) as predicted", Anchor::Middle, font);
    let heading = "share that we had; above it, the number of passes";
    svg.text([0.0, SIDE + 30.0], heading, Anchor::Start, Font { bold: true, ..font });
    let title = "P(we have it) as predicted against the share of passes after which we had the ball";
    svg.finish([-NUMBERS_WIDTH, -56.0], [SIDE + 20.0, SIDE + 68.0], 1.0, colors.paper, title)
}

/// Side of the square, px.
const SIDE: f64 = 320.0;
/// Space for the numbers beside it, px.
const NUMBERS_WIDTH: f64 = 44.0;
/// Tenths in the whole range.
const TENTHS: f64 = 10.0;
