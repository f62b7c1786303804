//! Tests of halt, stop, restarts and placements: robots that move, are too fast, or are too near.

use super::*;

#[test]
fn moving_two_seconds_after_halt_is_one_offence() {
    let mut stage = stage();
    stage.drive(blue(1), 1.0, 0.0);
    stage.run(1.9);
    assert_eq!(stage.count(Kind::MovedInHalt), 0);
    stage.run(0.5);
    let event = stage.only_by(Kind::MovedInHalt, blue(1));
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
fn being_too_fast_two_seconds_after_stop_is_one_foul() {
    let mut stage = stopped();
    stage.drive(blue(1), 0.0, 1.6);
    stage.run(1.9);
    assert_eq!(stage.count(Kind::TooFastInStop), 0);
    stage.run(6.0);
    let event = stage.only_by(Kind::TooFastInStop, blue(1));
    assert!(matches!(event.what, What::TooFastInStop { speed } if (speed - 1.6).abs() < 1e-5));
    assert_eq!((stage.phase(), stage.referee.accounts().blue.foul_count()), (Phase::Stop, 1));
}

#[test]
fn two_too_fast_robots_of_a_team_are_one_foul() {
    let mut stage = stopped();
    stage.drive(blue(1), 0.0, 1.6);
    stage.drive(blue(2), 0.0, 1.6);
    stage.drive(yellow(2), 0.0, 1.5);
    stage.run(2.2);
    assert_eq!(stage.count(Kind::TooFastInStop), 1);
}

#[test]
fn staying_within_half_a_metre_in_stop_is_an_offence_without_sanction() {
    let mut stage = stopped();
    stage.run(2.5);
    let event = stage.only_by(Kind::TooCloseInStop, yellow(1));
    // 0.5 m to its centre, 0.41 m to its side.
    assert!(matches!(event.what, What::TooCloseInStop { distance } if (distance - 0.41).abs() < 1e-4));
    assert_eq!(stage.referee.accounts().yellow.foul_count(), 0);
    stage.run(3.0);
    assert_eq!(stage.count(Kind::TooCloseInStop), 1);
}

#[test]
fn a_robot_at_the_ball_blocks_a_stop_and_is_named_after_ten_seconds() {
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
fn a_defender_within_half_a_metre_restarts_the_kickers_time() {
    let mut stage = kickoff(settings());
    stage.run(5.0);
    // 0.5 m to its side is allowed, 0.49 m not.
    stage.put(blue(1), at(0.591, 0.0));
    stage.step();
    assert_eq!(stage.count(Kind::DefenderTooClose), 0);
    stage.put(blue(1), at(0.58, 0.0));
    stage.step();
    stage.only_by(Kind::DefenderTooClose, blue(1));
    assert!(stage.referee.packet().current_action_time_remaining.unwrap() > 9_900_000);
    stage.put(blue(1), at(2.0, 2.0));
    stage.run(9.8);
    assert_eq!(stage.phase(), Phase::Kickoff(Colour::Yellow));
    stage.run(0.3);
    assert_eq!(stage.phase(), Phase::Run);
}

#[test]
fn a_defender_that_stays_too_close_is_a_foul_every_two_seconds() {
    let mut stage = kickoff(settings());
    stage.put(blue(1), at(0.3, 0.0));
    stage.run(3.9);
    assert_eq!(stage.count(Kind::DefenderTooClose), 2);
}

/// Yellow places the ball from (−1.5, 1) at (1, 2.8).
fn long_placement() -> Stage {
    let mut stage = placement();
    stage.move_ball(at(-1.5, 1.0));
    stage
}

#[test]
fn an_opponent_near_the_placement_line_for_two_seconds_adds_ten_seconds() {
    let mut stage = long_placement();
    let target = stage.referee.placement().unwrap();
    let middle = stage.place_of_ball() + (target - stage.place_of_ball()) * 0.5;
    stage.put(blue(1), middle);
    let left = |stage: &Stage| stage.referee.packet().current_action_time_remaining.unwrap();
    stage.run(1.9);
    assert_eq!(stage.count(Kind::InterferedPlacement), 0);
    let before = left(&stage);
    stage.run(0.2);
    stage.only_by(Kind::InterferedPlacement, blue(1));
    assert_eq!(left(&stage) - before, 10_000_000 - 200_000);
    stage.run(2.1);
    assert_eq!(stage.count(Kind::InterferedPlacement), 2);
    assert_eq!(stage.referee.accounts().blue.foul_count(), 1, "the first one counts alone");
}

#[test]
fn the_placing_team_may_be_near_the_placement_line() {
    let mut stage = long_placement();
    stage.put(yellow(1), stage.place_of_ball() + Vector::new(0.3, 0.0));
    stage.run(3.0);
    assert_eq!(stage.count(Kind::InterferedPlacement), 0);
}

#[test]
fn after_repeated_interference_the_ball_is_placed_by_hand() {
    let mut stage = long_placement();
    stage.put(blue(1), stage.place_of_ball() + Vector::new(0.3, 0.0));
    stage.until(Phase::Stop, 10.0);
    stage.until(Phase::FreeKick(Colour::Yellow), 15.0);
    assert!(stage.orders.iter().any(|order| matches!(order, WorldOrder::PutBall(_))));
}
