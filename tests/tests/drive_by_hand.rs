//! `drive_by_hand`: tests: a robot that is driven by hand goes as fast as ordered, kicks what lies at its
//! dribbler, and stands when the hand goes silent or the referee says HALT.

use arena::game::{Game, GameConfig, TICK_US, Watcher};
use casebase::CaseBase;
use geometry::{Angle, Field, Point, Pose, Vector};
use hil_sim::NativeBackend;
use hil_sim::small_size::{Ball, PhysicsEvent};
use host::robot_test::{HAND_EXPIRY, TestOrder, TestRefused};
use protocol::{RobotId, Who};
use rules::state::RefereeCommand;
use rules::{Colour, League, Phase, RobotSpec};

/// The page sends an order so often, s.
const ORDER_EVERY_S: f64 = 0.033;
/// From the host's stop to a robot that stands, s: radio, the robot's step, and braking from 2 m/s.
const STOPPED_WITHIN_S: f64 = 0.75;

struct Silent;
impl Watcher for Silent {}

fn driven() -> Who {
    Who { colour: Colour::Blue, id: RobotId::new(3).unwrap() }
}

fn drive(velocity: [f32; 3], dribbler: bool, kick: Option<f32>) -> TestOrder {
    TestOrder::Drive { robot: driven().id.number(), velocity, dribbler, kick }
}

/// A match in which the driven robot stands at a place, heading along +x, and all others stand aside.
fn game<'a>(backend: &mut NativeBackend<'a>, at: Point<Field>) -> Game<'a> {
    let mut game = Game::new(&GameConfig::new(League::DivisionB, 6, 600.0), backend).expect("a match");
    game.test(Colour::Yellow, TestOrder::Stand, &mut Silent).expect("they stand");
    game.test(Colour::Blue, TestOrder::Stand, &mut Silent).expect("they stand");
    play(&mut game, 1.0, None);
    game.command(RefereeCommand::ForceStart);
    let others: Vec<Who> = game.world().robots().iter().map(|robot| robot.who).collect();
    for (i, who) in others.into_iter().enumerate() {
        let y = if who.colour == Colour::Blue { 2.6 } else { -2.6 };
        let position = Point::new(i as f32 * 0.3 - 1.8, y);
        game.put_robot(who, Pose { position, heading: Angle::ZERO });
    }
    game.put_robot(driven(), Pose { position: at, heading: Angle::ZERO });
    game.put_ball(Ball::at(Point::new(-3.0, 1.5)));
    play(&mut game, 0.5, None);
    assert_eq!(game.referee().phase(), Phase::Run);
    game
}

/// Plays on for so long while a hand gives an order, or none; speeds of the kicks of the driven robot.
fn play(game: &mut Game<'_>, seconds: f64, order: Option<TestOrder>) -> Vec<f32> {
    let (mut kicks, mut given) = (Vec::new(), f64::NEG_INFINITY);
    let end = game.time() + seconds;
    while game.time() < end {
        if let Some(order) = order.filter(|_| game.time() - given >= ORDER_EVERY_S) {
            given = game.time();
            game.test(Colour::Blue, order, &mut Silent).expect("accepted");
        }
        game.step(&mut Silent).expect("no emulator");
        for event in game.events() {
            if let PhysicsEvent::Kicked { robot, velocity, .. } = event
                && *robot == driven()
            {
                kicks.push(velocity.norm());
            }
        }
    }
    kicks
}

fn velocity(game: &Game<'_>) -> Vector<Field> {
    game.world().robot(driven()).expect("it plays").velocity
}

