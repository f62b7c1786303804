//! `monitor`: monitoring of a running case by every robot involved (docs/architecture.md §5.3, docs/papers.md
//! R27).
//!
//! Before the first touch: ball in the case's scope, path free. On wheels, which meet a rolling ball on its
//! way, it is in scope while that way leads through it. After the touch: no opponent on the ball, and the
//! ball not stopped where no robot of the case expects it. A doubt must last a fifth of a second before it
//! aborts: an opponent at the edge of a trapezoid shall not end a gameplay by swaying. What is believed with
//! an error is doubted only beyond two standard deviations of it.

use casebase::{LegKind, PointMm, RetrievalSettings};
use geometry::{Field, Segment, Vector, math};
use protocol::team::AbortReason;

use crate::action_scene::ActionScene;

/// A doubt about the case, and its duration.
#[derive(Clone, Debug, Default)]
pub struct Monitor {
    doubt: Option<AbortReason>,
    steps: u8,
}

impl Monitor {
    /// Resets it for a new gameplay.
    pub fn reset(&mut self) {
        *self = Self::default();
    }

    /// The reason to abort, if there is one.
    pub fn step(
        &mut self,
        scene: &ActionScene<'_>,
        touched: bool,
        settings: &RetrievalSettings,
    ) -> Option<AbortReason> {
        let doubt = if touched { after_touch(scene) } else { before_touch(scene, settings) };
        self.steps = if doubt.is_some() && doubt == self.doubt { self.steps.saturating_add(1) } else { 0 };
        self.doubt = doubt;
        doubt.filter(|_| self.steps >= scene.body.spec().doubt_steps)
    }
}

fn before_touch(scene: &ActionScene<'_>, settings: &RetrievalSettings) -> Option<AbortReason> {
    let (ball, meets) = (scene.belief.ball?, scene.body.spec().meets_rolling_balls);
    let ball: PointMm =
        if meets { ball.path().closest_to(scene.ball_used().into()).into() } else { ball.rest.into() };
    if !scene.case.ball_in_scope(ball) && !may_be_in_scope(scene, ball) {
        return Some(AbortReason::BallOutOfScope);
    }
    let mut opponents: heapless::Vec<PointMm, { protocol::robot_io::OPPONENTS_MAX }> = heapless::Vec::new();
    // Same capacity as the belief's.
    for opponent in &scene.belief.opponents {
        let _room = opponents.push(PointMm::from(*opponent));
    }
    casebase::blocked_leg(&scene.case, scene.base, scene.ball_used(), &opponents, settings)
        // On wheels a shot takes the gap that there is when it is made.
        .filter(|blocked| !(meets && matches!(blocked.leg.kind, LegKind::Kick(_))))
        .filter(|blocked| blocked.inside_mm >= CERTAIN_SIGMAS * 1000.0 * scene.belief.opponent_sigma())
        .map(|_| AbortReason::PathBlocked)
}

/// Whether a ball whose estimate lies outside of the case's scope may lie inside: within [`CERTAIN_SIGMAS`]
/// deviations.
fn may_be_in_scope(scene: &ActionScene<'_>, ball: PointMm) -> bool {
    let sigma = if cfg!(feature = "legged") { scene.belief.ball_sigma } else { 0.0 };
    if sigma <= 0.0 {
        return false;
    }
    let [x, y] = scene.case.ball().minus(ball).to_f32();
    let nearer = Vector::<Field>::new(x, y).clamped(CERTAIN_SIGMAS * 1000.0 * sigma);
    scene.case.ball_in_scope(
        ball.plus(PointMm::new(math::round_to_i32(nearer.x()), math::round_to_i32(nearer.y()))),
    )
}

fn after_touch(scene: &ActionScene<'_>) -> Option<AbortReason> {
    if scene.belief.opponent_on_ball(scene.now, scene.teammates) {
        return Some(AbortReason::OpponentOnBall);
    }
    let ball = scene.belief.ball?;
    let held = scene.belief.holds_ball || scene.teammates.anyone_holds_ball();
    if held || !ball.is_at_rest() {
        return None;
    }
    let stray = STRAY + CERTAIN_SIGMAS * scene.belief.ball_sigma;
    let expected = scene.case.legs(scene.ball_used()).into_iter().any(|leg| {
        let path = Segment::new(leg.start(), leg.end());
        path.distance_to(ball.position) < leg.r_max * 0.001 + stray
    });
    let at_start = ball.position.distance(scene.ball_used().into()) < stray;
    (!expected && !at_start).then_some(AbortReason::BallAtRest)
}

/// Distance outside a leg's trapezoid up to which a stationary ball is still where the case expects it, m.
const STRAY: f32 = 0.3;

/// Standard deviations beyond which a believed position is certain enough to end a gameplay.
const CERTAIN_SIGMAS: f32 = 2.0;
