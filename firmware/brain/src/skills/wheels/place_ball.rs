//! Place ball: bring it to the designated place, leave it at rest there, and make room.
//!
//! The ball is pulled, the robot going backwards before it: so it works from walls and corners, where nobody comes behind a
//! ball. At a wall the robot comes at right angles to it and pulls the ball clear first. At the place it stops, lets the
//! dribbler run out, backs off straight without touching, and watches: a ball that did not stay is fetched again. A ball that is shown
//! at its mouth and that it does not feel is not there: it backs off, so that cameras see where the ball is.

use geometry::{Angle, Field, Point, Vector, math};
use protocol::robot_io::OmniKick;
use protocol::{Duration, Instant};
use rules::limits::{PLACEMENT_TOLERANCE, ROBOT_RADIUS};

use crate::belief::{Ball, Belief};
use crate::body::Intent;
use crate::body::omni::{BALL_AT, Drive};
use crate::skills::wheels::get_ball::{Approach, approach, meet};

/// How far a placement has come.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) enum Placing {
    /// Getting the ball.
    #[default]
    Fetching,
    /// At the place where the ball is shown, and it feels none.
    Feeling,
    /// Backing off from there, so that cameras see whether the ball is there at all.
    Revealing {
        /// The heading it keeps.
        facing: Angle,
    },
    /// Pulling it.
    Pulling {
        /// When it was felt last.
        felt: Instant,
    },
    /// Pushing it, from behind.
    Pushing,
    /// It is there; the roller runs out.
    Letting,
    /// Backing off along this way.
    Leaving {
        /// The heading it keeps.
        facing: Angle,
    },
    /// The ball lies there, and the robot is away from it.
    Done,
}

/// A placement under way: what it does, and what it has learned of the ball's grip.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Placement {
    placing: Placing,
    /// What it does, it does since then.
    since: Instant,
    /// How often the ball slipped off: no try is like the one before.
    slips: u8,
}

impl Placement {
    /// Whether a ball in the open is pushed: from where the robot is behind it anyway, and once it slipped off while it was pulled.
    fn pushes(self, belief: &Belief, ball: &Ball, at: Point<Field>) -> bool {
        let behind = (ball.position - belief.pose.position).dot(at - ball.position) > 0.0;
        (self.slips > 0 || behind) && at_wall(belief, ball, self.room()).is_none()
    }

    /// What a body needs beside the ball, m: to push it off a wall, a body and its way.
    fn room(self) -> f32 {
        if self.slips > 0 { WALL_ROOM_TO_PUSH } else { WALL_ROOM }
    }

    /// Share of the acceleration with which it is pulled.
    fn gentle(self) -> f32 {
        match self.slips {
            0 => 1.0,
            1 => GENTLE,
            _ => GENTLEST,
        }
    }

    /// At a wall, in turns with pulling, the ball is kicked off it: askew, or it would come straight back.
    fn kicks(self, wall: Option<Angle>) -> bool {
        let alone = |out: Angle| {
            let out = Vector::<Field>::polar(1.0, out);
            (out.x() * out.y()).abs() < IN_CORNER
        };
        self.slips >= SLIPS_TO_KICK && !self.slips.is_multiple_of(2) && wall.is_some_and(alone)
    }

    fn kick(self, wall: Option<Angle>) -> OmniKick {
        if self.kicks(wall) { OmniKick::Flat(OFF_WALL) } else { OmniKick::None }
    }

    fn slipped(&mut self) -> Placing {
        self.slips = self.slips.saturating_add(1);
        Placing::Fetching
    }
}

