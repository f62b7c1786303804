//! Tests of penalties: yellow shoots at the goal at +4.5 m from the mark at (−1.5, 0); 10 s.

use super::*;

/// The penalty is prepared and all conditions are met.
fn penalty_prepared() -> Stage {
    let mut stage = in_play();
    assert!(stage.referee.restart_by_hand(Restart::Penalty(Colour::Yellow), at(0.0, 0.0)));
    for (who, place) in [(blue(0), at(4.5, 0.0)), (blue(1), at(-3.0, 1.0)), (blue(2), at(-3.0, -1.0))] {
        stage.put(who, place);
    }
    stage.put(yellow(1), at(-3.0, 0.0));
    stage.put(yellow(2), at(-3.0, -2.0));
    stage.until(Phase::PreparePenalty(Colour::Yellow), 10.0);
    stage
}

/// NORMAL_START was given; shooter is yellow's robot 1, keeper blue's robot 0.
fn penalty() -> Stage {
    let mut stage = penalty_prepared();
    stage.put(yellow(1), at(-1.7, 0.0));
    stage.until(Phase::Penalty(Colour::Yellow), 3.0);
    assert_eq!(stage.place_of_ball(), at(-1.5, 0.0));
    stage
}

fn shoot(stage: &mut Stage, x: f32, y: f32) {
    stage.touch(yellow(1));
    stage.kick(x, y);
}

fn failed(stage: &Stage) -> PenaltyEnd {
    let What::PenaltyFailed { reason } = stage.only(Kind::PenaltyFailed).what else { panic!() };
    reason
}

#[test]
fn a_penalty_starts_only_when_keeper_and_robots_stand_correctly() {
    let mut stage = in_play();
    stage.move_ball(at(4.0, 0.0));
    stage.put(blue(1), at(3.9, 0.0));
    stage.touch(blue(1));
    stage.put(blue(1), at(3.0, 1.0));
    stage.until(Phase::PreparePenalty(Colour::Yellow), 20.0);
    // One after the other; the ball lies at (−1.5, 0), the goal line is at 4.5.
    stage.put(blue(0), at(4.40, 0.0));
    let waits_for = |stage: &mut Stage, who: Who, label: &str| {
        stage.run(30.0);
        assert_eq!(stage.phase(), Phase::PreparePenalty(Colour::Yellow));
        let obstacle = stage.referee.blocked().unwrap().obstacle;
        assert_eq!((obstacle.who(), obstacle.reason.label()), (Some(who), label));
    };
    stage.put(blue(2), at(-3.0, -1.0));
    stage.put(yellow(2), at(-3.0, -2.0));
    stage.put(yellow(1), at(-1.7, 0.0));
    stage.put(blue(1), at(-2.4, 1.0));
    waits_for(&mut stage, blue(0), "keeper_off_line");
    stage.put(blue(0), at(4.42, 0.0));
    waits_for(&mut stage, blue(1), "robot_not_behind_ball");
    stage.put(blue(1), at(-2.6, 1.0));
    stage.put(yellow(2), at(-2.4, -2.0));
    // The nearest to the ball is the kicker.
    waits_for(&mut stage, yellow(2), "robot_not_behind_ball");
    stage.put(yellow(2), at(-2.6, -2.0));
    stage.until(Phase::Penalty(Colour::Yellow), 2.1);
    assert_eq!(stage.orders.len(), 1, "nothing but the ball was put: {:?}", stage.orders);
}

#[test]
fn a_penalty_waits_for_a_missing_keeper() {
    let mut stage = penalty_prepared();
    stage.take(blue(0));
    stage.run(15.0);
    assert_eq!(stage.reason(), Some(Reason::NoKeeper));
}

#[test]
fn a_penalty_goal_counts_at_any_ball_height() {
    let mut stage = penalty();
    shoot(&mut stage, 6.0, 0.0);
    stage.ball_mut().height = 0.3;
    stage.run(0.5);
    stage.ball_mut().height = 0.0;
    stage.until(Phase::Halt, 2.0);
    assert_eq!(stage.referee.accounts().yellow.score, 1);
    assert_eq!(stage.referee.next(), Some(Restart::Kickoff(Colour::Blue)));
}

#[test]
fn a_penalty_beside_the_goal_is_a_goal_kick() {
    let mut stage = penalty();
    shoot(&mut stage, 6.0, 1.0);
    stage.until(Phase::Stop, 3.0);
    assert_eq!(failed(&stage), PenaltyEnd::Out);
    stage.assert_restart(Restart::FreeKick(Colour::Blue), at(3.5, 2.8));
}

