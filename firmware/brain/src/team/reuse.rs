//! ADAPT → EXECUTE → WAIT END: the state machine of a robot involved in a case (paper §4.2, Fig. 10).

use geometry::{Field, Point};
use protocol::team::{AbortReason, Progress};

use crate::action_scene::ActionScene;
use crate::body::Intent;
use crate::config::Positioning;
use crate::execution::{ActionOutcome, Execution, face_ball};
use crate::timer::TimerTable;

/// Result of a step of reuse.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ReuseRequest {
    /// This intent for the body.
    Body(Intent),
    /// This robot's part is over: default behaviour.
    Nothing,
    /// Abort of the cycle.
    Abort(AbortReason),
}

/// One step of the machine; `progress` moves on, never back.
pub fn step(
    scene: &ActionScene<'_>,
    positioning: Positioning,
    execution: &mut Execution,
    progress: &mut Progress,
    timers: &mut TimerTable,
) -> ReuseRequest {
    if let Progress::Adapt { .. } = progress {
        let arrived = has_arrived(scene, execution);
        *progress = if may_execute(scene, positioning, execution, arrived) {
            Progress::Execute { done: 0 }
        } else {
            Progress::Adapt { arrived }
        };
    }
    match progress {
        Progress::Adapt { .. } => ReuseRequest::Body(adapt(scene, execution)),
        Progress::Execute { .. } => match execution.step(scene, timers) {
            ActionOutcome::Running(intent) => {
                *progress = Progress::Execute { done: execution.done() };
                ReuseRequest::Body(intent)
            }
            ActionOutcome::Finished => {
                *progress = Progress::WaitEnd { finished: true };
                ReuseRequest::Nothing
            }
            ActionOutcome::Failed(reason) => ReuseRequest::Abort(reason),
        },
        Progress::WaitEnd { .. } | Progress::Idle => ReuseRequest::Nothing,
    }
}

/// Walks to the adapted position, facing the ball at its end.
fn adapt(scene: &ActionScene<'_>, execution: &Execution) -> Intent {
    if scene.belief.holds_ball {
        return Intent::Stand { face: None };
    }
    let to = scene.place_of(execution.part());
    Intent::Walk { to, face: face_ball(scene.belief, to), avoid_ball: true }
}

/// At its adapted position, facing the ball. For the robot that gets the ball, "next to the ball" is enough
/// (paper §4.2).
fn has_arrived(scene: &ActionScene<'_>, execution: &Execution) -> bool {
    let pose = scene.belief.pose;
    if scene.belief.holds_ball {
        return true;
    }
    let place = scene.place_of(execution.part());
    let spec = scene.body.spec();
    let gets_ball = execution.part() == scene.case.getter();
    let next_to_ball = |position: Point<Field>| {
        scene.belief.ball.is_some_and(|ball| position.distance(ball.position) <= spec.next_to_ball)
    };
    let near =
        pose.position.distance(place) <= spec.arrived_within || (gets_ball && next_to_ball(pose.position));
    let face = face_ball(scene.belief, pose.position);
    near && (face - pose.heading).abs() <= FACING_WITHIN
}

/// Dependent: the ball getter is there. Independent: all are. In both, a teammate that executes has found it
/// so.
fn may_execute(
    scene: &ActionScene<'_>,
    positioning: Positioning,
    execution: &Execution,
    arrived: bool,
) -> bool {
    let there = |part| {
        if part == execution.part() {
            arrived
        } else {
            matches!(scene.progress_of(part), Some(Progress::Adapt { arrived: true }))
                || executes(scene, part)
        }
    };
    let ready = match positioning {
        Positioning::Dependent => there(scene.case.getter()),
        Positioning::Independent => scene.case.robots().all(there),
    };
    ready || scene.case.robots().any(|part| part != execution.part() && executes(scene, part))
}

fn executes(scene: &ActionScene<'_>, part: casebase::CaseRobot) -> bool {
    matches!(scene.progress_of(part), Some(Progress::Execute { .. } | Progress::WaitEnd { finished: true }))
}

/// Facing the ball within this angle, rad: 20° (docs/papers.md R24).
const FACING_WITHIN: f32 = 0.35;
