//! Tests of defence areas: blue's reaches from x = 3.5 to 4.5 m and 1 m to either side; robots have a radius
//! of 0.09 m.

use super::*;

#[test]
fn an_attackers_touch_partly_in_the_area_is_a_foul_every_two_seconds() {
    let mut stage = in_play();
    stage.move_ball(at(3.55, 0.0));
    stage.put(yellow(2), at(3.4, 0.0));
    stage.touch(yellow(2));
    assert_eq!(stage.count(Kind::AttackerTouchedBall), 0, "outside by 1 cm");
    stage.put(yellow(2), at(3.45, 0.0));
    for _ in 0..50 {
        stage.touch(yellow(2));
    }
    let event = stage.only(Kind::AttackerTouchedBall);
    let What::AttackerTouchedBall { depth } = event.what else { panic!() };
    assert!((depth - 0.04).abs() < 0.006, "{depth}");
    assert_eq!((stage.phase(), stage.referee.accounts().yellow.foul_count()), (Phase::Run, 1));
    for _ in 0..160 {
        stage.touch(yellow(2));
    }
    assert_eq!(stage.count(Kind::AttackerTouchedBall), 2);
}

#[test]
fn a_defender_entirely_in_its_area_that_touches_the_ball_is_a_penalty() {
    let mut stage = in_play();
    stage.move_ball(at(4.0, 0.0));
    stage.put(blue(1), at(3.5, 0.0));
    stage.touch(blue(1));
    assert_eq!(stage.count(Kind::DefenderInArea), 0, "partly in");
    stage.put(blue(1), at(3.9, 0.0));
    stage.touch(blue(1));
    assert_eq!(stage.only(Kind::DefenderInArea).robot, Some(id(1)));
    assert_eq!(stage.phase(), Phase::Stop);
    assert_eq!(stage.referee.next(), Some(Restart::Penalty(Colour::Yellow)));
    // 6 m from the goal at +4.5 m.
    assert!(close(stage.referee.placement().unwrap(), at(-1.5, 0.0)));
    assert_eq!(stage.referee.accounts().blue.foul_count(), 0);
}

#[test]
fn the_keeper_may_touch_the_ball_in_its_area_and_others_may_be_there() {
    let mut stage = in_play();
    stage.move_ball(at(4.2, 0.0));
    stage.put(blue(1), at(3.9, 0.5));
    stage.put(yellow(2), at(3.6, 0.5));
    stage.touch(blue(0));
    stage.run(0.5);
    assert_eq!(stage.referee.metrics().offences, FoulCounts::default());
}

#[test]
fn a_keeper_can_be_changed_only_with_the_ball_in_the_other_half() {
    let mut stage = in_play();
    stage.move_ball(at(2.0, 0.0));
    stage.step();
    assert!(!stage.referee.set_keeper(Colour::Blue, id(1)));
    assert!(stage.referee.set_keeper(Colour::Yellow, id(1)));
    stage.move_ball(at(-2.0, 0.0));
    stage.step();
    assert!(stage.referee.set_keeper(Colour::Blue, id(1)));
    stage.move_ball(at(4.2, 0.0));
    stage.put(blue(1), at(4.1, 0.0));
    stage.touch(blue(1));
    assert_eq!(stage.count(Kind::DefenderInArea), 0);
}

/// Stop after a throw-in of yellow's at (1, 2.8), where no team is asked to place the ball.
fn stopped() -> Stage {
    let mut stage = in_play();
    stage.move_ball(at(1.0, 2.9));
    stage.touch(blue(1));
    stage.move_ball(at(1.0, 3.1));
    stage.step();
    assert_eq!(stage.phase(), Phase::Stop);
    stage.move_ball(at(1.0, 2.8));
    stage
}

#[test]
fn in_stop_attackers_have_two_seconds_to_leave_the_20_cm_around_the_area() {
    let mut stage = stopped();
    // 0.19 m from hull to area.
    stage.put(yellow(2), at(3.22, 0.0));
    stage.put(blue(1), at(1.1, 2.5));
    stage.run(1.9);
    assert_eq!(stage.count(Kind::AttackerTooClose), 0);
    stage.run(0.2);
    let event = stage.only_by(Kind::AttackerTooClose, yellow(2));
    let What::AttackerTooClose { distance, .. } = event.what else { panic!() };
    assert!((distance - 0.19).abs() < 0.006, "{distance}");
    assert_eq!(stage.referee.next(), Some(Restart::FreeKick(Colour::Blue)));
    assert_eq!(stage.phase(), Phase::Stop);
}

