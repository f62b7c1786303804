//! Get the ball: meet a rolling one, come up behind a resting one, and have it at the dribbler.
//!
//! Rolling: `motion::intercept` finds where the robot can stand beyond the ball in time, facing it; it stops
//! itself against the roller. Resting: around the ball to a place behind it, as seen from where it will go,
//! and slowly on from there. Before a wall or an opponent only a body's room is left: from there.

use geometry::{Angle, Field, Point, Segment, Vector, math};
use motion::ball::{BallModel, BallPath};
use motion::intercept::{InterceptRequest, InterceptVerdict, Interception};
use protocol::robot_io::OmniKick;
use rules::{Phase, contact};

use crate::belief::{Belief, BelievedBall};
use crate::body::Intent;
use crate::body::omni::{BALL_AT, Drive};
use crate::skills::Step;
use crate::skills::wheels::contest::contest;
use crate::skills::wheels::wall::wall;

/// Where a robot stands on the path to a ball at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Approach {
    /// Driving to the place behind the ball.
    Around(Drive),
    /// Behind the ball, facing the right direction: going in.
    In(Drive),
}

/// Takes the ball; facing `face` with it, or whichever heading is quickest.
pub fn get_ball(belief: &Belief, face: Option<Angle>) -> Step {
    if belief.holds_ball {
        return Step::Done;
    }
    let Some(ball) = belief.ball else { return Step::Running(Intent::Stand { face: None }) };
    let straight = belief.pose.position.direction_to(ball.position);
    let lies = belief.game.phase == Phase::Run && ball.velocity.norm() <= ROLLING;
    let has_room = barrier(belief, ball.position).is_none();
    if lies
        && has_room
        && let Some(intent) = contest(belief, &ball, face.unwrap_or(straight), OmniKick::None)
    {
        return Step::Running(intent);
    }
    Step::Running(go_for_ball(belief, &ball, face))
}

/// The same for a ball that there is time to line up for.
pub(super) fn go_for_ball(belief: &Belief, ball: &BelievedBall, face: Option<Angle>) -> Intent {
    if ball.velocity.norm() > ROLLING {
        return intercept_ball(belief, ball).into();
    }
    let face = match face {
        // With an opponent at it there is no time to go around.
        Some(face) if !is_contested(belief, ball) => face,
        _ => belief.pose.position.direction_to(ball.position),
    };
    let barrier = barrier(belief, ball.position);
    let (face, speed) = barrier.map_or((face, GO_IN), |barrier| (barrier.nearest(face), barrier.speed));
    match approach(belief, ball, face, speed) {
        Approach::Around(drive) => drive.into(),
        Approach::In(drive) => Drive { dribbler: 1.0, ..drive }.into(),
    }
}

