//! `manual`: manual control of the referee: commands and cards out of turn; the game continues as if an
//! event had caused them. Field frame, m.

use geometry::{Field, Point};
use protocol::Duration;
use rules::restart::nearest_free_kick_spot;
use rules::state::RefereeCommand;
use rules::{Colour, Phase};

use super::InternalReferee;
use super::event::{Restart, What};

/// A card given manually.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Card {
    /// For this playing time; 120 s by the rules.
    Yellow(Duration),
    /// Until the end of the match.
    Red,
}

impl InternalReferee {
    /// A manual command; false where it makes no sense now. HALT and STOP last until the next manual one; a
    /// kick-off, free kick or penalty is reached through a stop, with the ball at the position that the rules
    /// require.
    pub fn command_by_hand(&mut self, command: RefereeCommand) -> bool {
        if !self.begun || self.is_over() {
            return false;
        }
        let restart = match command {
            RefereeCommand::Halt | RefereeCommand::Stop => {
                self.held = true;
                self.give(command);
                return true;
            }
            RefereeCommand::ForceStart => Restart::ForceStart,
            RefereeCommand::PrepareKickoff(team) => Restart::Kickoff(team),
            RefereeCommand::PreparePenalty(team) => Restart::Penalty(team),
            RefereeCommand::FreeKick(team) => Restart::FreeKick(team),
            RefereeCommand::NormalStart => {
                let prepared = matches!(self.phase(), Phase::PrepareKickoff(_) | Phase::PreparePenalty(_));
                if prepared {
                    self.held = false;
                    self.give(command);
                }
                return prepared;
            }
            RefereeCommand::Timeout(_) | RefereeCommand::BallPlacement(_) => return false,
        };
        if restart == Restart::ForceStart {
            let may = !self.stage.is_break();
            if may {
                self.stop_by_hand();
                self.give(RefereeCommand::ForceStart);
            }
            return may;
        }
        self.restart_by_hand(restart, self.ball.position)
    }

    /// Stops the game and continues with that restart, once the ball lies where the rules require: a free
    /// kick's or force start's at the valid position nearest to `place`. False where it makes no sense now.
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

    /// Ends a manual HALT or STOP: the game continues from there.
    pub fn go_on_by_hand(&mut self) {
        self.held = false;
    }

    /// Gives that team a card.
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

    /// Starts a new stoppage: the cause of the last one, and placements in it, are discarded.
    fn stop_by_hand(&mut self) {
        self.held = false;
        self.recent.clear();
        if self.phase() != Phase::Stop {
            self.give(RefereeCommand::Stop);
        }
    }
}
