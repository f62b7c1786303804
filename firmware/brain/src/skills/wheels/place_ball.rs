//! Place ball: bring it to the designated place, leave it at rest there, and make room.
//!
//! At a wall or in a goal the robot comes from the field and pulls the ball clear, no faster than it follows:
//! each time it falls back the acceleration shrinks, and grows again while it stays. A ball that follows is
//! pulled to the place; one that does not is pushed from behind, and kicked off a wall. At the place the
//! robot stops, lets the dribbler run out, backs off straight without touching, and watches: a ball that did
//! not stay is fetched again. A ball that is shown at its front and that it does not feel is not there: it
//! backs off, so that cameras see where the ball is.

mod methods;

use geometry::{Angle, Field, Point, Vector};
use protocol::{Duration, Instant};
use rules::limits::ROBOT_RADIUS;

use crate::belief::{Belief, BelievedBall};
use crate::body::Intent;
use crate::body::omni::{BALL_AT, Drive};
use crate::skills::wheels::wall::wall;
use methods::{OffWall, PLACED_M, fetch, kick_off, pull, push, strays};

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
        /// Away from a wall, which lies there.
        out: Option<Angle>,
        /// It fell back, and has not come yet.
        loose: bool,
        /// That was counted as a loss.
        lost: bool,
    },
    /// Pushing it, from behind.
    Pushing,
    /// It is there; the roller runs out.
    Letting,
    /// Backing off in this direction.
    Leaving {
        /// The heading it keeps.
        facing: Angle,
    },
    /// The ball lies there, and the robot is away from it.
    Done,
}

/// A running placement: what it does, and what it has learned of how well the dribbler holds the ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    placing: Placing,
    /// What it does, it does since then.
    since: Instant,
    /// Tries at a wall so far; odd: the last was a kick off it. No try is like the one before.
    tries: u8,
    /// The ball is approached from the side opposite to the usual one, which no body could reach.
    other_side: bool,
    /// Share of the acceleration with which the ball followed the dribbler so far.
    grip: f32,
    /// The speed at which it followed, m/s: a roller may hold less of a fast ball.
    pace: f32,
    /// The ball did not follow at all, however gently it was pulled, or was not even felt.
    stays: bool,
}

impl Default for Placement {
    fn default() -> Self {
        Self {
            placing: Placing::Fetching,
            since: Instant::default(),
            tries: 0,
            other_side: false,
            grip: 1.0,
            pace: PULL,
            stays: false,
        }
    }
}

impl Placement {
    /// It is over; another one by the same robot begins with what its dribbler held.
    pub fn end(&mut self) {
        if self.since != Instant::default() {
            *self = Self {
                grip: (GROWS * self.grip).min(1.0),
                pace: self.pace,
                stays: self.stays,
                ..Self::default()
            };
        }
    }

    /// Whether a ball in the open is pushed: from where the robot is behind it anyway, and where it does not
    /// follow.
    fn pushes(&self, belief: &Belief, ball: &BelievedBall, at: Point<Field>) -> bool {
        let behind = (ball.position - belief.pose.position).dot(at - ball.position) > 0.0;
        let pulled = matches!(self.placing, Placing::Pulling { .. });
        let creeps = ball.position.distance(at) * (1.0 / self.pace - ON_PUSHED) > GOES_AROUND;
        (behind && !pulled || creeps || self.grip < FOLLOWS) != self.other_side
    }

    /// The direction out of the field, where a wall blocks what it intends to do.
    fn wall(&self, belief: &Belief, ball: &BelievedBall, at: Point<Field>) -> Option<Angle> {
        // Once it is pulled, it is pulled a little farther than it must be.
        let room = if matches!(self.placing, Placing::Pulling { .. }) { CLEARS } else { 0.0 };
        wall(&belief.league().field(), ball.position, at, self.pushes(belief, ball, at), room)
    }

    /// A ball at a wall that hardly follows is kicked off it, in turns with pulling; one that does not
    /// follow at all is kicked off any walls, and every fourth time pulled again.
    fn kicks(&self, belief: &Belief, ball: &BelievedBall, at: Point<Field>) -> Option<OffWall> {
        let pulls = if self.stays { self.tries & 3 == 3 } else { self.tries & 1 == 1 };
        if self.grip > KICKS_BELOW && !self.stays || pulls {
            return None;
        }
        let kick =
            kick_off(&belief.league().field(), ball.position, at, self.wall(belief, ball, at)?, self.tries)?;
        (self.stays || kick.one_wall).then_some(kick)
    }

