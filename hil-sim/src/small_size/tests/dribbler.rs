//! `dribbler`: tests: dribbler, kicker and break-beam sensor.

use super::*;

/// A robot in the middle, facing +x, the ball at its front.
fn with_ball() -> World {
    let mut world = world();
    let pose = Pose::from_mm_deg(0.0, 0.0, 0.0);
    world.put(yellow(1), pose);
    world.put_ball(Ball::at(dribbler_point(&world, pose)));
    world
}

fn kick(speed: f32, degrees: f32) -> Order {
    Order { kick: Some(KickCommand { speed, angle: degrees * 0.017_453_3 }), ..Order::default() }
}

#[test]
fn a_gently_driven_robot_keeps_the_ball_in_every_direction() {
    for gentle in [local(-1.0, 0.0, 0.0), local(1.0, 0.0, 0.0), local(0.0, 0.6, 0.0), local(0.0, 0.0, 3.0)] {
        let mut world = with_ball();
        // A brain accelerates by ramps: 2 m/s², 10 rad/s².
        for tenth in 1..=100 {
            let share = (tenth as f32 / 50.0).min(1.0);
            let Drive::Local(twist) = gentle.drive else { continue };
            let (v, w) = (twist.linear * share, twist.angular * share);
            lead(&mut world, yellow(1), dribble(local(v.x(), v.y(), w)), 10);
        }
        assert!(has_ball(&world), "{gentle:?}: {:?} {:?}", world.ball, world.robots()[0].pose);
    }
}

#[test]
fn hard_braking_loses_the_ball_without_speeding_it_up() {
    let mut world = with_ball();
    lead(&mut world, yellow(1), dribble(local(1.0, 0.0, 0.0)), 600);
    assert!(has_ball(&world));
    // Full braking while driving backwards pulls less than the roller holds; three times the traction does
    // not.
    world.alter(yellow(1), |robot| robot.set_limits(DriveParameters { brake: 16.0, ..*robot.limits() }));
    lead(&mut world, yellow(1), dribble(local(-2.0, 0.0, 0.0)), 600);
    assert!(!has_ball(&world));
    assert!(world.ball.velocity.norm() < 1.1, "no faster than it was carried: {:?}", world.ball);
}

#[test]
fn without_the_dribbler_the_ball_stays_behind() {
    let mut world = with_ball();
    lead(&mut world, yellow(1), local(-1.0, 0.0, 0.0), 500);
    assert!(!has_ball(&world) && world.ball.velocity.norm() < 0.01);
}

#[test]
fn a_soft_pass_is_caught_by_the_dribbler_and_a_hard_one_bounces() {
    let caught = |speed: f32| {
        let mut world = world();
        world.put(yellow(1), Pose::from_mm_deg(0.0, 0.0, 0.0));
        world.put_ball(Ball::rolling(Point::new(0.8, 0.005), Vector::new(-speed, 0.0)));
        lead(&mut world, yellow(1), dribble(Order::default()), 1_500);
        has_ball(&world)
    };
    assert!(caught(1.5) && !caught(7.5));
}

#[test]
fn a_kick_has_the_ordered_speed_and_needs_a_charged_kicker() {
    let mut world = with_ball();
    let events = lead(&mut world, yellow(1), kick(6.0, 0.0), 100);
    let kicks: Vec<_> = events.iter().filter(|event| matches!(event, PhysicsEvent::Kicked { .. })).collect();
    let [PhysicsEvent::Kicked { robot, speed, chip, velocity, .. }] = kicks[..] else { panic!("{events:?}") };
    assert_eq!((*robot, *speed, *chip, *velocity), (yellow(1), 6.0, false, Vector::new(6.0, 0.0)));
    let pose = world.robots()[0].pose;
    world.put_ball(Ball::at(dribbler_point(&world, pose)));
    assert!(!world.sensors(yellow(1)).unwrap().health.kicker_ready);
    let events = lead(&mut world, yellow(1), kick(6.0, 0.0), 300);
    assert!(!has_kick(&events), "not charged yet");
    let events = lead(&mut world, yellow(1), kick(6.0, 0.0), 200);
    assert!(has_kick(&events), "charged after half a second");
}

#[test]
fn a_kick_needs_the_ball_and_an_order_that_has_not_expired() {
    let mut world = with_ball();
    world.put_ball(Ball::at(Point::new(0.15, 0.0)));
    assert!(!has_kick(&lead(&mut world, yellow(1), kick(6.0, 0.0), 200)));
    let mut world = with_ball();
    let pose = world.robots()[0].pose;
    world.put_ball(Ball::at(Point::new(1.0, 1.0)));
    world.order(yellow(1), kick(6.0, 0.0));
    run(&mut world, 150);
    world.put_ball(Ball::at(dribbler_point(&world, pose)));
    assert!(!has_kick(&run(&mut world, 100)), "the order is old");
}

