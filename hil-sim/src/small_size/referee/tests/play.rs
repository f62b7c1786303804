//! Tests of fouls with the ball: speed, dribbling, double touch, keeper, no progress, crashes, pushing,
//! holding, placements.

use super::*;

#[test]
fn a_kick_over_the_speed_limit_is_one_foul_that_does_not_stop_the_game() {
    let mut stage = in_play();
    stage.kick_from(at(-3.0, 1.0), yellow(1), [6.6, 0.0]);
    stage.run(0.5);
    let event = stage.only_by(Kind::BallTooFast, yellow(1)).clone();
    let What::BallTooFast { speed, chipped } = event.what else { panic!() };
    assert!((speed - 6.6).abs() < 1e-3 && !chipped);
    assert_eq!((stage.phase(), stage.referee.accounts().yellow.foul_count()), (Phase::Run, 1));
}

#[test]
fn the_speed_of_a_kick_counts_in_three_dimensions() {
    let mut stage = in_play();
    stage.move_ball(at(-3.0, 1.0));
    stage.touch(yellow(1));
    // √(4.7² + 4.7²) = 6.65 m/s.
    stage.kick(4.7, 0.0);
    stage.ball_mut().climb = 4.7;
    stage.step();
    assert!(matches!(stage.only(Kind::BallTooFast).what, What::BallTooFast { chipped: true, .. }));
    let mut stage = in_play();
    stage.touch(yellow(1));
    stage.kick(6.5, 0.0);
    stage.run(0.2);
    assert_eq!(stage.count(Kind::BallTooFast), 0);
}

/// Yellow's robot 1 dribbles the ball from the centre over that distance.
fn dribble(metres: f32) -> Stage {
    let mut stage = in_play();
    stage.move_ball(at(-1.0, 1.0));
    let steps = (metres * 100.0) as u32;
    for step in 0..steps {
        let x = -1.0 + 0.01 * step as f32;
        stage.put(yellow(1), at(x - 0.095, 1.0));
        stage.move_ball(at(x, 1.0));
        stage.touch(yellow(1));
    }
    stage
}

#[test]
fn dribbling_further_than_a_metre_is_a_free_kick_from_where_it_began() {
    let stage = dribble(0.99);
    assert_eq!(stage.count(Kind::DribbledTooFar), 0);
    let stage = dribble(1.1);
    let event = stage.only_by(Kind::DribbledTooFar, yellow(1));
    assert!(close(event.place, at(-1.0, 1.0)));
    stage.assert_restart(Restart::FreeKick(Colour::Blue), at(-1.0, 1.0));
}

#[test]
fn a_visible_separation_starts_the_dribbling_distance_again() {
    let mut stage = dribble(0.8);
    // 3 cm between hull (0.09 m) and ball (0.0215 m).
    stage.move_ball(at(-0.1085, 1.0));
    stage.put(yellow(1), at(-0.25, 1.0));
    stage.step();
    for step in 0..80 {
        let x = -0.05 + 0.01 * step as f32;
        stage.put(yellow(1), at(x - 0.095, 1.0));
        stage.move_ball(at(x, 1.0));
        stage.touch(yellow(1));
    }
    assert_eq!(stage.count(Kind::DribbledTooFar), 0);
}

/// Yellow's kick-off; robot 1 has touched the ball, which is now at `x`.
fn kicked_off(x: f32) -> Stage {
    let mut stage = kickoff(settings());
    stage.put(yellow(1), at(-0.11, 0.0));
    stage.touch(yellow(1));
    stage.move_ball(at(x, 0.0));
    stage.step();
    stage
}

#[test]
fn the_kicker_may_not_touch_the_ball_again() {
    let mut stage = kicked_off(0.1);
    stage.put(yellow(1), at(0.0, 0.0));
    stage.touch(yellow(1));
    stage.only_by(Kind::DoubleTouch, yellow(1));
    assert_eq!(stage.referee.next(), Some(Restart::FreeKick(Colour::Blue)));
    // No foul: it does not lead to a card.
    assert_eq!(stage.referee.accounts().yellow.foul_count(), 0);
}