    /// The ball fell back: during the pull, or as soon as the robot backed up.
    fn lost(&mut self, felt: Instant, speed: f32) {
        let share = if felt.since(self.since) < AT_ONCE { LOSES_AT_ONCE } else { LOSES };
        self.stays |= share < LOSES && self.grip <= GRIP_LEAST;
        self.grip = (self.grip * share).max(GRIP_LEAST);
        if speed > PULL_SPEED_KEPT {
            self.pace = SLOWER * speed;
        }
        self.tries = (self.tries + 1) & 6;
    }
}

/// One step of bringing the ball to `at`. Not part of its caller: what it needs of the stack is free again
/// while a path is planned.
#[inline(never)]
pub fn place_ball(now: Instant, placement: &mut Placement, belief: &Belief, at: Point<Field>) -> Intent {
    let Some(ball) = belief.ball else { return Intent::Stand { face: None } };
    let me = belief.pose.position;
    let heading = belief.pose.heading;
    let kicks = placement.kicks(belief, &ball, at);
    if placement.since == Instant::default() {
        placement.since = now;
    }
    let next = next(now, placement, belief, &ball, at, kicks);
    if core::mem::discriminant(&next) != core::mem::discriminant(&placement.placing) {
        placement.since = now;
    }
    placement.placing = next;
    match placement.placing {
        Placing::Fetching => fetch(placement, belief, &ball, at, kicks),
        // Cameras do not see a ball so near, and where it is taken to be errs by two centimetres: on to where
        // it must be.
        Placing::Feeling => {
            let to = ball.position - Vector::polar(BALL_AT - FEELS_INTO, heading);
            let drive = Drive { speed: FEELS_AT, ..Drive::holding(to, heading) };
            match kicks {
                Some(kick) if (kick.face - heading).abs() < KICKS_WITHIN => kick.with(drive).into(),
                _ => drive.into(),
            }
        }
        Placing::Revealing { facing } => {
            let back = ball.position - Vector::polar(BALL_AT + REVEALS, facing);
            // At once after a kick: it comes back off the wall, and shall not meet the robot.
            let speed = if belief.kicker_ready { LEAVE } else { LEAVE_SPEED_AFTER_KICK };
            Drive { speed, ..Drive::bold(back, facing) }.into()
        }
        Placing::Pulling { out, loose, .. } => {
            // Not yet sure in the grip: on ahead with it.
            let backs = -belief.velocity.dot(Vector::polar(1.0, heading));
            if now.since(placement.since) < SEATS || loose && backs < EASED {
                let (on, speed) = if loose { (COMES_ON, COMES_BACK) } else { (AT_FRONT, SEATS_AT) };
                let on = me + Vector::polar(on, heading);
                return Drive { speed, ..Drive::holding(on, heading) }.into();
            }
            let drive = pull(belief, at, out, placement);
            // It falls back: slower than it rolls, and it comes.
            if loose { Drive { speed: EASES * backs, ..drive } } else { drive }.into()
        }
        Placing::Pushing => push(belief, &ball, at, placement),
        Placing::Letting => {
            // Held until the robot stands.
            let dribbler = if belief.velocity.norm() > AT_REST { 1.0 } else { 0.0 };
            Drive { dribbler, ..Drive::bold(me, heading) }.into()
        }
        Placing::Leaving { facing } => {
            let straight = ball.position - Vector::polar(KEEP_OFF_M, facing);
            let room = belief.league().field().surface().grown(-ROBOT_RADIUS);
            if room.contains(straight) {
                return Drive { speed: LEAVE, ..Drive::bold(straight, facing) }.into();
            }
            // A wall is behind it: a little back, and then around the ball into the field.
            let clear = me.distance(ball.position) - BALL_AT;
            if clear < STEP_BACK {
                let back = ball.position - Vector::polar(BALL_AT + 2.0 * STEP_BACK, facing);
                return Drive { speed: LEAVE, ..Drive::bold(back, facing) }.into();
            }
            let inwards = (Point::new(0.0, 0.0) - ball.position).clamped(KEEP_OFF_M);
            Drive::avoiding(ball.position + inwards, facing).into()
        }
        Placing::Done => Intent::Stand { face: Some(me.direction_to(ball.position)) },
    }
}