/// Comes up to a resting ball so as to look along `face` over it, the last bit with `speed`.
pub fn approach(belief: &Belief, ball: &BelievedBall, face: Angle, speed: f32) -> Approach {
    let ahead = Vector::polar(1.0, face);
    let to_ball = ball.position - belief.pose.position;
    let (along, beside) = (to_ball.dot(ahead), ahead.cross(to_ball));
    let off = (face - belief.pose.heading).abs();
    // The farther back, the wider the approach; at the ball itself a finger's breadth.
    let room = along - BALL_AT;
    // On its way in it corrects what it is beside: stopping for it, it steps past the line and back.
    let goes_in = belief.is_placing() && belief.velocity.dot(ahead) > GOES_IN;
    let line = if goes_in { OPENING_HALF_WIDTH_M } else { LINE_HALF_WIDTH_M };
    let width = line + WIDENS * room.clamp(0.0, 0.3);
    let drifts = belief.is_placing() && ahead.cross(belief.velocity).abs() > DRIFTS && !goes_in;
    if along > 0.0 && room < GO_IN_FROM && beside.abs() < width && off < ALIGNED && !drifts {
        let to = ball.position - ahead * (BALL_AT - PRESS);
        // A ball that still moves a little goes on while the robot comes.
        let to = to + ball.velocity * LEAD;
        return Approach::In(Drive { speed: speed + 2.0 * room.max(0.0), ..Drive::bold(to, face) });
    }
    if belief.is_placing() && room > 0.0 && room < GO_IN_FROM && beside.abs() < SIDESTEPS && off < ALIGNED {
        // Nearly behind it: a step aside, not all the way around.
        let to = ball.position - ahead * (BALL_AT + room.max(PRESS)) + ball.velocity * LEAD;
        return Approach::Around(Drive { speed: SIDESTEP, ..Drive::bold(to, face) });
    }
    let stand_off = if belief.is_placing() { PLACING_STAND_OFF } else { STAND_OFF };
    let behind = ball.position - ahead * (BALL_AT + stand_off) + ball.velocity * LEAD;
    let drive = Drive::avoiding(behind, face);
    // Slow at its end where there is time, or what the robot is behind in time takes it past.
    let settles = math::sqrt(SETTLES * belief.pose.position.distance(behind)) + DRIFTS;
    Approach::Around(Drive { speed: if belief.is_placing() { settles } else { drive.speed }, ..drive })
}

/// Goes for a ball that rolls: from behind where it rolls away before the robot, else beyond it on its path,
/// facing it.
pub(super) fn intercept_ball(belief: &Belief, ball: &BelievedBall) -> Drive {
    let to_ball = ball.position - belief.pose.position;
    let (gap, speed) = (to_ball.norm() - BALL_AT, ball.velocity.norm());
    let away = ball.velocity.dot(to_ball) > ROLLS_AWAY * speed * to_ball.norm();
    if away && gap < CHASED {
        let face = to_ball.angle();
        // So much faster than the ball as it can still slow down before it touches.
        let closing = CLOSES + math::sqrt(2.0 * CLOSING_BRAKE * gap.max(0.0));
        let to = ball.position + to_ball * ((PRESS - BALL_AT) / to_ball.norm()) + ball.velocity * CHASE_LEAD;
        let dribbler = if gap < DRIBBLES_FROM { 1.0 } else { 0.0 };
        return Drive { speed: speed + closing, dribbler, ..Drive::bold(to, face) };
    }
    let path = BallModel::default().rolling(ball.position, ball.velocity);
    let along = path.along();
    let until = time_in_field(belief, ball, &path).min(LOOKS_AHEAD);
    let question = Interception {
        robot: belief.pose.position,
        velocity: belief.velocity,
        ball: &path,
        // It shall stand beyond the ball and look back along its path.
        target: ball.position - along * FAR_BACK,
        reach: BALL_AT,
        until,
    };
    let limits = belief.limits_without_ball();
    let (verdict, effort) = question.find_within(&limits, InterceptRequest::Soonest, INTERCEPTION_EFFORT_MAX);
    let place = match verdict {
        InterceptVerdict::Intercepts(interception_point) => interception_point.place,
        InterceptVerdict::Chase { place, .. } => place,
    };
    Drive { effort, ..receive_at(belief, ball, place) }
}

/// Stands on the ball's line at `place`, facing it; moves back a little as it comes, with the dribbler
/// turning.
pub(super) fn receive_at(belief: &Belief, ball: &BelievedBall, place: Point<Field>) -> Drive {
    let me = belief.pose.position;
    let speed = ball.velocity.norm();
    let gap = me.distance(ball.position) - BALL_AT;
    let near = gap < speed * CUSHION_TIME + 0.1;
    let face = me.direction_to(ball.position);
    let direction = ball.velocity * (1.0 / speed.max(f32::MIN_POSITIVE));
    let line = Segment::new(ball.position, ball.position + direction * FAR_BACK);
    if near && line.distance_to(me) < ON_LINE && (me - ball.position).dot(direction) > 0.0 {
        let back = (speed * YIELD * YIELD_TIME).min(YIELD_MOST);
        let to = line.closest_to(me) + direction * back;
        return Drive { dribbler: 1.0, ..Drive::bold(to, face) };
    }
    Drive { dribbler: if near { 1.0 } else { 0.0 }, ..Drive::bold(place, face) }
}

