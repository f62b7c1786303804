//! Tests of the course of a match: halt, stop, kick-off, halves, time-outs, shoot-out.

use super::*;

#[test]
fn a_match_begins_with_halt_stop_and_the_first_teams_kick_off() {
    let mut stage = stage();
    stage.step();
    assert_eq!((stage.phase(), stage.referee.stage()), (Phase::Halt, rules::state::Stage::FirstHalfPre));
    stage.until(Phase::Stop, 3.1);
    stage.until(Phase::PrepareKickoff(Colour::Yellow), 2.2);
    stage.until(Phase::Kickoff(Colour::Yellow), 2.1);
    assert_eq!(stage.referee.stage(), rules::state::Stage::FirstHalf);
}

#[test]
fn a_kick_off_waits_until_all_robots_are_in_their_halves() {
    let mut stage = stage();
    stage.until(Phase::PrepareKickoff(Colour::Yellow), 10.0);
    // The controller requires all of the robot in its half, the kicker too: 0.09 m.
    for (who, outside, inside) in
        [(blue(1), at(0.08, 2.0), at(0.095, 2.0)), (yellow(1), at(0.2, 0.0), at(-0.1, 0.2))]
    {
        stage.put(who, outside);
        stage.run(60.0);
        assert_eq!(stage.phase(), Phase::PrepareKickoff(Colour::Yellow));
        assert_eq!(stage.referee.blocked().unwrap().obstacle.who(), Some(who));
        assert!(matches!(stage.reason(), Some(Reason::OtherHalf { .. })));
        stage.put(who, inside);
        stage.step();
    }
    assert_eq!(stage.count(Kind::Blocked), 2);
    stage.until(Phase::Kickoff(Colour::Yellow), 2.1);
}

#[test]
fn a_kick_off_waits_for_a_ball_in_the_centre_circle() {
    let mut stage = stage();
    stage.until(Phase::PrepareKickoff(Colour::Yellow), 10.0);
    stage.move_ball(at(0.0, 0.6));
    stage.run(5.0);
    stage.move_ball(at(0.0, 0.4));
    stage.until(Phase::Kickoff(Colour::Yellow), 2.1);
    // A robot that does not come back is placed there again, after a stop.
    let mut stage = super::stage();
    stage.until(Phase::PrepareKickoff(Colour::Yellow), 10.0);
    stage.move_ball(at(0.0, 0.6));
    stage.until(Phase::Stop, 10.1);
    assert!(matches!(stage.only(Kind::Blocked).what, What::Blocked { reason: Reason::BallOffPlace { .. } }));
    stage.until(Phase::Kickoff(Colour::Yellow), 8.0);
    assert_eq!(stage.orders, [WorldOrder::PutBall(at(0.0, 0.0))]);
}

#[test]
fn only_one_kicker_may_be_in_the_centre_circle() {
    let mut stage = stage();
    stage.until(Phase::PrepareKickoff(Colour::Yellow), 16.0);
    stage.put(yellow(1), at(-0.2, 0.0));
    stage.put(yellow(2), at(-0.3, 0.4));
    stage.run(25.0);
    assert_eq!(stage.phase(), Phase::PrepareKickoff(Colour::Yellow));
    stage.put(yellow(2), at(-2.0, -2.0));
    stage.until(Phase::Kickoff(Colour::Yellow), 2.1);
}

#[test]
fn the_ball_is_in_play_when_it_has_moved_5_cm_or_after_ten_seconds() {
    let mut stage = kickoff(settings());
    stage.move_ball(at(0.04, 0.0));
    stage.step();
    assert_eq!(stage.phase(), Phase::Kickoff(Colour::Yellow));
    stage.move_ball(at(0.06, 0.0));
    stage.step();
    assert_eq!(stage.phase(), Phase::Run);
    assert_eq!(stage.referee.command(), RefereeCommand::NormalStart);

    let mut stage = kickoff(settings());
    stage.run(9.9);
    assert_eq!(stage.phase(), Phase::Kickoff(Colour::Yellow));
    stage.run(0.2);
    assert_eq!(stage.phase(), Phase::Run);
}

#[test]
fn the_ball_is_placed_for_a_kick_off_once_robots_have_made_room() {
    let mut stage = stage();
    stage.move_ball(at(2.0, 1.0));
    stage.put(blue(1), at(0.1, 0.0));
    stage.until(Phase::Stop, 5.0);
    stage.run(5.0);
    assert_eq!(stage.orders, []);
    stage.put(blue(1), at(2.0, 2.0));
    stage.step();
    assert_eq!(stage.orders, [WorldOrder::PutBall(at(0.0, 0.0))]);
    stage.until(Phase::PrepareKickoff(Colour::Yellow), 2.1);
}

