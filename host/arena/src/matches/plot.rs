//! `plot`: plot of the match ratios beside the paper's. One figure: offence and attack ratio a pair, with 95
//! % intervals; the paper's range as a band. px, a ratio's axis is logarithmic, for 2 and 1/2 are as far from
//! 1.

use figures::{Anchor, Font, Svg, Theme};

use super::outcome::{Estimate, Outcome};
use super::paper::PAPER;

/// Title, ratio, and the paper's range.
type Panel = (&'static str, fn(&Outcome) -> Option<Estimate>, [f64; 2]);

/// Both ratios of all pairs, as an SVG.
pub fn plot(outcomes: &[Outcome]) -> String {
    let mut svg = Svg::default();
    let colors = Theme::Light.colors();
    let font = |fill| Font { size: 13.0, fill, bold: false, halo: None };
    // Width of the longest pair's name.
    let name = |outcome: &Outcome| format!("{} – {}", outcome.own, outcome.opponent);
    let longest = outcomes.iter().map(|outcome| name(outcome).chars().count()).max().unwrap_or(0);
    let names = longest as f64 * LETTER + 20.0;
    let height = ROW * (outcomes.len() as f64 + 3.0);
    let panels: [Panel; 2] = [
        ("offence ratio", |outcome| outcome.offence_ratio, range(PAPER.map(|game| game.offence_ratio))),
        ("attack ratio", |outcome| outcome.attack_ratio, range(PAPER.map(|game| game.attack_ratio))),
    ];
    for (panel, (title, of, [low, high])) in panels.into_iter().enumerate() {
        let left = names + (PANEL + GAP) * panel as f64;
        let x = |ratio: f64| left + PANEL * (ratio.clamp(LEAST, MOST) / LEAST).ln() / (MOST / LEAST).ln();
        let bottom = -height + 2.0 * ROW;
        svg.rect([x(low), -ROW], [x(high), bottom], format_args!("fill=\"{}\"", colors.surface));
        svg.text([left, -ROW * 0.6], title, Anchor::Start, Font { bold: true, ..font(colors.ink) });
        for tick in [0.25, 0.5, 1.0, 2.0, 4.0, 8.0] {
            let shade = if tick == 1.0 { colors.faint } else { colors.unknown };
            let style = format!("stroke=\"{shade}\" stroke-width=\"1\"");
            svg.line([x(tick), -ROW], [x(tick), bottom], style);
            svg.text([x(tick), bottom - 14.0], &tick.to_string(), Anchor::Middle, font(colors.faint));
        }
        for (i, outcome) in outcomes.iter().enumerate() {
            let y = -ROW * (i as f64 + 1.5);
            if panel == 0 {
                svg.text([names - 10.0, y - 4.0], &name(outcome), Anchor::End, font(colors.ink));
            }
            let Some(estimate) = of(outcome) else { continue };
            if let (Some(low), Some(high)) = (estimate.low, estimate.high) {
                let style = format_args!("stroke=\"{}\" stroke-width=\"2\"", colors.team).to_string();
                svg.line([x(low), y], [x(high), y], style);
            }
            svg.circle([x(estimate.mean), y], 4.5, format_args!("fill=\"{}\"", colors.team));
        }
    }
    let key = "band: the paper's range; bars: 95 % intervals, cut at the axis' ends";
    svg.text([names, -height + 2.0], key, Anchor::Start, font(colors.faint));
    let width = names + 2.0 * PANEL + GAP + 20.0;
    let title = "Offence and attack ratios by opponent; the band is the paper's range";
    svg.finish([0.0, -height], [width, 0.0], 1.0, colors.paper, title)
}

fn range(values: [f64; 6]) -> [f64; 2] {
    [values.into_iter().fold(f64::INFINITY, f64::min), values.into_iter().fold(0.0, f64::max)]
}

/// Height of a pair's row, px.
const ROW: f64 = 28.0;
/// Width of a letter of the pairs' names, px.
const LETTER: f64 = 7.0;
/// Length of a ratio's axis, px.
const PANEL: f64 = 260.0;
/// Gap between the two panels, px.
const GAP: f64 = 40.0;
/// Ends of the axis: ratios beyond are drawn at them.
const LEAST: f64 = 0.2;
const MOST: f64 = 12.0;
