//! `desk`: what a person at the referee's desk does. Commands and cards out of turn; the game follows as if an event had asked for
//! them. Field frame, m.

use geometry::{Field, Point};
use protocol::Duration;
use rules::restart::nearest_free_kick_spot;
use rules::state::Command;
use rules::{Colour, Phase};

use super::InternalReferee;
use super::event::{Restart, What};

/// A card shown by hand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Card {
    /// For this playing time; the rules say 120 s.
    Yellow(Duration),
    /// For the rest of the match.
    Red,
}

impl InternalReferee {
    /// A command by hand; false where it makes no sense now. HALT and STOP last until the next one by hand; a kick-off, free kick
    /// or penalty is reached by a stop, with the ball where the rules want it.
    pub fn command_by_hand(&mut self, command: Command) -> bool {
        if !self.begun || self.is_over() {
            return false;
        }
        let restart = match command {
            Command::Halt | Command::Stop => {
                self.held = true;
                self.give(command);
                return true;
            }
            Command::ForceStart => Restart::ForceStart,
            Command::PrepareKickoff(team) => Restart::Kickoff(team),
            Command::PreparePenalty(team) => Restart::Penalty(team),
            Command::FreeKick(team) => Restart::FreeKick(team),
            Command::NormalStart => {
                let prepared = matches!(self.phase(), Phase::PrepareKickoff(_) | Phase::PreparePenalty(_));
                if prepared {
                    self.held = false;
                    self.give(command);
                }
                return prepared;
            }
            Command::Timeout(_) | Command::BallPlacement(_) => return false,
        };
        if restart == Restart::ForceStart {
            let may = !self.stage.is_break();
            if may {
                self.stop_by_hand();
                self.give(Command::ForceStart);
            }
            return may;
        }
        self.restart_by_hand(restart, self.ball.position)
    }

    /// The game is stopped and goes on with that, once the ball lies where the rules want it: a free kick's or force start's at the
    /// valid place nearest to `place`. False where it makes no sense now.
    pub fn restart_by_hand(&mut self, next: Restart, place: Point<Field>) -> bool {
        if !self.begun || self.is_over() || self.stage.is_break() || !place.is_finite() {
            return false;
        }
        self.stop_by_hand();
        self.next = Some(next);
        self.drawn = None;
        self.placement = Some(match next {
            Restart::Kickoff(_) => Point::new(0.0, 0.0),
            Restart::Penalty(team) => self.penalty_spot(team),
            Restart::FreeKick(_) | Restart::ForceStart => {
                nearest_free_kick_spot(&self.field, &self.limits, place)
            }
        });
        true
    }

    /// A HALT or STOP by hand ends: the game follows its own course from there.
    pub fn go_on_by_hand(&mut self) {
        self.held = false;
    }

    /// That team is shown a card.
    pub fn card_by_hand(&mut self, team: Colour, card: Card) {
        let now = self.now;
        let account = self.accounts.of_mut(team);
        match card {
            Card::Red => account.show_red(now),
            Card::Yellow(time) => {
                if !account.show_yellow(now, time.0 as i64) {
                    self.judge(&self.event(Some(team), What::MultipleCards));
                }
            }
        }
    }

    /// A new stoppage: what led to the last one, and placements in it, are past.
    fn stop_by_hand(&mut self) {
        self.held = false;
        self.recent.clear();
        if self.phase() != Phase::Stop {
            self.give(Command::Stop);
        }
    }
}
