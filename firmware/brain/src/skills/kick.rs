//! `kick`, `pass_ball`, `dribble_to`: with the ball held, turn until the kick points right, and kick; or carry it.

use geometry::{Angle, Field, Point};
use protocol::robot_io::LeggedKick;

use crate::belief::Belief;
use crate::body::{Intent, legged};
use crate::skills::Step;

/// Turns until `kick` would send the ball in `direction` of the field, then kicks.
pub fn shoot(belief: &Belief, direction: Angle, kick: LeggedKick) -> Intent {
    let heading = direction - legged::nominal(kick).0;
    if (heading - belief.pose.heading).abs() > AIM_WITHIN {
        Intent::Turn { heading }
    } else {
        Intent::Kick(kick)
    }
}

/// The direction from the ball (or the robot, while no ball is seen) to `target`.
pub fn aim(belief: &Belief, target: Point<Field>) -> Angle {
    let from = belief.ball.map_or(belief.pose.position, |ball| ball.position);
    // A ball between the legs is nearer the pivot than the target is: aim from the body.
    let from = if belief.holds_ball { belief.pose.position } else { from };
    from.direction_to(target)
}

/// Carries the ball held to `to`; done within `tolerance` of it, m.
pub fn carry_to(belief: &Belief, to: Point<Field>, tolerance: f32) -> Step {
    if belief.pose.position.distance(to) <= tolerance {
        Step::Done
    } else {
        Step::Running(Intent::Carry { to })
    }
}

/// How well a kick is aimed before it is let go, rad: half of the 10° by which it scatters anyway.
const AIM_WITHIN: f32 = 0.087;

#[cfg(test)]
mod tests {
    use super::*;
    use rules::League;

    #[test]
    fn a_left_kick_points_the_robot_to_the_right_of_its_target() {
        let belief = Belief::new(League::FourLegged);
        let intent = shoot(&belief, Angle::degrees(75.0), LeggedKick::Left);
        assert_eq!(intent, Intent::Kick(LeggedKick::Left));
        let Intent::Turn { heading } = shoot(&belief, Angle::ZERO, LeggedKick::Left) else { panic!("turns") };
        assert!((heading.to_degrees() + 75.0).abs() < 1e-3);
    }
}
