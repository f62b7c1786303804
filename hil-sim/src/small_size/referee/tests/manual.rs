//! Tests of manual commands. Every step of the stage asserts that the league's state graph is kept.

use rules::state::RefereeCommand;

use super::*;

#[test]
fn a_manual_halt_lasts_until_the_next_command() {
    let mut stage = in_play();
    assert!(stage.referee.command_by_hand(RefereeCommand::Halt));
    stage.run(60.0);
    assert_eq!(stage.phase(), Phase::Halt);
    assert!(stage.referee.command_by_hand(RefereeCommand::ForceStart));
    stage.step();
    assert_eq!(stage.phase(), Phase::Run);
}

#[test]
fn a_manual_free_kick_follows_a_stop_where_the_ball_lies() {
    let mut stage = in_play();
    stage.move_ball(at(1.0, 1.0));
    stage.step();
    assert!(stage.referee.command_by_hand(RefereeCommand::FreeKick(Colour::Blue)));
    assert_eq!(stage.phase(), Phase::Stop);
    stage.assert_restart(Restart::FreeKick(Colour::Blue), at(1.0, 1.0));
    stage.until(Phase::FreeKick(Colour::Blue), 60.0);
}

#[test]
fn manual_commands_that_do_not_fit_the_phase_are_refused() {
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