#[test]
fn bumping_the_ball_within_5_cm_is_no_double_touch() {
    let mut stage = kicked_off(0.03);
    for _ in 0..5 {
        stage.touch(yellow(1));
        stage.step();
    }
    assert_eq!((stage.phase(), stage.count(Kind::DoubleTouch)), (Phase::Kickoff(Colour::Yellow), 0));
}

#[test]
fn after_another_robots_touch_the_kicker_may_touch_again() {
    let mut stage = kicked_off(0.1);
    stage.touch(yellow(2));
    stage.put(yellow(1), at(0.0, 0.0));
    stage.touch(yellow(1));
    assert_eq!(stage.count(Kind::DoubleTouch), 0);
}

#[test]
fn a_ball_in_a_defence_area_for_ten_seconds_is_a_foul_of_its_owner() {
    let mut stage = in_play();
    stage.move_ball(at(4.2, 0.3));
    stage.run(5.0);
    // It moves, so that there is progress.
    stage.move_ball(at(4.2, -0.3));
    stage.run(5.0);
    assert_eq!(stage.count(Kind::KeeperHeldBall), 0);
    stage.run(0.1);
    assert_eq!(stage.only(Kind::KeeperHeldBall).by, Some(Colour::Blue));
    assert_eq!(stage.referee.next(), Some(Restart::FreeKick(Colour::Yellow)));
}

#[test]
fn no_progress_for_ten_seconds_is_a_force_start() {
    let mut stage = in_play();
    stage.run(9.9);
    assert_eq!(stage.phase(), Phase::Run);
    stage.run(0.2);
    stage.only(Kind::NoProgress);
    assert_eq!(stage.referee.next(), Some(Restart::ForceStart));
    stage.until(Phase::Run, 5.0);
    assert_eq!(stage.referee.command(), RefereeCommand::ForceStart);
}

/// Yellow's robot 1 and blue's robot 1 collide head-on with these speeds.
fn crash(yellow_speed: f32, blue_speed: f32) -> Stage {
    let mut stage = in_play();
    stage.put(yellow(1), at(0.0, 1.0));
    stage.put(blue(1), at(0.18, 1.0));
    let velocities = [Vector::new(yellow_speed, 0.0), Vector::new(-blue_speed, 0.0)];
    stage.crashes.push(CrashSeen { between: [yellow(1), blue(1)], velocities });
    stage.step();
    stage.run(0.1);
    stage
}

#[test]
fn the_faster_robot_is_at_fault_for_a_crash_both_if_nearly_equal() {
    let stage = crash(1.2, 0.2);
    assert_eq!(stage.count(Kind::CrashUnique), 0);
    let stage = crash(0.5, 1.2);
    let event = stage.only_by(Kind::CrashUnique, blue(1));
    let What::CrashUnique { victim, crash_speed, speed_difference, .. } = event.what else { panic!() };
    assert_eq!(victim, id(1));
    assert!((crash_speed - 1.7).abs() < 1e-5 && (speed_difference - 0.7).abs() < 1e-5);
    let stage = crash(1.0, 0.9);
    stage.only(Kind::CrashDrawn);
    let fouls = |account: &Account| account.foul_count();
    let accounts = stage.referee.accounts();
    assert_eq!((fouls(&accounts.yellow), fouls(&accounts.blue)), (1, 1));
}

#[test]
fn a_glancing_crash_counts_only_along_the_line_between_the_robots() {
    let mut stage = in_play();
    stage.put(yellow(1), at(0.0, 1.0));
    stage.put(blue(1), at(0.0, 1.18));
    // 3 m/s relative to each other, passing side by side: no closing speed.
    let velocities = [Vector::new(1.5, 0.0), Vector::new(-1.5, 0.0)];
    stage.crashes.push(CrashSeen { between: [yellow(1), blue(1)], velocities });
    stage.step();
    assert_eq!(stage.count(Kind::CrashUnique) + stage.count(Kind::CrashDrawn), 0);
}

