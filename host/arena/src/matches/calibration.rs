//! `calibration`: calibration plot of P(we have it). One figure: for each tenth of it, how many of the
//! passes the team had, with Wilson's 95 % interval; on the diagonal both agree (Biswas et al. 2014,
//! equation 5). px, shares from 0 to 1.

use figures::{Anchor, Font, Svg, Theme};

use super::passes::Passes;

/// Predicted against observed shares, as an SVG.
pub fn calibration_plot(passes: &Passes) -> String {
    let mut svg = Svg::default();
    let colors = Theme::Light.colors();
    let font = |fill| Font { size: 13.0, fill, bold: false, halo: None };
    let at = |share: f64| share * SIDE;
    let thin = format!("stroke=\"{}\" stroke-width=\"1\"", colors.unknown);
    for i in 0..=5 {
        let share = f64::from(i) / 5.0;
        svg.line([at(share), 0.0], [at(share), SIDE], thin.clone());
        svg.line([0.0, at(share)], [SIDE, at(share)], thin.clone());
        svg.text([at(share), -20.0], &share.to_string(), Anchor::Middle, font(colors.faint));
        svg.text([-8.0, at(share) - 4.0], &share.to_string(), Anchor::End, font(colors.faint));
    }
    let dashed = format!("stroke=\"{}\" stroke-width=\"1.5\" stroke-dasharray=\"6 4\"", colors.faint);
    svg.line([0.0, 0.0], [SIDE, SIDE], dashed);
    for tenth in &passes.calibration {
        let Some(seen) = tenth.seen.share else { continue };
        let x = at(tenth.predicted);
        if let (Some(low), Some(high)) = (tenth.seen.low, tenth.seen.high) {
            let style = format!("stroke=\"{}\" stroke-width=\"2\"", colors.team);
            svg.line([x, at(low)], [x, at(high)], style);
        }
        svg.circle([x, at(seen)], 4.5, format_args!("fill=\"{}\"", colors.team));
        // The number of passes above the axis of its tenth.
        let middle = at((tenth.tenth as f64 + 0.5) / TENTHS);
        svg.text([middle, SIDE + 8.0], &tenth.seen.of.to_string(), Anchor::Middle, font(colors.ink));
    }
    svg.text([SIDE / 2.0, -42.0], "P(we have it) as predicted", Anchor::Middle, font(colors.ink));
    let bold = Font { bold: true, ..font(colors.ink) };
    svg.text([0.0, SIDE + 30.0], "share that we had; above it, the number of passes", Anchor::Start, bold);
    let title = "P(we have it) as predicted against the share of passes after which we had the ball";
    svg.finish([-ROOM, -56.0], [SIDE + 20.0, SIDE + 68.0], 1.0, colors.paper, title)
}

/// Side of the square, px.
const SIDE: f64 = 320.0;
/// Space for the numbers beside it, px.
const ROOM: f64 = 44.0;
/// Tenths in the whole range.
const TENTHS: f64 = 10.0;
