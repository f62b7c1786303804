//! Tests of halt, stop, restarts and placements: robots that move, are too fast, or are too near.

use super::*;

#[test]
fn who_moves_two_seconds_after_halt_is_reported_once() {
    let mut stage = stage();
    stage.drive(blue(1), 1.0, 0.0);
    stage.run(1.9);
    assert_eq!(stage.count(Kind::MovedInHalt), 0);
    stage.run(0.5);
    let event = stage.only(Kind::MovedInHalt);
    assert_eq!((event.by, event.robot), (Some(Colour::Blue), Some(id(1))));
    // The league has no message and no sanction for it.
    assert_eq!(event.to_wire(0), None);
    assert_eq!(stage.referee.metrics().offences.of(Colour::Blue, Kind::MovedInHalt), 1);
    assert_eq!(stage.referee.accounts().blue.foul_count(), 0);
}

/// Stop before the first kick-off, which a robot near the ball prevents from continuing.
fn stopped() -> Stage {
    let mut stage = stage();
    stage.until(Phase::Stop, 4.0);
    stage.put(yellow(1), at(-0.5, 0.0));
    stage
}

#[test]
fn who_is_too_fast_in_stop_after_two_seconds_is_reported_once_a_stop() {
    let mut stage = stopped();
    stage.drive(blue(1), 0.0, 1.6);
    stage.run(1.9);
    assert_eq!(stage.count(Kind::TooFastInStop), 0);
    stage.run(6.0);
    let event = stage.only(Kind::TooFastInStop);
    assert_eq!((event.by, event.robot), (Some(Colour::Blue), Some(id(1))));
    assert!(matches!(event.what, What::TooFastInStop { speed } if (speed - 1.6).abs() < 1e-5));
    assert_eq!((stage.phase(), stage.referee.accounts().blue.foul_count()), (Phase::Stop, 1));
}

#[test]
fn of_two_of_a_team_that_are_too_fast_at_once_one_is_reported() {
    let mut stage = stopped();
    stage.drive(blue(1), 0.0, 1.6);
    stage.drive(blue(2), 0.0, 1.6);
    stage.drive(yellow(2), 0.0, 1.5);
    stage.run(2.2);
    assert_eq!(stage.count(Kind::TooFastInStop), 1);
}

#[test]
fn who_stays_within_half_a_metre_of_the_ball_in_stop_is_counted_but_not_punished() {
    let mut stage = stopped();
    stage.run(2.5);
    let event = stage.only(Kind::TooCloseInStop);
    assert_eq!((event.by, event.robot), (Some(Colour::Yellow), Some(id(1))));
    // 0.5 m to its centre, 0.41 m to its side.
    assert!(matches!(event.what, What::TooCloseInStop { distance } if (distance - 0.41).abs() < 1e-4));
    assert_eq!(stage.referee.accounts().yellow.foul_count(), 0);
    stage.run(3.0);
    assert_eq!(stage.count(Kind::TooCloseInStop), 1);
}

#[test]
fn a_stop_in_which_a_robot_stays_at_the_ball_does_not_end_and_after_ten_seconds_says_why() {
    let mut stage = stopped();
    stage.run(9.9);
    assert_eq!((stage.phase(), stage.reason()), (Phase::Stop, None));
    stage.run(50.0);
    assert_eq!(stage.phase(), Phase::Stop);
    let blocked = *stage.referee.blocked().unwrap();
    assert_eq!(blocked.obstacle.who(), Some(yellow(1)));
    assert!(
        matches!(blocked.obstacle.reason, Reason::NearBall { distance } if (distance - 0.41).abs() < 1e-4)
    );
    assert!((59.8..60.0).contains(&blocked.lasted.as_secs_f32()), "{:?}", blocked.lasted);
    assert_eq!(
        stage.referee.packet().status_message.as_deref(),
        Some("blocked: yellow 1: 0.41 m from the ball")
    );
    assert_eq!(stage.only(Kind::Blocked).robot, Some(id(1)));
    // 0.55 m from centre to centre is enough for the controller, 0.53 m is not.
    stage.put(yellow(1), at(-0.53, 0.0));
    stage.run(5.0);
    assert_eq!(stage.phase(), Phase::Stop);
    stage.put(yellow(1), at(-0.55, 0.0));
    stage.until(Phase::PrepareKickoff(Colour::Yellow), 2.1);
    assert_eq!(stage.referee.blocked(), None);
    let metrics = stage.referee.metrics();
    assert_eq!((metrics.blocks.len(), metrics.blocked_s() > 60.0), (1, true));
}

