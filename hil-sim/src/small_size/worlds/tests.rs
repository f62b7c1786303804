//! Tests: the physics behaves as a world of the family states. One test per quantity, by hand calculations.

mod family;
mod robots;
mod vision;

use geometry::{Point, Pose, Vector};
use protocol::robot_io::{ActuatorFrame, OmniKick};
use protocol::{RobotId, Who};
use rules::League;

use super::*;
use crate::small_size::tests::{dribble, dribbler_point, has_ball, local, yellow};
use crate::small_size::{Ball, KickCommand, NoiseParameters, Order, PhysicsEvent, World};

/// Division B without randomness, changed.
fn model(change: impl FnOnce(&mut WorldModel)) -> WorldModel {
    let mut model = WorldModel::of(League::DivisionB, &WorldChoice::Nominal).unwrap();
    model.parameters.noise = NoiseParameters::NONE;
    (model.parameters.kick.speed_sd, model.parameters.kick.angle_sd_deg) = (0.0, 0.0);
    change(&mut model);
    assert_eq!(model.check(), Ok(()));
    model
}

/// A robot in the middle that faces +x with the ball at its front.
fn with_ball(change: impl FnOnce(&mut WorldModel)) -> World {
    let model = model(change);
    let mut world = World::of_model(League::DivisionB, &model, 1);
    world.put(yellow(1), Pose::from_mm_deg(0.0, 0.0, 0.0));
    world.put_ball(Ball::at(dribbler_point(&world, Pose::default())));
    world
}

/// Leads yellow's robot 1.
fn lead(world: &mut World, order: Order, steps: u32) -> Vec<PhysicsEvent> {
    crate::small_size::tests::lead(world, yellow(1), order, steps)
}

/// The robot accelerates uniformly to that velocity of its own frame, its dribbler turning.
fn pull(world: &mut World, to: [f32; 2], acceleration: f32) {
    let most = geometry::math::hypot(to[0], to[1]);
    let ticks = (most / acceleration * 100.0) as u32;
    for tick in 1..=ticks {
        let share = tick as f32 / ticks as f32;
        lead(world, dribble(local(to[0] * share, to[1] * share, 0.0)), 10);
    }
}

/// The speeds with which that robot's kicks leave.
fn kick_of(world: &mut World, who: Who, speed: f32, angle: f32) -> f32 {
    let order = Order { kick: Some(KickCommand { speed, angle }), ..Order::default() };
    let pose = world.robot(who).unwrap().pose;
    world.put_ball(Ball::at(dribbler_point(world, pose)));
    let mut events = Vec::new();
    for _ in 0..1_100 {
        world.order(who, order);
        world.step();
        world.take_events(&mut events);
    }
    let kicked = events.iter().find_map(|event| match event {
        PhysicsEvent::Kicked { speed, robot, .. } if *robot == who => Some(*speed),
        _ => None,
    });
    kicked.expect("it had the ball")
}

fn wheels(rims: [f32; 4]) -> ActuatorFrame {
    ActuatorFrame::Omni { wheels: rims, dribbler: 0.0, kick: OmniKick::None }
}

#[test]
fn a_dribbler_keeps_the_ball_up_to_the_acceleration_of_its_pull() {
    // Pull and side of the dribbler, speed and acceleration backwards, kept. The field surface takes 0.35
    // m/s² of a pull of 1, and each hop off the front removes the ball's roll; without a pull the ball stays
    // behind.
    for (of_pull, of_side, speed, acceleration, kept) in [
        (0.5, None, 1.5, 3.0, false),
        (2.0, None, 1.5, 3.0, false),
        (6.0, None, 1.5, 3.0, true),
        (1.0, None, 0.4, 0.4, true),
        (0.0, Some(0.0), 0.5, 0.5, false),
    ] {
        let mut world = with_ball(|model| {
            let dribbler = &mut model.parameters.dribbler;
            (dribbler.pull, dribbler.side) = (of_pull, of_side.unwrap_or(dribbler.side));
        });
        pull(&mut world, [-speed, 0.0], acceleration);
        assert_eq!(has_ball(&world), kept, "{of_pull}: {:?}", world.ball);
        assert!(of_pull > 0.0 || world.ball.velocity.norm() < 0.01, "{:?}", world.ball);
    }
}

#[test]
fn a_fading_dribbler_keeps_a_slow_ball_and_loses_a_fast_one() {
    let fading = |speed: f32| {
        let mut world = with_ball(|model| {
            (model.parameters.dribbler.pull, model.parameters.dribbler.fade) = (3.0, 0.4);
        });
        pull(&mut world, [-speed, 0.0], 0.5);
        lead(&mut world, dribble(local(-speed, 0.0, 0.0)), 300);
        has_ball(&world)
    };
    // At 2.2 m/s 3 · (1 − 0.88) = 0.36 m/s² are left, of which the field surface takes 0.35: half a m/s² more
    // is too much.
    assert!(fading(1.0) && !fading(2.2));
}

