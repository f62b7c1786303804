//! Tests of manual commands. Every step of the stage asserts that the league's state graph is kept.

use rules::state::RefereeCommand;

use super::*;

#[test]
fn a_halt_by_hand_lasts_until_another_command() {
    let mut stage = in_play();
    assert!(stage.referee.command_by_hand(RefereeCommand::Halt));
    stage.run(60.0);
    assert_eq!(stage.phase(), Phase::Halt);
    assert!(stage.referee.command_by_hand(RefereeCommand::ForceStart));
    stage.step();
    assert_eq!(stage.phase(), Phase::Run);
}

#[test]
fn a_free_kick_by_hand_is_reached_by_a_stop_where_the_ball_lies() {
    let mut stage = in_play();
    stage.move_ball(at(1.0, 1.0));
    stage.step();
    assert!(stage.referee.command_by_hand(RefereeCommand::FreeKick(Colour::Blue)));
    assert_eq!(stage.phase(), Phase::Stop);
    assert_eq!(stage.referee.next(), Some(Restart::FreeKick(Colour::Blue)));
    assert!(close(stage.referee.placement().unwrap(), at(1.0, 1.0)));
    stage.until(Phase::FreeKick(Colour::Blue), 60.0);
}

#[test]
fn what_makes_no_sense_is_not_done() {
    let mut stage = in_play();
    for command in [
        RefereeCommand::NormalStart,
        RefereeCommand::Timeout(Colour::Blue),
        RefereeCommand::BallPlacement(Colour::Blue),
    ] {
        assert!(!stage.referee.command_by_hand(command), "{command:?}");
    }
    assert_eq!(stage.phase(), Phase::Run);
}
