//! `ahead`: timing of pass-ahead (Biswas et al. 2014 §3.2, Algorithm 1: pass-ahead; D14). Attack frame, SI
//! units.
//!
//! A short time between the first move and the shot leaves opponents little time to react: the robot that
//! needs longer starts first, the other one when both would be ready together. A start is never revoked;
//! after giving up the passer does not shoot. The tests compare the start times with the latest schedule of
//! least length of the paper's Simple Temporal Network (Fig. 4; D15).

use geometry::{Angle, Attack, Point, math};
use motion::intercept::{kick_place, kick_reach};
use motion::trajectory::{CalcMotion, FreeLimits, TurnLimits};
use protocol::{Duration, Instant};
use rules::limits::{BALL_RADIUS, ROBOT_RADIUS};

use super::super::view::ViewRobot;
use super::scene::Rating;

/// T_f: a pass that has not left by then is replanned, s: the 10 s that a free kick may take leave room for a
/// second try.
pub const SEARCH_TIME: Duration = Duration::millis(4000);
/// The receiver may come this much later than the ball, s: the time in which a body covers 0.09 m while
/// braking, and the delay of a camera frame (D14).
const RECEIVER_LATE_MAX_S: f32 = 0.08;
/// Nearer to x_p than this the passer has arrived, m: the tolerance of its dribbler opening.
const AT_BALL_WITHIN_M: f32 = 0.03;
/// A passer that has arrived faces x* this exactly, rad (3°, as the robots' own kicks).
const AIMED_WITHIN_RAD: f32 = 3.0 * (math::PI / 180.0);

/// Times used by Algorithm 1, s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Times {
    /// T_r: the receiver's time to x_r.
    pub receiver: f32,
    /// T_s: the passer's time to x_p.
    pub passer: f32,
    /// T_b: the ball's time from x0 to x*.
    pub ball: f32,
    /// The passer is at x_p.
    pub at_ball: bool,
}

/// Poses of the two robots when the ball leaves, and when it arrives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Places {
    /// x_p: behind the ball, facing x*.
    pub passer: (Point<Attack>, Angle),
    /// x_r: behind x*, facing the goal for a one-touch shot, else the ball.
    pub receiver: (Point<Attack>, Angle),
}

impl Places {
    /// For a pass from `from` as rated.
    pub fn of(from: Point<Attack>, rating: &Rating) -> Self {
        let reach = kick_reach(ROBOT_RADIUS, BALL_RADIUS);
        let heading_after = if rating.shot.one_touch { rating.shot.aim } else { from };
        Self {
            passer: (kick_place(from, rating.at, reach), from.direction_to(rating.at)),
            receiver: (kick_place(rating.at, heading_after, reach), rating.at.direction_to(heading_after)),
        }
    }
}

impl Times {
    /// Estimated for passer and receiver at their present states, by `CalcMotion2D` and the turn to their
    /// headings, whichever takes longer.
    pub fn of(
        places: &Places,
        passer: &ViewRobot,
        receiver: &ViewRobot,
        ball_time: f32,
        limits: &FreeLimits,
    ) -> Self {
        let time = |robot: &ViewRobot, (at, facing): (Point<Attack>, Angle)| {
            let turn = TurnLimits::default().plan(robot.heading, 0.0, facing).duration();
            limits.time(robot.position, robot.velocity, at).max(turn)
        };
        let off = passer.position.distance(places.passer.0);
        Self {
            receiver: time(receiver, places.receiver),
            passer: time(passer, places.passer),
            ball: ball_time,
            at_ball: off < AT_BALL_WITHIN_M && (passer.heading - places.passer.1).abs() < AIMED_WITHIN_RAD,
        }
    }

    /// T_p = T_s + T_b.
    pub fn pass(&self) -> f32 {
        self.passer + self.ball
    }
}

/// A pass that is being coordinated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PassAhead {
    began: Instant,
    passer: Option<Instant>,
    receiver: Option<Instant>,
    shot: Option<Instant>,
}

/// The present moves of both robots.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Moves {
    /// The passer's present move.
    pub passer: PasserMove,
    /// Whether the receiver goes to x_r.
    pub receiver_goes: bool,
}

/// A move of the passer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PasserMove {
    /// Does not start yet.
    Waits,
    /// Goes to x_p, and waits there for the receiver.
    Goes,
    /// Kicks the ball now.
    Shoots,
    /// T_f is over: the caller chooses another target.
    GivesUp {
        /// Time since the pass was requested.
        after: Duration,
    },
}

impl PassAhead {
    /// A pass requested at `now`: neither passer nor receiver has started.
    pub fn new(now: Instant) -> Self {
        Self { began: now, passer: None, receiver: None, shot: None }
    }

    /// When the receiver started, if it has.
    pub fn receiver_started(&self) -> Option<Instant> {
        self.receiver
    }

    /// When the passer was ordered to kick, if it was.
    pub fn shot(&self) -> Option<Instant> {
        self.shot
    }

    /// One step of Algorithm 1. Where T_p = T_r both start.
    pub fn step(&mut self, now: Instant, times: &Times) -> Moves {
        let after = now.since(self.began);
        if self.shot.is_none() && after > SEARCH_TIME {
            return Moves { passer: PasserMove::GivesUp { after }, receiver_goes: false };
        }
        if times.pass() >= times.receiver {
            self.passer.get_or_insert(now);
        }
        if times.receiver >= times.pass() {
            self.receiver.get_or_insert(now);
        }
        // T_r ≈ T_p, and T_s is 0 by now.
        let together = times.receiver <= times.ball + RECEIVER_LATE_MAX_S;
        if self.passer.is_some() && times.at_ball && together {
            self.shot.get_or_insert(now);
            // When the passer shoots, its receiver has started, however short its path.
            self.receiver.get_or_insert(now);
        }
        let passer = match (self.shot, self.passer) {
            (Some(_), _) => PasserMove::Shoots,
            (None, Some(_)) => PasserMove::Goes,
            (None, None) => PasserMove::Waits,
        };
        Moves { passer, receiver_goes: self.receiver.is_some() }
    }
}

#[cfg(test)]
mod tests;