#[test]
fn a_perfect_dribbler_keeps_the_ball_in_every_motion() {
    let perfect = |model: &mut WorldModel| {
        (model.parameters.dribbler.pull, model.parameters.dribbler.side) = (PERFECT_PULL, PERFECT_PULL);
        (model.parameters.drive.forward, model.parameters.drive.side) = (7.0, 7.0);
        model.parameters.drive.brake = 7.0;
    };
    for twist in [local(-2.5, 0.0, 0.0), local(2.5, 0.0, 0.0), local(0.0, 2.0, 0.0), local(0.0, 0.0, 12.0)] {
        let mut world = with_ball(perfect);
        lead(&mut world, dribble(twist), 500);
        assert!(has_ball(&world), "{twist:?}: {:?}", world.ball);
        lead(&mut world, dribble(local(0.0, 0.0, 0.0)), 500);
        assert!(has_ball(&world), "{twist:?}, braking: {:?}", world.ball);
        let gap = world.robot(yellow(1)).unwrap().pose.to_body(world.ball.position).x() - 0.0945;
        assert!(gap.abs() < 0.002, "{gap}");
    }
}

#[test]
fn a_dribbler_holds_the_ball_within_its_width() {
    for (mouth, kept) in [(0.025, false), (0.040, true)] {
        let mut world = with_ball(|model| {
            (model.parameters.robot.mouth, model.parameters.dribbler.center) = (mouth, 0.0);
        });
        world.put_ball(Ball::at(Point::new(0.0946, 0.032)));
        pull(&mut world, [-0.5, 0.0], 1.0);
        assert_eq!(has_ball(&world), kept, "{mouth}: {:?}", world.ball);
    }
}

#[test]
fn front_and_turning_dribbler_have_restitutions_of_their_own() {
    let comes_back = |dribbler: f32| {
        let mut world = with_ball(|model| {
            (model.parameters.bounce.front, model.parameters.bounce.dribbling) = (0.6, 0.2);
            model.parameters.dribbler.pull = 0.0;
        });
        world.put_ball(Ball::rolling(Point::new(0.3, 0.0), Vector::new(-2.0, 0.0)));
        let mut fastest = 0.0_f32;
        for _ in 0..200 {
            lead(&mut world, Order { dribbler, ..Order::default() }, 1);
            fastest = fastest.max(world.ball.velocity.x());
        }
        fastest
    };
    // It hits the front at 1.96 m/s; robot and ball share the impact as 2.5 kg and 46 g do.
    let (still, turning) = (comes_back(0.0), comes_back(1.0));
    assert!((still - 0.6 * 1.96).abs() < 0.06, "{still}");
    assert!((turning - 0.2 * 1.96).abs() < 0.06, "{turning}");
}

#[test]
fn rolling_distance_and_end_of_sliding_follow_the_friction_parameters() {
    let mut world = with_ball(|model| model.parameters.ball.roll = 0.8);
    world.put_ball(Ball::rolling(Point::new(1.0, 1.0), Vector::new(1.0, 0.0)));
    (0..2_000).for_each(|_| world.step());
    // 1²/(2 · 0.8).
    assert!((world.ball.position.x() - 1.625).abs() < 0.002, "{:?}", world.ball);
    let after = |slide: f32| {
        let mut world = with_ball(|model| model.parameters.ball.slide = slide);
        kick_of(&mut world, yellow(1), 0.5, 0.0);
        world.put_ball(Ball { velocity: Vector::new(6.0, 0.0), ..Ball::at(Point::new(0.0, 1.0)) });
        (0..125).for_each(|_| world.step());
        world.ball.velocity.x()
    };
    // 6 m/s lose 2/7 within 6 · 2/7 / 14 = 0.122 s; at 3.9 m/s² they have lost 0.49 m/s by then.
    assert!((after(14.0) - 4.285).abs() < 0.01, "{}", after(14.0));
    assert!((after(3.9) - 5.51).abs() < 0.01, "{}", after(3.9));
}

#[test]
fn a_heavy_ball_pushes_its_kicker_back_harder_than_a_light_one() {
    let recoil = |mass: f32| {
        let mut world = with_ball(|model| model.parameters.ball.mass = mass);
        world.order(
            yellow(1),
            Order { kick: Some(KickCommand { speed: 5.0, angle: 0.0 }), ..Order::default() },
        );
        world.step();
        world.robot(yellow(1)).unwrap().velocity.x()
    };
    // 46 g · 5 m/s over 2.5 kg.
    assert!((recoil(0.046) + 0.092).abs() < 1e-4 && (recoil(0.040) + 0.080).abs() < 1e-4);
}