#[test]
fn an_attacker_20_cm_from_the_area_is_far_enough() {
    let mut stage = stopped();
    stage.put(yellow(2), at(3.20, 0.0));
    stage.put(blue(1), at(1.1, 2.5));
    stage.run(5.0);
    assert_eq!(stage.count(Kind::AttackerTooClose), 0);
}

#[test]
fn a_teams_second_attacker_too_close_in_a_stop_halts_the_game() {
    let mut stage = stopped();
    stage.put(yellow(2), at(3.2, 0.5));
    stage.put(yellow(2), at(3.3, 0.0));
    // A robot at the ball prevents the game from continuing.
    stage.put(blue(1), at(1.0, 2.6));
    stage.put(yellow(1), at(1.0, 2.55));
    stage.run(4.1);
    assert_eq!(stage.phase(), Phase::Halt);
    assert_eq!(stage.count(Kind::AttackerTooClose), 2);
    stage.run(3.1);
    assert_eq!(stage.phase(), Phase::Stop);
}

#[test]
fn an_attacker_too_close_at_a_free_kick_gives_the_others_a_free_kick() {
    let mut stage = stopped();
    stage.until(Phase::FreeKick(Colour::Yellow), 3.0);
    stage.put(yellow(2), at(3.3, 0.0));
    stage.run(1.9);
    assert_eq!(stage.phase(), Phase::FreeKick(Colour::Yellow));
    stage.run(0.2);
    assert_eq!(stage.phase(), Phase::Stop);
    assert_eq!(stage.referee.next(), Some(Restart::FreeKick(Colour::Blue)));
}

#[test]
fn every_third_foul_is_a_yellow_card_and_the_offender_goes_off() {
    let mut stage = in_play();
    for _ in 0..3 {
        stage.kick_from(at(-3.0, 1.0), blue(2), [7.0, 0.0]);
        stage.step();
        stage.kick(0.0, 0.0);
        stage.run(0.5);
    }
    stage.only(Kind::MultipleFouls);
    let account = &stage.referee.accounts().blue;
    assert_eq!((account.yellow_cards.len(), account.allowed(6)), (1, 5));
    assert_eq!(stage.referee.packet().blue.max_allowed_bots, Some(5));
    // Three robots are fewer than five; with six it has one too many.
    for number in 3..6 {
        stage.put(blue(number), at(2.5, -2.5 + 0.5 * f32::from(number)));
    }
    stage.move_ball(at(0.5, 0.5));
    stage.run(5.0);
    stage.move_ball(at(1.0, 0.5));
    stage.run(4.9);
    assert_eq!((stage.phase(), stage.count(Kind::TooManyRobots)), (Phase::Run, 0));
    stage.run(0.2);
    stage.only(Kind::TooManyRobots);
    assert_eq!(stage.referee.next(), Some(Restart::ForceStart));
    // It may leave by itself; where it does not, the game is halted to take it off by hand once robots stand.
    stage.run(9.0);
    assert_eq!((stage.phase(), stage.orders.len()), (Phase::Stop, 0));
    stage.until(Phase::Halt, 2.0);
    assert!(matches!(
        stage.only(Kind::Blocked).what,
        What::Blocked { reason: Reason::TooManyRobots { allowed: 5, on_field: 6 } }
    ));
    stage.until(Phase::Stop, 3.1);
    assert_eq!(stage.orders, [WorldOrder::RemoveRobot(blue(2))]);
    stage.until(Phase::Run, 5.0);
}

/// Blue has six robots on the field and one yellow card; the game is stopped.
fn one_too_many() -> Stage {
    let mut stage = in_play();
    stage.referee.accounts.blue.show_yellow(Instant(0), 120_000_000);
    for number in 3..6 {
        stage.put(blue(number), at(2.5, -2.5 + 0.5 * f32::from(number)));
    }
    stage.kick_from(at(0.0, 1.0), blue(1), [0.0, 6.0]);
    stage.until_stop(1.0);
    stage.move_ball(at(0.0, 2.5));
    stage
}