#[test]
fn a_defender_within_half_a_metre_of_the_ball_gives_the_kicker_its_time_again() {
    let mut stage = stage();
    stage.until(Phase::Kickoff(Colour::Yellow), 30.0);
    stage.run(5.0);
    // 0.5 m to its side is allowed, 0.49 m not.
    stage.put(blue(1), at(0.591, 0.0));
    stage.step();
    assert_eq!(stage.count(Kind::DefenderTooClose), 0);
    stage.put(blue(1), at(0.58, 0.0));
    stage.step();
    let event = stage.only(Kind::DefenderTooClose);
    assert_eq!((event.by, event.robot), (Some(Colour::Blue), Some(id(1))));
    assert!(stage.referee.packet().current_action_time_remaining.unwrap() > 9_900_000);
    stage.put(blue(1), at(2.0, 2.0));
    stage.run(9.8);
    assert_eq!(stage.phase(), Phase::Kickoff(Colour::Yellow));
    stage.run(0.3);
    assert_eq!(stage.phase(), Phase::Run);
}

#[test]
fn a_defender_that_stays_too_close_is_reported_every_two_seconds() {
    let mut stage = stage();
    stage.until(Phase::Kickoff(Colour::Yellow), 30.0);
    stage.put(blue(1), at(0.3, 0.0));
    stage.run(3.9);
    assert_eq!(stage.count(Kind::DefenderTooClose), 2);
}

/// Yellow places the ball from (1, 3.1) at (1, 2.8).
fn placement() -> Stage {
    let mut stage = in_play();
    stage.move_ball(at(1.0, 2.9));
    stage.touch(blue(1));
    stage.move_ball(at(-1.5, 3.1));
    stage.step();
    stage.move_ball(at(-1.5, 1.0));
    stage.put(blue(1), at(2.0, 1.0));
    stage.put(yellow(1), at(-2.0, 1.0));
    stage.until(Phase::BallPlacement(Colour::Yellow), 1.0);
    stage
}

#[test]
fn an_opponent_in_the_stadium_for_more_than_two_seconds_interferes_and_adds_ten() {
    let mut stage = placement();
    let target = stage.referee.placement().unwrap();
    let middle = stage.place_of_ball() + (target - stage.place_of_ball()) * 0.5;
    stage.put(blue(1), middle);
    let left = |stage: &Stage| stage.referee.packet().current_action_time_remaining.unwrap();
    stage.run(1.9);
    assert_eq!(stage.count(Kind::InterferedPlacement), 0);
    let before = left(&stage);
    stage.run(0.2);
    let event = stage.only(Kind::InterferedPlacement);
    assert_eq!((event.by, event.robot), (Some(Colour::Blue), Some(id(1))));
    assert_eq!(left(&stage) - before, 10_000_000 - 200_000);
    stage.run(2.1);
    assert_eq!(stage.count(Kind::InterferedPlacement), 2);
    assert_eq!(stage.referee.accounts().blue.foul_count(), 1, "the first one counts alone");
}

#[test]
fn the_placing_team_may_stand_in_the_stadium() {
    let mut stage = placement();
    stage.put(yellow(1), stage.place_of_ball() + Vector::new(0.3, 0.0));
    stage.run(3.0);
    assert_eq!(stage.count(Kind::InterferedPlacement), 0);
}

#[test]
fn who_interferes_again_and_again_only_brings_a_person() {
    let mut stage = placement();
    stage.put(blue(1), stage.place_of_ball() + Vector::new(0.3, 0.0));
    stage.until(Phase::Stop, 10.0);
    stage.until(Phase::FreeKick(Colour::Yellow), 15.0);
    assert!(stage.orders.iter().any(|order| matches!(order, WorldOrder::PutBall(_))));
}
