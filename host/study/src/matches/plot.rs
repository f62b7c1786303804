//! `plot`: offence and attack ratio of each pair with 95 % intervals, the paper's range as a band, px.

use figures::{Anchor, Axis, Font, Svg, Theme};

use super::outcome::{Estimate, Outcome};
use super::paper::PAPER;

/// Title, ratio, and the paper's range.
type Panel = (&'static str, fn(&Outcome) -> Option<Estimate>, [f64; 2]);

/// Both ratios of all pairs, as an SVG.
pub fn plot(outcomes: &[Outcome]) -> String {
    let mut svg = Svg::default();
    let colors = Theme::Light.colors();
    let font = Font { size: 13.0, fill: colors.ink, bold: false, halo: None };
    let longest = outcomes.iter().map(|outcome| name(outcome).chars().count()).max().unwrap_or(0);
    let names_width = longest as f64 * LETTER_WIDTH + 20.0;
    let height = ROW_HEIGHT * (outcomes.len() as f64 + 3.0);
    let panels: [Panel; 2] = [
        ("offence ratio", |outcome| outcome.offence_ratio, range(PAPER.map(|game| game.offence_ratio))),
        ("attack ratio", |outcome| outcome.attack_ratio, range(PAPER.map(|game| game.attack_ratio))),
    ];
    for (panel, (title, ratio, [low, high])) in panels.into_iter().enumerate() {
        let left = names_width + (AXIS_LENGTH + PANEL_GAP) * panel as f64;
        let axis = Axis::logarithmic(RATIOS, [left, left + AXIS_LENGTH], &[0.25, 0.5, 1.0, 2.0, 4.0, 8.0]);
        let (top, bottom) = (-ROW_HEIGHT, -height + 2.0 * ROW_HEIGHT);
        let band = [[axis.place(low), top], [axis.place(high), bottom]];
        svg.rect(band[0], band[1], format_args!("fill=\"{}\"", colors.surface));
        svg.text([left, -ROW_HEIGHT * 0.6], title, Anchor::Start, Font { bold: true, ..font });
        axis.draw_below(&mut svg, top, bottom, "");
        for (i, outcome) in outcomes.iter().enumerate() {
            let y = -ROW_HEIGHT * (i as f64 + 1.5);
            if panel == 0 {
                svg.text([names_width - 10.0, y - 4.0], &name(outcome), Anchor::End, font);
            }
            let Some(estimate) = ratio(outcome) else { continue };
            if let (Some(low), Some(high)) = (estimate.low, estimate.high) {
                let style = format!("stroke=\"{}\" stroke-width=\"2\"", colors.team);
                svg.line([axis.place(low), y], [axis.place(high), y], style);
            }
            svg.circle([axis.place(estimate.mean), y], 4.5, format_args!("fill=\"{}\"", colors.team));
        }
    }
    let key = "band: the paper's range; bars: 95 % intervals, cut at the axis' ends";
    svg.text([names_width, -height + 2.0], key, Anchor::Start, Font { fill: colors.faint, ..font });
    let width = names_width + 2.0 * AXIS_LENGTH + PANEL_GAP + 20.0;
    let title = "Offence and attack ratios by opponent; the band is the paper's range";
    svg.finish([0.0, -height], [width, 0.0], 1.0, colors.paper, title)
}

fn name(outcome: &Outcome) -> String {
    format!("{} – {}", outcome.own, outcome.opponent)
}

fn range(values: [f64; 6]) -> [f64; 2] {
    [values.into_iter().fold(f64::INFINITY, f64::min), values.into_iter().fold(0.0, f64::max)]
}

/// Ends of the axis: ratios beyond are drawn at them.
const RATIOS: [f64; 2] = [0.2, 12.0];
/// Height of a pair's row, px.
const ROW_HEIGHT: f64 = 28.0;
/// Width of a letter of the pairs' names, px.
const LETTER_WIDTH: f64 = 7.0;
/// Length of a ratio's axis, px.
const AXIS_LENGTH: f64 = 260.0;
/// Gap between the two panels, px.
const PANEL_GAP: f64 = 40.0;
