//! `description`: decodes the referee's commands and stages into the types of [`rules`].

use rules::Colour::{self, Blue, Yellow};
use rules::state::{RefereeCommand, Stage};
use ssl::referee as wire;

/// A command's meaning; none for a number that no program of the league sends. Indirect free kicks are free
/// kicks since 2020; GOAL is obsolete too, and implied a stop.
pub fn command_of(number: i32) -> Option<RefereeCommand> {
    let command = wire::Command::try_from(number).ok()?;
    Some(match command {
        wire::Command::Halt => RefereeCommand::Halt,
        wire::Command::Stop | wire::Command::GoalYellow | wire::Command::GoalBlue => RefereeCommand::Stop,
        wire::Command::NormalStart => RefereeCommand::NormalStart,
        wire::Command::ForceStart => RefereeCommand::ForceStart,
        wire::Command::PrepareKickoffYellow => RefereeCommand::PrepareKickoff(Yellow),
        wire::Command::PrepareKickoffBlue => RefereeCommand::PrepareKickoff(Blue),
        wire::Command::PreparePenaltyYellow => RefereeCommand::PreparePenalty(Yellow),
        wire::Command::PreparePenaltyBlue => RefereeCommand::PreparePenalty(Blue),
        wire::Command::DirectFreeYellow | wire::Command::IndirectFreeYellow => {
            RefereeCommand::FreeKick(Yellow)
        }
        wire::Command::DirectFreeBlue | wire::Command::IndirectFreeBlue => RefereeCommand::FreeKick(Blue),
        wire::Command::TimeoutYellow => RefereeCommand::Timeout(Yellow),
        wire::Command::TimeoutBlue => RefereeCommand::Timeout(Blue),
        wire::Command::BallPlacementYellow => RefereeCommand::BallPlacement(Yellow),
        wire::Command::BallPlacementBlue => RefereeCommand::BallPlacement(Blue),
    })
}

/// A stage's meaning; none for a number that no program of the league sends.
pub fn stage_of(number: i32) -> Option<Stage> {
    let index = usize::try_from(number).ok()?;
    Stage::ALL.get(index).copied()
}

/// The wire's name of a team.
pub(super) const fn team_of(colour: Colour) -> ssl::common::Team {
    match colour {
        Yellow => ssl::common::Team::Yellow,
        Blue => ssl::common::Team::Blue,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stages_have_the_wires_numbers() {
        let pairs = [
            (wire::Stage::NormalFirstHalfPre, Stage::FirstHalfPre),
            (wire::Stage::NormalFirstHalf, Stage::FirstHalf),
            (wire::Stage::NormalHalfTime, Stage::HalfTime),
            (wire::Stage::NormalSecondHalfPre, Stage::SecondHalfPre),
            (wire::Stage::NormalSecondHalf, Stage::SecondHalf),
            (wire::Stage::ExtraTimeBreak, Stage::ExtraTimeBreak),
            (wire::Stage::ExtraFirstHalfPre, Stage::ExtraFirstHalfPre),
            (wire::Stage::ExtraFirstHalf, Stage::ExtraFirstHalf),
            (wire::Stage::ExtraHalfTime, Stage::ExtraHalfTime),
            (wire::Stage::ExtraSecondHalfPre, Stage::ExtraSecondHalfPre),
            (wire::Stage::ExtraSecondHalf, Stage::ExtraSecondHalf),
            (wire::Stage::PenaltyShootoutBreak, Stage::ShootOutBreak),
            (wire::Stage::PenaltyShootout, Stage::ShootOut),
            (wire::Stage::PostGame, Stage::PostGame),
        ];
        for (number, stage) in pairs {
            assert_eq!(stage_of(number as i32), Some(stage));
        }
        assert_eq!((stage_of(14), stage_of(-1)), (None, None));
    }

    #[test]
    fn every_command_of_the_wire_has_a_meaning_and_no_other_number() {
        for number in 0..=17 {
            assert!(command_of(number).is_some(), "{number}");
        }
        assert_eq!((command_of(18), command_of(-1)), (None, None));
        assert_eq!(command_of(9), Some(RefereeCommand::FreeKick(Blue)));
        assert_eq!(command_of(16), Some(RefereeCommand::BallPlacement(Yellow)));
    }
}
