//! Block: stand on a stretch where the ball would cross it, and stop an approaching ball.
//!
//! A ball that approaches: at the point of most slack on its path, by `motion::intercept`, but never behind
//! the stretch. Otherwise: on the line from the ball to the own goal, or along the heading of its holder. The
//! keeper's stretch lies before its goal.

use geometry::{Field, Point, Pose, Segment};
use motion::ball::BallModel;
use motion::intercept::{InterceptRequest, InterceptVerdict, Interception};
use rules::limits::ROBOT_RADIUS;
use rules::{Phase, Side};

use crate::belief::{Belief, BelievedBall};
use crate::body::Intent;
use crate::body::omni::{BALL_AT, Drive};
use crate::skills::wheels::get_ball::{INTERCEPTION_EFFORT_MAX, LOOKS_AHEAD};

/// Blocks a ball on `stretch`.
pub fn block(belief: &Belief, stretch: Segment<Field>) -> Intent {
    let me = belief.pose.position;
    let Some(ball) = belief.ball else {
        let middle = stretch.from + stretch.vector() * 0.5;
        return Drive::avoiding(middle, belief.pose.heading).into();
    };
    let face = me.direction_to(ball.position);
    if let Some(crossing) = coming(&ball, stretch) {
        let (place, effort) = stop(belief, &ball, crossing);
        return Drive { dribbler: 1.0, effort, ..Drive::bold(place, face) }.into();
    }
    Drive::avoiding(threatened(belief, &ball, stretch), face).into()
}

/// Point at which an approaching ball crosses the stretch.
fn coming(ball: &BelievedBall, stretch: Segment<Field>) -> Option<Point<Field>> {
    if ball.velocity.norm() < APPROACH_SPEED_MIN {
        return None;
    }
    let ball_path = ball.path();
    crossing(ball_path, stretch, BLOCKED_BESIDE_M)
}

/// The point with the most slack on the ball's path to `crossing`, and the instructions of its search.
fn stop(belief: &Belief, ball: &BelievedBall, crossing: Point<Field>) -> (Point<Field>, u32) {
    let path = BallModel::default().rolling(ball.position, ball.velocity);
    let until = path.time_to(ball.position.distance(crossing)).unwrap_or(f32::INFINITY).min(LOOKS_AHEAD);
    let question = Interception {
        robot: belief.pose.position,
        velocity: belief.velocity,
        ball: &path,
        target: ball.position - path.along() * FAR_BACK,
        reach: BALL_AT,
        until,
    };
    let limits = belief.limits_without_ball();
    let (verdict, effort) = question.find_within(&limits, InterceptRequest::Safest, INTERCEPTION_EFFORT_MAX);
    let place = match verdict {
        InterceptVerdict::Intercepts(interception_point) if interception_point.slack() > 0.0 => {
            interception_point.place
        }
        // Too late to stop there: go where it crosses, as fast as possible; a body on the ball's path is
        // enough.
        _ => crossing,
    };
    (place, effort)
}

/// Point at which a ball that does not approach would cross the stretch.
fn threatened(belief: &Belief, ball: &BelievedBall, stretch: Segment<Field>) -> Point<Field> {
    let goal = belief.league().field().goal_center(belief.game.defending);
    // The kicker of a penalty reveals its aim by where it lines up: there is no time to wait for the ball.
    let penalty = belief.game.phase == Phase::Penalty(Side::Theirs);
    let looks_at_it =
        |pose: Pose<Field>| (pose.position.direction_to(ball.position) - pose.heading).abs() < LOOKS_AT;
    let holder = belief.others.iter().filter(|other| other.side == Side::Theirs).find(|other| {
        let distance = other.pose.position.distance(ball.position);
        if penalty {
            distance < LINES_UP && looks_at_it(other.pose)
        } else {
            distance < POSSESSION_DISTANCE_M
        }
    });
    let shot = holder.and_then(|other| {
        let along = geometry::Vector::polar(FAR_BACK, other.pose.heading);
        crossing(Segment::new(ball.position, ball.position + along), stretch, 0.0)
    });
    let straight = crossing(Segment::new(ball.position, goal), stretch, 0.0);
    shot.or(straight).unwrap_or_else(|| stretch.closest_to(ball.position))
}

