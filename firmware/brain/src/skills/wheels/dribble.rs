//! Dribble: carry the ball, never farther than the rules let (1 m; 0.5 m in 2013), counted from the first touch.
//!
//! Near the limit the ball is let go: dribbler still, a step back, until everybody sees the gap; then it may be taken anew.

use geometry::{Field, Point, Pose, Vector, math};
use protocol::robot_io::OmniKick;
use rules::League;

use crate::belief::Belief;
use crate::body::Intent;
use crate::body::omni::{BALL_AT, Drive, Manner};
use crate::skills::Step;
use crate::skills::wheels::get_ball::get_ball;

/// Brings the ball to `pose`.
pub fn dribble(belief: &Belief, pose: Pose<Field>) -> Intent {
    if belief.holds_ball {
        return Drive::holding(pose.position, pose.heading).into();
    }
    let towards = belief.ball.map(|ball| ball.position.direction_to(pose.position));
    match get_ball(belief, towards) {
        Step::Running(intent) => intent,
        Step::Done => Intent::Stand { face: None },
    }
}

/// The case language's `dribble_to`: the ball comes within `tolerance` of the place.
pub fn carry_to(belief: &Belief, to: Point<Field>, tolerance: f32) -> Step {
    let mouth = belief.mouth();
    if mouth.distance(to) <= tolerance {
        return Step::Done;
    }
    let me = belief.pose.position;
    let face = if me.distance(to) > TURNS_FROM { me.direction_to(to) } else { belief.pose.heading };
    Step::Running(Drive::holding(to - Vector::polar(BALL_AT, face), face).into())
}

/// What any skill wants, but with the ball let go before it was carried too far.
pub fn let_go_in_time(belief: &Belief, intent: Intent) -> Intent {
    let Intent::Drive(drive) = intent else { return intent };
    let kicks = matches!(drive.kick, OmniKick::Flat(_) | OmniKick::Chip(_));
    if drive.manner != Manner::Holding || kicks {
        return intent;
    }
    let left = limit(belief.league()) - SPARE - belief.carried();
    if left > 0.0 {
        // Slow by then: what is let go while it moves rolls on.
        let slow = math::sqrt(2.0 * SLOWS * left) + CRAWL;
        return Drive { speed: drive.speed.min(slow), ..drive }.into();
    }
    let back = belief.pose.position - Vector::polar(STEP_BACK, belief.pose.heading);
    Drive { speed: AWAY, ..Drive::bold(back, belief.pose.heading) }.into()
}

/// How far that league's rules let a robot dribble, m.
fn limit(league: League) -> f32 {
    league.limits().map_or(f32::INFINITY, |limits| limits.dribble)
}

/// Let go so much before the limit, m: what the ball rolls on from a crawl, a robot's delay, and noise.
const SPARE: f32 = 0.25;
/// How fast it slows down towards that, m/s².
const SLOWS: f32 = 1.0;
/// How fast it still is then, m/s.
const CRAWL: f32 = 0.15;
/// How far back, m.
const STEP_BACK: f32 = 0.2;
/// How fast, m/s.
const AWAY: f32 = 0.8;
/// Nearer than this it keeps its heading, m.
const TURNS_FROM: f32 = 0.2;