#[test]
fn driving_an_opponent_ahead_for_20_cm_is_pushing() {
    let mut stage = in_play();
    let mut push = |metres: f32| {
        for step in 0..(metres * 100.0) as u32 {
            let x = 0.01 * step as f32;
            stage.put(yellow(1), at(x, 1.0));
            stage.put(blue(1), at(x + 0.18, 1.0));
            stage.drive(yellow(1), 1.0, 0.0);
            stage.drive(blue(1), 1.0, 0.0);
            stage.step();
        }
        stage.count(Kind::Pushed)
    };
    assert_eq!(push(0.19), 0);
    assert_eq!(push(0.1), 1);
    // From the position of the ball, the centre in this test, not of the robots.
    assert!(close(stage.referee.placement().unwrap(), at(0.3, 0.0)));
    stage.only_by(Kind::Pushed, yellow(1));
    assert_eq!(stage.referee.next(), Some(Restart::FreeKick(Colour::Blue)));
}

#[test]
fn three_robots_around_the_ball_for_two_seconds_are_ball_holding() {
    let mut stage = in_play();
    let ball = at(-1.0, 1.0);
    stage.move_ball(ball);
    for (number, degrees) in [(1, 0.0), (2, 120.0), (3, 240.0)] {
        stage.put(blue(number), ball + Vector::polar(0.15, Angle::degrees(degrees)));
    }
    stage.run(1.9);
    assert_eq!(stage.count(Kind::HeldBall), 0);
    stage.run(0.2);
    assert_eq!(stage.only(Kind::HeldBall).by, Some(Colour::Blue));
    let mut lenient = stage_with(RefereeSettings { judge_manual_fouls: false, ..settings() });
    lenient.robots = stage.robots.clone();
    lenient.run(30.0);
    assert_eq!(lenient.count(Kind::HeldBall), 0);
}

#[test]
fn a_placed_ball_is_taken_at_once_by_the_team_that_placed_it() {
    let mut stage = placement();
    stage.put(yellow(1), at(1.0, 2.5));
    stage.move_ball(at(1.0, 2.75));
    stage.run(1.5);
    assert_eq!(stage.phase(), Phase::BallPlacement(Colour::Yellow), "not before 2 s");
    stage.until(Phase::FreeKick(Colour::Yellow), 1.0);
    let What::PlacementSucceeded { took, precision, .. } = stage.only(Kind::PlacementSucceeded).what else {
        panic!()
    };
    assert!((2.0..2.1).contains(&took) && (precision - 0.05).abs() < 0.01, "{took} {precision}");
}

#[test]
fn a_ball_is_not_placed_while_a_robot_is_at_it() {
    let mut stage = placement();
    // 4 cm from hull to ball centre.
    stage.put(yellow(1), at(1.0, 2.67));
    stage.move_ball(at(1.0, 2.8));
    stage.run(4.0);
    assert_eq!(stage.phase(), Phase::BallPlacement(Colour::Yellow));
}

#[test]
fn after_30_s_the_other_team_places_and_after_60_s_a_human() {
    let mut stage = placement();
    stage.run(29.9);
    assert_eq!(stage.phase(), Phase::BallPlacement(Colour::Yellow));
    stage.run(0.2);
    assert_eq!(stage.only(Kind::PlacementFailed).by, Some(Colour::Yellow));
    assert_eq!(stage.phase(), Phase::BallPlacement(Colour::Blue));
    stage.run(30.1);
    assert_eq!(stage.count(Kind::PlacementFailed), 2);
    stage.until(Phase::FreeKick(Colour::Yellow), 5.0);
    assert!(close(stage.place_of_ball(), at(1.0, 2.8)));
    let failures = |account: &Account| account.placement_failures;
    let accounts = stage.referee.accounts();
    assert_eq!((failures(&accounts.yellow), failures(&accounts.blue)), (1, 1));
}