#[test]
fn a_driven_robot_goes_and_turns_as_fast_as_ordered() {
    let mut backend = NativeBackend::new(CaseBase::default());
    let mut reached = Vec::new();
    for speed in [0.2, 0.5, 1.0, 1.5, 2.0] {
        let mut game = game(&mut backend, Point::new(-2.5, 0.0));
        play(&mut game, 1.2, Some(drive([speed, 0.0, 0.0], false, None)));
        reached.push((speed, velocity(&game)));
    }
    eprintln!("ordered ahead, m/s, and reached: {reached:?}");
    for (speed, is) in reached {
        assert!((is.x() / speed - 1.0).abs() < 0.05 && is.y().abs() < 0.1, "{speed}: {is:?}");
    }
    let mut game = game(&mut backend, Point::new(0.0, -1.0));
    play(&mut game, 0.8, Some(drive([0.0, 1.0, 0.0], false, None)));
    assert!((velocity(&game).y() - 1.0).abs() < 0.15, "{:?} to its left", velocity(&game));
    play(&mut game, 1.0, None);
    let heading = |game: &Game<'_>| game.world().robot(driven()).expect("it plays").pose.heading;
    for rate in [1.0, -3.0] {
        play(&mut game, 0.5, Some(drive([0.0, 0.0, rate], false, None)));
        let before = heading(&game);
        play(&mut game, 0.4, Some(drive([0.0, 0.0, rate], false, None)));
        let turned = (heading(&game) - before).radians() / 0.4;
        eprintln!("ordered {rate} rad/s: {turned}");
        assert!((turned / rate - 1.0).abs() < 0.15, "{rate}: {turned}");
    }
}

#[test]
fn a_robot_stands_soon_after_its_hand_goes_silent_or_the_referee_halts() {
    let mut backend = NativeBackend::new(CaseBase::default());
    for halts in [false, true] {
        let mut game = game(&mut backend, Point::new(-2.5, 0.0));
        let order = drive([2.0, 0.0, 0.0], false, None);
        play(&mut game, 1.2, Some(order));
        assert!(velocity(&game).norm() > 1.6, "{:?}", velocity(&game));
        // The hand goes on where the referee halts: HALT wins.
        if halts {
            assert!(game.command(RefereeCommand::Halt));
        }
        let (stopped, mut slower) = (game.time(), None);
        while velocity(&game).norm() > 0.02 {
            play(&mut game, TICK_US as f64 * 1e-6, halts.then_some(order));
            if velocity(&game).norm() < 1.5 {
                slower.get_or_insert(game.time() - stopped);
            }
            assert!(game.time() - stopped < f64::from(HAND_EXPIRY.as_secs_f32()) + STOPPED_WITHIN_S);
        }
        eprintln!(
            "halts {halts}: below 1.5 m/s after {slower:?} s, stands after {:.3} s",
            game.time() - stopped
        );
        play(&mut game, 0.5, halts.then_some(order));
        assert!(velocity(&game).norm() < 0.02, "and stays: {:?}", velocity(&game));
    }
}

#[test]
fn a_driven_robot_carries_the_ball_and_kicks_it_straight_ahead_at_the_ordered_speed() {
    let mut backend = NativeBackend::new(CaseBase::default());
    let mut game = game(&mut backend, Point::new(-1.0, 0.0));
    let front = RobotSpec::OURS.hull.ball_at();
    game.put_ball(Ball::at(Point::new(-1.0 + front + 0.1, 0.0)));
    play(&mut game, 0.3, None);
    play(&mut game, 1.2, Some(drive([0.3, 0.0, 0.0], true, None)));
    let ball = game.world().ball.position;
    let robot = game.world().robot(driven()).expect("it plays").pose.position;
    assert!(ball.distance(robot) < front + 0.04 && ball.x() > -0.8, "it has it: {ball:?} {robot:?}");
    let kicks = play(&mut game, 0.6, Some(drive([0.0; 3], true, Some(3.0))));
    eprintln!("kicks {kicks:?}");
    assert!(kicks.len() == 1 && (kicks[0] / 3.0 - 1.0).abs() < 0.1, "{kicks:?}");
    let ball = game.world().ball;
    assert!(ball.velocity.y().abs() < 0.15 * ball.velocity.x(), "{ball:?}");
    let too_fast = game.test(Colour::Blue, drive([3.0, 0.0, 0.0], false, None), &mut Silent);
    assert_eq!(too_fast, Err(TestRefused::Speed));
}
