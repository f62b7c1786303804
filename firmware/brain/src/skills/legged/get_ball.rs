//! `get_ball`: intercept the ball and take it. Field frame, SI.

use geometry::{Angle, Field, Point, Vector, math};
use motion::legged::{CARRY_TURN_RATE, GRAB_HALF_ANGLE, GRAB_REACH, WALK_FORWARD};

use crate::belief::{Belief, BelievedBall};
use crate::body::Intent;
use crate::skills::Step;

/// Takes the ball; facing `exit_heading` afterwards if that costs no race against an opponent.
pub fn get_ball(belief: &Belief, exit_heading: Option<Angle>) -> Step {
    if belief.holds_ball {
        return Step::Done;
    }
    let Some(ball) = belief.ball else { return Step::Running(Intent::Stand { face: None }) };
    if belief.busy {
        return Step::Running(Intent::Stand { face: None });
    }
    let pose = belief.pose;
    let seen = pose.to_body(ball.position);
    let distance = math::hypot(seen.x(), seen.y());
    let off = math::atan2(seen.y(), seen.x()).abs();
    if distance < GRAB_REACH && off < GRAB_HALF_ANGLE && belief.may_grab() {
        return Step::Running(Intent::Grab);
    }
    let (interception_point, in_time) = interception_point(&ball, pose.position);
    let direct = pose.position.direction_to(interception_point);
    if let Some(exit_heading) = exit_heading
        && distance > STAND_OFF
        && let Some(to) = place_behind(
            belief,
            &ball,
            exit_heading,
            in_time + (exit_heading - direct).abs() / CARRY_TURN_RATE,
        )
    {
        return Step::Running(Intent::Walk { to, face: exit_heading, avoid_ball: true });
    }
    // No slowing down before the ball is in reach: the walk would end beyond that.
    let to = interception_point - Vector::polar(WALK_UP_TO, direct);
    let face = if distance < NEAR_BALL_M { pose.position.direction_to(ball.position) } else { direct };
    Step::Running(Intent::Walk { to, face, avoid_ball: false })
}

/// Where to stand for a ball that will stop, so as to face `exit_heading` with it at once; `None` where
/// intercepting it and turning with it, ready `by` seconds from now, is quicker, or an opponent is there
/// first.
fn place_behind(belief: &Belief, ball: &BelievedBall, exit_heading: Angle, by: f32) -> Option<Point<Field>> {
    let from = belief.pose.position;
    let behind = ball.rest - Vector::polar(STAND_OFF, exit_heading);
    // Around the ball the path is an arc about it, not through it.
    let astray = (exit_heading - from.direction_to(ball.rest)).abs();
    let arc = BALL_CLEARANCE * (astray - math::FRAC_PI_2).max(0.0);
    let walk = (from.distance(behind) + arc) / WALK_FORWARD;
    let ready = walk.max(ball.rolls_for());
    let opponent = belief
        .nearest_opponent(ball.rest)
        .map_or(f32::INFINITY, |(_, distance)| (distance - GRAB_REACH) / WALK_FORWARD);
    (ready + WORTH_TURNING < by && ready < opponent).then_some(behind)
}

/// Where a robot that now stands at `from` can have the ball, and in how many seconds: the earliest point on
/// the ball's path that it reaches no later than the ball, else the ball's stop position.
pub fn interception_point(ball: &BelievedBall, from: Point<Field>) -> (Point<Field>, f32) {
    let walk = |to: Point<Field>| from.distance(to) / WALK_FORWARD;
    if ball.is_at_rest() {
        return (ball.position, walk(ball.position));
    }
    let offset = ball.rest - ball.position;
    // An evenly slowing ball: at share 1 − (1 − τ)² of its path after share τ of its time.
    let duration = ball.rolls_for();
    for step in 1..INTERCEPTION_POINT_STEPS {
        let tau = step as f32 / INTERCEPTION_POINT_STEPS as f32;
        let point = ball.position + offset * (1.0 - (1.0 - tau) * (1.0 - tau));
        if walk(point) <= tau * duration {
            return (point, tau * duration);
        }
    }
    (ball.rest, walk(ball.rest).max(duration))
}

