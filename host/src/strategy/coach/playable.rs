//! `playable`: whether field players may, or can, play the ball. Attack frame, m.

use super::super::threat::receiving::comes_at_goal;
use super::super::view::{View, ViewBall};

/// A ball this near their area counts as in it, m: a robot that touches it from outside is 5 mm off the area,
/// and cameras err by 3.
const THEIR_AREA_WITHIN_M: f32 = 0.008;
/// A slower ball at our goal can be reached, m/s.
const SHOT_SPEED_MIN_M_S: f32 = 1.0;

/// Only a keeper may, or can, play the ball; a robot that blocks a shot stays there.
pub(super) fn is_left_to_the_keeper(view: &View, ball: &ViewBall) -> bool {
    let forbidden =
        view.in_their_area(ball.position, THEIR_AREA_WITHIN_M) || view.in_our_area(ball.position, 0.0);
    forbidden || is_shot_at_us(view, ball)
}

/// Whether a shot moves at our goal: a robot that ran after it would open the line that it blocks.
fn is_shot_at_us(view: &View, ball: &ViewBall) -> bool {
    let goal = view.our_goal();
    ball.velocity.norm() > SHOT_SPEED_MIN_M_S
        && ball.position.x() < 0.0
        && ball.rest.x() < goal.x()
        && comes_at_goal(view, ball.position, ball.velocity)
}