fn next(
    now: Instant,
    placement: &mut Placement,
    belief: &Belief,
    ball: &BelievedBall,
    at: Point<Field>,
    kicks: Option<OffWall>,
) -> Placing {
    let off = ball.position.distance(at);
    let slow = ball.velocity.norm() < AT_REST;
    let clear = belief.pose.position.distance(ball.position) - BALL_AT;
    let at_front = belief.dribbler_point().distance(ball.position) < AT_FRONT;
    let age = now.since(placement.since);
    let heading = belief.pose.heading;
    let aligned = kicks.is_none_or(|kick| (kick.face - heading).abs() < KICKS_WITHIN);
    let kicks = kicks.is_some();
    match placement.placing {
        // The kick is out.
        Placing::Fetching | Placing::Feeling if kicks && !belief.kicker_ready && clear < GAP => {
            placement.tries = (placement.tries + 1) & 7;
            Placing::Revealing { facing: heading }
        }
        Placing::Fetching | Placing::Feeling | Placing::Revealing { .. } if belief.holds_ball && !kicks => {
            let out = placement.wall(belief, ball, at);
            placement.other_side = false;
            let askew = (ball.position.direction_to(at) - heading).abs();
            if askew < ASKEW {
                Placing::Pushing
            } else {
                Placing::Pulling { felt: now, out, loose: false, lost: false }
            }
        }
        // That failed: try another method.
        Placing::Fetching if clear < FETCHING_DISTANCE_M && slow && age > FETCHES => {
            placement.since = now;
            placement.other_side ^= true;
            placement.tries = (placement.tries + 1) & 7;
            Placing::Fetching
        }
        Placing::Fetching if at_front && slow && aligned => Placing::Feeling,
        Placing::Feeling if !at_front || !aligned => Placing::Fetching,
        Placing::Feeling if age > FEELS => {
            placement.stays |= placement.tries > 0;
            placement.tries = (placement.tries + 1) & 7;
            Placing::Revealing { facing: heading }
        }
        Placing::Revealing { .. } if clear > REVEALS - GAP || age > REVEALED => Placing::Fetching,
        Placing::Fetching if off < PLACED_M && slow && clear > GAP => {
            Placing::Leaving { facing: belief.pose.position.direction_to(ball.position) }
        }
        // It is not at the ball yet.
        Placing::Fetching if clear > FETCHING_DISTANCE_M || !slow => {
            placement.since = now;
            Placing::Fetching
        }
        Placing::Pulling { felt, out, loose, lost } => {
            let gone = now.since(felt);
            let arrived =
                belief.dribbler_point().distance(at) < ARRIVED_M && belief.velocity.norm() < AT_REST;
            let free = placement.wall(belief, ball, at).is_none();
            if arrived {
                return Placing::Letting;
            }
            if free && placement.grip < FOLLOWS {
                placement.grip = placement.grip.max(FOLLOWED);
                return Placing::Leaving { facing: heading };
            }
            let out = out.filter(|_| !free);
            if belief.contact() {
                // It has come back to the break-beam sensor, which sees farther than the roller reaches.
                if loose && belief.velocity.dot(Vector::polar(1.0, heading)) > -PRESSING_SPEED_MAX {
                    placement.since = now;
                }
                return Placing::Pulling { felt: now, out, loose: false, lost: false };
            }
            if gone > REGAINS || loose && kicks {
                return Placing::Fetching;
            }
            // A sensor that touches flickers while the ball is there; cameras show one that is not.
            let seen_off = belief.dribbler_point().distance(ball.position) > SEEN_OFF;
            let falls = gone > if seen_off { FLICKERS } else { MISSES };
            // A ball that rolled by was never in the grip, and says nothing of it.
            if falls && !lost && felt.since(placement.since) > SEATS {
                placement.lost(felt, belief.velocity.norm());
            }
            Placing::Pulling { felt, out, loose: gone > FLICKERS, lost: lost || falls }
        }
        // It rolls on as the robot stays behind.
        Placing::Pushing if off < PUSHED => Placing::Leaving { facing: heading },
        Placing::Pushing if strays(belief, ball, at) => {
            placement.lost(now, 0.0);
            Placing::Fetching
        }
        Placing::Letting if age > RUNS_OUT => Placing::Leaving { facing: heading },
        Placing::Leaving { .. } | Placing::Done
            if off > PLACED_M && (slow || off > KEEP_OFF_M) && clear > GAP =>
        {
            Placing::Fetching
        }
        Placing::Leaving { .. } if clear + BALL_AT > KEEP_OFF_M - 0.05 => Placing::Done,
        same => same,
    }
}

