//! `possession`: which robot has the ball, and how soon each robot can play it. Attack frame, SI units.
//!
//! A robot *has* the ball while it lies or rolls slowly before its front plate. The robot that has it keeps
//! it until another robot does, or the ball has left it. Robots that do not have it are compared by the time
//! at which they can be *behind* it, where they intercept it: at the side from which they can play it.

use geometry::{Attack, Point, Vector};
use motion::ball::BallModel;
use motion::trajectory::FreeLimits;
use protocol::{Instant, RobotId};
use rules::contact;

use super::pass::reach::Mover;
use super::view::{RobotSet, View, ViewBall, ViewRobot, nearest};

/// Half the width of the dribbler opening, m: front plates are 0.12 to 0.16 wide.
const OPENING_HALF_M: f32 = 0.06;
/// A robot that has the ball keeps it while that is this much farther off, m: a ball bounces off the roller.
const KEPT_MARGIN_M: f32 = 0.03;
/// A ball felt by the sensor of a robot is at most this far from its centre, m: cameras err by less.
const FELT_WITHIN_M: f32 = 0.16;
/// A ball that passes a robot is faster than this against it, m/s.
const RELATIVE_SPEED_MAX_M_S: f32 = 1.0;
/// A slower ball rests, m/s.
const RESTING_SPEED_MAX_M_S: f32 = 0.2;
/// From the ball to the centre of a robot behind it, m.
const BEHIND_BALL_M: f32 = contact::TOUCHES_WITHIN;
/// Steps along the ball's path, s.
const TIME_STEP_S: f32 = 0.05;
/// Cost of moving around a ball, s: half a circle of 0.2 m radius at moderate speed (estimate).
const AROUND_BALL_COST_S: f32 = 0.4;

/// Possession of the ball by robots.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Possession {
    /// No robot has the ball.
    #[default]
    Free,
    /// This robot of ours, since.
    Ours(RobotId, Instant),
    /// This robot of theirs, since.
    Theirs(RobotId, Instant),
    /// A robot of each team, ours first.
    Contested(RobotId, RobotId),
}

impl Possession {
    /// Possession at this moment, after `self`; `contact` lists our robots whose sensors feel it.
    pub fn next(self, view: &View, contact: RobotSet) -> Self {
        let Some(ball) = view.ball else { return Self::Free };
        let (held, held_by_them) = match self {
            Self::Ours(id, _) => (Some(id), None),
            Self::Theirs(id, _) => (None, Some(id)),
            Self::Contested(ours, theirs) => (Some(ours), Some(theirs)),
            Self::Free => (None, None),
        };
        let kept = |is_held: bool| if is_held { KEPT_MARGIN_M } else { 0.0 };
        let ours = view.ours.iter().filter(|robot| {
            has(robot, &ball, kept(held == Some(robot.id)))
                || contact.has(robot.id) && robot.position.distance(ball.position) < FELT_WITHIN_M
        });
        let ours = nearest(ours, ball.position).map(|(robot, _)| robot.id);
        let theirs =
            view.theirs.iter().filter(|robot| has(robot, &ball, kept(held_by_them == Some(robot.id))));
        let theirs = nearest(theirs, ball.position).map(|(robot, _)| robot.id);
        match (ours, theirs, self) {
            (None, None, _) => Self::Free,
            (Some(ours), Some(theirs), _) => Self::Contested(ours, theirs),
            (Some(id), None, Self::Ours(before, _)) if before == id => self,
            (Some(id), None, _) => Self::Ours(id, view.now),
            (None, Some(id), Self::Theirs(before, _)) if before == id => self,
            (None, Some(id), _) => Self::Theirs(id, view.now),
        }
    }

    /// Our robot that has it, alone or against an opponent.
    pub fn owner(self) -> Option<RobotId> {
        match self {
            Self::Ours(id, _) | Self::Contested(id, _) => Some(id),
            Self::Free | Self::Theirs(..) => None,
        }
    }
}

/// Whether the ball is before the robot's front plate and moves with it.
fn has(robot: &ViewRobot, ball: &ViewBall, margin: f32) -> bool {
    let heading = Vector::<Attack>::polar(1.0, robot.heading);
    let off = ball.position - robot.position;
    let (ahead, across) = (off.dot(heading), heading.cross(off));
    ahead > 0.0
        && ahead < contact::TOUCHES_WITHIN + margin
        && across.abs() < OPENING_HALF_M + margin
        && (ball.velocity - robot.velocity).norm() < RELATIVE_SPEED_MAX_M_S
}

/// Place and time at which a robot can play the ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arrival {
    /// Time until it is behind the ball, s.
    pub seconds: f32,
    /// Place of the ball then, m.
    pub ball: Point<Attack>,
}