#[test]
fn a_chip_of_45_degrees_lands_at_the_ballistic_range() {
    let mut world = with_ball();
    let start = world.ball.position.x();
    world.order(yellow(1), kick(5.0, 45.0));
    let mut landed = None;
    for _ in 0..2_000 {
        for event in run(&mut world, 1) {
            if let (PhysicsEvent::Landed(at), None) = (event, landed) {
                landed = Some(at);
            }
        }
    }
    // v²·sin 90°/g = 25/9.81 = 2.548 m.
    let length = landed.unwrap().x() - start;
    assert!((length - 2.548).abs() < 0.01, "{length}");
}

#[test]
fn a_ball_kicked_from_a_turning_dribbler_slides_like_any_other() {
    let comes_to = |order: Order| {
        let mut world = with_ball();
        lead(&mut world, yellow(1), order, 10);
        run(&mut world, 9_000);
        assert_eq!(world.ball.velocity.norm(), 0.0);
        world.ball.position.x()
    };
    let (still, turning) = (comes_to(kick(2.0, 0.0)), comes_to(dribble(kick(2.0, 0.0))));
    // 2 m/s slide to 5/7 of that: (4 - 2.041)/7.8 + 2.041/0.7 = 3.17 m; a ball that rolled at once would come
    // 5.7 m.
    assert!((still - 0.0945 - 3.17).abs() < 0.05, "{still}");
    assert!((still - turning).abs() < 0.15, "{still} {turning}");
}

#[test]
fn kicks_scatter_with_the_configured_deviation_within_the_limit() {
    let mut parameters = exact();
    (parameters.kick.speed_sd, parameters.kick.angle_sd_deg) = (0.02, 1.0);
    let mut world = World::new(League::DivisionB, &parameters, 5);
    let pose = Pose::from_mm_deg(0.0, 0.0, 0.0);
    let (mut speeds, mut angles) = (Vec::new(), Vec::new());
    for _ in 0..300 {
        world.put(yellow(1), pose);
        world.put_ball(Ball::at(dribbler_point(&world, pose)));
        for event in lead(&mut world, yellow(1), kick(5.0, 0.0), 501) {
            if let PhysicsEvent::Kicked { speed, velocity, .. } = event {
                speeds.push(speed);
                angles.push(velocity.angle().to_degrees());
            }
        }
    }
    assert_eq!(speeds.len(), 300);
    assert!(speeds.iter().all(|v| (4.8..=5.2).contains(v)) && angles.iter().all(|a| a.abs() <= 2.0));
    let sd = |values: &[f32], mean: f32| {
        geometry::math::sqrt(values.iter().map(|v| (v - mean) * (v - mean)).sum::<f32>() / 300.0)
    };
    // A normal cut at two deviations has 0.88 of its deviation; standard error 1/√600 = 4 %.
    assert!((sd(&speeds, 5.0) / 0.1 - 0.88).abs() < 0.14 && (sd(&angles, 0.0) - 0.88).abs() < 0.14);
}

#[test]
fn dribbling_counts_from_the_first_touch_to_visible_separation() {
    let mut world = with_ball();
    let start = world.ball.position;
    lead(&mut world, yellow(1), dribble(local(0.8, 0.0, 0.0)), 700);
    let from = world.robot(yellow(1)).unwrap().dribbling_from.unwrap();
    assert!(from.distance(start) < 0.01, "{from:?}");
    assert!(from.distance(world.ball.position) > 0.3);
    assert_eq!(world.last_touch().map(|(who, _)| who), Some(yellow(1)));
    world.put_ball(Ball::at(Point::new(2.0, 2.0)));
    run(&mut world, 1);
    assert_eq!(world.robot(yellow(1)).unwrap().dribbling_from, None);
}

#[test]
fn a_discharged_kicker_kicks_only_after_charging_again() {
    let mut world = with_ball();
    let frame = ActuatorFrame::Omni {
        wheels: [0.0; 4],
        dribbler: 0.0,
        kick: protocol::robot_io::OmniKick::Discharge,
    };
    world.command(yellow(1), &frame);
    assert!(!world.sensors(yellow(1)).unwrap().health.kicker_ready);
    assert!(!has_kick(&lead(&mut world, yellow(1), kick(3.0, 0.0), 480)));
    assert!(has_kick(&lead(&mut world, yellow(1), kick(3.0, 0.0), 40)));
}
