//! Place ball: bring it to the designated place, leave it at rest there, and make room.
//!
//! The ball is pulled, the robot going backwards before it: so it works from walls and corners, where nobody comes behind a
//! ball. At a wall the robot comes at right angles to it and pulls the ball clear first. At the place it stops, lets the
//! dribbler run out, backs off straight without touching, and watches: a ball that did not stay is fetched again. A ball that is shown
//! at its mouth and that it does not feel is not there: it backs off, so that cameras see where the ball is.

use geometry::{Angle, Field, Point, Vector};
use protocol::{Duration, Instant};
use rules::limits::{PLACEMENT_TOLERANCE, ROBOT_RADIUS};

use crate::belief::{Ball, Belief};
use crate::body::Intent;
use crate::body::omni::{BALL_AT, Drive};
use crate::skills::wheels::get_ball::{Approach, approach, meet};

/// How far a placement has come.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Placing {
    /// Getting the ball.
    #[default]
    Fetching,
    /// At the place where the ball is shown, and it feels none.
    Feeling {
        /// Since when.
        since: Instant,
    },
    /// Backing off from there, so that cameras see whether the ball is there at all.
    Revealing {
        /// Since when.
        since: Instant,
        /// The heading it keeps.
        facing: Angle,
    },
    /// Pulling it.
    Pulling,
    /// It is there; the roller runs out.
    Letting {
        /// Since when.
        since: Instant,
    },
    /// Backing off along this way.
    Leaving {
        /// The heading it keeps.
        facing: Angle,
    },
    /// The ball lies there, and the robot is away from it.
    Done,
}

/// One step of bringing the ball to `at`.
pub fn place_ball(now: Instant, placing: &mut Placing, belief: &Belief, at: Point<Field>) -> Intent {
    let Some(ball) = belief.ball else { return Intent::Stand { face: None } };
    let me = belief.pose.position;
    *placing = next(now, *placing, belief, &ball, at);
    match *placing {
        Placing::Fetching | Placing::Feeling { .. } => fetch(belief, &ball, at),
        Placing::Revealing { facing, .. } => {
            let back = ball.position - Vector::polar(BALL_AT + REVEALS, facing);
            Drive { speed: LEAVE, ..Drive::bold(back, facing) }.into()
        }
        Placing::Pulling => {
            let wall = at_wall(belief, &ball);
            let face = match wall {
                Some(out) => out,
                None => turned(belief, me, at),
            };
            // At a wall it first comes straight away from it.
            let to = match wall {
                Some(out) => me - Vector::polar(CLEAR_OF_WALL, out),
                None => at - Vector::polar(BALL_AT, face),
            };
            Drive { speed: PULL, ..Drive::holding(to, face) }.into()
        }
        Placing::Letting { .. } => Drive::bold(me, belief.pose.heading).into(),
        Placing::Leaving { facing } => {
            let straight = ball.position - Vector::polar(OFF, facing);
            let room = belief.league().field().carpet().grown(-ROBOT_RADIUS);
            if room.contains(straight) {
                return Drive { speed: LEAVE, ..Drive::bold(straight, facing) }.into();
            }
            // A wall is behind it: a little back, and then around the ball into the field.
            let clear = me.distance(ball.position) - BALL_AT;
            if clear < STEP_BACK {
                let back = ball.position - Vector::polar(BALL_AT + 2.0 * STEP_BACK, facing);
                return Drive { speed: LEAVE, ..Drive::bold(back, facing) }.into();
            }
            let inwards = (Point::new(0.0, 0.0) - ball.position).clamped(OFF);
            Drive::shy(ball.position + inwards, facing).into()
        }
        Placing::Done => Intent::Stand { face: Some(me.direction_to(ball.position)) },
    }
}

