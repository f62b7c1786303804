//! Receive: be on the line of a passed ball, face it, retreat as it comes; or redirect it at first touch.
//!
//! One touch: the kicker adds its speed along the heading, the ball keeps part of its speed across the
//! heading. The heading between where the ball comes from and where it goes is found by three corrections.
//! Beyond 60° it is taken instead.

use geometry::{Angle, Field, Point, Vector};
use protocol::robot_io::OmniKick;

use crate::belief::{Belief, BelievedBall};
use crate::body::Intent;
use crate::body::omni::{BALL_AT, Drive, SHOT};
use crate::skills::wheels::get_ball::{get_ball, receive_at};
use crate::skills::wheels::kick::{kick_held, pass_speed};
use crate::skills::{Reception, Step};

/// Receives a passed ball at `at`, and redirects it to `then`.
pub fn receive(belief: &Belief, at: Point<Field>, then: Option<Point<Field>>) -> Intent {
    if belief.holds_ball {
        return match then {
            Some(then) => kick_held(belief, then, redirecting_kick(belief, then).0),
            None => Intent::Stand { face: None },
        };
    }
    let Some(ball) = belief.ball else { return Drive::avoiding(at, belief.pose.heading).into() };
    if !comes(belief, &ball, at) {
        // One that has bounced off the front, too: it is not waited for.
        let slow = ball.velocity.norm() < APPROACH_SPEED_MIN;
        if slow && ball.position.distance(at) < FETCHED {
            return match get_ball(belief, None) {
                Step::Running(intent) => intent,
                Step::Done => Intent::Stand { face: None },
            };
        }
        // Its dribbler opening waits where the ball shall come.
        let face = at.direction_to(ball.position);
        return Drive::avoiding(at - Vector::polar(BALL_AT, face), face).into();
    }
    let line = ball.path();
    // The ordered place, or where the line passes it.
    let meeting_point = line.closest_to(at);
    let direction = ball.velocity.unit().unwrap_or_default();
    if let Some(then) = then
        && let (kick, speed) = redirecting_kick(belief, then)
        && let Some(face) = deflection(&ball, meeting_point, then, speed)
    {
        let place = meeting_point - Vector::polar(BALL_AT, face);
        return Drive { kick, ..Drive::bold(place, face) }.into();
    }
    receive_at(belief, &ball, meeting_point + direction * BALL_AT).into()
}

/// The case language's `receive_ball`: takes a ball that was passed to this robot, anywhere near.
pub fn take_pass(belief: &Belief, exit_heading: Option<Angle>) -> Reception {
    if belief.holds_ball {
        return Reception::Going(Step::Done);
    }
    let Some(ball) = belief.ball else { return Reception::Going(get_ball(belief, exit_heading)) };
    let me = belief.pose.position;
    let missed = if ball.velocity.norm() < RESTS {
        ball.position.distance(me) > FETCHED
    } else {
        ball.path().distance_to(me) > FETCHED
    };
    if missed { Reception::Missed } else { Reception::Going(get_ball(belief, exit_heading)) }
}

/// Whether the ball comes towards the robot: past `at` or this robot within a metre.
fn comes(belief: &Belief, ball: &BelievedBall, at: Point<Field>) -> bool {
    let me = belief.pose.position;
    let towards = ball.velocity.dot(at - ball.position) > 0.0 || ball.velocity.dot(me - ball.position) > 0.0;
    let line = ball.path();
    ball.velocity.norm() > APPROACH_SPEED_MIN
        && towards
        && line.distance_to(at).min(line.distance_to(me)) < REACH
}

/// The kick that redirects it, and its speed, m/s.
fn redirecting_kick(belief: &Belief, then: Point<Field>) -> (OmniKick, f32) {
    let field = belief.league().field();
    let goal = field.goal_center(belief.game.defending.opposite());
    // At their goal at full speed, else as a pass.
    let shot = then.distance(goal) < 0.5 * field.goal_width + 0.1;
    let speed = if shot { SHOT } else { pass_speed(belief.dribbler_point().distance(then)) };
    (OmniKick::Flat(speed), speed)
}

