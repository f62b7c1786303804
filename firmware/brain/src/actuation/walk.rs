//! `walk`: conversion of intents to walking velocities and primitives; SI, body frame out.
//!
//! Far from its goal the robot turns towards its direction of travel and walks ahead (its fastest gait); near
//! it, it steps sideways and turns to the heading wanted at the end. Robots on the path are walked around,
//! one at a time, nearest first.

use geometry::{Angle, Body, Field, Point, Pose, Segment, Twist, Vector, math};
use motion::legged::{CARRY_SPEED, CARRY_TURN_RATE, TURN_RATE, WALK_FORWARD, WALK_SIDEWAYS};
use protocol::robot_io::{ActuatorFrame, LeggedPrimitive};

use crate::belief::Belief;
use crate::body::Intent;
use crate::teammates::Teammates;
use protocol::Instant;

/// The frame that makes the body do `intent`.
pub(super) fn actuate(now: Instant, belief: &Belief, teammates: &Teammates, intent: Intent) -> ActuatorFrame {
    let pose = belief.pose;
    match intent {
        Intent::Stand { face: None } => walk(Twist::default()),
        Intent::Stand { face: Some(heading) } | Intent::Turn { heading } => {
            let limit = if belief.holds_ball { CARRY_TURN_RATE } else { TURN_RATE };
            walk(Twist { linear: Vector::default(), angular: turn(pose, heading, limit) })
        }
        Intent::Walk { to, face, avoid_ball } => {
            // Adapted positions may lie outside (they are never clamped): the body stays on the field
            // surface.
            let to = belief.league().field().clamp(to, SURFACE);
            let way_point = around(now, belief, teammates, to, avoid_ball);
            let far = pose.position.distance(to) > FACE_END_WITHIN;
            let heading = if far { pose.position.direction_to(way_point) } else { face };
            walk(Twist { linear: step_to(pose, way_point, to), angular: turn(pose, heading, TURN_RATE) })
        }
        Intent::Carry { to } => {
            let heading = pose.position.direction_to(to);
            let ahead = if (heading - pose.heading).abs() < CARRY_AHEAD_WITHIN { CARRY_SPEED } else { 0.0 };
            let linear = Vector::new(ahead.min(pose.position.distance(to) * GAIN), 0.0);
            walk(Twist { linear, angular: turn(pose, heading, CARRY_TURN_RATE) })
        }
        Intent::Grab => primitive(LeggedPrimitive::Grab),
        Intent::Kick(kick) => primitive(LeggedPrimitive::Kick(kick)),
        // Legs have no wheels.
        Intent::Drive(_) | Intent::KeepPath => walk(Twist::default()),
    }
}

fn walk(walk: Twist<Body>) -> ActuatorFrame {
    ActuatorFrame::Legged { walk, primitive: LeggedPrimitive::None }
}

fn primitive(primitive: LeggedPrimitive) -> ActuatorFrame {
    ActuatorFrame::Legged { walk: Twist::default(), primitive }
}

fn turn(pose: Pose<Field>, heading: Angle, limit: f32) -> f32 {
    math::clamp((heading - pose.heading).radians() * TURN_GAIN, -limit, limit)
}

/// Velocity towards `way_point`, within the gait's limits in that direction, slowing down before `end`.
fn step_to(pose: Pose<Field>, way_point: Point<Field>, end: Point<Field>) -> Vector<Body> {
    let Some(direction) = (way_point - pose.position).unit() else { return Vector::default() };
    let left = pose.position.distance(end);
    let body = pose.vector_to_body(direction * (left * GAIN).min(WALK_FORWARD));
    let ahead = if body.x() > 0.0 { WALK_FORWARD } else { WALK_SIDEWAYS };
    let excess = (body.x().abs() / ahead).max(body.y().abs() / WALK_SIDEWAYS).max(1.0);
    body * (1.0 / excess)
}

/// The next point to walk to on the path to `to`: `to` itself, or a point beside the first obstacle on the
/// path.
fn around(
    now: Instant,
    belief: &Belief,
    teammates: &Teammates,
    to: Point<Field>,
    avoid_ball: bool,
) -> Point<Field> {
    let path = Segment::new(belief.pose.position, to);
    let others = teammates.present(now).map(|(_, teammate)| teammate.pose().position);
    let robots = belief
        .opponents
        .iter()
        .copied()
        .chain(others)
        // A robot on the target itself cannot be walked around.
        .filter(|robot| robot.distance(to) > ROBOT_CLEARANCE)
        .map(|robot| (robot, ROBOT_CLEARANCE));
    let ball = belief.ball.filter(|_| avoid_ball).map(|ball| (ball.position, BALL_CLEARANCE));
    let first = robots
        .chain(ball)
        .map(|(at, clearance)| (at, clearance, path.share_of(at)))
        .filter(|&(at, clearance, share)| (0.0..1.0).contains(&share) && path.distance_to(at) < clearance)
        .reduce(|a, b| if b.2 < a.2 { b } else { a });
    match first {
        Some((at, clearance, _)) => beside(path, at, clearance + SIDE_STEP),
        None => to,
    }
}

