//! Tests: robots and ball agree with hand calculations: drives, impacts, dribbler, kicks; and equal seeds
//! give equal worlds.

mod ball;
mod dribbler;
mod drive;

use geometry::{Point, Pose, Twist, Vector};
use protocol::RobotId;
use rules::League;

use super::*;
use crate::four_legged::trace::TraceHash;

pub(super) fn yellow(id: u8) -> Who {
    Who::yellow(RobotId::new(id).unwrap())
}

fn blue(id: u8) -> Who {
    Who::blue(RobotId::new(id).unwrap())
}

fn exact() -> Parameters {
    let mut parameters = Parameters::of(League::DivisionB).unwrap().clone();
    parameters.noise = NoiseParameters::NONE;
    parameters.kick.speed_sd = 0.0;
    parameters.kick.angle_sd_deg = 0.0;
    parameters
}

/// Division B without randomness, the ball far from the middle.
fn world() -> World {
    let mut world = World::new(League::DivisionB, &exact(), 1);
    world.put_ball(Ball::at(Point::new(0.0, 2.5)));
    world
}

/// The same world with six robots a side on the field and the ball at (1, 1).
pub(super) fn six_a_side(mut world: World) -> World {
    for n in 0..6 {
        let x = 300.0 * f32::from(n);
        world.put(yellow(n), Pose::from_mm_deg(-x, 500.0, 10.0));
        world.put(blue(n), Pose::from_mm_deg(x + 100.0, -500.0, 170.0));
    }
    world.put_ball(Ball::at(Point::new(1.0, 1.0)));
    world
}

fn run(world: &mut World, steps: u32) -> Vec<PhysicsEvent> {
    for _ in 0..steps {
        world.step();
    }
    let mut events = Vec::new();
    world.take_events(&mut events);
    events
}

/// Runs with the order repeated every 10 ms, as a brain does.
pub(super) fn lead(world: &mut World, who: Who, order: Order, steps: u32) -> Vec<PhysicsEvent> {
    let mut events = Vec::new();
    for step in 0..steps {
        if step % 10 == 0 {
            world.order(who, order);
        }
        world.step();
        world.take_events(&mut events);
    }
    events
}

pub(super) fn local(x: f32, y: f32, turn: f32) -> Order {
    let drive = Drive::Local(Twist { linear: Vector::new(x, y), angular: turn });
    Order { drive, ..Order::default() }
}

pub(super) fn dribble(order: Order) -> Order {
    Order { dribbler: 1.0, ..order }
}

/// True where the break-beam sensor of yellow's robot 1 detects the ball.
pub(super) fn has_ball(world: &World) -> bool {
    world.robot(yellow(1)).unwrap().ball_contact
}

fn has_kick(events: &[PhysicsEvent]) -> bool {
    events.iter().any(|event| matches!(event, PhysicsEvent::Kicked { .. }))
}

/// Position of the ball at the front of a robot with that pose.
pub(super) fn dribbler_point(world: &World, pose: Pose<Field>) -> Point<Field> {
    let of = world.parameters();
    pose.to_field(Point::new(of.robot.front + of.ball.radius + 0.0001, 0.0))
}

/// Eleven robots a side that drive around by a fixed script, kicking and dribbling.
fn busy(seed: u64, order_of_putting: impl Iterator<Item = u8>) -> World {
    let league = League::DivisionA;
    let mut world = World::new(league, Parameters::of(league).unwrap(), seed);
    for n in order_of_putting {
        let (row, id) = (f32::from(n % 11), n % 11);
        if n < 11 {
            world.put(yellow(id), Pose::from_mm_deg(-3000.0 + 300.0 * row, 200.0 * row - 1000.0, 10.0 * row));
        } else {
            world.put(
                blue(id),
                Pose::from_mm_deg(3000.0 - 300.0 * row, 1000.0 - 200.0 * row, 180.0 - 7.0 * row),
            );
        }
    }
    world
}

fn play(world: &mut World, steps: u32) -> String {
    let mut trace = TraceHash::default();
    for step in 0..steps {
        if step % 10 == 0 {
            trace.small_size_tick(step / 10, world);
            let ball = world.ball.position;
            let orders: Vec<_> = (world.robots().iter())
                .map(|robot| {
                    let to_ball = robot.pose.to_body(ball);
                    let drive = Drive::Local(Twist {
                        linear: Vector::new(to_ball.x() * 3.0, to_ball.y() * 3.0),
                        angular: robot.pose.turn_to(ball).radians() * 5.0,
                    });
                    let speed = 2.0 + f32::from(robot.who.id.number()) * 0.5;
                    let angle = if robot.who.id.number() % 3 == 0 { 0.8 } else { 0.0 };
                    (
                        robot.who,
                        Order {
                            drive,
                            kick: Some(KickCommand { speed, angle }),
                            dribbler: 1.0,
                            discharge: false,
                        },
                    )
                })
                .collect();
            for (who, order) in orders {
                world.order(who, order);
            }
        }
        world.step();
        assert!(world.ball.position.is_finite() && world.ball.velocity.is_finite(), "step {step}");
    }
    trace.digits()
}

#[test]
fn the_same_seed_gives_the_same_match_and_another_seed_another() {
    let match_of = |seed| play(&mut busy(seed, 0..22), 3_000);
    assert_eq!(match_of(7), match_of(7));
    assert_ne!(match_of(7), match_of(8));
}

#[test]
fn the_order_of_placing_robots_has_no_effect() {
    let shuffled = (0..22_u32).map(|n| ((n * 13 + 5) % 22) as u8);
    assert_eq!(play(&mut busy(7, 0..22), 2_000), play(&mut busy(7, shuffled), 2_000));
}

#[test]
fn crowded_robots_do_not_overlap_and_their_kicks_are_events() {
    let mut world = busy(3, 0..22);
    let mut kicks = 0;
    for _ in 0..40 {
        play(&mut world, 100);
        let (mut events, robots) = (Vec::new(), world.robots());
        for (i, one) in robots.iter().enumerate() {
            for other in &robots[i + 1..] {
                let gap = one.pose.position.distance(other.pose.position) - 0.18;
                // Between 22 robots in contact an overlap of a millimetre or two remains.
                assert!(gap > -0.004, "{:?} and {:?}: {gap}", one.who, other.who);
            }
            let [x, y] = world.pitch().corner();
            assert!(one.pose.position.x().abs() <= x && one.pose.position.y().abs() <= y);
        }
        world.take_events(&mut events);
        kicks += events.iter().filter(|event| matches!(event, PhysicsEvent::Kicked { .. })).count();
    }
    assert!(kicks > 3, "{kicks}");
}

#[test]
fn a_removed_robot_has_no_effect() {
    let mut world = world();
    world.put(yellow(1), Pose::from_mm_deg(0.0, 0.0, 0.0));
    world.remove(yellow(1));
    assert!(world.sensors(yellow(1)).is_none());
    assert!(!world.order(yellow(1), local(1.0, 0.0, 0.0)));
    world.put_ball(Ball::rolling(Point::new(-0.5, 0.0), Vector::new(2.0, 0.0)));
    assert!(run(&mut world, 500).is_empty());
    assert!(world.ball.position.x() > 0.4);
}