#[test]
fn after_half_time_teams_change_ends_and_the_other_kicks_off() {
    let clock = MatchClock::Playing { half: Duration::millis(20_000) };
    let mut stage = stage_with(RefereeSettings { clock, ..settings() });
    use rules::state::Stage as Part;
    while stage.referee.stage() < Part::HalfTime {
        assert!(stage.seconds() < 300.0);
        stage.step();
    }
    assert_eq!(stage.phase(), Phase::Halt);
    assert_eq!(stage.referee.own_end(Colour::Blue), GoalEnd::Positive);
    stage.run(3.1);
    assert_eq!(stage.referee.stage(), Part::SecondHalfPre);
    assert_eq!(stage.referee.own_end(Colour::Blue), GoalEnd::Negative);
    stage.until(Phase::PrepareKickoff(Colour::Blue), 20.0);
}

#[test]
fn playing_time_runs_only_while_a_team_may_play() {
    let mut stage = kickoff(settings());
    assert_eq!(stage.referee.packet().stage_time_left, Some(300_000_000));
    stage.run(2.0);
    assert_eq!(stage.referee.packet().stage_time_left, Some(298_000_000));
}

#[test]
fn a_match_of_600_simulated_seconds_ends_after_600_simulated_seconds() {
    let clock = MatchClock::Simulated { total: Duration::millis(600_000) };
    let mut stage = stage_with(RefereeSettings { clock, ..settings() });
    let mut half_time = None;
    while !stage.referee.is_over() {
        stage.step();
        if half_time.is_none() && stage.referee.stage() == rules::state::Stage::HalfTime {
            half_time = Some(stage.seconds());
        }
        assert!(stage.seconds() < 601.0);
    }
    // The first observation is at 0.01 s; (600 − 3) / 2 = 298.5 s a half.
    assert!((stage.seconds() - 600.01).abs() < 0.02, "{}", stage.seconds());
    assert!((half_time.unwrap() - 298.51).abs() < 0.02, "{half_time:?}");
    stage.run(10.0);
    assert_eq!(stage.phase(), Phase::Halt);
}

#[test]
fn a_time_out_starts_at_the_next_stop_for_the_requested_time() {
    let mut stage = in_play();
    assert!(stage.referee.request_timeout(Colour::Blue, Duration::millis(5_000)));
    stage.run(3.0);
    assert_eq!(stage.phase(), Phase::Run);
    stage.kick(0.0, 6.0);
    stage.until(Phase::Timeout(Colour::Blue), 3.0);
    let began = stage.seconds();
    stage.until(Phase::Stop, 6.0);
    assert!((stage.seconds() - began - 5.0).abs() < 0.03);
    let account = &stage.referee.accounts().blue;
    assert_eq!(account.timeouts, 3);
    assert!((account.timeout_left - 295_000_000).abs() <= 20_000, "{}", account.timeout_left);
}

#[test]
fn ten_goals_with_a_lead_of_two_end_the_match() {
    let mut stage = in_play();
    stage.referee.accounts.yellow.score = 9;
    stage.referee.accounts.blue.score = 8;
    stage.touch(yellow(2));
    stage.kick(6.0, 0.0);
    stage.put(blue(0), at(4.45, 0.8));
    stage.run(2.0);
    assert_eq!(stage.referee.accounts().yellow.score, 10);
    assert!(stage.referee.is_over());
}

#[test]
fn a_drawn_knockout_match_has_overtime_and_a_shoot_out() {
    use rules::state::Stage as Part;
    let clock = MatchClock::Playing { half: Duration::millis(10_000) };
    let mut stage = stage_with(RefereeSettings { clock, knockout: true, ..settings() });
    stage.obedient = true;
    let mut parts = vec![Part::FirstHalfPre];
    while !stage.referee.is_over() {
        stage.step();
        if parts.last() != Some(&stage.referee.stage()) {
            parts.push(stage.referee.stage());
        }
        assert!(stage.seconds() < 3_000.0, "{parts:?}");
    }
    assert_eq!(parts, Part::ALL);
    // No team shot: ended after 20 attempts each.
    let failed = stage.count(Kind::PenaltyFailed);
    assert_eq!(failed, 40);
}

#[test]
fn the_four_legged_league_is_refused() {
    let error = InternalReferee::new(RefereeSettings::new(League::FourLegged), 0).unwrap_err();
    assert_eq!(error, NoRules(League::FourLegged));
}
