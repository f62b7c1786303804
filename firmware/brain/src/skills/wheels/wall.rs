//! `wall`: the side from which a robot comes to a ball that lies at a wall or a goal, and the room that a
//! body has there.

use geometry::{Angle, Field, Point, Vector};
use rules::FieldSpec;
use rules::limits::ROBOT_RADIUS;

use crate::body::omni::BALL_AT;

/// The direction out of the field, where a ball lies so near a wall or goal that no body gets beside it, or
/// behind it to push it to `at`.
pub(super) fn wall(
    field: &FieldSpec,
    ball: Point<Field>,
    at: Point<Field>,
    pushes: bool,
    room: f32,
) -> Option<Angle> {
    let (x, y) = (ball.x(), ball.y());
    let (line, post) = (0.5 * field.length, 0.5 * field.goal_width);
    let to_end = line + field.goal_line_margin - x.abs();
    let to_side = 0.5 * field.width + field.margin - y.abs();
    // In the goal, before it, and beside its walls.
    let at_goal = x.abs() > line - WALL_ROOM && y.abs() < post + BESIDE_POST;
    let spot = ball - Vector::polar(LINE_UP_BEHIND_M, ball.direction_to(at));
    let fits = if pushes {
        stands(field, spot, room)
            && to_end.min(to_side) > BESIDE_WALL
            && to_end.max(to_side) > GOES_ROUND + room
    } else {
        to_end.min(to_side) > WALL_ROOM
    };
    if fits && !at_goal {
        return None;
    }
    let end = Vector::<Field>::new(x, 0.0).unit().unwrap_or_default();
    let side = Vector::<Field>::new(0.0, y).unit().unwrap_or_default();
    let out = if at_goal {
        // Where a goal's wall leaves no room for the body beside the ball, between both.
        let wall = y.abs() - post;
        let beyond = x.abs() > line - ROBOT_RADIUS;
        if beyond && wall < 0.0 && -wall < BESIDE_WALL {
            end + side
        } else if beyond && wall > 0.0 && wall - field.goal_wall < BESIDE_WALL {
            end - side
        } else {
            end
        }
    } else if to_end.max(to_side) < if pushes { GOES_ROUND } else { IN_CORNER } {
        end + side
    } else if to_end < to_side {
        end
    } else {
        side
    };
    Some(out.angle())
}

/// A body has this much room there beyond what it needs, m.
pub(super) fn stands(field: &FieldSpec, spot: Point<Field>, room: f32) -> bool {
    let body = BODY + room;
    let goal = spot.x().abs() > 0.5 * field.length - body
        && spot.y().abs() < 0.5 * field.goal_width + field.goal_wall + body;
    !goal && field.surface().grown(-body).contains(spot)
}

/// From a ball to the centre of who lines up behind it, m (`get_ball`).
pub(super) const LINE_UP_BEHIND_M: f32 = BALL_AT + 0.1;
/// A body, and room to get there, m.
const BODY: f32 = ROBOT_RADIUS + 0.03;
/// A ball this near a wall leaves no room for a body beside it that turns, m; …
const WALL_ROOM: f32 = 0.16;
/// … and this near none for one that goes along.
const BESIDE_WALL: f32 = 0.1;
/// The same beyond a post, m: a body across and its path around.
const BESIDE_POST: f32 = 0.3;
/// Nearer than this to two walls no body gets around a ball on either side, m: it, a body and margins.
const GOES_ROUND: f32 = 0.3;
/// Nearer than this to two walls a ball is pulled between them, m.
const IN_CORNER: f32 = 0.2;

#[cfg(test)]
mod tests {
    use super::*;
    use rules::League;

    fn out(ball: (f32, f32), pushes: bool) -> Option<f32> {
        let at = Point::new(0.0, 0.0);
        let field = League::DivisionB.field();
        wall(&field, Point::new(ball.0, ball.1), at, pushes, 0.0).map(Angle::to_degrees)
    }

    #[test]
    fn a_ball_in_a_corner_is_come_to_from_the_field_between_both_walls() {
        assert!((out((4.75, 3.25), false).unwrap() - 45.0).abs() < 1e-3);
        assert!((out((1.0, -3.25), false).unwrap() + 90.0).abs() < 1e-3);
        assert!(out((-4.6, 0.2), false).unwrap().abs() > 179.9);
        // In the goal's own corner, and outside beside its wall.
        assert!((out((4.6, 0.47), false).unwrap() - 45.0).abs() < 1e-3);
        assert!((out((4.6, 0.55), false).unwrap() + 45.0).abs() < 1e-3);
        assert_eq!(out((1.0, 1.0), false), None);
        // Pulled it is free where no robot can get behind it to push it.
        assert_eq!(out((4.6, 2.0), false), None);
        assert!(out((4.6, 2.0), true).is_some());
    }
}