/// How long the ball stays within the lines, s.
fn time_in_field(belief: &Belief, ball: &BelievedBall, path: &BallPath<Field>) -> f32 {
    let field = belief.league().field();
    let rest = path.rest();
    if field.contains(rest) {
        return f32::INFINITY;
    }
    let (v, p) = (rest - ball.position, ball.position);
    let share = |at: f32, by: f32, limit: f32| {
        if by.abs() < f32::MIN_POSITIVE { 1.0 } else { ((limit * by.signum() - at) / by).clamp(0.0, 1.0) }
    };
    let out = share(p.x(), v.x(), 0.5 * field.length).min(share(p.y(), v.y(), 0.5 * field.width));
    path.time_to(v.norm() * out).unwrap_or(f32::INFINITY)
}

/// What stands so near a ball that a body fits only on the side away from it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Barrier {
    /// Where it stands, as seen from the ball.
    towards: Angle,
    /// A robot there may look at most this far past it, rad.
    width: f32,
    /// So fast it may come to the ball, m/s.
    speed: f32,
}

impl Barrier {
    /// The heading nearest to `face` at which a body has room.
    fn nearest(&self, face: Angle) -> Angle {
        self.towards + Angle::new(math::clamp((face - self.towards).radians(), -self.width, self.width))
    }
}

/// The barrier at a ball: a board or goal outside the lines, or an opponent.
pub fn barrier(belief: &Belief, ball: Point<Field>) -> Option<Barrier> {
    let field = belief.league().field();
    if !field.contains(ball) {
        let towards = wall(&field, ball, ball, false, 0.0)?;
        return Some(Barrier { towards, width: 0.0, speed: GO_IN_AT_WALL });
    }
    let (opponent, apart) = belief.nearest_opponent(ball).filter(|(_, apart)| *apart < BODY_BESIDE)?;
    // Bodies may be seen nearer than they can be.
    let width = (PAST_OPPONENT * (apart - contact::CENTERS) + ASKEW_TOUCHING).max(0.0);
    Some(Barrier { towards: ball.direction_to(opponent), width, speed: GO_IN })
}

fn is_contested(belief: &Belief, ball: &BelievedBall) -> bool {
    belief.nearest_opponent(ball.position).is_some_and(|(_, distance)| distance < CONTESTED)
}

