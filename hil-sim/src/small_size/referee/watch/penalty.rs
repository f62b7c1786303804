//! `penalty`: failed penalties. Rules: penalty kick.
//!
//! m, m/s, field frame. Goals, lines and time are checked by other monitors.

use geometry::{Field, Vector};
use rules::{Colour, Phase, legality, limits};

use super::super::event::{PenaltyEnd, RefereeEvent, What};
use super::super::scene::Scene;
use super::Touches;
use protocol::Who;

#[derive(Clone, Debug, Default)]
pub(super) struct PenaltyWatch {
    /// Maximum advance of the ball towards the goal, m.
    farthest: Option<f32>,
    /// Velocity of the ball before the keeper touched it.
    incoming: Option<Vector<Field>>,
    raised: bool,
}

impl PenaltyWatch {
    pub(super) fn command_given(&mut self) {
        *self = Self::default();
    }

    pub(super) fn look(&mut self, scene: &Scene<'_>, touches: &Touches, events: &mut Vec<RefereeEvent>) {
        let Phase::Penalty(team) = scene.game.phase else { return };
        let failed = self.failed(scene, touches, team).filter(|_| !self.raised);
        if let Some(reason) = failed {
            self.raised = true;
            events.push(scene.of(Some(team), scene.ball.position, What::PenaltyFailed { reason }));
        }
    }

    fn failed(&mut self, scene: &Scene<'_>, touches: &Touches, team: Colour) -> Option<PenaltyEnd> {
        let goal = scene.game.own_end(team.other()).sign() as f32;
        let keeper = Who { colour: team.other(), id: scene.game.accounts.of(team.other()).keeper };
        let by_keeper = touches.last().is_some_and(|touch| touch.who == keeper);
        let velocity = scene.ball.velocity;
        if !by_keeper {
            self.incoming = Some(velocity);
        } else if let Some(before) = self.incoming
            && before.norm() > limits::BALL_STILL
            && velocity.norm() > limits::BALL_STILL
            && legality::turned_back(before, velocity)
        {
            return Some(PenaltyEnd::Saved);
        }
        let advance = scene.ball.position.x() * goal;
        let farthest = self.farthest.map_or(advance, |farthest| farthest.max(advance));
        self.farthest = Some(farthest);
        // Within the distance that the ball may move before it is in play.
        (farthest - advance > limits::IN_PLAY_DISTANCE).then_some(PenaltyEnd::MovedBack)
    }
}
