//! `field`: field background of the figures. The field with robots, ball and a map of probabilities over it;
//! mm, +x to the right.

use casebase::FieldMm;
use figures::{Anchor, At, Colors, Font, Svg, Theme};
use geometry::{Attack, Point};
use host::strategy::View;
use rules::{AreaForm, FieldSpec};

/// Colours of the figures.
pub(crate) fn colors() -> &'static Colors {
    Theme::Light.colors()
}

/// A place of the attack frame in mm.
pub(crate) fn mm(at: Point<Attack>) -> At {
    [f64::from(at.x()) * 1000.0, f64::from(at.y()) * 1000.0]
}

/// The field in the drawing's integers.
pub(crate) fn in_mm(field: &FieldSpec) -> FieldMm {
    let mm = |x: f32| (x * 1000.0) as i32;
    FieldMm {
        length: mm(field.length),
        width: mm(field.width),
        margin: mm(field.margin),
        goal_width: mm(field.goal_width),
        penalty_depth: mm(field.penalty_depth),
        penalty_width: mm(field.penalty_width),
    }
}

/// Lines and goals over the drawing so far, with the rules' defence areas.
pub(crate) fn lines(svg: &mut Svg, field: &FieldSpec) {
    let style = r##"fill="none" stroke="#ffffff" stroke-width="25""##;
    let (x, y) = (f64::from(field.length) * 500.0, f64::from(field.width) * 500.0);
    let goal = f64::from(field.goal_width) * 500.0;
    for (sign, fill) in [(-1.0, colors().yellow), (1.0, colors().cyan)] {
        let deep = x + f64::from(field.goal_depth) * 1000.0;
        let edge = r##"stroke="#ffffff" stroke-width="25""##;
        svg.rect([sign * x, -goal], [sign * deep, goal], format_args!(r#"fill="{fill}" {edge}"#));
        let (depth, half) = (f64::from(field.penalty_depth) * 1000.0, f64::from(field.penalty_width) * 500.0);
        match field.penalty_form {
            AreaForm::Box => svg.rect([sign * x, -half], [sign * (x - depth), half], style),
            AreaForm::QuarterCircles => {
                let round = |up: f64| {
                    (0..=12).map(move |i| {
                        let (s, c) = (f64::from(i) * std::f64::consts::FRAC_PI_2 / 12.0).sin_cos();
                        [sign * (x - depth * c), up * (half - depth + depth * s)]
                    })
                };
                let below: Vec<At> = round(-1.0).collect();
                let border: Vec<At> = below.into_iter().rev().chain(round(1.0)).collect();
                svg.polyline(&border, r##"stroke="#ffffff" stroke-width="25""##);
            }
        }
    }
    svg.rect([-x, -y], [x, y], style);
    svg.line([0.0, -y], [0.0, y], style);
    svg.circle([0.0, 0.0], f64::from(field.center_radius) * 1000.0, style);
}

/// A map over the field: the value of each square of `cell` m, 0 to 1, in the colour of [`shade`].
pub(crate) fn map(svg: &mut Svg, field: &FieldSpec, cell: f32, value: impl Fn(Point<Attack>) -> f32) {
    let (columns, rows) = ((field.length / cell) as u32, (field.width / cell) as u32);
    let side = f64::from(cell) * 1000.0;
    let mut squares = Svg::default();
    for row in 0..rows {
        let y = (row as f32 + 0.5) * cell - field.width * 0.5;
        // Squares of one colour side by side are one rectangle.
        let mut run: Option<(u32, String)> = None;
        for column in 0..=columns {
            let x = (column as f32 + 0.5) * cell - field.length * 0.5;
            let color = (column < columns).then(|| shade(f64::from(value(Point::new(x, y)))));
            let same = matches!((&run, &color), (Some((_, now)), Some(next)) if now == next);
            if same {
                continue;
            }
            if let Some((from, color)) = run.take() {
                let left = (f64::from(from) * side) - f64::from(field.length) * 500.0;
                let right = (f64::from(column) * side) - f64::from(field.length) * 500.0;
                let middle = f64::from(y) * 1000.0;
                // Slightly larger, so that no seam is visible between them.
                let (low, high) = ([left, middle - side * 0.5], [right + 2.0, middle + side * 0.5 + 2.0]);
                squares.rect(low, high, format_args!(r#"fill="{color}""#));
            }
            run = color.map(|color| (column, color));
        }
    }
    svg.group(&squares, r#"shape-rendering="crispEdges""#);
}

/// From dark violet (0) over blue-green to yellow (1), evenly in brightness: viridis at nine places, in
/// [`SHADES`] steps.
pub(crate) fn shade(value: f64) -> String {
    let step = (value.clamp(0.0, 1.0) * f64::from(SHADES)).round() / f64::from(SHADES);
    let place = step * (VIRIDIS.len() - 1) as f64;
    let low = (place as usize).min(VIRIDIS.len() - 2);
    let share = place - low as f64;
    let mix = |i: usize| {
        let (a, b) = (f64::from(VIRIDIS[low][i]), f64::from(VIRIDIS[low + 1][i]));
        (a + (b - a) * share).round() as u8
    };
    format!("#{:02x}{:02x}{:02x}", mix(0), mix(1), mix(2))
}

const SHADES: u32 = 50;
const VIRIDIS: [[u8; 3]; 9] = [
    [68, 1, 84],
    [71, 44, 122],
    [59, 81, 139],
    [44, 113, 142],
    [33, 144, 141],
    [39, 173, 129],
    [92, 200, 99],
    [170, 220, 50],
    [253, 231, 37],
];

/// A bar with the colour scale, from `at` to the right.
pub(crate) fn legend(svg: &mut Svg, at: At, length: f64, high: f64, from: &str, to: &str) {
    let colors = colors();
    let steps = f64::from(SHADES);
    for i in 0..SHADES {
        let x = at[0] + length * f64::from(i) / steps;
        let color = shade((f64::from(i) + 0.5) / steps);
        svg.rect([x, at[1]], [x + length / steps + 1.0, at[1] + high], format_args!(r#"fill="{color}""#));
    }
    let font = text(LETTERS * 0.85);
    svg.text([at[0] - 60.0, at[1] + high * 0.2], from, Anchor::End, font);
    svg.text(
        [at[0] + length + 60.0, at[1] + high * 0.2],
        to,
        Anchor::Start,
        Font { fill: colors.ink, ..font },
    );
}

/// Draws ball and robots.
pub(crate) fn robots(svg: &mut Svg, view: &View) {
    let colors = colors();
    let edge = r##"stroke="#ffffff" stroke-width="22""##;
    for (robots, fill) in [(&view.theirs, colors.opponent), (&view.ours, colors.team)] {
        for robot in robots {
            svg.circle(mm(robot.position), BODY, format_args!(r#"fill="{fill}" {edge}"#));
        }
    }
    if let Some(ball) = view.ball {
        svg.circle(
            mm(ball.position),
            BALL,
            format_args!(r##"fill="{}" stroke="#1b1b1b" stroke-width="18""##, colors.ball),
        );
    }
}

/// Text above and to the right of a place, readable over any background.
pub(crate) fn label(svg: &mut Svg, at: Point<Attack>, description: &str) {
    let [x, y] = mm(at);
    let font = Font { size: LETTERS, fill: "#ffffff", bold: true, halo: Some("#1b1b1b") };
    svg.circle([x, y], 45.0, r##"fill="#ffffff" stroke="#1b1b1b" stroke-width="18""##);
    svg.text([x + 70.0, y + 110.0], description, Anchor::Start, font);
}

/// Plain text of a figure.
pub(crate) fn text(size: f64) -> Font<'static> {
    Font { size, fill: colors().ink, bold: false, halo: None }
}

/// Font size of a figure, mm.
pub(crate) const LETTERS: f64 = 190.0;
/// A robot's radius, mm, and the ball's, drawn larger than its 21.5 mm so that it is visible.
const BODY: f64 = 90.0;
const BALL: f64 = 55.0;