#[test]
fn a_team_may_not_place_after_five_failures() {
    let mut stage = placement();
    stage.referee.accounts.yellow.placement_failures = 4;
    stage.run(30.1);
    let yellow = &stage.referee.accounts().yellow;
    assert!(yellow.placement_blocked && !yellow.places());
}

#[test]
fn in_division_b_the_other_team_places_for_one_that_cannot() {
    let mut settings = settings();
    settings.yellow.can_place_ball = false;
    let mut stage = kickoff(settings);
    stage.move_ball(at(1.0, 2.9));
    stage.step();
    stage.touch(blue(1));
    stage.kick(0.0, 5.0);
    stage.until_stop(1.0);
    stage.until(Phase::BallPlacement(Colour::Blue), 1.0);
    assert_eq!(stage.referee.next(), Some(Restart::FreeKick(Colour::Yellow)));
}

#[test]
fn in_division_a_a_failed_placement_after_ball_out_loses_the_free_kick() {
    let mut stage = kickoff(RefereeSettings::new(League::DivisionA));
    stage.move_ball(at(1.0, 4.4));
    stage.step();
    stage.touch(blue(1));
    stage.kick(0.0, 5.0);
    stage.until_stop(1.0);
    stage.until(Phase::BallPlacement(Colour::Yellow), 1.0);
    stage.run(30.1);
    assert_eq!(stage.phase(), Phase::BallPlacement(Colour::Blue));
    assert_eq!(stage.referee.next(), Some(Restart::FreeKick(Colour::Blue)));
}

#[test]
fn a_ball_near_its_place_needs_no_placement() {
    let mut stage = in_play();
    stage.move_ball(at(1.0, 2.5));
    stage.touch(blue(1));
    stage.move_ball(at(1.0, 3.1));
    stage.step();
    assert_eq!(stage.phase(), Phase::Stop);
    stage.move_ball(at(1.5, 2.4));
    stage.run(1.9);
    assert_eq!(stage.phase(), Phase::Stop);
    stage.until(Phase::FreeKick(Colour::Yellow), 0.3);
    assert_eq!(stage.orders, []);
}

#[test]
fn a_ball_in_the_goal_is_placed_by_hand() {
    let mut stage = in_play();
    stage.kick_from(at(3.0, 0.0), yellow(2), [5.0, 0.0]);
    stage.ball_mut().height = 0.2;
    stage.until_stop(1.0);
    stage.ball_mut().height = 0.0;
    stage.run(2.2);
    assert!(
        matches!(stage.orders[..], [WorldOrder::PutBall(place)] if place.y().abs() > 2.7),
        "{:?}",
        stage.orders
    );
    stage.until(Phase::FreeKick(Colour::Blue), 3.0);
}

#[test]
fn a_ball_pushed_into_the_goal_in_a_placement_is_placed_by_hand() {
    let mut stage = placement();
    stage.move_ball(at(4.6, 0.0));
    stage.until(Phase::Stop, 0.1);
    stage.until(Phase::FreeKick(Colour::Yellow), 6.0);
    assert!(close(stage.place_of_ball(), at(1.0, 2.8)));
}

#[test]
fn the_team_that_places_for_a_force_start_is_drawn() {
    let mut drawn = [false; 2];
    for seed in 0..16 {
        let mut stage = in_play();
        stage.referee.chance = crate::rng::Stream::new(seed, "small-size-referee");
        // Half a metre from blue's area: too near for a free kick, so the ball has to be moved.
        stage.move_ball(at(4.0, 1.5));
        stage.until(Phase::Stop, 11.0);
        assert_eq!(stage.referee.next(), Some(Restart::ForceStart));
        stage.run(0.1);
        let Phase::BallPlacement(team) = stage.phase() else { panic!("{:?}", stage.phase()) };
        drawn[usize::from(team == Colour::Blue)] = true;
    }
    assert_eq!(drawn, [true, true]);
}
