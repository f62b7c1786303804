//! `areas`: offences at defence areas. Rules: robot too close to opponent defense area, attacker touched
//! ball, multiple defenders. m, s, field frame; distances from a robot's nearest side.

use geometry::{Field, GoalEnd, Point};
use protocol::{Instant, Who};
use rules::legality::{self, InArea};
use rules::{Colour, FieldSpec, Phase, limits};

use super::super::event::{RefereeEvent, What};
use super::super::observation::RobotSeen;
use super::super::scene::Scene;
use super::Episodes;

#[derive(Clone, Debug, Default)]
pub(super) struct Areas {
    attackers: Episodes<Who>,
    defenders: Episodes<Who>,
    /// Time of each team's last foul of being too close, in the order of [`Colour::ALL`].
    too_close: [Option<Instant>; 2],
}

impl Areas {
    pub(super) fn command_given(&mut self) {
        self.defenders.clear();
        self.too_close = [None; 2];
    }

    pub(super) fn look(&mut self, scene: &Scene<'_>, events: &mut Vec<RefereeEvent>) {
        // Teams that change ends drive through each other's areas; on a real field their robots are carried.
        if matches!(scene.game.phase, Phase::Stop | Phase::FreeKick(_)) && !scene.game.before_half {
            for (team, raised) in Colour::ALL.into_iter().zip(&mut self.too_close) {
                events.extend(too_close(scene, team, raised));
            }
        }
        if !scene.game.is_running() {
            return;
        }
        for robot in scene.robots {
            let (field, place) = (scene.game.field, robot.pose.position);
            let own = scene.game.own_end(robot.who.colour);
            let attacks =
                robot.touches_ball && legality::in_area(field, own.opposite(), place) >= InArea::Partly;
            if self.attackers.raise(robot.who, attacks, scene.now) {
                let depth = depth_in(field, own.opposite(), place);
                events.push(scene.by(robot.who, place, What::AttackerTouchedBall { depth }));
            }
            let defends = robot.touches_ball
                && !scene.game.accounts.is_keeper(robot.who)
                && legality::in_area(field, own, place) >= InArea::Entirely;
            if self.defenders.raise(robot.who, defends, scene.now) {
                let depth = depth_in(field, own, place);
                events.push(scene.by(robot.who, place, What::DefenderInArea { depth }));
            }
        }
    }
}

/// The team's robot that is nearest to the opponents' area, where it is too near and the team's grace is
/// over.
fn too_close(scene: &Scene<'_>, team: Colour, raised: &mut Option<Instant>) -> Option<RefereeEvent> {
    let grace_began = raised.map_or(scene.game.since, |raised| raised.max(scene.game.since));
    if scene.now.since(grace_began).as_secs_f32() <= limits::GRACE {
        return None;
    }
    let end = scene.game.own_end(team).opposite();
    let distance = |robot: &RobotSeen| gap_to_area(scene.game.field, end, robot.pose.position);
    let ours = scene.robots.iter().filter(|robot| robot.who.colour == team);
    let nearest = ours.min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
    let distance = distance(nearest);
    let close = legality::too_close_to_area(scene.game.field, end, nearest.pose.position);
    close.then(|| {
        *raised = Some(scene.now);
        let what = What::AttackerTooClose { distance: distance.max(0.0), ball: scene.ball.position };
        scene.by(nearest.who, nearest.pose.position, what)
    })
}

/// Distance from a robot's nearest side to the area, m: negative inside.
fn gap_to_area(field: &FieldSpec, end: GoalEnd, position: Point<Field>) -> f32 {
    field.distance_to_area(end, position) - limits::ROBOT_RADIUS
}

/// Depth of that robot's nearest side within the area, m: negative outside.
fn depth_in(field: &FieldSpec, end: GoalEnd, position: Point<Field>) -> f32 {
    limits::ROBOT_RADIUS - field.distance_to_area(end, position)
}