/// Distance of the robot's centre behind the ball for a grab, m: the ball lies between the front legs.
const STAND_OFF: f32 = 0.14;
/// End of a walk straight to the ball, before its centre, m: less than the grab's reach.
const WALK_UP_TO: f32 = 0.08;
/// Within this distance only the time to the ball counts, m.
const NEAR_BALL_M: f32 = 0.5;
/// Least gain of standing behind the ball, s: the steps that a robot needs to stand still there.
const WORTH_TURNING: f32 = 0.3;
/// Distance from the ball at which a robot walks around it, m.
const BALL_CLEARANCE: f32 = 0.2;
/// Points tried on the ball's path.
const INTERCEPTION_POINT_STEPS: u32 = 16;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::teammates::Teammates;
    use geometry::{Pose, Twist};
    use protocol::robot_io::{BallSight, Health, SensorFrame};
    use protocol::{Duration, Instant, RobotId};
    use rules::League;

    fn belief(ball: (f32, f32), velocity: (f32, f32), rest: (f32, f32)) -> Belief {
        let mut belief = Belief::new(League::FourLegged);
        belief.pose = Pose::from_mm_deg(0.0, 0.0, 0.0);
        belief.ball = Some(BelievedBall {
            position: Point::new(ball.0, ball.1),
            velocity: Vector::new(velocity.0, velocity.1),
            rest: Point::new(rest.0, rest.1),
        });
        belief
    }

    fn see_twice(b: &mut Belief, x: f32) {
        for ms in [40, 80] {
            let sensors = SensorFrame {
                pose: Some(b.pose),
                ball: Some(BallSight { position: Point::new(x, 0.0), sigma: 0.0, age: Duration(0) }),
                opponents: heapless::Vec::new(),
                ball_contact: false,
                busy: false,
                odometry: Twist::default(),
                health: Health::default(),
                camera: None,
            };
            b.update(Instant(ms * 1000), RobotId::new(1).unwrap(), &sensors, &Teammates::default());
        }
    }

    #[test]
    fn a_ball_in_reach_is_grabbed_and_one_held_is_done() {
        let mut b = belief((0.16, 0.0), (0.0, 0.0), (0.16, 0.0));
        assert!(!matches!(get_ball(&b, None), Step::Running(Intent::Grab)), "one look is not enough");
        see_twice(&mut b, 0.16);
        assert_eq!(get_ball(&b, None), Step::Running(Intent::Grab));
        b.holds_ball = true;
        assert_eq!(get_ball(&b, None), Step::Done);
    }

    #[test]
    fn a_rolling_ball_is_met_where_the_robot_is_in_time() {
        // 1 m ahead, rolling to the left at 0.7 m/s, stopping after 0.7 m and 2 s: the robot needs more than
        // 3 s.
        let b = belief((1.0, 0.0), (0.0, 0.7), (1.0, 0.7));
        assert_eq!(interception_point(&b.ball.unwrap(), b.pose.position).0, Point::new(1.0, 0.7));
        // Rolling towards the robot it is intercepted.
        let b = belief((1.0, 0.0), (-0.7, 0.0), (0.3, 0.0));
        let met = interception_point(&b.ball.unwrap(), b.pose.position).0;
        assert!(met.x() > 0.3 && met.x() < 0.7, "{met:?}");
    }

    #[test]
    fn with_time_it_walks_around_to_face_onwards() {
        let b = belief((0.6, 0.0), (0.0, 0.0), (0.6, 0.0));
        let Step::Running(Intent::Walk { to, avoid_ball, .. }) = get_ball(&b, Some(Angle::HALF_TURN)) else {
            panic!("walks")
        };
        assert!(avoid_ball && to.x() > 0.7);
        // With an opponent at the ball it walks straight to it.
        let mut contested = b.clone();
        let _ = contested.opponents.push(Point::new(1.0, 0.0));
        let Step::Running(Intent::Walk { to, .. }) = get_ball(&contested, Some(Angle::HALF_TURN)) else {
            panic!("walks")
        };
        assert!(to.x() < 0.55, "straight up to the ball: {to:?}");
    }

    #[test]
    fn for_a_ball_that_comes_to_rest_near_it_stands_where_it_will_face_onwards() {
        // Rolling towards it for 2.4 s, stopping 0.4 m ahead; a quarter turn with the ball would take 1.6 s
        // more.
        let b = belief((1.4, 0.0), (-0.84, 0.0), (0.4, 0.0));
        let left = Angle::degrees(90.0);
        let Step::Running(Intent::Walk { to, face, .. }) = get_ball(&b, Some(left)) else { panic!("walks") };
        assert!(to.distance(Point::new(0.4, -STAND_OFF)) < 1e-4 && face == left, "{to:?}");
    }
}
