//! What lies under the game? Carpet, lines, goals, from crate `rules`.

use geometry::Point;
use rules::{FieldSpec, League};

use super::canvas::{Canvas, SCALE};

/// Draws the four-legged field.
pub(super) fn draw(canvas: &mut Canvas) {
    let field = League::FourLegged.field();
    let (x, y) = (field.length * 0.5, field.width * 0.5);
    let line = format!(r#"fill="none" stroke="{LINE}" stroke-width="3""#);
    rectangle(
        canvas,
        (-x - GOAL_ROOM, y + SIDE_ROOM),
        (x + GOAL_ROOM, -y - SIDE_ROOM),
        &format!(r#"fill="{CARPET}" rx="6""#),
    );
    for sign in [-1.0, 1.0] {
        goal(canvas, &field, sign);
        let depth = sign * (x - field.penalty_depth);
        let (left, right) = if sign < 0.0 { (-x, depth) } else { (depth, x) };
        let half = field.penalty_width * 0.5;
        rectangle(canvas, (left, half), (right, -half), &line);
    }
    rectangle(canvas, (-x, y), (x, -y), &line);
    let (top, bottom) = (canvas.place(Point::new(0.0, y)), canvas.place(Point::new(0.0, -y)));
    canvas.line(top, bottom, format!(r#"stroke="{LINE}" stroke-width="3""#));
    let center = canvas.place(Point::new(0.0, 0.0));
    canvas.circle(center, field.center_radius * SCALE, line);
}

/// Ours yellow at −x, theirs cyan at +x, as the paper names them.
fn goal(canvas: &mut Canvas, field: &FieldSpec, sign: f32) {
    let (line, half) = (sign * field.length * 0.5, field.goal_width * 0.5);
    let back = line + sign * field.goal_depth;
    let fill = if sign < 0.0 { YELLOW } else { CYAN };
    let style = format!(r#"fill="{fill}" stroke="{LINE}" stroke-width="3""#);
    rectangle(canvas, (line.min(back), half), (line.max(back), -half), &style);
}

/// A rectangle from its upper left to its lower right corner, m.
fn rectangle(canvas: &mut Canvas, upper_left: (f32, f32), lower_right: (f32, f32), style: &str) {
    let corner = canvas.place(Point::new(upper_left.0, upper_left.1));
    let (width, height) = (lower_right.0 - upper_left.0, upper_left.1 - lower_right.1);
    canvas.rect(corner, width * SCALE, height * SCALE, style);
}

const CARPET: &str = "#e3eedd";
const LINE: &str = "#ffffff";
const YELLOW: &str = "#f3e08b";
const CYAN: &str = "#a9dcee";
/// Carpet shown behind the goal lines, m.
const GOAL_ROOM: f32 = 0.36;
/// Carpet shown beside the side lines, m.
const SIDE_ROOM: f32 = 0.17;