fn next(now: Instant, placing: Placing, belief: &Belief, ball: &Ball, at: Point<Field>) -> Placing {
    let off = ball.position.distance(at);
    let slow = ball.velocity.norm() < AT_REST;
    let clear = belief.pose.position.distance(ball.position) - BALL_AT;
    let at_mouth = belief.mouth().distance(ball.position) < AT_MOUTH;
    match placing {
        Placing::Fetching | Placing::Feeling { .. } if belief.holds_ball => Placing::Pulling,
        Placing::Fetching if at_mouth && slow => Placing::Feeling { since: now },
        Placing::Feeling { .. } if !at_mouth => Placing::Fetching,
        Placing::Feeling { since } if now.since(since) > FEELS => {
            Placing::Revealing { since: now, facing: belief.pose.heading }
        }
        Placing::Revealing { .. } if belief.holds_ball => Placing::Pulling,
        Placing::Revealing { since, .. } if clear > REVEALS - GAP || now.since(since) > FEELS => {
            Placing::Fetching
        }
        Placing::Fetching if off < NEAR_ENOUGH && slow && clear > GAP => {
            Placing::Leaving { facing: facing(belief, ball) }
        }
        Placing::Pulling if !belief.holds_ball && clear > GAP => Placing::Fetching,
        Placing::Pulling if belief.mouth().distance(at) < THERE && belief.velocity.norm() < AT_REST => {
            Placing::Letting { since: now }
        }
        Placing::Letting { since } if now.since(since) > RUNS_OUT => {
            Placing::Leaving { facing: belief.pose.heading }
        }
        Placing::Leaving { .. } | Placing::Done if off > NEAR_ENOUGH && slow && clear > GAP => {
            Placing::Fetching
        }
        Placing::Leaving { .. } if clear + BALL_AT > OFF - 0.05 => Placing::Done,
        same => same,
    }
}

/// To the ball from the side of the place; at a wall from the field, at right angles to it.
fn fetch(belief: &Belief, ball: &Ball, at: Point<Field>) -> Intent {
    if ball.velocity.norm() > ROLLING {
        return meet(belief, ball).into();
    }
    let wall = at_wall(belief, ball);
    let face = wall.unwrap_or_else(|| {
        if ball.position.distance(at) > PLACEMENT_TOLERANCE {
            at.direction_to(ball.position)
        } else {
            facing(belief, ball)
        }
    });
    let speed = if wall.is_some() { GO_IN_AT_WALL } else { GO_IN };
    match approach(belief, ball, face, speed) {
        Approach::Around(drive) => drive.into(),
        Approach::In(drive) => Drive { dribbler: 1.0, ..drive }.into(),
    }
}

/// The direction out of the field, where the ball lies too near a wall to get a body beside it.
fn at_wall(belief: &Belief, ball: &Ball) -> Option<Angle> {
    let field = belief.league().field();
    let walls = field.carpet();
    let depth = -walls.distance_to(ball.position);
    // Beside a post there is no room for a body either: such a ball is come to from the field as one in the goal is.
    let at_goal = ball.position.x().abs() > 0.5 * field.length - WALL_ROOM;
    let in_mouth = at_goal && ball.position.y().abs() < 0.5 * field.goal_width + BESIDE_POST;
    if depth > WALL_ROOM && !in_mouth {
        return None;
    }
    let (x, y) = (ball.position.x(), ball.position.y());
    let to_end = 0.5 * field.length + field.goal_line_margin - x.abs();
    let to_side = 0.5 * field.width + field.margin - y.abs();
    let (end, side) = (Vector::<Field>::new(x, 0.0), Vector::<Field>::new(0.0, y));
    let (end, side) = (end.unit().unwrap_or_default(), side.unit().unwrap_or_default());
    let out = match (in_mouth || to_end < WALL_ROOM, to_side < WALL_ROOM) {
        (true, true) if !in_mouth => end + side,
        (true, _) => end,
        _ => side,
    };
    Some(out.angle())
}

/// Facing away from the place while it goes there backwards; at the end the heading stays.
fn turned(belief: &Belief, me: Point<Field>, at: Point<Field>) -> Angle {
    if belief.mouth().distance(at) > KEEPS_HEADING { at.direction_to(me) } else { belief.pose.heading }
}

fn facing(belief: &Belief, ball: &Ball) -> Angle {
    belief.pose.position.direction_to(ball.position)
}