/// Cosine between where a ball rolls and where it is seen, above which it rolls away: 60°.
const ROLLS_AWAY: f32 = 0.5;
/// This near it is chased, m; from farther it is intercepted.
const CHASED: f32 = 0.5;
/// How much faster than the ball a robot touches it, m/s.
const CLOSES: f32 = 0.25;
/// How fast it slows down to that, m/s².
const CLOSING_BRAKE: f32 = 1.5;
/// The place to be is that far ahead, s: a motion ends at rest, and this one shall not.
const CHASE_LEAD: f32 = 0.4;
/// So near the dribbler turns, m.
const DRIBBLES_FROM: f32 = 0.1;
/// A faster ball is met, a slower one approached, m/s.
const ROLLING: f32 = 0.3;
/// An opponent this near the ball is about to have it, m.
const CONTESTED: f32 = 0.3;
/// How fast a robot comes to a resting ball, m/s: slower than would push it out of the roller's reach.
const GO_IN: f32 = 0.35;
/// The same at a wall, m/s: a body that comes on for a centimetre squeezes the ball out of the dribbler.
const GO_IN_AT_WALL: f32 = 0.12;
/// An opponent's centre this far from the ball leaves room for a body everywhere, m.
const BODY_BESIDE: f32 = 0.25;
/// At a ball that an opponent touches two bodies fit while one looks no farther past the other than this,
/// rad: 52°, by the triangle of ball and centres with a centimetre between the bodies; …
const ASKEW_TOUCHING: f32 = 0.9;
/// … and so much farther for each metre between them, rad/m: 110° at 0.2 m.
const PAST_OPPONENT: f32 = 11.0;
/// From so far before the ball it goes in, m.
const GO_IN_FROM: f32 = 0.25;
/// Between front and ball at the place behind it, m.
const STAND_OFF: f32 = 0.07;
/// The same where there is time.
const PLACING_STAND_OFF: f32 = 0.1;
/// How deep it presses into where the ball lies, m: until it touches for certain.
const PRESS: f32 = 0.02;
/// Beside the line over the ball: half of the opening's half width, m.
const LINE_HALF_WIDTH_M: f32 = 0.015;
/// The same of one that moves towards it faster than the second, m/s, where there is time: the opening.
const OPENING_HALF_WIDTH_M: f32 = 0.03;
const GOES_IN: f32 = 0.05;
/// So far beside it a robot before the ball steps aside to it, m.
const SIDESTEPS: f32 = 0.1;
/// Faster across than this it would come beside the ball, m/s.
const DRIFTS: f32 = 0.1;
/// How fast, m/s: what it is behind in time makes it overshoot a faster step.
const SIDESTEP: f32 = 0.25;
/// Twice the deceleration at the end of a path, m/s²: what a robot is behind in time takes one that brakes
/// harder 0.1 m too far.
const SETTLES: f32 = 5.0;
/// Additional width for each metre farther back, m.
const WIDENS: f32 = 0.2;
/// It faces the right direction within this, rad.
const ALIGNED: f32 = 0.15;
/// Delay of a robot: camera frame, radio and a step, s.
const LEAD: f32 = 0.05;
/// Horizon for which the ball is predicted, s: a longer one costs, and what comes later is predicted again
/// before.
pub(super) const LOOKS_AHEAD: f32 = 0.8;
/// Instructions that the search for an interception takes at most: four points of the ball's path and a
/// motion. Of 2,000 questions with this horizon 219 have an answer: 175 times it is found, 43 times one at
/// most 0.14 s later (a test of `motion::intercept`).
pub(super) const INTERCEPTION_EFFORT_MAX: u32 = 7_500;
/// A point far back on the ball's line, m.
const FAR_BACK: f32 = 20.0;
/// Time before the ball arrives from which the dribbler turns and the robot moves back, s.
const CUSHION_TIME: f32 = 0.2;
/// Share of the ball's speed with which it moves back.
const YIELD: f32 = 0.2;
/// For at most this long, s, and no farther than this, m.
const YIELD_TIME: f32 = 0.15;
const YIELD_MOST: f32 = 0.06;
/// On the ball's line within this, m.
const ON_LINE: f32 = 0.06;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::skills::wheels::testing::{belief, rolling};

    #[test]
    fn a_resting_ball_is_passed_at_a_distance_and_taken_from_behind() {
        // The robot stands before the ball and wants to face +x with it.
        let b = belief((0.5, 0.0, 0.0), (0.0, 0.0));
        let Approach::Around(drive) = approach(&b, &b.ball.unwrap(), Angle::ZERO, GO_IN) else { panic!() };
        assert!((drive.to.x() + BALL_AT + STAND_OFF).abs() < 1e-6 && drive.to.y() == 0.0);
        // From that place it goes in.
        let b = belief((-BALL_AT - STAND_OFF, 0.005, 0.0), (0.0, 0.0));
        let Approach::In(drive) = approach(&b, &b.ball.unwrap(), Angle::ZERO, GO_IN) else { panic!() };
        assert!(drive.to.x() > -BALL_AT && drive.speed < 0.6);
        // Beside it, it does not.
        let b = belief((-BALL_AT - 0.02, 0.04, 0.0), (0.0, 0.0));
        assert!(matches!(approach(&b, &b.ball.unwrap(), Angle::ZERO, GO_IN), Approach::Around(_)));
    }

    #[test]
    fn a_placer_that_goes_in_corrects_what_it_is_beside_on_the_way() {
        let mut b = belief((-BALL_AT - 0.04, 0.025, 0.0), (0.0, 0.0));
        b.game.phase = Phase::BallPlacement(rules::Side::Ours);
        let goes_in = |b: &crate::belief::Belief| {
            matches!(approach(b, &b.ball.unwrap(), Angle::ZERO, GO_IN), Approach::In(_))
        };
        assert!(!goes_in(&b), "from rest it steps aside first");
        b.velocity = Vector::new(0.1, -0.15);
        assert!(goes_in(&b));
        b.pose.position = Point::new(-BALL_AT - 0.04, 0.045);
        assert!(!goes_in(&b), "it would push the ball with its edge");
    }

    #[test]
    fn a_ball_that_comes_is_met_beyond_it_on_its_line_facing_it() {
        let b = rolling(belief((0.0, 0.3, 0.0), (2.0, 0.0)), (-2.0, 0.0));
        let drive = intercept_ball(&b, &b.ball.unwrap());
        assert!(drive.to.y().abs() < 1e-3 && drive.to.x() < 1.5, "{drive:?}");
        assert!(drive.face.abs() < 0.3);
    }

    #[test]
    fn a_ball_held_is_done() {
        let mut b = belief((0.0, 0.0, 0.0), (BALL_AT, 0.0));
        b.holds_ball = true;
        assert_eq!(get_ball(&b, None), Step::Done);
    }

    #[test]
    fn with_an_opponent_at_the_ball_the_straight_way_is_taken() {
        let mut b = belief((-1.0, 0.0, 0.0), (0.0, 0.0));
        let wanted = Some(Angle::HALF_TURN);
        let Step::Running(Intent::Drive(free)) = get_ball(&b, wanted) else { panic!() };
        assert!(free.to.x() > 0.1, "around: {free:?}");
        let _ = b.opponents.push(Point::new(0.2, 0.0));
        let Step::Running(Intent::Drive(hasty)) = get_ball(&b, wanted) else { panic!() };
        assert!(hasty.to.x() < 0.0, "{hasty:?}");
    }

    #[test]
    fn a_ball_at_a_board_is_taken_looking_at_the_board_and_slowly() {
        // The attacked goal lies along the board: no body fits behind the ball.
        let b = belief((1.0, 2.0, 90.0), (1.0, 3.27));
        let wanted = Some(b.ball.unwrap().position.direction_to(Point::new(4.5, 0.0)));
        let Step::Running(Intent::Drive(drive)) = get_ball(&b, wanted) else { panic!() };
        assert!((drive.face.to_degrees() - 90.0).abs() < 1e-3, "{drive:?}");
        let b = belief((1.0, 3.27 - BALL_AT, 90.0), (1.0, 3.27));
        let Step::Running(Intent::Drive(drive)) = get_ball(&b, wanted) else { panic!() };
        assert!(drive.speed < 0.2 && drive.dribbler == 1.0, "{drive:?}");
    }

    #[test]
    fn beside_an_opponent_that_touches_the_ball_it_is_taken_from_where_a_body_fits() {
        let mut b = belief((0.5, 0.1, 180.0), (0.0, 0.0));
        let _ = b.opponents.push(Point::new(0.115, 0.0));
        let Step::Running(Intent::Drive(drive)) = get_ball(&b, None) else { panic!() };
        // Straight on it would meet the opponent: its own body comes beside that one.
        let stands = Point::<Field>::new(0.0, 0.0) - Vector::polar(BALL_AT, drive.face);
        let apart = stands.distance(Point::new(0.115, 0.0));
        assert!((0.18..0.25).contains(&apart), "{apart}");
    }
}