/// The heading from which the incoming ball is redirected to `then`; `None` where that is too far round.
fn deflection(ball: &BelievedBall, at: Point<Field>, then: Point<Field>, speed: f32) -> Option<Angle> {
    let wanted = at.direction_to(then);
    let back = (-ball.velocity).angle();
    if (wanted - back).abs() > DEFLECTS {
        return None;
    }
    let mut face = wanted;
    for _ in 0..3 {
        let heading = Vector::<Field>::polar(1.0, face);
        let across = ball.velocity - heading * ball.velocity.dot(heading);
        let leaves = heading * speed + across * KEEPS_ACROSS;
        face = face + (wanted - leaves.angle());
    }
    Some(face)
}

/// A slower ball is stationary, m/s.
const RESTS: f32 = 0.15;
/// A faster ball approaches, m/s.
const APPROACH_SPEED_MIN: f32 = 0.4;
/// A pass that ends within this distance is fetched, m.
const FETCHED: f32 = 1.0;
/// A ball that passes within this distance can be taken, m.
const REACH: f32 = 1.0;
/// The largest angle between the ball's origin and its target at first touch, rad: 60° (docs/papers.md D11).
const DEFLECTS: f32 = core::f32::consts::FRAC_PI_3;
/// Share of its speed across the heading that a ball keeps in a kick (the simulator's friction, an estimate).
const KEEPS_ACROSS: f32 = 0.7;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::skills::wheels::testing::{belief, rolling};

    fn drive(intent: Intent) -> Drive {
        match intent {
            Intent::Drive(drive) => drive,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn before_the_pass_its_dribbler_waits_at_the_ordered_place_facing_the_ball() {
        let waiting = drive(receive(&belief((1.0, 1.0, 0.0), (-1.0, 0.0)), Point::new(1.0, 0.0), None));
        assert!(waiting.to.distance(Point::new(1.0 + BALL_AT, 0.0)) < 1e-5, "{waiting:?}");
        assert!((waiting.face - Angle::HALF_TURN).abs() < 1e-5);
    }

    #[test]
    fn a_pass_that_goes_astray_is_met_on_its_line() {
        let b = rolling(belief((1.1, 0.0, 180.0), (-1.0, 0.0)), (3.0, 0.6));
        let met = drive(receive(&b, Point::new(1.0, 0.0), None));
        // The line passes (1, 0.4): beyond that.
        assert!(met.to.y() > 0.3, "{met:?}");
    }

    #[test]
    fn within_60_degrees_it_is_sent_on_at_first_touch_and_beyond_it_is_taken() {
        let b = rolling(belief((2.0, 0.0, 180.0), (0.0, 0.0)), (3.0, 0.0));
        let (at, goal) = (Point::new(2.0, 0.0), Point::new(0.0, 2.0));
        let sent = drive(receive(&b, at, Some(goal)));
        assert!(matches!(sent.kick, OmniKick::Flat(_)));
        // The ball drifts on to +x: aimed farther back than straight at the goal (135°), not as far as it
        // came from (180°).
        assert!(
            sent.face.to_degrees() > 135.0 && sent.face.to_degrees() < 180.0,
            "{}",
            sent.face.to_degrees()
        );
        let taken = drive(receive(&b, at, Some(Point::new(4.0, 2.0))));
        assert_eq!(taken.kick, OmniKick::None);
    }

    #[test]
    fn a_ball_that_bounced_off_its_front_is_followed_and_not_waited_for() {
        let b = rolling(belief((0.0, 0.0, 180.0), (-BALL_AT - 0.02, 0.0)), (-0.25, 0.0));
        let follows = drive(receive(&b, Point::new(-0.05, 0.0), None));
        assert!(follows.to.x() < 0.0 && follows.face.abs() > 3.0, "{follows:?}");
    }
}
