//! `field`: robots, ball and maps of probabilities over the field; mm, +x to the right.

use figures::{Anchor, At, Colors, Font, Svg, Theme, scale_bar, shade, squares};
use geometry::{Attack, Point};
use host::strategy::View;
use rules::FieldSpec;

/// Colours of the figures.
pub(crate) fn colors() -> &'static Colors {
    Theme::Light.colors()
}

/// A place of the attack frame in mm.
pub(crate) fn mm(at: Point<Attack>) -> At {
    [f64::from(at.x()) * 1000.0, f64::from(at.y()) * 1000.0]
}

/// Draws a map over the field: the value of each square of `cell` m, 0 to 1, as a colour of the scale.
pub(crate) fn map(svg: &mut Svg, field: &FieldSpec, cell: f32, value: impl Fn(Point<Attack>) -> f32) {
    let (columns, rows) = ((field.length / cell) as usize, (field.width / cell) as usize);
    let half = [f64::from(field.length) * 500.0, f64::from(field.width) * 500.0];
    squares(svg, [half.map(|side| -side), half], [columns, rows], |column, row| {
        let x = (column as f32 + 0.5) * cell - field.length * 0.5;
        let y = (row as f32 + 0.5) * cell - field.width * 0.5;
        shade(f64::from(value(Point::new(x, y))))
    });
}

/// Draws the scale as a bar with its ends' values; `at` is its upper left corner.
pub(crate) fn legend(svg: &mut Svg, at: At, [length, height]: At, [from, to]: [&str; 2]) {
    scale_bar(svg, at, [length, height]);
    let (below, font) = (at[1] - height * 0.8, text(LETTER_SIZE_MM * 0.85));
    svg.text([at[0] - 60.0, below], from, Anchor::End, font);
    svg.text([at[0] + length + 60.0, below], to, Anchor::Start, font);
}

/// Draws ball and robots.
pub(crate) fn robots(svg: &mut Svg, view: &View) {
    let colors = colors();
    let edge = r##"stroke="#ffffff" stroke-width="22""##;
    for (robots, fill) in [(&view.theirs, colors.opponent), (&view.ours, colors.team)] {
        for robot in robots {
            svg.circle(mm(robot.position), ROBOT_RADIUS_MM, format_args!(r#"fill="{fill}" {edge}"#));
        }
    }
    if let Some(ball) = view.ball {
        svg.circle(
            mm(ball.position),
            BALL_RADIUS_MM,
            format_args!(r##"fill="{}" stroke="#1b1b1b" stroke-width="18""##, colors.ball),
        );
    }
}

/// Text above and to the right of a place, readable over any background.
pub(crate) fn label(svg: &mut Svg, at: Point<Attack>, name: &str) {
    let [x, y] = mm(at);
    let font = Font { size: LETTER_SIZE_MM, fill: "#ffffff", bold: true, halo: Some("#1b1b1b") };
    svg.circle([x, y], 45.0, r##"fill="#ffffff" stroke="#1b1b1b" stroke-width="18""##);
    svg.text([x + 70.0, y + 110.0], name, Anchor::Start, font);
}

/// Plain text of a figure.
pub(crate) fn text(size: f64) -> Font<'static> {
    Font { size, fill: colors().ink, bold: false, halo: None }
}

/// Font size of a figure, mm.
pub(crate) const LETTER_SIZE_MM: f64 = 190.0;
/// A robot's radius, mm.
const ROBOT_RADIUS_MM: f64 = 90.0;
/// The ball's drawn radius, mm: larger than its 21.5 mm, so that it is visible.
const BALL_RADIUS_MM: f64 = 55.0;
