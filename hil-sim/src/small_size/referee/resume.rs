//! `resume`: the internal referee goes on from a moment of a match that was followed by its packets, in place
//! of a match's start. m; µs of the simulation.

use geometry::{Field, Point};
use rules::state::{RefereeCommand, Stage};
use rules::{Colour, Phase};

use super::InternalReferee;
use super::observation::BallSeen;
use super::remote::RemoteMatch;
use super::settings::MatchClock;

impl InternalReferee {
    /// Goes on from that match with the ball here; call it before the first observation. Stage, score, cards,
    /// keepers, phase and the next restart are the match's; the stage lasts as long as the settings' match.
    /// A ball in play is announced as FORCE_START, a kick-off or penalty with its preparation before it: a
    /// receiver that joins now comes to the same phase. Of a match without a packet the ball is in play.
    pub fn resume(&mut self, from: &RemoteMatch, ball: Point<Field>) {
        (self.begun, self.ball) = (true, BallSeen::at(ball));
        self.follow_accounts(from);
        for team in [Colour::Yellow, Colour::Blue] {
            self.accounts.of_mut(team).can_place_ball &= self.settings.team(team).can_place_ball;
        }
        let (MatchClock::Playing { half: length } | MatchClock::Simulated { total: length }) =
            self.settings.clock;
        self.ends_at =
            matches!(self.settings.clock, MatchClock::Simulated { .. }).then_some(self.now + length);
        let known = from.newest.is_some();
        self.stage = if known { from.stage } else { Stage::FirstHalf };
        let length = if self.stage.is_break() { self.settings.half_time } else { length };
        self.stage_left = i64::try_from(length.0).unwrap_or(i64::MAX).saturating_add(STAGE_MORE_US);
        let phase = if known { from.phase() } else { Phase::Run };
        (self.next, self.placement) = (from.next(), from.target());
        for command in commands_to(phase).into_iter().flatten() {
            self.give(command);
        }
    }
}

/// The stage lasts this much longer than the match, µs: the match ends while play runs, not by a stop.
const STAGE_MORE_US: i64 = 1_000_000;

/// The commands that lead a receiver without a state to this phase.
fn commands_to(phase: Phase<Colour>) -> [Option<RefereeCommand>; 2] {
    use RefereeCommand as Command;
    match phase {
        Phase::Halt => [Some(Command::Halt), None],
        Phase::Stop => [Some(Command::Stop), None],
        Phase::Timeout(team) => [Some(Command::Timeout(team)), None],
        Phase::BallPlacement(team) => [Some(Command::BallPlacement(team)), None],
        Phase::PrepareKickoff(team) => [Some(Command::PrepareKickoff(team)), None],
        Phase::PreparePenalty(team) => [Some(Command::PreparePenalty(team)), None],
        Phase::Kickoff(team) => [Some(Command::PrepareKickoff(team)), Some(Command::NormalStart)],
        Phase::Penalty(team) => [Some(Command::PreparePenalty(team)), Some(Command::NormalStart)],
        Phase::FreeKick(team) => [Some(Command::FreeKick(team)), None],
        Phase::Run => [Some(Command::ForceStart), None],
    }
}

#[cfg(test)]
mod tests {
    use protocol::Instant;
    use rules::League;

    use super::*;
    use crate::small_size::referee::RefereeSettings;
    use crate::small_size::referee::observation::Observation;

    #[test]
    fn a_resumed_match_has_the_phase_and_score_of_the_one_that_was_followed() {
        let all = [
            Phase::Halt,
            Phase::Stop,
            Phase::Run,
            Phase::PrepareKickoff(Colour::Blue),
            Phase::Kickoff(Colour::Yellow),
            Phase::PreparePenalty(Colour::Blue),
            Phase::Penalty(Colour::Blue),
            Phase::FreeKick(Colour::Yellow),
            Phase::BallPlacement(Colour::Blue),
            Phase::Timeout(Colour::Yellow),
        ];
        for phase in all {
            let mut first = InternalReferee::new(RefereeSettings::new(League::DivisionB), 1).unwrap();
            first.observe(&Observation {
                time: Instant(0),
                ball: None,
                fastest: 0.0,
                robots: &[],
                crashes: &[],
            });
            first.accounts.of_mut(Colour::Blue).score = 3;
            commands_to(phase).into_iter().flatten().for_each(|command| first.give(command));
            let mut followed = RemoteMatch::new(League::DivisionB).unwrap();
            let at = Point::new(1.0, 0.5);
            while let Some(packet) = first.poll_packet() {
                followed.receive(packet, Instant(0), at);
            }
            let mut second = InternalReferee::new(RefereeSettings::new(League::DivisionB), 1).unwrap();
            second.resume(&followed, at);
            assert_eq!(second.phase(), followed.phase());
            assert_eq!(second.accounts().of(Colour::Blue).score, 3);
            assert_eq!(second.stage(), followed.stage(), "{phase:?}");
        }
    }
}