/// The soonest time at which `robot` can be behind the ball to play it towards `goal`, along the whole of the
/// ball's path on the field; for a ball that no robot plays before it leaves, at the line.
pub fn arrival(
    robot: &ViewRobot,
    (ball, view): (&ViewBall, &View),
    ground: &BallModel,
    limits: &FreeLimits,
    goal: Point<Attack>,
) -> Arrival {
    let mover = Mover::new(robot.position, robot.velocity, limits);
    let path = ground.rolling(ball.position, ball.velocity);
    let speed = ball.velocity.norm();
    let (mut time, mut progress) = (0.0, (0.0, speed));
    while progress.1 > RESTING_SPEED_MAX_M_S {
        let at = ball.position + path.along() * progress.0;
        let on_field = view.clamp(at, 0.0);
        if on_field != at {
            return Arrival { seconds: mover.time_to(on_field).max(time), ball: on_field };
        }
        // A rolling ball is met on its path.
        let behind = at + path.along() * BEHIND_BALL_M;
        if mover.time_to(behind) <= time {
            return Arrival { seconds: time, ball: at };
        }
        time += TIME_STEP_S;
        progress = path.progress(time);
    }
    let at = if speed > RESTING_SPEED_MAX_M_S { path.rest() } else { ball.position };
    let aim = (goal - at).unit().unwrap_or_default();
    let around = match (robot.position - at).unit() {
        // From the side that the ball shall go to, half a circle around it.
        Some(from) if robot.position.distance(at) > BEHIND_BALL_M => {
            0.5 * AROUND_BALL_COST_S * (1.0 + from.dot(aim))
        }
        _ => 0.0,
    };
    let there = mover.time_to(at - aim * BEHIND_BALL_M) + around;
    Arrival { seconds: there.max(if speed > RESTING_SPEED_MAX_M_S { time } else { 0.0 }), ball: at }
}

#[cfg(test)]
mod tests {
    use super::super::view::tests::view;
    use super::*;
    use geometry::Angle;
    use protocol::Duration;

    fn goal() -> Point<Attack> {
        Point::new(4.5, 0.0)
    }

    /// The arrival of our robot `i`.
    fn of(view: &View, i: usize) -> Arrival {
        let ball = view.ball.unwrap();
        arrival(&view.ours[i], (&ball, view), &BallModel::default(), &FreeLimits::default(), goal())
    }

    #[test]
    fn a_ball_that_leaves_the_field_is_played_at_the_line_at_the_latest() {
        // 5 m/s over the touch line after 3 m: it would come to rest 36 m away.
        let mut view = view((0.0, 0.0), &[(-4.0, -2.0)], &[]);
        for speed in [4.9, 5.0, 5.1] {
            view.ball.as_mut().unwrap().velocity = Vector::new(0.0, speed);
            let found = of(&view, 0);
            assert!(found.ball.distance(Point::new(0.0, 3.0)) < 1e-3, "{found:?}");
            assert!(found.seconds < 5.0, "{found:?}");
        }
    }

    #[test]
    fn a_robot_with_the_ball_before_its_plate_has_it_and_one_with_it_behind_has_not() {
        let mut view = view((0.1, 0.0), &[(0.0, 0.0)], &[(1.0, 0.0)]);
        let id = view.ours[0].id;
        assert_eq!(Possession::Free.next(&view, RobotSet::default()).owner(), Some(id));
        view.ours[0].heading = Angle::HALF_TURN;
        assert_eq!(Possession::Free.next(&view, RobotSet::default()), Possession::Free);
        let mut felt = RobotSet::default();
        felt.insert(id);
        assert_eq!(Possession::Free.next(&view, felt).owner(), Some(id), "its sensor feels it");
    }

    #[test]
    fn an_owner_keeps_a_ball_that_bounces_off_and_its_time_counts_from_the_first_moment() {
        let mut view = view((0.1, 0.0), &[(0.0, 0.0)], &[]);
        let first = Possession::Free.next(&view, RobotSet::default());
        view.now = Instant(view.now.0 + 300_000);
        view.ball.as_mut().unwrap().position = Point::new(contact::TOUCHES_WITHIN + 0.02, 0.0);
        let kept = first.next(&view, RobotSet::default());
        assert!(matches!(kept, Possession::Ours(_, since) if view.now.since(since) == Duration::millis(300)));
        assert_eq!(Possession::Free.next(&view, RobotSet::default()), Possession::Free);
    }

    #[test]
    fn two_robots_at_the_ball_contest_it() {
        let mut view = view((0.1, 0.0), &[(0.0, 0.0)], &[(0.2, 0.0)]);
        view.theirs[0].heading = Angle::HALF_TURN;
        let both = Possession::Contested(view.ours[0].id, view.theirs[0].id);
        assert_eq!(Possession::Free.next(&view, RobotSet::default()), both);
        assert_eq!(both.owner(), Some(view.ours[0].id));
    }

    #[test]
    fn a_ball_that_rolls_towards_a_robot_is_intercepted_on_its_path_by_hand() {
        // 2 m/s from 3 m away: 0.11 m before the robot after 1.71 s with 0.35 m/s² of friction.
        let mut view = view((3.0, 0.0), &[(0.0, 0.0)], &[]);
        let ball = view.ball.as_mut().unwrap();
        ball.velocity = Vector::new(-2.0, 0.0);
        let found = of(&view, 0);
        assert!(found.seconds < 1.75 && found.ball.x() > 0.1, "{found:?}");
        // It need not wait: driving towards the ball it meets it sooner than it would arrive.
        assert!(found.seconds < 1.71, "{found:?}");
    }

    #[test]
    fn behind_a_resting_ball_is_sooner_than_before_it() {
        let view = view((0.0, 0.0), &[(-0.5, 0.0), (0.5, 0.0)], &[]);
        let of = |i: usize| of(&view, i).seconds;
        assert!(of(0) + 0.3 < of(1), "{} {}", of(0), of(1));
    }
}
