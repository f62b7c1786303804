//! `requests`: automatic requests of our team to the game controller: a keeper that can play, a substitution,
//! the advantage.
//!
//! Sans-IO: [`Requests::look`] takes the strategy's view, [`Requests::poll`] gives the next request for the
//! controller's port for teams ([`crate::referee::team_port`]). SI, attack frame.

use std::collections::VecDeque;

use protocol::{Duration, Instant};
use rules::{Phase, Side};

use crate::referee::team_port::TeamPortRequest;
use crate::strategy::View;
use crate::strategy::view::nearest;

/// A keeper counts as missing after this time: vision loses a robot for less, and the radio link is restored
/// within half a second.
const KEEPER_MISSING_AFTER: Duration = Duration::millis(2000);
/// A keeper is requested again after this time, if the requested one is not named.
const REQUEST_EVERY: Duration = Duration::millis(3000);
/// A robot that is leaving needs less: division A's diagonal at the 1.5 m/s of a stop takes 10 s.
const LEAVING_TIME_MAX: Duration = Duration::millis(12_000);

/// The requests sent, and since when their causes persist.
#[derive(Clone, Debug, Default)]
pub(crate) struct Requests {
    out: VecDeque<TeamPortRequest>,
    keeper_gone: Option<Instant>,
    keeper_asked: Option<Instant>,
    crowded: Option<Instant>,
    /// A substitution was requested, for the surplus robots now on the field.
    substitution: bool,
    advantage: bool,
}

impl Requests {
    /// Takes the strategy's view of the field; `left`: substitutions left in this half, if the referee sends
    /// it.
    pub(crate) fn look(&mut self, view: &View, left: Option<u32>) {
        self.keeper(view);
        self.substitution(view, left);
        self.advantage(view);
    }

    pub(crate) fn poll(&mut self) -> Option<TeamPortRequest> {
        self.out.pop_front()
    }

    /// A keeper that is missing (or does not receive the host) delays every penalty against us, and leaves
    /// our goal open: the robot nearest to our goal takes over. The controller grants that while the ball is
    /// out of play.
    fn keeper(&mut self, view: &View) {
        if view.our(view.keeper).is_some() || view.ours.is_empty() {
            (self.keeper_gone, self.keeper_asked) = (None, None);
            return;
        }
        let gone = view.now.since(*self.keeper_gone.get_or_insert(view.now));
        let granted = matches!(view.phase, Phase::Halt | Phase::Stop | Phase::Timeout(_));
        let again = self.keeper_asked.is_none_or(|asked| view.now.since(asked) >= REQUEST_EVERY);
        if gone >= KEEPER_MISSING_AFTER
            && granted
            && again
            && let Some((robot, _)) = nearest(view.ours.iter(), view.our_goal())
        {
            self.keeper_asked = Some(view.now);
            self.out.push_back(TeamPortRequest::Keeper(robot.id));
        }
    }

    /// A surplus robot that cannot leave by itself blocks the game: after [`LEAVING_TIME_MAX`] in a stop our
    /// robot handler is to take it out.
    ///
    /// Requested once until there is no surplus robot any more, and only while it is free: where no robot
    /// handler acts, every further request would halt the game again, and after the fifth each is a foul and
    /// every third a card.
    fn substitution(&mut self, view: &View, left: Option<u32>) {
        let ours = view.ours.iter().filter(|robot| view.counts_for_us(robot.position)).count();
        let too_many = ours + view.uncommanded > view.allowed;
        if !too_many {
            self.crowded = None;
            if std::mem::take(&mut self.substitution) {
                self.out.push_back(TeamPortRequest::Substitute(false));
            }
            return;
        }
        if view.phase != Phase::Stop {
            self.crowded = None;
            return;
        }
        let stuck = view.now.since(*self.crowded.get_or_insert(view.now)) >= LEAVING_TIME_MAX;
        if stuck && !self.substitution && left != Some(0) {
            self.substitution = true;
            self.out.push_back(TeamPortRequest::Substitute(true));
        }
    }

    /// Answers an advantage, as the opponents have a surplus robot: we continue while that is to our
    /// advantage (our penalty, or the ball in their half); the controller stops the game for it otherwise.
    fn advantage(&mut self, view: &View) {
        let theirs = view.theirs.iter().filter(|robot| view.counts_for_them(robot.position)).count();
        let attack = match view.phase {
            Phase::PreparePenalty(side) | Phase::Penalty(side) | Phase::FreeKick(side) => side == Side::Ours,
            Phase::Run => view.ball.is_some_and(|ball| ball.position.x() > 0.0),
            _ => false,
        };
        let go_on = attack && theirs > view.theirs_allowed;
        if go_on != self.advantage {
            self.advantage = go_on;
            self.out.push_back(TeamPortRequest::Advantage { go_on });
        }
    }
}

#[cfg(test)]
mod tests;