/// With a larger share of the acceleration left, a ball is pulled to the place: 0.5 m/s².
const FOLLOWS: f32 = 0.3;
/// With a smaller one, it is kicked off walls: 0.18 m/s².
const KICKS_BELOW: f32 = 0.1;
/// And it is no worse than this where it came off a wall.
const FOLLOWED: f32 = 0.07;
/// How much farther a ball is pulled off a wall than it must be, m.
const CLEARS: f32 = 0.04;
/// What each loss leaves of the acceleration, …
const LOSES: f32 = 0.6;
/// … and one that comes within this time; …
const LOSES_AT_ONCE: f32 = 0.25;
const AT_ONCE: Duration = Duration::millis(800);
/// One lost during a pull at more than this, m/s, came as quickly as it was asked to and no faster: …
const PULL_SPEED_KEPT: f32 = 1.0;
/// … it is pulled with this share of that speed.
const SLOWER: f32 = 0.8;
/// How fast a ball is pulled, m/s.
const PULL: f32 = 1.4;
/// Time of a pushed metre, s/m, and time to get around the ball to push it, s: where pulling takes longer, it
/// is pushed.
const ON_PUSHED: f32 = 0.75;
const GOES_AROUND: f32 = 2.5;
/// … no less than this: 0.07 m/s²; …
const GRIP_LEAST: f32 = 0.04;
/// … and how much more is tried the next time.
const GROWS: f32 = 2.0;
/// A ball that falls back is waited for with this share of the speed.
const EASES: f32 = 0.6;
/// Until the robot is no faster than this, m/s: then it comes back for it.
const EASED: f32 = 0.2;
/// How fast a robot backs off from it, m/s.
const LEAVE: f32 = 0.6;
/// The same after a kick, m/s.
const LEAVE_SPEED_AFTER_KICK: f32 = 1.5;
/// A slower ball rests, m/s.
const AT_REST: f32 = 0.06;
/// So slowly a robot presses on a ball without pushing it off, m/s.
const PRESSING_SPEED_MAX: f32 = 0.15;
/// Position tolerance of a ball at the dribbler, m.
const ARRIVED_M: f32 = 0.03;
/// Where the ball is shown this near the front, it should be felt, m.
const AT_FRONT: f32 = 0.04;
/// It goes so far into where the ball is shown, m: not so far that it is past it; …
const FEELS_INTO: f32 = 0.035;
/// … so fast, m/s: a body that comes on for a centimetre squeezes the ball out.
const FEELS_AT: f32 = 0.12;
/// And so fast to a ball that fell back, m/s.
const COMES_BACK: f32 = 0.25;
/// Distance ahead at which it aims then, m: nearer, it would hardly move.
const COMES_ON: f32 = 0.08;
/// Time after which a robot that senses no ball there stops pressing: the ball is elsewhere, or its sensor is
/// blind.
const FEELS: Duration = Duration::millis(500);
/// One that is this near and does not get the ball for this long tries another method, m.
const FETCHING_DISTANCE_M: f32 = 0.4;
const FETCHES: Duration = Duration::millis(3000);
/// Distance by which it backs off so that the cameras see the place, m, and the longest time for it.
const REVEALS: f32 = 0.2;
const REVEALED: Duration = Duration::millis(1000);
/// So much between front and ball, and it is not held, m.
const GAP: f32 = 0.04;
/// Where a kick points right enough, rad.
const KICKS_WITHIN: f32 = 0.2;
/// Time for which the break-beam sensor may miss a ball on the roller.
const FLICKERS: Duration = Duration::millis(30);
/// The longest gap of a sensor that feels the ball only where the roller touches it: 0.14 s in ER-Force's
/// simulator.
const MISSES: Duration = Duration::millis(150);
/// A ball shown this far from where it is held is not there, m: cameras are late by 0.05 s.
const SEEN_OFF: f32 = 0.06;
/// A ball that is felt may still be out of the roller's reach: time for which it is pressed.
const SEATS: Duration = Duration::millis(120);
/// Speed at which it presses on, m/s: at a wall a faster body squeezes the ball out.
const SEATS_AT: f32 = 0.2;
/// A ball that slipped off rolls on after the robot that brakes; it is felt again within this, or lost.
const REGAINS: Duration = Duration::millis(800);
/// Pushed this near, a ball is let roll on, m.
const PUSHED: f32 = 0.14;
/// It looks this much askew of where a ball is pushed to, rad: it is not behind it.
const ASKEW: f32 = 0.6;
/// Time for which the dribbler runs down.
const RUNS_OUT: Duration = Duration::millis(200);
/// So far back a robot may turn and go around the ball without touching it, m.
const STEP_BACK: f32 = 0.06;
/// How far off the robot goes, centre to ball, m: 0.5 by the rules, its body, and a margin.
const KEEP_OFF_M: f32 = 0.75;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::skills::wheels::testing::belief;

    #[test]
    fn a_placer_that_feels_no_ball_where_one_is_seen_backs_off_and_tries_again() {
        // A hidden ball is believed at the dribbler.
        let mut b = belief((0.0, 0.0, 0.0), (BALL_AT, 0.0));
        let mut placement = Placement::default();
        let (mut revealed, mut tried_again) = (0, 0);
        for tick in 0..1_000_u64 {
            let now = Instant(tick * 10_000);
            let before = placement.placing;
            let intent = place_ball(now, &mut placement, &b, Point::new(-2.0, 0.0));
            let placing = placement.placing;
            let Intent::Drive(drive) = intent else { panic!("{intent:?}") };
            // A robot that drives as ordered, at its own pace.
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
    fn what_falls_back_at_once_is_pulled_more_gently_and_the_robot_remembers_it() {
        let mut placement = Placement { since: Instant(1_000_000), ..Placement::default() };
        placement.lost(Instant(3_000_000), 0.2);
        assert!((placement.grip - LOSES).abs() < 1e-6);
        placement.lost(Instant(1_100_000), 0.2);
        assert!((placement.grip - LOSES * LOSES_AT_ONCE).abs() < 1e-6);
        placement.lost(Instant(1_100_000), 0.2);
        assert!((placement.grip - GRIP_LEAST).abs() < 1e-6);
        placement.end();
        placement.end();
        assert!((placement.grip - GROWS * GRIP_LEAST).abs() < 1e-6);
    }

    #[test]
    fn a_flicker_of_the_sensor_is_no_loss_while_the_ball_is_shown_where_it_is_held() {
        let at = Point::new(-2.0, 0.0);
        let mut b = belief((0.0, 0.0, 0.0), (BALL_AT, 0.0));
        b.holds_ball = true;
        let mut placement = Placement::default();
        place_ball(Instant(1_000_000), &mut placement, &b, at);
        // Felt for 0.2 s.
        let felt = Instant(1_200_000);
        placement.placing = Placing::Pulling { felt, out: None, loose: false, lost: false };
        b.holds_ball = false;
        place_ball(Instant(1_300_000), &mut placement, &b, at);
        assert!(placement.grip >= 1.0, "{placement:?}");
        // Shown away from the front it is lost.
        b.ball.as_mut().unwrap().position = Point::new(BALL_AT + 0.08, 0.0);
        place_ball(Instant(1_310_000), &mut placement, &b, at);
        assert!(placement.grip < 1.0, "{placement:?}");
    }

    #[test]
    fn a_ball_that_rolls_by_the_front_is_no_loss() {
        let mut b = belief((0.0, 0.0, 0.0), (BALL_AT, 0.0));
        b.holds_ball = true;
        let mut placement = Placement::default();
        let at = Point::new(-2.0, 0.0);
        place_ball(Instant(1_000_000), &mut placement, &b, at);
        (b.holds_ball, b.ball.as_mut().unwrap().position) = (false, Point::new(BALL_AT, 0.1));
        place_ball(Instant(1_300_000), &mut placement, &b, at);
        assert_eq!(placement.grip, 1.0, "{placement:?}");
    }

    #[test]
    fn only_a_ball_that_does_not_follow_at_all_is_kicked_into_a_corner() {
        let b = belief((4.6, 3.1, 45.0), (4.77, 3.27));
        let (ball, at) = (b.ball.unwrap(), Point::new(0.0, 0.0));
        let mut placement = Placement { grip: GRIP_LEAST, ..Placement::default() };
        assert_eq!(placement.kicks(&b, &ball, at), None);
        placement.stays = true;
        assert!(placement.kicks(&b, &ball, at).is_some());
        placement.tries = 3;
        assert_eq!(placement.kicks(&b, &ball, at), None, "pulled again");
    }
}
