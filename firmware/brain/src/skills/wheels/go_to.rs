//! Go to: be at a place with a heading. Also: stay off a ball that must not be touched again.

use geometry::{Angle, Field, Pose, Vector};

use crate::belief::Belief;
use crate::body::Intent;
use crate::body::omni::Drive;

/// Drives there, around all obstacles and around the ball.
pub fn go_to(pose: Pose<Field>) -> Intent {
    Drive::avoiding(pose.position, pose.heading).into()
}

/// Stays away from the ball, facing it: backs off where it is near.
pub fn keep_off(belief: &Belief) -> Intent {
    let me = belief.pose.position;
    let Some(ball) = belief.ball else { return Intent::Stand { face: None } };
    let face = me.direction_to(ball.position);
    let away =
        (me - ball.position).unit().unwrap_or(Vector::polar(1.0, belief.pose.heading + Angle::HALF_TURN));
    if me.distance(ball.position) > KEEP_OFF_M {
        return Intent::Stand { face: Some(face) };
    }
    Drive::avoiding(ball.position + away * (KEEP_OFF_M + 0.1), face).into()
}

/// At this distance from the ball a robot does not touch it by accident, m.
const KEEP_OFF_M: f32 = 0.3;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::skills::wheels::testing::belief;

    #[test]
    fn who_must_not_touch_the_ball_backs_off_and_stands_when_it_is_far() {
        let Intent::Drive(drive) = keep_off(&belief((0.0, 0.0, 0.0), (0.1, 0.0))) else { panic!("drives") };
        assert!(drive.to.x() < -0.2, "{drive:?}");
        assert!(matches!(keep_off(&belief((0.0, 0.0, 0.0), (1.0, 0.0))), Intent::Stand { face: Some(_) }));
    }
}