#[test]
fn a_keeper_that_turns_the_ball_back_saves_the_penalty() {
    let mut stage = penalty();
    shoot(&mut stage, 6.0, 0.0);
    stage.run(0.8);
    stage.kick(-1.0, 1.0);
    stage.touch(blue(0));
    assert_eq!((failed(&stage), stage.phase()), (PenaltyEnd::Saved, Phase::Stop));
}

#[test]
fn a_keeper_that_only_slows_the_ball_does_not_end_the_penalty() {
    let mut stage = penalty();
    shoot(&mut stage, 6.0, 0.0);
    stage.run(0.8);
    stage.kick(1.0, 0.5);
    stage.touch(blue(0));
    stage.run(0.1);
    assert_eq!(stage.phase(), Phase::Penalty(Colour::Yellow));
}

#[test]
fn a_penalty_ball_that_moves_back_fails() {
    let mut stage = penalty();
    shoot(&mut stage, 1.0, 0.0);
    stage.run(0.5);
    stage.kick(-1.0, 0.0);
    stage.run(0.1);
    assert_eq!(failed(&stage), PenaltyEnd::MovedBack);
}

#[test]
fn a_penalty_is_over_after_ten_seconds() {
    let mut stage = penalty();
    stage.run(9.9);
    assert_eq!(stage.phase(), Phase::Penalty(Colour::Yellow));
    stage.until(Phase::Stop, 0.2);
    assert_eq!(failed(&stage), PenaltyEnd::TimeUp);
}

#[test]
fn a_foul_fails_the_penalty_of_the_shooters_and_is_a_goal_of_the_others() {
    let mut stage = penalty();
    shoot(&mut stage, 7.0, 0.0);
    stage.run(0.1);
    assert_eq!(failed(&stage), PenaltyEnd::Foul(Kind::BallTooFast));
    assert_eq!(stage.referee.next(), Some(Restart::FreeKick(Colour::Blue)));

    let mut stage = penalty();
    shoot(&mut stage, 3.0, 0.0);
    stage.put(yellow(2), at(-3.0, -1.0));
    stage.put(blue(2), at(-3.0, -0.82));
    let velocities = [Vector::default(), Vector::new(0.0, -2.0)];
    stage.crashes.push(CrashSeen { between: [yellow(2), blue(2)], velocities });
    stage.step();
    assert_eq!(stage.only(Kind::Goal).by, Some(Colour::Yellow));
    assert_eq!(stage.referee.accounts().yellow.score, 1);
    assert_eq!(stage.referee.next(), Some(Restart::Kickoff(Colour::Blue)));
}

#[test]
fn a_half_lasts_until_its_last_penalty_is_over() {
    let mut stage = penalty();
    stage.referee.stage_left = 1_000_000;
    stage.run(5.0);
    assert_eq!(stage.phase(), Phase::Penalty(Colour::Yellow));
    shoot(&mut stage, 6.0, 1.0);
    stage.run(2.0);
    assert_eq!(stage.referee.stage(), rules::state::Stage::HalfTime);
}

#[test]
fn in_a_shoot_out_five_alternating_attempts_each_decide() {
    use rules::state::Stage as Part;
    let mut stage = stage();
    stage.obedient = true;
    stage.step();
    stage.referee.stage = Part::ShootOutBreak;
    stage.referee.stage_left = 0;
    let mut shooters = Vec::new();
    while !stage.referee.is_over() {
        if let Phase::Penalty(team) = stage.phase() {
            shooters.push(team);
            // Yellow scores, blue shoots beside.
            stage.kick(
                if team == Colour::Yellow { 6.0 } else { -6.0 },
                if team == Colour::Yellow { 0.0 } else { 2.0 },
            );
            while matches!(stage.phase(), Phase::Penalty(_)) {
                stage.step();
            }
            stage.kick(0.0, 0.0);
        }
        stage.step();
        assert!(stage.seconds() < 600.0);
    }
    let expected: Vec<_> = [Colour::Yellow, Colour::Blue].into_iter().cycle().take(10).collect();
    assert_eq!(shooters, expected);
    assert_eq!((stage.referee.accounts().yellow.score, stage.referee.accounts().blue.score), (5, 0));
}
