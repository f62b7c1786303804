//! `stop_rules`: rules while the ball is out of play: standing still, speed and distances. Rules: referee
//! commands; fouls while the ball is out of play.
//!
//! m, m/s, s, field frame; distances from a robot's nearest side to the ball's centre.

use std::collections::{BTreeMap, BTreeSet};

use protocol::{Instant, Who};
use rules::{Colour, Phase, legality, limits};

use super::super::event::{RefereeEvent, What};
use super::super::observation::RobotSeen;
use super::super::scene::Scene;
use super::Episodes;

/// Monitors positions and speeds while the ball is out of play.
#[derive(Clone, Debug, Default)]
pub(super) struct StopRules {
    /// Robots already reported in this halt or stop, for each of its offences.
    moved: BTreeSet<Who>,
    fast: BTreeSet<Who>,
    near: BTreeSet<Who>,
    /// Since when each robot is at a forbidden position.
    near_since: BTreeMap<Who, Instant>,
    /// Of several robots of a team within 2 s only the first counts.
    fast_teams: Episodes<Colour>,
    kick_point: Episodes<Colour>,
    placement: Episodes<Colour>,
}

impl StopRules {
    pub(super) fn command_given(&mut self) {
        *self = Self::default();
    }

    pub(super) fn look(&mut self, scene: &Scene<'_>, events: &mut Vec<RefereeEvent>) {
        match scene.game.phase {
            Phase::Halt => self.halt(scene, events),
            Phase::Stop => {
                self.stop_speed(scene, events);
                self.stop_distance(scene, events);
            }
            Phase::FreeKick(team) | Phase::Kickoff(team) => {
                events.extend(self.kick_point(scene, team.other()));
            }
            Phase::BallPlacement(team) => events.extend(self.placement(scene, team.other())),
            _ => {}
        }
    }

    fn halt(&mut self, scene: &Scene<'_>, events: &mut Vec<RefereeEvent>) {
        if scene.game.is_break || scene.game.age(scene.now) <= limits::GRACE {
            return;
        }
        for robot in scene.robots {
            let speed = robot.velocity.norm();
            if speed > STANDING_SPEED_MAX && self.moved.insert(robot.who) {
                events.push(scene.by(robot.who, robot.pose.position, What::MovedInHalt { speed }));
            }
        }
    }

    fn stop_speed(&mut self, scene: &Scene<'_>, events: &mut Vec<RefereeEvent>) {
        if scene.game.age(scene.now) <= limits::GRACE {
            return;
        }
        for robot in scene.robots {
            let speed = robot.velocity.norm();
            let new = legality::too_fast_in_stop(robot.velocity) && self.fast.insert(robot.who);
            if new && self.fast_teams.raise(robot.who.colour, true, scene.now) {
                events.push(scene.by(robot.who, robot.pose.position, What::TooFastInStop { speed }));
            }
        }
    }

    fn stop_distance(&mut self, scene: &Scene<'_>, events: &mut Vec<RefereeEvent>) {
        for robot in scene.robots {
            let distance = scene.distance_to_ball(robot);
            let close = legality::too_close_to_ball(robot.pose.position, scene.ball.position);
            let stays = self.stays(scene, robot, close);
            if stays && self.near.insert(robot.who) {
                let what = What::TooCloseInStop { distance: distance.max(0.0) };
                events.push(scene.by(robot.who, robot.pose.position, what));
            }
        }
    }

    /// The nearest robot of the team that must keep its distance while the other kicks.
    fn kick_point(&mut self, scene: &Scene<'_>, team: Colour) -> Option<RefereeEvent> {
        let nearest = nearest(scene, team)?;
        let distance = scene.distance_to_ball(nearest);
        let holds = legality::too_close_to_ball(nearest.pose.position, scene.ball.position);
        let raised = self.kick_point.raise(team, holds, scene.now);
        let what = What::DefenderTooClose { distance: distance.max(0.0) };
        raised.then(|| scene.by(nearest.who, nearest.pose.position, what))
    }

    /// A robot of the team that does not place, too near the line from ball to target for longer than the
    /// grace.
    fn placement(&mut self, scene: &Scene<'_>, team: Colour) -> Option<RefereeEvent> {
        let target = scene.game.target?;
        let mut first = None;
        for robot in scene.robots.iter().filter(|robot| robot.who.colour == team) {
            let within = legality::interferes(robot.pose.position, scene.ball.position, target);
            if self.stays(scene, robot, within) && first.is_none() {
                first = Some(robot);
            }
        }
        let raised = self.placement.raise(team, first.is_some(), scene.now);
        first
            .filter(|_| raised)
            .map(|robot| scene.by(robot.who, robot.pose.position, What::InterferedPlacement))
    }

    /// True for a robot that has been at a forbidden position for longer than the grace.
    fn stays(&mut self, scene: &Scene<'_>, robot: &RobotSeen, within: bool) -> bool {
        if !within {
            self.near_since.remove(&robot.who);
            return false;
        }
        let since = *self.near_since.entry(robot.who).or_insert(scene.now);
        scene.now.since(since).as_secs_f32() > limits::GRACE
    }
}

fn nearest<'a>(scene: &'a Scene<'_>, team: Colour) -> Option<&'a RobotSeen> {
    let distance = |robot: &RobotSeen| scene.distance_to_ball(robot);
    let robots = scene.robots.iter().filter(|robot| robot.who.colour == team);
    robots.min_by(|a, b| distance(a).total_cmp(&distance(b)))
}

/// Speed below which a robot stands, m/s: below the apparent speed of a standing robot by a camera's noise,
/// estimated.
const STANDING_SPEED_MAX: f32 = 0.05;
