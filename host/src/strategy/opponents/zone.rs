//! `zone`: opponent team with zone defence. All but two stand side by side on an arc between ball and goal
//! and follow the ball; one plays it, one waits in front. Attack frame, m.

use geometry::{Angle, Vector};

use super::{Places, Style, free_places};
use crate::strategy::order::{OrderReason, Role};
use crate::strategy::support;
use crate::strategy::view::{View, ViewBall};

pub(super) const STYLE: Style = Style { target: support::target, places, keeps_places_at_free_kicks: true };
/// Spacing of the wall's robots, centre to centre, m: two bodies, and a gap smaller than a ball.
const WALL_SPACING_M: f32 = 0.3;
/// The wall stands this far before the ball, m: the nearest it may be while the ball is the opponents', with
/// a body.
const WALL_OFF_BALL_M: f32 = 0.8;
/// Least distance of the wall from the goal beyond the area's depth, m.
const WALL_BEYOND_AREA_MIN_M: f32 = 0.35;
/// Nor farther from it than this share of the field: a wall at the halfway line could be chipped over, to the
/// keeper alone.
const WALL_DISTANCE_SHARE_MAX: f32 = 0.4;

fn places(view: &View, ball: &ViewBall, wanted: usize) -> Places {
    let goal = view.our_goal();
    let forward = usize::from(wanted > 2);
    let wall = wanted - forward.min(wanted);
    let to_ball = view.clamp(ball.position, 0.0) - goal;
    let nearest = view.field.penalty_depth + WALL_BEYOND_AREA_MIN_M;
    let radius = (to_ball.norm() - WALL_OFF_BALL_M)
        .clamp(nearest, (view.field.length * WALL_DISTANCE_SHARE_MAX).max(nearest));
    let middle = to_ball.unit().unwrap_or(Vector::new(1.0, 0.0));
    let bricks = (0..wall).map(|i| {
        let beside = (i as f32 - (wall as f32 - 1.0) * 0.5) * WALL_SPACING_M / radius;
        let at = goal + middle.rotated(Angle::new(beside)) * radius;
        (at, Role::Wall, OrderReason::OnBallLine { y: goal.y() })
    });
    bricks.chain(free_places(view, ball, forward)).take(wanted).collect()
}
