//! `hybrid`: combination of the deliberative and the reactive approach (Ros et al. 2009, §5.4 and §7).
//!
//! The paper: "when the players are in front of the goal, there is no need of reasoning about interesting
//! plays", elsewhere cooperation is better. So the reactive behaviour competes with the retrieved case by the
//! time to its shot, as both are expected: the case's gameplay and what is left to the goal after it, against
//! fetching the ball and kicking it on until the goal is in reach. SI units.

use geometry::{Field, Point, Segment};

use casebase::{Action, KickAim, LegKind};

use crate::action_scene::ActionScene;
use crate::estimate;

/// Whether the reactive behaviour is expected to shoot sooner than the gameplay of `scene`.
pub fn reactive_shoots_sooner(scene: &ActionScene<'_>) -> bool {
    let ball = Point::from(casebase::PointMm::from(scene.play.ball));
    let goal = scene.belief.league().field().goal_center(scene.case.defending().opposite());
    if ball.distance(goal) > IN_REACH {
        return false;
    }
    let players = scene.play.robots.iter().filter_map(|&id| scene.teammates.get(scene.now, id));
    let nearest = players
        .map(|teammate| teammate.pose().position)
        .chain([scene.belief.pose.position])
        .map(|robot| robot.distance(ball))
        .fold(f32::INFINITY, f32::min);
    let path = Segment::new(ball, goal);
    let stands_in_it = |robot: &Point<Field>| {
        let at = path.closest_to(*robot).distance(ball);
        at < DUEL_AHEAD && path.distance_to(*robot) < DUEL_BESIDE
    };
    let duel = if scene.belief.opponents.iter().any(stands_in_it) { DUEL } else { 0.0 };
    let alone = nearest / scene.body.spec().speed + until_shot(scene, ball) + duel;
    alone + REACTIVE_LEAD_MIN_S < gameplay_until_shot(scene)
}

/// Expected seconds until the gameplay's shot, or until the shot that could follow from its final ball
/// position.
fn gameplay_until_shot(scene: &ActionScene<'_>) -> f32 {
    let shoots = scene.case.robots().flat_map(|part| scene.case.gameplay(part)).any(|action| match action {
        Action::Kick(kind) => {
            scene.base.kick(kind).is_some_and(|kick| matches!(kick.aim, KickAim::Goal { .. }))
        }
        _ => false,
    });
    let duration = estimate::gameplay(scene);
    if shoots {
        return duration;
    }
    let last = scene.case.legs(scene.ball_used()).last();
    // Who has received a pass has the ball at its feet.
    last.map_or(duration, |leg| {
        let grabbed = if matches!(leg.kind, LegKind::Pass(_)) { scene.body.spec().grab } else { 0.0 };
        duration + until_shot(scene, leg.end()) - grabbed
    })
}

/// Expected seconds from reaching a ball at `ball` until a shot: grabs, and short kicks on until the goal is
/// in reach.
fn until_shot(scene: &ActionScene<'_>, ball: Point<Field>) -> f32 {
    let goal = scene.belief.league().field().goal_center(scene.case.defending().opposite());
    let mut pushes = 0.0;
    let mut left = ball.distance(goal) - SHOT_FROM;
    while left > 0.0 {
        pushes += 1.0;
        left -= PUSH;
    }
    let spec = scene.body.spec();
    spec.grab + pushes * (spec.kick + estimate::roll(scene, PUSH) + spec.grab) + spec.turn + spec.kick
}

/// Elsewhere a deliberate gameplay is better (§5.4): a ball this far from the goal's centre is out of reach,
/// m.
const IN_REACH: f32 = 2.15;
/// Least lead of the reactive behaviour, s: the accuracy of a gameplay's estimate.
const REACTIVE_LEAD_MIN_S: f32 = 1.0;
/// An opponent this far ahead of the ball, and this far beside its path to the goal, will dispute it, m: what
/// it walks in 3 s.
const DUEL_AHEAD: f32 = 1.0;
/// Sideways limit, m; see [`DUEL_AHEAD`].
const DUEL_BESIDE: f32 = 0.6;
/// Duration of a duel, s: a few grabs by either side.
const DUEL: f32 = 6.0;
/// Distance up to which shots can reach the goal, m: a hard kick (2.15 m) less its scatter in length.
const SHOT_FROM: f32 = 1.6;
/// A short kick's nominal distance, m.
const PUSH: f32 = 0.8;