#[test]
fn a_robot_entirely_in_its_goal_substitution_area_is_not_counted() {
    // Division A: the wall at 6.6 m, the area 0.3 m, the robot's centre at most 0.21 m before the wall.
    for (x, counted) in [(6.38, true), (6.40, false), (-6.40, true)] {
        let mut stage = stage_with(RefereeSettings::new(League::DivisionA));
        stage.until(Phase::Stop, 4.0);
        for number in 3..11 {
            stage.put(blue(number), at(3.0, 0.4 * f32::from(number)));
        }
        stage.referee.accounts.blue.show_yellow(Instant(0), 120_000_000);
        stage.put(blue(10), at(x, 1.5));
        stage.run(5.0);
        let goes_on = stage.phase() != Phase::Stop;
        assert_eq!((goes_on, stage.orders.len()), (!counted, 0), "{x}");
    }
}

#[test]
fn a_surplus_robot_beside_the_halfway_line_is_taken_off_away_from_the_ball() {
    let mut stage = one_too_many();
    stage.put(blue(5), at(0.2, 3.15));
    stage.move_ball(at(0.0, 2.8));
    stage.run(1.0);
    assert_eq!(stage.orders, []);
    stage.put(blue(5), at(0.2, -3.15));
    stage.step();
    assert_eq!(stage.orders, [WorldOrder::RemoveRobot(blue(5))]);
    stage.until(Phase::FreeKick(Colour::Yellow), 3.0);
}

#[test]
fn a_yellow_card_lasts_120_s_of_playing_time_and_the_robot_comes_back_in_a_stop() {
    let mut stage = in_play();
    stage.referee.accounts.blue.show_yellow(Instant(0), 120_000_000);
    for number in 3..6 {
        stage.put(blue(number), at(2.5, -2.5 + 0.5 * f32::from(number)));
    }
    stage.touch(blue(1));
    stage.kick(0.0, 6.0);
    stage.until_stop(1.0);
    stage.move_ball(stage.referee.placement().unwrap());
    stage.until(Phase::FreeKick(Colour::Yellow), 30.0);
    let Some(WorldOrder::RemoveRobot(taken)) = stage.orders.last().copied() else { panic!() };
    stage.orders.clear();
    let played = |stage: &Stage| stage.referee.metrics().running_s;
    let began = played(&stage);
    let left = stage.referee.accounts().blue.yellow_cards[0] as f32 * 1e-6;
    assert!((119.0..=120.0).contains(&left));
    while !stage.referee.accounts().blue.yellow_cards.is_empty() {
        stage.step();
        assert!(stage.seconds() < 400.0);
    }
    assert!((played(&stage) - began - left).abs() < 0.1);
    while stage.orders.is_empty() {
        stage.step();
        assert!(stage.seconds() < 450.0);
    }
    assert_eq!(stage.phase(), Phase::Stop);
    assert!(
        matches!(stage.orders[..], [WorldOrder::ReturnRobot(who, _)] if who == taken),
        "{:?}",
        stage.orders
    );
}

#[test]
fn the_third_card_at_a_time_is_red_and_cards_can_be_switched_off() {
    let foul = |stage: &mut Stage| {
        for _ in 0..9 {
            stage.kick_from(at(-3.0, 1.0), blue(2), [7.0, 0.0]);
            stage.step();
            stage.kick(0.0, 0.0);
            stage.run(0.5);
        }
    };
    let mut stage = in_play();
    foul(&mut stage);
    let account = &stage.referee.accounts().blue;
    assert_eq!((account.yellow_cards.len(), account.red_cards, account.allowed(6)), (2, 1, 3));
    stage.only(Kind::MultipleCards);

    let mut stage = in_play();
    stage.referee.settings.cards = false;
    foul(&mut stage);
    let account = &stage.referee.accounts().blue;
    assert_eq!((account.foul_count(), account.allowed(6)), (9, 6));
}

#[test]
fn behind_the_own_goal_line_is_off_the_field_in_a_substitution_area() {
    for (league, place, counted) in [
        (League::DivisionA, at(6.45, 2.5), 2),
        (League::DivisionA, at(6.3, 2.5), 3),
        (League::DivisionB, at(4.65, 2.5), 3),
    ] {
        let mut stage = stage_with(RefereeSettings::new(league));
        stage.put(blue(1), place);
        assert_eq!(stage.referee.on_field(&stage.robots, Colour::Blue), counted, "{league:?}");
        // Behind the other team's goal line there is no such area for it.
        stage.put(blue(1), at(-place.x(), place.y()));
        assert_eq!(stage.referee.on_field(&stage.robots, Colour::Blue), 3, "{league:?}");
    }
}
