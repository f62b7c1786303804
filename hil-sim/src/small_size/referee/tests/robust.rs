//! `robust`: tests with teams that stand still, absent teams, and inconsistent worlds. The match continues or
//! reports why not, and nothing panics.

use super::*;
use crate::rng::Stream;

/// A match of 300 simulated seconds ends in time, and was played for a part of them.
fn plays_to_the_end(stage: Stage) -> Stage {
    let stage = ends_in_time(stage);
    let metrics = stage.referee.metrics();
    assert!(metrics.running_s > 30.0, "{metrics:?}");
    stage
}

fn ends_in_time(stage: Stage) -> Stage {
    ends_in_time_with(stage, settings())
}

fn ends_in_time_with(mut stage: Stage, settings: RefereeSettings) -> Stage {
    let clock = MatchClock::Simulated { total: Duration::millis(300_000) };
    let settings = RefereeSettings { clock, ..settings };
    stage.referee = InternalReferee::new(settings, 3).unwrap();
    while !stage.referee.is_over() {
        stage.step();
        assert!(stage.seconds() < 301.0);
    }
    stage
}

#[test]
fn robots_that_only_make_way_do_not_block_the_match() {
    let mut standing = stage();
    // They stand where they commit no offence, but in the wrong half after half-time.
    standing.obedient = true;
    let stage = plays_to_the_end(standing);
    assert!(stage.count(Kind::NoProgress) > 3);
}

#[test]
fn a_match_without_robots_continues() {
    let mut stage = stage();
    stage.robots.clear();
    plays_to_the_end(stage);
}

/// Robots of both teams in each other's areas and at the ball.
fn in_the_way(stage: &mut Stage) {
    for (number, x) in [(1, 3.4), (2, 3.6)] {
        stage.put(yellow(number), at(x, 0.5));
        stage.put(blue(number), at(-x, 0.5));
    }
    stage.put(blue(3), at(0.3, 0.0));
    stage.put(yellow(3), at(-0.3, 0.0));
}

#[test]
fn the_referee_names_the_robot_that_blocks_the_match_for_good() {
    let mut stage = stage();
    stage.put(blue(3), at(0.3, 0.0));
    let stage = ends_in_time(stage);
    let metrics = stage.referee.metrics();
    assert_eq!(metrics.running_s, 0.0);
    assert!(metrics.blocked_s() > 280.0, "{:?}", metrics.blocks);
    let block = &metrics.blocks[0];
    assert_eq!((block.phase, block.obstacle.reason.label()), (Phase::Stop, "robot_near_ball"));
    assert!(stage.orders.is_empty(), "{:?}", stage.orders);
}

#[test]
fn robots_that_do_not_drive_are_moved_by_hand_in_a_halt() {
    let mut stage = stage();
    in_the_way(&mut stage);
    let mut settings = settings();
    (settings.yellow.drives, settings.blue.drives) = (false, false);
    let stage = ends_in_time_with(stage, settings);
    let metrics = stage.referee.metrics();
    assert!(metrics.running_s > 30.0, "{metrics:?}");
    let carried = |order: &&WorldOrder| matches!(order, WorldOrder::CarryRobot(..));
    assert!(stage.orders.iter().filter(carried).count() >= 6, "{:?}", stage.orders);
    assert!(stage.count(Kind::MultipleFouls) > 0);
}

#[test]
fn a_ball_that_needs_manual_placement_blocks_until_it_is_placed() {
    let mut stage = stage();
    stage.obeyed = false;
    stage.move_ball(at(2.0, 1.0));
    let mut stage = ends_in_time(stage);
    assert_eq!(stage.referee.metrics().running_s, 0.0);
    assert_eq!(stage.referee.metrics().blocks[0].obstacle.reason.label(), "ball_not_put");
    // Repeated until it succeeds: the first order was lost.
    stage.orders.clear();
    stage.obeyed = true;
    stage.now = Instant(0);
    plays_to_the_end(stage);
}

#[test]
fn a_match_without_a_ball_continues() {
    let mut stage = stage();
    stage.obeyed = false;
    stage.ball = None;
    let stage = ends_in_time(stage);
    assert!(stage.count(Kind::NoProgress) > 3);
}

#[test]
fn the_same_observations_give_the_same_match() {
    let play = || plays_to_the_end(wild(7)).referee.log;
    assert_eq!(play(), play());
}

/// Six robots of each team at random places.
fn wild(seed: u64) -> Stage {
    let mut stage = stage();
    stage.obedient = true;
    let mut chance = Stream::new(seed, "wild stage");
    for number in 0..6 {
        for who in [yellow(number), blue(number)] {
            stage.put(who, at(chance.between(-4.6, 4.6), chance.between(-3.1, 3.1)));
        }
    }
    stage
}

