//! `estimate`: expected duration and timeout of a gameplay (docs/architecture.md §5.3: 1.5 × expected
//! duration + 2 s).

use casebase::{Action, CaseRobot, Leg};
use geometry::{Field, Point};
use protocol::Duration;

use crate::action_scene::ActionScene;

/// Time limit for a task expected to take `expected` seconds.
pub(crate) fn limit(expected: f32) -> Duration {
    Duration::from_secs_f32(1.5 * expected + 2.0)
}

/// Expected seconds from now until the whole gameplay is over: the ball getter's walk, then every action that
/// the ball waits for, one after the other; walks without the ball run beside them.
pub(crate) fn gameplay(scene: &ActionScene<'_>) -> f32 {
    let case = &scene.case;
    let mut walk = 0.0_f32;
    for part in case.robots() {
        let from = scene
            .player(part)
            .and_then(|id| scene.teammates.get(scene.now, id))
            .map_or(scene.belief.pose.position, |teammate| teammate.pose().position);
        walk = walk.max(from.distance(scene.place_of(part)) / scene.body.spec().speed);
    }
    let chain: f32 = case
        .robots()
        .map(|part| {
            case.gameplay(part)
                .enumerate()
                .map(|(index, kind)| match kind {
                    Action::Wait => 0.0,
                    _ => action(scene, part, index),
                })
                .sum::<f32>()
        })
        .sum();
    walk + chain
}

/// Expected seconds of one action, from the time it starts.
fn action(scene: &ActionScene<'_>, part: CaseRobot, index: usize) -> f32 {
    action_with(scene, part, index, || scene.case.partner_of(part, index))
}

/// The same, called for `partner` at the other end of the action's hand-over.
pub(crate) fn action_with(
    scene: &ActionScene<'_>,
    part: CaseRobot,
    index: usize,
    partner: impl FnOnce() -> Option<(CaseRobot, usize)>,
) -> f32 {
    let place = scene.place_of(part);
    let spec = scene.body.spec();
    match scene.case.action(part, index) {
        None | Some(Action::Wait) => 0.0,
        Some(Action::GoToPoint(p)) => walk(place, scene.adapt(p), spec.speed),
        Some(Action::DribbleTo(p)) => spec.turn + walk(place, scene.adapt(p), spec.carry_speed),
        Some(Action::Turn(_)) => spec.turn,
        Some(Action::GetBall) => {
            spec.grab
                + match handed_over(scene, partner()) {
                    // After a kick: from its origin, or from the robot's place, to the ball's stop position.
                    Some((from, leg)) => {
                        let start = if from == part { leg.start() } else { place };
                        walk(start, leg.end(), spec.speed).max(along(scene, &leg))
                    }
                    None => walk(place, scene.ball_used().into(), spec.speed).min(spec.longest_fetch),
                }
        }
        Some(Action::ReceiveBall(_)) => {
            spec.grab + handed_over(scene, partner()).map_or(0.0, |(_, leg)| along(scene, &leg))
        }
        Some(Action::PassBall(_) | Action::Kick(_)) => spec.turn + spec.kick,
    }
}

/// The leg by which the ball comes from that action of a partner, and the robot that makes it.
fn handed_over(scene: &ActionScene<'_>, partner: Option<(CaseRobot, usize)>) -> Option<(CaseRobot, Leg)> {
    let (from, action) = partner?;
    Some((from, scene.leg(from, action)?))
}

/// Seconds until a ball passed over `distance` is there.
pub(crate) fn roll(scene: &ActionScene<'_>, distance: f32) -> f32 {
    scene.body.roll(scene.belief.league(), distance)
}

fn along(scene: &ActionScene<'_>, leg: &Leg) -> f32 {
    roll(scene, leg.start().distance(leg.end()))
}

fn walk(from: Point<Field>, to: Point<Field>, speed: f32) -> f32 {
    from.distance(to) / speed
}
