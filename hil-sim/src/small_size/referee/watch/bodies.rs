//! `bodies`: contact offences: crashing, pushing, ball holding. Rules: crashing, pushing, ball holding.
//!
//! m, m/s, s, field frame. What the rules leave to the human referee's judgement has thresholds of ours here,
//! estimated.

use std::collections::BTreeMap;

use geometry::{Angle, Vector, math};
use protocol::{Instant, Who};
use rules::legality::{self, Blame};
use rules::{Colour, limits};

use super::super::event::{RefereeEvent, What};
use super::super::observation::{CrashSeen, RobotSeen};
use super::super::scene::Scene;
use super::Episodes;

#[derive(Clone, Debug, Default)]
pub(super) struct Bodies {
    crashes: Episodes<[Who; 2]>,
    /// Distance that the first has pushed the second, and the time of the last push.
    pushes: BTreeMap<[Who; 2], Push>,
    /// Since when a team encloses the ball, in the order of [`Colour::ALL`].
    closed: [Option<Instant>; 2],
    before: Option<Instant>,
}

#[derive(Clone, Copy, Debug)]
struct Push {
    distance: f32,
    at: Instant,
}

impl Bodies {
    pub(super) fn look(&mut self, scene: &Scene<'_>, events: &mut Vec<RefereeEvent>) {
        for crash in scene.crashes {
            events.extend(self.crash(scene, crash));
        }
        let dt = scene.now.since(self.before.unwrap_or(scene.now)).as_secs_f32();
        self.before = Some(scene.now);
        if !scene.game.judge_manual_fouls || !scene.game.is_running() {
            self.pushes.clear();
            self.closed = [None; 2];
            return;
        }
        for yellow in scene.robots.iter().filter(|robot| robot.who.colour == Colour::Yellow) {
            for blue in scene.robots.iter().filter(|robot| robot.who.colour == Colour::Blue) {
                events.extend(self.push(scene, yellow, blue, dt));
                events.extend(self.push(scene, blue, yellow, dt));
            }
        }
        for (team, since) in Colour::ALL.into_iter().zip(&mut self.closed) {
            events.extend(holding(scene, team, since));
        }
    }

    fn crash(&mut self, scene: &Scene<'_>, crash: &CrashSeen) -> Option<RefereeEvent> {
        let [a, b] = crash.between;
        if a.colour == b.colour {
            return None;
        }
        let (one, other) = (scene.robot(a)?, scene.robot(b)?);
        let (places, velocities) = ([one, other].map(|robot| robot.pose.position), crash.velocities);
        let fault = legality::crash((places[0], velocities[0]), (places[1], velocities[1]));
        let pair = if a < b { [a, b] } else { [b, a] };
        if !self.crashes.raise(pair, fault.is_some(), scene.now) {
            return None;
        }
        let fault = fault?;
        let (crash_speed, speed_difference) = (fault.speed, fault.difference.abs());
        let angle = angle_between(velocities[0] - velocities[1], places[1] - places[0]);
        let place = places[0] + (places[1] - places[0]) * 0.5;
        let (violator, victim) = match fault.blame {
            Blame::First => (a, b.id),
            Blame::Second => (b, a.id),
            Blame::Both => {
                let (yellow, blue) = if a.colour == Colour::Yellow { (a.id, b.id) } else { (b.id, a.id) };
                let what = What::CrashDrawn { yellow, blue, crash_speed, speed_difference, angle };
                return Some(scene.of(None, place, what));
            }
        };
        Some(scene.by(violator, place, What::CrashUnique { victim, crash_speed, speed_difference, angle }))
    }

    /// Pushing: both are in contact and move in the direction from the first to the second.
    fn push(&mut self, scene: &Scene<'_>, from: &RobotSeen, to: &RobotSeen, dt: f32) -> Option<RefereeEvent> {
        let pair = [from.who, to.who];
        let between = to.pose.position - from.pose.position;
        let apart = between.norm() - 2.0 * limits::ROBOT_RADIUS;
        let at_ball = from.touches_ball && to.touches_ball;
        let line = between.unit()?;
        let pushed = to.velocity.dot(line);
        let straight = pushed > to.velocity.norm() * PUSHED_STRAIGHT_COS_MIN;
        let pushes = (apart <= CONTACT_GAP_MAX || at_ball)
            && straight
            && pushed > PUSHING_SPEED_MIN
            && from.velocity.dot(line) > PUSHING_SPEED_MIN;
        if !pushes {
            if self.pushes.get(&pair).is_some_and(|push| scene.now.since(push.at).as_secs_f32() > PUSH_PAUSE)
            {
                self.pushes.remove(&pair);
            }
            return None;
        }
        let push = self.pushes.entry(pair).or_insert(Push { distance: 0.0, at: scene.now });
        push.at = scene.now;
        let before = push.distance;
        push.distance += pushed * dt;
        let raised = before <= PUSH_DISTANCE && push.distance > PUSH_DISTANCE;
        let what = What::Pushed { victim: to.who.id, distance: push.distance };
        raised.then(|| scene.by(from.who, from.pose.position, what))
    }
}

/// A team's robots enclose the ball so that no opponent fits between them.
fn holding(scene: &Scene<'_>, team: Colour, since: &mut Option<Instant>) -> Option<RefereeEvent> {
    let around = scene
        .robots
        .iter()
        .filter(|robot| robot.who.colour == team && scene.distance_to_ball(robot) <= AROUND_BALL_DISTANCE);
    let mut directions: Vec<f32> =
        around.map(|robot| scene.ball.position.direction_to(robot.pose.position).radians()).collect();
    directions.sort_by(f32::total_cmp);
    let next = directions.iter().cycle().skip(1);
    let widest = directions
        .iter()
        .zip(next)
        .map(|(from, to)| if to > from { to - from } else { to - from + math::TAU })
        .fold(0.0, f32::max);
    if directions.len() < 3 || widest > GAP {
        *since = None;
        return None;
    }
    let began = *since.get_or_insert(scene.now);
    let duration = scene.now.since(began).as_secs_f32();
    (duration > HOLD_TIME).then(|| {
        *since = None;
        scene.of(Some(team), scene.ball.position, What::HeldBall { duration })
    })
}

fn angle_between(a: Vector<geometry::Field>, b: Vector<geometry::Field>) -> f32 {
    Angle::new(math::atan2(b.cross(a), b.dot(a))).radians()
}

/// Distance between hulls, m, below which they are in contact: as in the automatic referee of the TIGERs.
const CONTACT_GAP_MAX: f32 = 0.01;
/// Minimum speed of a moving robot, m/s: a robot with blocked wheels is slower.
const PUSHING_SPEED_MIN: f32 = 0.2;
/// Pushed distance that is a foul, m: as in the automatic referee of the TIGERs while it judged pushing.
const PUSH_DISTANCE: f32 = 0.2;
/// Cosine of 0.7 rad: a robot is pushed if its motion is within this angle of the line between the two (same
/// source).
const PUSHED_STRAIGHT_COS_MIN: f32 = 0.764_842;
/// Pauses up to this do not end a push, s.
const PUSH_PAUSE: f32 = 0.2;
/// Maximum distance from the ball, m, of robots around it: an opponent of 0.18 m fits behind them only.
const AROUND_BALL_DISTANCE: f32 = 0.18;
/// The widest gap between two neighbours, seen from the ball, through which no opponent reaches it, rad
/// (150°).
const GAP: f32 = 2.617_994;
/// Maximum time a ball may be enclosed, s: as the rules' other graces.
const HOLD_TIME: f32 = limits::GRACE;
