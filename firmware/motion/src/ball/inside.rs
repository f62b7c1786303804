//! `inside`: the fastest kick that rests within the lines. m, m/s, field frame.

use geometry::{Field, GoalEnd, Point, Vector};
use rules::FieldSpec;

use super::BallModel;

/// The fastest flat kick from `from` along `along` (length 1) that rests within the lines, m/s; infinite
/// where it goes into the goal at an end that `goals` admits.
pub fn fastest_inside(
    model: &BallModel,
    field: &FieldSpec,
    from: Point<Field>,
    along: Vector<Field>,
    goals: impl Fn(GoalEnd) -> bool,
) -> f32 {
    let to_line = |at: f32, along: f32, line: f32| {
        if along.abs() < PARALLEL { f32::INFINITY } else { (line * along.signum() - at) / along }
    };
    let to_goal_line = to_line(from.x(), along.x(), 0.5 * field.length);
    let to_touch_line = to_line(from.y(), along.y(), 0.5 * field.width);
    let end = if along.x() > 0.0 { GoalEnd::Positive } else { GoalEnd::Negative };
    let crosses = from.y() + along.y() * to_goal_line;
    if goals(end) && crosses.abs() < 0.5 * field.goal_width + BESIDE_POST {
        return f32::INFINITY;
    }
    let room = to_goal_line.min(to_touch_line) - INSIDE;
    model.kick_speed(room.max(ROLLS_AT_LEAST), 0.0)
}

/// A heading this parallel to a line does not cross it.
const PARALLEL: f32 = 1e-3;
/// Beside a post, m: a shot that misses by less counts as one.
const BESIDE_POST: f32 = 0.1;
/// From the line to where the ball rests, m: more than a ball's radius, and kicks scatter.
pub const INSIDE: f32 = 0.2;
/// A kick rolls at least this far, m: out of the dribbler's reach.
const ROLLS_AT_LEAST: f32 = 0.8;