/// One step of bringing the ball to `at`.
pub fn place_ball(now: Instant, placement: &mut Placement, belief: &Belief, at: Point<Field>) -> Intent {
    let Some(ball) = belief.ball else { return Intent::Stand { face: None } };
    let me = belief.pose.position;
    let next = next(now, placement, belief, &ball, at);
    if core::mem::discriminant(&next) != core::mem::discriminant(&placement.placing) {
        placement.since = now;
    }
    placement.placing = next;
    match placement.placing {
        Placing::Fetching => fetch(placement, belief, &ball, at),
        // Cameras do not see a ball so near, and where it is taken to be errs by two centimetres: on to where it must be.
        Placing::Feeling => {
            let kick = placement.kick(at_wall(belief, &ball, placement.room()));
            let facing = belief.pose.heading;
            let to = ball.position - Vector::polar(BALL_AT - FEELS_INTO, facing);
            Drive { speed: GO_IN_AT_WALL, kick, ..Drive::holding(to, facing) }.into()
        }
        Placing::Revealing { facing } => {
            let back = ball.position - Vector::polar(BALL_AT + REVEALS, facing);
            Drive { speed: LEAVE, ..Drive::bold(back, facing) }.into()
        }
        // Not yet sure in the grip; or it slips: brake, and it comes.
        Placing::Pulling { felt } if now.since(felt) > FLICKERS || now.since(placement.since) < SEATS => {
            press(belief).into()
        }
        Placing::Pulling { .. } => {
            let wall = at_wall(belief, &ball, placement.room());
            let face = match wall {
                Some(out) => out,
                None => turned(belief, me, at),
            };
            // At a wall it first comes straight away from it.
            let to = match wall {
                Some(out) => me - Vector::polar(CLEAR_OF_WALL, out),
                None => at - Vector::polar(BALL_AT, face),
            };
            Drive { speed: PULL, gentle: placement.gentle(), ..Drive::holding(to, face) }.into()
        }
        Placing::Pushing => {
            let face = ball.position.direction_to(at);
            // So slow that the ball rests at the place when it rolls on from here, and no slower than it starts at all.
            let rolls = if placement.slips == 0 { HELD_ROLLS } else { ROLLS };
            let speed = math::sqrt(2.0 * rolls * ball.position.distance(at)) + CREEP;
            let most = PUSH / (1.0 + 0.02 * f32::from(placement.slips));
            let to = ball.position + Vector::polar(AHEAD - BALL_AT, face);
            Drive { speed: speed.min(most), ..Drive::holding(to, face) }.into()
        }
        Placing::Letting => Drive::bold(me, belief.pose.heading).into(),
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

fn next(now: Instant, placement: &mut Placement, belief: &Belief, ball: &Ball, at: Point<Field>) -> Placing {
    let off = ball.position.distance(at);
    let slow = ball.velocity.norm() < AT_REST;
    let clear = belief.pose.position.distance(ball.position) - BALL_AT;
    let at_mouth = belief.mouth().distance(ball.position) < AT_MOUTH;
    let age = now.since(placement.since);
    let kicks = placement.kicks(at_wall(belief, ball, placement.room()));
    match placement.placing {
        // The kick is out.
        Placing::Fetching | Placing::Feeling if kicks && !belief.kicker_ready && clear < GAP => {
            placement.slipped();
            Placing::Revealing { facing: belief.pose.heading }
        }
        Placing::Fetching | Placing::Feeling if belief.holds_ball && !kicks => {
            let askew = (ball.position.direction_to(at) - belief.pose.heading).abs();
            if askew < ASKEW { Placing::Pushing } else { Placing::Pulling { felt: now } }
        }
        // Not so: another way.
        Placing::Fetching if clear < NEAR && age > FETCHES => {
            placement.since = now;
            placement.slipped()
        }
        Placing::Fetching if at_mouth && slow => Placing::Feeling,
        Placing::Feeling if !at_mouth => Placing::Fetching,
        Placing::Feeling if age > FEELS => {
            placement.slipped();
            Placing::Revealing { facing: belief.pose.heading }
        }
        Placing::Revealing { .. } if belief.holds_ball && !kicks => Placing::Pulling { felt: now },
        Placing::Revealing { .. } if clear > REVEALS - GAP || age > FEELS => Placing::Fetching,
        Placing::Fetching if off < NEAR_ENOUGH && slow && clear > GAP => {
            Placing::Leaving { facing: facing(belief, ball) }
        }
        Placing::Pulling { .. }
            if belief.mouth().distance(at) < THERE && belief.velocity.norm() < AT_REST =>
        {
            Placing::Letting
        }
        // It follows so badly that it is pushed as soon as there is room for that.
        Placing::Pulling { .. }
            if placement.slips > 0 && at_wall(belief, ball, placement.room()).is_none() =>
        {
            Placing::Letting
        }
        Placing::Pulling { felt } if belief.contact() && now.since(felt) > FLICKERS => {
            let again = placement.slipped();
            // On the way it goes on; a ball that has not even come along is taken again.
            if belief.velocity.norm() < AT_REST { again } else { Placing::Pulling { felt: now } }
        }
        Placing::Pulling { .. } if belief.contact() => Placing::Pulling { felt: now },
        Placing::Pulling { felt } if now.since(felt) > REGAINS => placement.slipped(),
        Placing::Pushing if off < PUSHED => Placing::Letting,
        Placing::Pushing if strays(belief, ball, at) => placement.slipped(),
        Placing::Letting if age > RUNS_OUT => Placing::Leaving { facing: belief.pose.heading },
        Placing::Leaving { .. } | Placing::Done
            if off > NEAR_ENOUGH && (slow || off > OFF) && clear > GAP =>
        {
            Placing::Fetching
        }
        Placing::Leaving { .. } if clear + BALL_AT > OFF - 0.05 => Placing::Done,
        same => same,
    }
}

/// On ahead with the ball, by a finger's breadth.
fn press(belief: &Belief) -> Drive {
    Drive::holding(belief.pose.position + Vector::polar(AT_MOUTH, belief.pose.heading), belief.pose.heading)
}

/// A pushed ball has got beside the robot, or the robot beside its way.
fn strays(belief: &Belief, ball: &Ball, at: Point<Field>) -> bool {
    let seen = belief.pose.to_body(ball.position);
    let askew = (ball.position.direction_to(at) - belief.pose.heading).abs();
    seen.x() < BALL_AT - GAP || seen.y().abs() > BESIDE || askew > ASKEW || seen.x() > ESCAPED
}

/// To the ball from the side of the place, or from behind it; at a wall from the field, at right angles to it.
fn fetch(placement: &Placement, belief: &Belief, ball: &Ball, at: Point<Field>) -> Intent {
    let wall = at_wall(belief, ball, placement.room());
    let kicks = placement.kicks(wall);
    let rolls = ball.velocity.norm() > ROLLING;
    if rolls && placement.slips == 0 {
        return meet(belief, ball).into();
    }
    // Chased, a ball that the dribbler does not hold is only driven on: it is waited for where it will rest.
    let resting = Ball { position: ball.rest, velocity: Vector::default(), rest: ball.rest };
    let ball = if rolls { &resting } else { ball };
    let face = match wall {
        // To the side where the place is.
        Some(out) if kicks => {
            let side = Vector::<Field>::polar(1.0, out).cross(at - ball.position);
            out + Angle::new(if side > 0.0 { KICKS_ASKEW } else { -KICKS_ASKEW })
        }
        Some(out) => out,
        None if placement.pushes(belief, ball, at) => ball.position.direction_to(at),
        None if ball.position.distance(at) > PLACEMENT_TOLERANCE => at.direction_to(ball.position),
        None => facing(belief, ball),
    };
    let speed = if wall.is_some() { GO_IN_AT_WALL } else { GO_IN };
    match approach(belief, ball, face, speed) {
        Approach::Around(drive) => drive.into(),
        Approach::In(drive) if kicks => Drive { kick: OmniKick::Flat(OFF_WALL), ..drive }.into(),
        Approach::In(drive) => Drive { dribbler: 1.0, ..drive }.into(),
    }
}

/// The direction out of the field, where the ball lies too near a wall to get a body beside it, which takes this `room`, m.
fn at_wall(belief: &Belief, ball: &Ball, room: f32) -> Option<Angle> {
    let field = belief.league().field();
    let walls = field.carpet();
    let depth = -walls.distance_to(ball.position);
    // Beside a post there is no room for a body either: such a ball is come to from the field as one in the goal is.
    let at_goal = ball.position.x().abs() > 0.5 * field.length - room;
    let in_mouth = at_goal && ball.position.y().abs() < 0.5 * field.goal_width + BESIDE_POST;
    if depth > room && !in_mouth {
        return None;
    }
    let (x, y) = (ball.position.x(), ball.position.y());
    let to_end = 0.5 * field.length + field.goal_line_margin - x.abs();
    let to_side = 0.5 * field.width + field.margin - y.abs();
    let (end, side) = (Vector::<Field>::new(x, 0.0), Vector::<Field>::new(0.0, y));
    let (end, side) = (end.unit().unwrap_or_default(), side.unit().unwrap_or_default());
    let out = match (in_mouth || to_end < room, to_side < room) {
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
const PULL: f32 = 1.4;
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
/// It goes so far into where the ball is shown, m: not so far that it is past it.
const FEELS_INTO: f32 = 0.035;
/// A robot that feels no ball there for so long does not press on: the ball is elsewhere, or its barrier is blind.
const FEELS: Duration = Duration::millis(1000);
/// One that is this near and does not get the ball for so long tries another way, m.
const NEAR: f32 = 0.4;
const FETCHES: Duration = Duration::millis(3000);
/// It backs off by so much to show the place to the cameras, m.
const REVEALS: f32 = 0.3;
/// So much between front and ball, and it is not held, m.
const GAP: f32 = 0.04;
/// The light barrier may miss a ball on the roller for so long.
const FLICKERS: Duration = Duration::millis(30);
/// A ball that is felt may still be out of the roller's reach: it is pressed for so long.
const SEATS: Duration = Duration::millis(120);
/// A ball that slipped off rolls on after the robot that brakes; it is felt again within this, or lost.
const REGAINS: Duration = Duration::millis(500);
/// Share of the acceleration with which a ball is pulled from a wall once it slipped off, and from then on: a roller that holds it at
/// all moves it with 0.14 m/s².
const GENTLE: f32 = 0.25;
const GENTLEST: f32 = 0.08;
/// After so many slips a ball at a wall is kicked and pulled in turns.
const SLIPS_TO_KICK: u8 = 3;
/// Product of a direction's shares along two walls, beyond which it points into their corner.
const IN_CORNER: f32 = 0.2;
/// With this, m/s: it leaves a board with 1 across and rests within two metres.
const OFF_WALL: f32 = 3.5;
/// Off the wall's normal, rad: 40°, more leaves no room for the body, and with less the ball comes back to it.
const KICKS_ASKEW: f32 = 0.7;
/// How fast a ball is pushed at first, m/s.
const PUSH: f32 = 1.5;
/// A pushed ball is slowed down by this on the way, m/s²: about as carpets do, so that it stays near the front.
const ROLLS: f32 = 0.35;
/// The same of one that the dribbler has held so far, m/s².
const HELD_ROLLS: f32 = 0.6;
/// The slowest push, m/s.
const CREEP: f32 = 0.15;
/// A push aims this far ahead on the ball's way, m.
const AHEAD: f32 = 0.25;
/// Pushed this near, a ball is let roll on, m.
const PUSHED: f32 = 0.08;
/// A pushed ball this far beside the middle is lost, m; ahead, m; and pushed this much askew, rad.
const BESIDE: f32 = 0.07;
const ESCAPED: f32 = 0.5;
const ASKEW: f32 = 0.6;
/// The dribbler runs out for so long.
const RUNS_OUT: Duration = Duration::millis(300);
/// So far back a robot may turn and go around the ball without touching it, m.
const STEP_BACK: f32 = 0.06;
/// How far off the robot goes, centre to ball, m: 0.5 by the rules, its body, and a margin.
const OFF: f32 = 0.75;
/// A ball this near a wall leaves no room for a body beside it, m.
const WALL_ROOM: f32 = 0.16;
/// And none for one behind it and its way, m.
const WALL_ROOM_TO_PUSH: f32 = 0.28;
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
        assert!((at_wall(&b, &b.ball.unwrap(), WALL_ROOM).unwrap().to_degrees() - 45.0).abs() < 1e-3);
        let side = belief((3.0, 2.0, 0.0), (1.0, -3.25));
        assert!((at_wall(&side, &side.ball.unwrap(), WALL_ROOM).unwrap().to_degrees() + 90.0).abs() < 1e-3);
        let goal = belief((3.0, 0.0, 0.0), (-4.6, 0.2));
        assert!(at_wall(&goal, &goal.ball.unwrap(), WALL_ROOM).unwrap().abs() > 3.1);
        let free = belief((3.0, 2.0, 0.0), (1.0, 1.0));
        assert_eq!(at_wall(&free, &free.ball.unwrap(), WALL_ROOM), None);
    }

    #[test]
    fn a_placer_that_feels_no_ball_where_one_is_shown_backs_off_and_tries_again() {
        // The mouth is where a hidden ball is believed.
        let mut b = belief((0.0, 0.0, 0.0), (BALL_AT, 0.0));
        let mut placement = Placement::default();
        let (mut revealed, mut tried_again) = (0, 0);
        for tick in 0..1_000_u64 {
            let now = Instant(tick * 10_000);
            let before = placement.placing;
            let intent = place_ball(now, &mut placement, &b, Point::new(-2.0, 0.0));
            let placing = placement.placing;
            let Intent::Drive(drive) = intent else { panic!("{intent:?}") };
            // A robot that drives as it is told, at its own pace.
            b.pose.position += (drive.to - b.pose.position).clamped(drive.speed.min(1.0) * 0.01);
            b.pose.heading = drive.face;
            revealed += u32::from(matches!(placing, Placing::Revealing { .. }) && before != placing);
            tried_again += u32::from(placing == Placing::Fetching && before != placing);
        }
        assert!(revealed >= 2 && tried_again >= 2, "{revealed}, {tried_again}");
        // Felt at the first try, it is pulled.
        let mut placement = Placement::default();
        let mut b = belief((0.0, 0.0, 0.0), (BALL_AT, 0.0));
        b.holds_ball = true;
        place_ball(Instant(20_000_000), &mut placement, &b, Point::new(-2.0, 0.0));
        place_ball(Instant(20_010_000), &mut placement, &b, Point::new(-2.0, 0.0));
        assert!(matches!(placement.placing, Placing::Pulling { .. }));
    }

    #[test]
    fn the_ball_is_fetched_from_the_side_of_the_place() {
        let b = belief((0.0, 0.0, 0.0), (1.0, 0.0));
        let Intent::Drive(drive) = fetch(&Placement::default(), &b, &b.ball.unwrap(), Point::new(1.0, -1.0))
        else {
            panic!("drives")
        };
        // South of the ball, looking north.
        assert!(drive.to.y() < -0.1 && (drive.face.to_degrees() - 90.0).abs() < 1e-3, "{drive:?}");
    }
}
