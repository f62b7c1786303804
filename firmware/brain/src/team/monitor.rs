//! `monitor`: monitoring of a running case by every robot involved (docs/architecture.md §5.3, docs/papers.md
//! R27).
//!
//! Before the first touch: ball in the case's scope, path free. After it: no opponent on the ball, and the
//! ball not stopped where no robot of the case expects it. A doubt must last a fifth of a second before it
//! aborts: an opponent at the edge of a trapezoid shall not end a gameplay by swaying.

use casebase::{PointMm, RetrievalSettings};
use geometry::Segment;
use protocol::team::AbortReason;

use crate::execution::ActionScene;

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
    let ball = scene.belief.ball?.rest.into();
    if !scene.case.ball_in_scope(ball) {
        return Some(AbortReason::BallOutOfScope);
    }
    let mut opponents: heapless::Vec<PointMm, { protocol::robot_io::OPPONENTS_MAX }> = heapless::Vec::new();
    // Same capacity as the belief's.
    for opponent in &scene.belief.opponents {
        let _room = opponents.push(PointMm::from(*opponent));
    }
    casebase::blocked_leg(&scene.case, scene.base, scene.ball_used(), &opponents, settings)
        .map(|_| AbortReason::PathBlocked)
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
    let expected = scene.case.legs(scene.ball_used()).into_iter().any(|leg| {
        let path = Segment::new(leg.start(), leg.end());
        path.distance_to(ball.position) < leg.r_max * 0.001 + STRAY
    });
    let at_start = ball.position.distance(scene.ball_used().into()) < STRAY;
    (!expected && !at_start).then_some(AbortReason::BallAtRest)
}

/// Distance outside a leg's trapezoid up to which a stationary ball is still where the case expects it, m.
const STRAY: f32 = 0.3;