/// The point `offset` beside `obstacle`, on the side on which the path already runs.
fn beside(path: Segment<Field>, obstacle: Point<Field>, offset: f32) -> Point<Field> {
    let Some(along) = path.vector().unit() else { return path.to };
    let left = Vector::new(-along.y(), along.x());
    let side = if along.cross(obstacle - path.from) > 0.0 { -1.0 } else { 1.0 };
    obstacle + left * (side * offset)
}

/// How far within the lines a walk may end, m: negative, half a body outside on the edge of the field
/// surface.
const SURFACE: f32 = -0.1;
/// The robot is near enough to turn to its final heading, m: the distance walked during half a turn.
const FACE_END_WITHIN: f32 = 0.4;
/// Heading is near enough to walk ahead with the ball, rad.
const CARRY_AHEAD_WITHIN: f32 = 0.4;
/// Approach: speed per metre left, 1/s; with 0.6 m/s² the body can stop from it.
const GAIN: f32 = 2.0;
/// Turning: rate per rad left, 1/s.
const TURN_GAIN: f32 = 4.0;
/// Distance of centres at which two robots pass each other: two radii of 0.12 m and a foot, m.
const ROBOT_CLEARANCE: f32 = 0.30;
/// Distance at which a robot passes a ball without touching it, m.
const BALL_CLEARANCE: f32 = 0.17;
/// How much farther out than the clearance the intermediate point lies, m.
const SIDE_STEP: f32 = 0.06;

const _: () = assert!(math::PI > CARRY_AHEAD_WITHIN);

#[cfg(test)]
mod tests {
    use super::*;
    use rules::League;

    fn at(x: f32, y: f32) -> Belief {
        let mut belief = Belief::new(League::FourLegged);
        belief.pose = Pose { position: Point::new(x, y), heading: Angle::ZERO };
        belief
    }

    fn walking(belief: &Belief, intent: Intent) -> Twist<Body> {
        match actuate(Instant(0), belief, &Teammates::default(), intent) {
            ActuatorFrame::Legged { walk, primitive: LeggedPrimitive::None } => walk,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn straight_ahead_is_walked_at_full_speed_and_no_faster() {
        let to = Point::new(2.0, 0.0);
        let twist = walking(&at(0.0, 0.0), Intent::Walk { to, face: Angle::ZERO, avoid_ball: false });
        assert!((twist.linear.x() - WALK_FORWARD).abs() < 1e-6);
        let side = Point::new(0.0, 0.3);
        let twist = walking(&at(0.0, 0.0), Intent::Walk { to: side, face: Angle::ZERO, avoid_ball: false });
        assert!((twist.linear.y() - WALK_SIDEWAYS).abs() < 1e-6);
    }

    #[test]
    fn a_robot_in_the_way_is_passed_on_the_nearer_side() {
        let mut belief = at(0.0, 0.0);
        let _ = belief.opponents.push(Point::new(0.5, 0.1));
        let to = Point::new(2.0, 0.0);
        let twist = walking(&belief, Intent::Walk { to, face: Angle::ZERO, avoid_ball: false });
        assert!(twist.linear.y() < -0.05, "{twist:?}");
    }

    #[test]
    fn a_robot_at_the_goal_of_the_walk_does_not_stop_it() {
        let mut belief = at(0.0, 0.0);
        let _ = belief.opponents.push(Point::new(1.0, 0.1));
        let to = Point::new(1.0, 0.0);
        let twist = walking(&belief, Intent::Walk { to, face: Angle::ZERO, avoid_ball: false });
        assert!(twist.linear.y().abs() < 1e-6);
    }

    #[test]
    fn with_the_ball_it_turns_slowly() {
        let mut belief = at(0.0, 0.0);
        belief.holds_ball = true;
        let twist = walking(&belief, Intent::Turn { heading: Angle::HALF_TURN });
        assert_eq!(twist.angular.abs(), CARRY_TURN_RATE);
    }
}