/// Random changes of the world in a step, as by a fuzzer.
fn disturb(stage: &mut Stage, chance: &mut Stream) {
    match chance.whole(0, 400) {
        0 => stage.kick(chance.between(-8.0, 8.0), chance.between(-8.0, 8.0)),
        1 => stage.kick(0.0, 0.0),
        2 => stage.move_ball(at(chance.between(-6.0, 6.0), chance.between(-4.0, 4.0))),
        3 => stage.ball_mut().height = chance.between(0.0, 1.0),
        4 => stage.ball_mut().height = 0.0,
        5 | 6 => {
            let index = chance.whole(0, stage.robots.len().max(1) as u32 - 1) as usize;
            let ball = stage.place_of_ball();
            if let Some(robot) = stage.robots.get_mut(index) {
                robot.pose.position =
                    ball + Vector::new(chance.between(-0.2, 0.2), chance.between(-0.2, 0.2));
                robot.touches_ball = true;
                robot.velocity = Vector::new(chance.between(-3.0, 3.0), chance.between(-3.0, 3.0));
            }
        }
        7 => stage.robots.iter_mut().for_each(|robot| robot.touches_ball = false),
        8 => {
            // Robots returned by hand again and again would delay a match that has to be decided.
            let most = if stage.referee.settings.knockout { 5 } else { 15 };
            let who = Who {
                id: id(chance.whole(0, most) as u8),
                ..if chance.chance(0.5) { yellow(0) } else { blue(0) }
            };
            stage.put(who, at(chance.between(-5.0, 5.0), chance.between(-3.5, 3.5)));
        }
        9 => {
            let velocities =
                [0, 1].map(|_| Vector::new(chance.between(-3.0, 3.0), chance.between(-3.0, 3.0)));
            stage.crashes.push(CrashSeen { between: [yellow(1), blue(1)], velocities });
        }
        10 => {
            let _ = stage.referee.request_timeout(Colour::Blue, Duration::millis(500));
        }
        11 => {
            // A robot with a NaN counts as absent.
            let index = chance.whole(0, stage.robots.len().max(1) as u32 - 1) as usize;
            if let Some(robot) = stage.robots.get_mut(index) {
                robot.pose.position = at(f32::NAN, f32::INFINITY);
            }
        }
        _ => {}
    }
    for robot in &mut stage.robots {
        robot.pose.position += robot.velocity * 0.01;
        robot.velocity = robot.velocity * 0.98;
    }
}

#[test]
fn a_wild_world_ends_in_time_and_never_leaves_the_state_graph() {
    // `Stage::step` compares with an independent game state after every step and asserts the graph.
    for seed in 0..12 {
        let mut stage = wild(seed);
        let clock = MatchClock::Simulated { total: Duration::millis(200_000) };
        let knockout = seed % 4 == 3;
        let mut settings = RefereeSettings { clock, knockout, cards: !knockout, ..settings() };
        // These robots place no ball: in the long matches it is placed by hand at once.
        (settings.yellow.can_place_ball, settings.blue.can_place_ball) = (!knockout, !knockout);
        stage.referee = InternalReferee::new(settings, seed).unwrap();
        let mut chance = Stream::new(seed, "disturbances");
        while !stage.referee.is_over() {
            disturb(&mut stage, &mut chance);
            stage.step();
            assert!(
                stage.seconds() < 3_000.0,
                "seed {seed}: {:?} {:?}",
                stage.phase(),
                stage.referee.blocked()
            );
        }
        assert!(stage.referee.events().len() > 20, "{}", stage.referee.events().len());
    }
}

#[test]
fn time_that_goes_back_is_ignored() {
    let mut stage = in_play();
    let before = stage.referee.log.len();
    let seen = Observation { time: Instant(5), ball: None, fastest: 0.0, robots: &[], crashes: &[] };
    stage.referee.observe(&seen);
    assert_eq!((stage.referee.now, stage.referee.log.len()), (stage.now, before));
}

#[test]
fn steps_of_1_10_and_20_ms_find_the_same_offences() {
    let play = |step: Duration| {
        let mut stage = in_play();
        stage.step = step;
        stage.kick_from(at(-3.0, 1.0), yellow(1), [6.8, 0.0]);
        stage.run(0.3);
        stage.kick(0.0, 0.0);
        stage.until(Phase::Stop, 12.0);
        stage.drive(blue(1), 0.0, 1.7);
        stage.put(yellow(2), at(3.3, 0.0));
        stage.put(yellow(1), stage.place_of_ball() + Vector::new(0.3, 0.0));
        stage.run(2.5);
        stage.referee.events().iter().map(|event| (event.what.kind(), event.robot)).collect::<Vec<_>>()
    };
    let events = play(Duration::millis(10));
    assert_eq!(events.len(), 5, "{events:?}");
    assert_eq!(play(Duration::millis(1)), events);
    assert_eq!(play(Duration::millis(20)), events);
}

#[test]
fn a_ball_left_in_the_goal_does_not_score_again() {
    let mut stage = in_play();
    stage.obeyed = false;
    stage.put(blue(0), at(4.45, 0.8));
    stage.kick_from(at(3.0, 0.0), yellow(2), [5.0, 0.0]);
    stage.until(Phase::Halt, 1.0);
    stage.kick(0.0, 0.0);
    stage.run(120.0);
    assert_eq!((stage.count(Kind::Goal), stage.count(Kind::LeftGoalLine)), (1, 0));
    assert!(matches!(stage.reason(), Some(Reason::BallNotPut { .. })));
}