/// Intersection of two stretches; the second one is longer by `beyond` at either end, and a crossing there is
/// moved onto it.
fn crossing(ball_path: Segment<Field>, stretch: Segment<Field>, beyond: f32) -> Option<Point<Field>> {
    let (v, w) = (ball_path.vector(), stretch.vector());
    let across = v.cross(w);
    if across.abs() < f32::MIN_POSITIVE {
        return None;
    }
    let between = stretch.from - ball_path.from;
    let (along, share) = (between.cross(w) / across, between.cross(v) / across);
    let slack = beyond / w.norm().max(f32::MIN_POSITIVE);
    let crosses = (0.0..=1.0).contains(&along) && (-slack..=1.0 + slack).contains(&share);
    crosses.then(|| stretch.from + w * share.clamp(0.0, 1.0))
}

/// A faster ball approaches, m/s.
const APPROACH_SPEED_MIN: f32 = 0.3;
/// A ball that passes the stretch's ends within this is blocked there, m: a robot's width.
const BLOCKED_BESIDE_M: f32 = 2.0 * ROBOT_RADIUS;
/// An opponent this near the ball has it, m.
const POSSESSION_DISTANCE_M: f32 = 0.15;
/// The kicker of a penalty this near the ball lines up for its shot, m; and faces it within this, rad.
const LINES_UP: f32 = 0.6;
const LOOKS_AT: f32 = 0.3;
/// A point far along a line, m.
const FAR_BACK: f32 = 20.0;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::skills::wheels::testing::{belief, rolling};
    use geometry::GoalEnd;

    fn goes_to(intent: Intent) -> Point<Field> {
        match intent {
            Intent::Drive(drive) => drive.to,
            other => panic!("{other:?}"),
        }
    }

    fn line() -> Segment<Field> {
        Segment::new(Point::new(-4.3, -0.5), Point::new(-4.3, 0.5))
    }

    #[test]
    fn a_ball_that_lies_is_watched_from_its_line_to_the_goal() {
        let mut b = belief((-4.3, 0.0, 0.0), (-2.5, 1.0));
        b.game.defending = GoalEnd::Negative;
        // From (−2.5, 1) to (−4.5, 0): at x = −4.3 it is 0.1.
        assert!(goes_to(block(&b, line())).distance(Point::new(-4.3, 0.1)) < 1e-5);
    }

    #[test]
    fn a_shot_is_met_where_there_is_most_time_and_not_behind_the_stretch() {
        let b = rolling(belief((-4.3, 0.0, 0.0), (-1.3, 0.4)), (-3.0, 0.0));
        let to = goes_to(block(&b, line()));
        // On its line, but no nearer the ball than useful.
        assert!((to.y() - 0.4).abs() < 1e-3 && to.x() >= -4.3 - BALL_AT - 1e-3, "{to:?}");
        // A ball too fast to be intercepted is still approached, on the stretch.
        let b = rolling(belief((-4.3, -0.5, 0.0), (-3.6, 0.45)), (-6.0, 0.0));
        assert!(goes_to(block(&b, line())).distance(Point::new(-4.3, 0.45)) < 1e-3);
    }

    #[test]
    fn at_a_penalty_the_keeper_goes_where_the_kicker_lines_up_to_shoot() {
        let mut b = belief((-4.5, 0.0, 0.0), (1.5, 0.0));
        b.game.defending = GoalEnd::Negative;
        let goal_line = Segment::new(Point::new(-4.5, -0.5), Point::new(-4.5, 0.5));
        // 0.4 m behind the ball, facing across it to the goal line's y = −0.3: 6 m on, 0.3 m aside.
        let along = Point::<Field>::new(1.5, 0.0).direction_to(Point::new(-4.5, -0.3));
        let pose =
            Pose { position: Point::new(1.5, 0.0) - geometry::Vector::polar(0.4, along), heading: along };
        let id = protocol::RobotId::ZERO;
        b.others
            .push(crate::belief::Other {
                side: Side::Theirs,
                id,
                pose,
                velocity: geometry::Vector::default(),
            })
            .unwrap();
        b.game.phase = Phase::PreparePenalty(Side::Theirs);
        assert!(goes_to(block(&b, goal_line)).y().abs() < 1e-3, "not before it may shoot");
        b.game.phase = Phase::Penalty(Side::Theirs);
        assert!(
            (goes_to(block(&b, goal_line)).y() + 0.3).abs() < 0.01,
            "{:?}",
            goes_to(block(&b, goal_line))
        );
    }

    #[test]
    fn a_ball_that_misses_the_stretch_is_not_chased() {
        let b = rolling(belief((-4.3, 0.0, 0.0), (-2.0, 1.0)), (-3.0, 0.0));
        assert!(goes_to(block(&b, line())).y() < 0.2);
    }
}
