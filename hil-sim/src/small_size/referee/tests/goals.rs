//! Tests of goals and balls that leave the field: which goal counts, which team gets the ball, and where.
//! Field of 9 × 6 m, the defence areas 2 × 1 m.

use super::*;

/// Yellow's robot 2 shoots into the goal, and it does not count.
fn refused_goal(stage: &mut Stage, speed: f32) -> (Invalid, ShotEvent) {
    stage.kick_from(at(3.0, 0.0), yellow(2), [speed, 0.0]);
    stage.until(Phase::Halt, 1.0);
    let What::InvalidGoal { reason, shot } = stage.only(Kind::InvalidGoal).what else { panic!() };
    (reason, shot)
}

/// That robot touches last; the ball rolls from `from` with that velocity until the game stops.
fn shoot(who: Who, from: Point<Field>, x: f32, y: f32) -> Stage {
    let mut stage = in_play();
    stage.put(blue(0), at(4.45, 0.8));
    stage.put(yellow(0), at(-4.45, 0.8));
    stage.kick_from(from, who, [x, y]);
    while stage.phase() == Phase::Run {
        assert!(stage.seconds() < 60.0);
        stage.step();
    }
    stage
}

#[test]
fn a_ball_between_the_posts_is_a_goal_and_the_other_team_kicks_off() {
    let mut stage = shoot(yellow(2), at(2.0, 0.0), 5.0, 0.0);
    assert_eq!(stage.phase(), Phase::Halt);
    assert_eq!(stage.referee.accounts().yellow.score, 1);
    let What::Goal { shot: Some(shot) } = &stage.only(Kind::Goal).what else { panic!() };
    assert_eq!((shot.kicker, shot.from), (Some(yellow(2)), at(2.0, 0.0)));
    stage.until(Phase::Stop, 3.1);
    stage.until(Phase::PrepareKickoff(Colour::Blue), 10.0);
    assert_eq!(stage.place_of_ball(), at(0.0, 0.0));
}

#[test]
fn a_ball_on_the_goal_line_is_no_goal_yet() {
    let mut stage = in_play();
    stage.touch(yellow(2));
    stage.move_ball(at(4.52, 0.0));
    stage.run(0.1);
    assert_eq!(stage.phase(), Phase::Run);
    stage.move_ball(at(4.53, 0.0));
    stage.step();
    assert_eq!(stage.phase(), Phase::Halt);
}

#[test]
fn an_own_goal_counts_for_the_other_team() {
    let stage = shoot(yellow(2), at(-2.0, 0.0), -5.0, 0.0);
    assert_eq!(stage.referee.accounts().blue.score, 1);
    assert_eq!(stage.only(Kind::Goal).by, Some(Colour::Blue));
}

#[test]
fn a_ball_above_15_cm_since_the_scorers_last_touch_is_a_goal_kick() {
    let mut stage = in_play();
    stage.kick_from(at(3.0, 0.0), yellow(2), [5.0, 0.0]);
    stage.ball_mut().height = 0.16;
    stage.step();
    stage.ball_mut().height = 0.0;
    stage.until(Phase::Halt, 1.0);
    let What::InvalidGoal { reason, .. } = stage.only(Kind::InvalidGoal).what else { panic!() };
    assert_eq!(reason, Invalid::TooHigh);
    assert_eq!(stage.referee.accounts().yellow.score, 0);
    assert_eq!(stage.referee.next(), Some(Restart::FreeKick(Colour::Blue)));
    // A goal kick: 1 m from the goal line, 0.2 m from the touch line.
    let spot = stage.referee.placement().unwrap();
    assert!(close(at(3.5, spot.y()), spot) && (spot.y().abs() - 2.8).abs() < 0.01, "{spot:?}");
}

#[test]
fn a_high_ball_that_the_scorers_touch_again_counts() {
    let mut stage = in_play();
    stage.ball_mut().height = 0.5;
    stage.touch(yellow(1));
    stage.step();
    stage.ball_mut().height = 0.0;
    stage.kick_from(at(3.0, 0.0), yellow(2), [5.0, 0.0]);
    stage.until(Phase::Halt, 1.0);
    assert_eq!(stage.referee.accounts().yellow.score, 1);
}

#[test]
fn a_ball_over_the_bar_is_out() {
    let mut stage = in_play();
    stage.kick_from(at(4.0, 0.0), yellow(2), [5.0, 0.0]);
    stage.ball_mut().height = 0.2;
    stage.until(Phase::Stop, 1.0);
    stage.only(Kind::LeftGoalLine);
}

#[test]
fn a_goal_within_two_seconds_of_a_non_stopping_foul_does_not_count() {
    let mut stage = in_play();
    assert_eq!(refused_goal(&mut stage, 7.0).0, Invalid::RecentFoul(Kind::BallTooFast));
    stage.only(Kind::BallTooFast);
}

#[test]
fn a_goal_with_too_many_robots_does_not_count() {
    let mut stage = in_play();
    for number in 3..7 {
        stage.put(yellow(number), at(-3.0, -2.5 + 0.3 * f32::from(number)));
    }
    let (reason, shot) = refused_goal(&mut stage, 5.0);
    assert_eq!((reason, shot.robots), (Invalid::TooManyRobots, 7));
}

#[test]
fn a_ball_over_a_line_gives_the_others_a_free_kick_at_the_place_of_the_rules() {
    // A throw-in 20 cm inside, a goal kick, a corner, and division B's aimless kick from the own half.
    for (who, from, [x, y], kind, spot) in [
        (blue(1), at(1.0, 2.0), [0.0, 3.0], Kind::LeftTouchLine, at(1.0, 2.8)),
        (yellow(2), at(1.0, 1.5), [5.0, 0.0], Kind::LeftGoalLine, at(3.5, 2.8)),
        (blue(2), at(1.0, -1.5), [5.0, 0.0], Kind::LeftGoalLine, at(4.3, -2.8)),
        (yellow(2), at(-1.0, 1.5), [6.0, 0.0], Kind::AimlessKick, at(-1.0, 1.5)),
    ] {
        let stage = shoot(who, from, x, y);
        assert_eq!(stage.phase(), Phase::Stop, "{kind:?}");
        stage.only_by(kind, who);
        stage.assert_restart(Restart::FreeKick(who.colour.other()), spot);
    }
}

#[test]
fn a_kick_over_the_boundary_is_a_foul_and_a_free_kick_from_its_start() {
    let mut stage = shoot(yellow(2), at(1.0, 1.0), 0.0, 6.0);
    assert_eq!(stage.phase(), Phase::Stop);
    stage.run(0.3);
    let event = stage.only(Kind::BoundaryCrossing);
    assert_eq!(event.by, Some(Colour::Yellow));
    assert!(close(stage.referee.placement().unwrap(), at(1.0, 1.0)));
    assert_eq!(stage.referee.accounts().yellow.foul_count(), 1);
}
