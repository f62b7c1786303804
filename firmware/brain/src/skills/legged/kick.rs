//! `kick`, `pass_ball`, `dribble_to`: with the ball held, turn until the kick points right, and kick; or
//! carry it.

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

/// Passes to `place`: straight ahead, or with a head kick where its fixed length fits and it saves turning.
pub fn pass(belief: &Belief, place: Point<Field>) -> Intent {
    let (direction, distance) = (aim(belief, place), belief.pose.position.distance(place));
    let turn = |off: Angle| (direction - off - belief.pose.heading).abs();
    let ahead = LeggedKick::Pass(distance * PASS_FIRMLY);
    let side = if turn(legged::nominal(LeggedKick::Left).0) < turn(legged::nominal(LeggedKick::Right).0) {
        LeggedKick::Left
    } else {
        LeggedKick::Right
    };
    let (off, length) = legged::nominal(side);
    let suits = (length - distance).abs() < SIDE_PASS_WITHIN * length;
    let kick = if suits && turn(off) < turn(Angle::ZERO) { side } else { ahead };
    shoot(belief, direction, kick)
}

/// The direction from the ball (or the robot, while no ball is seen) to `target`.
pub fn aim(belief: &Belief, target: Point<Field>) -> Angle {
    let from = belief.ball.map_or(belief.pose.position, |ball| ball.position);
    // A ball between the legs is nearer the pivot than the target is: aim from the body.
    let from = if belief.holds_ball { belief.pose.position } else { from };
    from.direction_to(target)
}

/// Carries the ball held to `to`; done when the ball is within `tolerance` of it, m.
pub fn carry_to(belief: &Belief, to: Point<Field>, tolerance: f32) -> Step {
    // A robot that stands between the ball and the target has not brought the ball there.
    let ball = belief.ball.map_or(belief.pose.position, |ball| ball.position);
    if ball.distance(to) <= tolerance { Step::Done } else { Step::Running(Intent::Carry { to }) }
}

/// A pass would roll this much farther than its receiver stands: over a metre it arrives with 0.37 m/s, which
/// can still be grabbed, and in 1.6 s instead of the 2.4 s of one that stops there (0.35 m/s²).
const PASS_FIRMLY: f32 = 1.2;
/// A head kick may miss the wanted length by this share: about the scatter of kicks.
const SIDE_PASS_WITHIN: f32 = 0.3;
/// Aiming tolerance of a kick, rad: half of the 10° by which it scatters anyway.
const AIM_WITHIN: f32 = 0.087;

#[cfg(test)]
mod tests {
    use super::*;
    use rules::League;

    #[test]
    fn a_pass_aside_is_a_head_kick_where_its_length_suits() {
        let belief = Belief::new(League::FourLegged);
        assert_eq!(pass(&belief, Point::new(0.31, 1.16)), Intent::Kick(LeggedKick::Left));
        // Too near for a head kick: turn and pass.
        let Intent::Turn { heading } = pass(&belief, Point::new(0.1, 0.4)) else { panic!("turns") };
        assert!(heading.to_degrees() > 70.0);
        let Intent::Kick(LeggedKick::Pass(length)) = pass(&belief, Point::new(1.0, 0.0)) else {
            panic!("passes")
        };
        assert!((length - PASS_FIRMLY).abs() < 1e-6);
    }

    #[test]
    fn a_left_kick_points_the_robot_to_the_right_of_its_target() {
        let belief = Belief::new(League::FourLegged);
        let intent = shoot(&belief, Angle::degrees(75.0), LeggedKick::Left);
        assert_eq!(intent, Intent::Kick(LeggedKick::Left));
        let Intent::Turn { heading } = shoot(&belief, Angle::ZERO, LeggedKick::Left) else { panic!("turns") };
        assert!((heading.to_degrees() + 75.0).abs() < 1e-3);
    }
}