/// How fast a ball is pulled, m/s.
const PULL: f32 = 1.3;
/// How fast a robot backs off from it, m/s.
const LEAVE: f32 = 0.6;
/// How fast it comes to the ball, m/s.
const GO_IN: f32 = 0.3;
/// The same at a wall, m/s: a body that comes on for a centimetre squeezes the ball out of its mouth.
const GO_IN_AT_WALL: f32 = 0.12;
/// A faster ball is met, m/s.
const ROLLING: f32 = 0.3;
/// A slower ball rests, m/s.
const AT_REST: f32 = 0.06;
/// The ball is there, m: less than the rules' 0.15.
const NEAR_ENOUGH: f32 = 0.1;
/// A ball in the mouth is there, m.
const THERE: f32 = 0.03;
/// Where the ball is shown this near the mouth, it should be felt, m.
const AT_MOUTH: f32 = 0.04;
/// A robot that feels no ball there for so long does not press on: the ball is elsewhere, or its barrier is blind.
const FEELS: Duration = Duration::millis(1500);
/// It backs off by so much to show the place to the cameras, m.
const REVEALS: f32 = 0.3;
/// So much between front and ball, and it is not held, m.
const GAP: f32 = 0.04;
/// The dribbler runs out for so long.
const RUNS_OUT: Duration = Duration::millis(300);
/// So far back a robot may turn and go around the ball without touching it, m.
const STEP_BACK: f32 = 0.06;
/// How far off the robot goes, centre to ball, m: 0.5 by the rules, its body, and a margin.
const OFF: f32 = 0.75;
/// A ball this near a wall leaves no room for a body beside it, m.
const WALL_ROOM: f32 = 0.16;
/// The same beyond a post, m: a body across and its way around.
const BESIDE_POST: f32 = 0.3;
/// How far it is pulled off a wall before anything else, m.
const CLEAR_OF_WALL: f32 = 0.3;
/// Nearer than this to the place the heading stays, m.
const KEEPS_HEADING: f32 = 0.15;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::skills::wheels::testing::belief;

    #[test]
    fn a_ball_in_a_corner_is_come_to_from_the_field_between_both_walls() {
        let b = belief((3.0, 2.0, 0.0), (4.75, 3.25));
        assert!((at_wall(&b, &b.ball.unwrap()).unwrap().to_degrees() - 45.0).abs() < 1e-3);
        let side = belief((3.0, 2.0, 0.0), (1.0, -3.25));
        assert!((at_wall(&side, &side.ball.unwrap()).unwrap().to_degrees() + 90.0).abs() < 1e-3);
        let goal = belief((3.0, 0.0, 0.0), (-4.6, 0.2));
        assert!(at_wall(&goal, &goal.ball.unwrap()).unwrap().abs() > 3.1);
        let free = belief((3.0, 2.0, 0.0), (1.0, 1.0));
        assert_eq!(at_wall(&free, &free.ball.unwrap()), None);
    }

    #[test]
    fn a_placer_that_feels_no_ball_where_one_is_shown_backs_off_and_tries_again() {
        // The mouth is where a hidden ball is believed.
        let mut b = belief((0.0, 0.0, 0.0), (BALL_AT, 0.0));
        let mut placing = Placing::default();
        let (mut revealed, mut tried_again) = (0, 0);
        for tick in 0..1_000_u64 {
            let now = Instant(tick * 10_000);
            let before = placing;
            let intent = place_ball(now, &mut placing, &b, Point::new(-2.0, 0.0));
            let Intent::Drive(drive) = intent else { panic!("{intent:?}") };
            // A robot that drives as it is told, at its own pace.
            b.pose.position += (drive.to - b.pose.position).clamped(drive.speed.min(1.0) * 0.01);
            b.pose.heading = drive.face;
            revealed += u32::from(matches!(placing, Placing::Revealing { .. }) && before != placing);
            tried_again += u32::from(placing == Placing::Fetching && before != placing);
        }
        assert!(revealed >= 2 && tried_again >= 2, "{revealed}, {tried_again}");
        // Felt in time, it is pulled.
        b.holds_ball = true;
        place_ball(Instant(20_000_000), &mut placing, &b, Point::new(-2.0, 0.0));
        place_ball(Instant(20_010_000), &mut placing, &b, Point::new(-2.0, 0.0));
        assert_eq!(placing, Placing::Pulling);
    }

    #[test]
    fn the_ball_is_fetched_from_the_side_of_the_place() {
        let b = belief((0.0, 0.0, 0.0), (1.0, 0.0));
        let Intent::Drive(drive) = fetch(&b, &b.ball.unwrap(), Point::new(1.0, -1.0)) else {
            panic!("drives")
        };
        // South of the ball, looking north.
        assert!(drive.to.y() < -0.1 && (drive.face.to_degrees() - 90.0).abs() < 1e-3, "{drive:?}");
    }
}
