//! `requests`: what our team asks of the game controller by itself: a keeper that can play, a substitution, the advantage.
//!
//! Sans-IO: [`Requests::look`] takes what strategy sees, [`Requests::poll`] gives what is to be sent on the controller's port for
//! teams ([`crate::referee::team_port`]). SI, attack frame.

use std::collections::VecDeque;

use protocol::{Duration, Instant};
use rules::{Phase, Side};

use crate::referee::team_port::Request;
use crate::strategy::View;
use crate::strategy::view::nearest;

/// What we asked for, and since when something is amiss.
#[derive(Clone, Debug, Default)]
pub(crate) struct Requests {
    out: VecDeque<Request>,
    keeper_gone: Option<Instant>,
    keeper_asked: Option<Instant>,
    crowded: Option<Instant>,
    /// A substitution was asked for, for the robots that are too many now.
    substitution: bool,
    advantage: bool,
}

impl Requests {
    /// Looks at the field as strategy sees it; `left`: substitutions that are free in this half, if the referee says.
    pub(crate) fn look(&mut self, view: &View, left: Option<u32>) {
        self.keeper(view);
        self.substitution(view, left);
        self.advantage(view);
    }

    /// The next request to be sent.
    pub(crate) fn poll(&mut self) -> Option<Request> {
        self.out.pop_front()
    }

    /// A keeper that is not there (or does not hear us) makes every penalty against us wait, and leaves our goal open: the robot
    /// nearest to our goal takes over. The controller grants that while the ball is out of play.
    fn keeper(&mut self, view: &View) {
        if view.our(view.keeper).is_some() || view.ours.is_empty() {
            (self.keeper_gone, self.keeper_asked) = (None, None);
            return;
        }
        let gone = view.now.since(*self.keeper_gone.get_or_insert(view.now));
        let granted = matches!(view.phase, Phase::Halt | Phase::Stop | Phase::Timeout(_));
        let again = self.keeper_asked.is_none_or(|asked| view.now.since(asked) >= ASK_AGAIN);
        if gone >= GONE
            && granted
            && again
            && let Some((robot, _)) = nearest(view.ours.iter(), view.our_goal())
        {
            self.keeper_asked = Some(view.now);
            self.out.push_back(Request::Keeper(robot.id));
        }
    }

    /// A robot too many that cannot leave by itself blocks the game: after [`STUCK`] in a stop our robot handler is to take it out.
    ///
    /// Asked once until no robot is too many any more, and only while it is free: where no person answers, every further request would
    /// halt the game again, and after the fifth each is a foul and every third a card.
    fn substitution(&mut self, view: &View, left: Option<u32>) {
        let ours = view.ours.iter().filter(|robot| view.counts_for_us(robot.position)).count();
        let too_many = ours + view.uncommanded > view.allowed;
        if !too_many {
            self.crowded = None;
            if std::mem::take(&mut self.substitution) {
                self.out.push_back(Request::Substitute(false));
            }
            return;
        }
        if view.phase != Phase::Stop {
            self.crowded = None;
            return;
        }
        let stuck = view.now.since(*self.crowded.get_or_insert(view.now)) >= STUCK;
        if stuck && !self.substitution && left != Some(0) {
            self.substitution = true;
            self.out.push_back(Request::Substitute(true));
        }
    }

    /// They have a robot too many: we play on while that is good for us (our penalty, or the ball in their half); the
    /// controller stops the game for it otherwise.
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
            self.out.push_back(Request::Advantage { go_on });
        }
    }
}

/// A keeper is taken for gone after so long: vision loses a robot for less, and the radio's link is up again in half a second.
const GONE: Duration = Duration::millis(2000);
/// A keeper is asked for again after so long, if the one that was asked for is not named.
const ASK_AGAIN: Duration = Duration::millis(3000);
/// A robot on its way out needs less: division A's diagonal at the 1.5 m/s of a stop takes 10 s.
const STUCK: Duration = Duration::millis(12_000);

#[cfg(test)]
mod tests;
