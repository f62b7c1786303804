//! What may a person at the referee's desk do? Give commands out of turn; the game follows as if an event had asked for them.

use geometry::Point;
use rules::Phase;
use rules::restart::nearest_free_kick_spot;
use rules::state::Command;

use super::InternalReferee;
use super::event::Restart;

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
        if self.stage.is_break() {
            return false;
        }
        self.held = false;
        if self.phase() != Phase::Stop {
            self.give(Command::Stop);
        }
        if restart == Restart::ForceStart {
            self.give(Command::ForceStart);
            return true;
        }
        self.next = Some(restart);
        self.drawn = None;
        self.placement = Some(match restart {
            Restart::Kickoff(_) | Restart::ForceStart => Point::new(0.0, 0.0),
            Restart::Penalty(team) => self.penalty_spot(team),
            Restart::FreeKick(_) => nearest_free_kick_spot(&self.field, &self.limits, self.ball.position),
        });
        true
    }
}
