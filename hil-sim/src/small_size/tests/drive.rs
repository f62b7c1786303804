//! `drive`: tests: how robots accelerate, stop, turn and push each other.

use super::*;

#[test]
fn two_metres_from_rest_take_the_time_of_acceleration_and_top_speed() {
    let mut world = world();
    world.put(yellow(1), Pose::from_mm_deg(-1000.0, 0.0, 0.0));
    let mut steps = 0;
    while world.robot(yellow(1)).unwrap().pose.position.x() < 1.0 && steps < 3_000 {
        lead(&mut world, yellow(1), local(3.0, 0.0, 0.0), 10);
        steps += 10;
    }
    // 4.5 m/s² to 3 m/s: 1 m in 0.667 s; 1 m more at 3 m/s: 0.333 s. Exactly 1 s for a body with immediate
    // traction; motors are stronger than traction, so no more than two control steps are lost.
    assert!((1_000..=1_020).contains(&steps), "{steps}");
}

#[test]
fn the_braking_distance_is_that_of_the_configured_brake() {
    let mut world = world();
    world.put(yellow(1), Pose::from_mm_deg(0.0, 0.0, 0.0)).push(Vector::new(3.0, 0.0), 0.0);
    lead(&mut world, yellow(1), Order::default(), 1_000);
    let robot = world.robot(yellow(1)).unwrap();
    // 9/(2·5.5) = 0.818 m; the front wheels give 40 m/s² at the rim, far more than the brakes.
    assert!((robot.pose.position.x() - 0.818).abs() < 0.01, "{:?}", robot.pose);
    assert!(robot.velocity.norm() < 1e-3);
}

#[test]
fn a_robot_accelerates_less_to_the_side() {
    let length = |x, y| {
        let mut world = world();
        world.put(yellow(1), Pose::from_mm_deg(0.0, 0.0, 0.0));
        lead(&mut world, yellow(1), local(x, y, 0.0), 500);
        world.robot(yellow(1)).unwrap().pose.position.distance(Point::new(0.0, 0.0))
    };
    // ½·4.5·0.25 = 0.5625 m and ½·3.5·0.25 = 0.4375 m.
    assert!((length(3.0, 0.0) - 0.5625).abs() < 0.01, "{}", length(3.0, 0.0));
    assert!((length(0.0, 3.0) - 0.4375).abs() < 0.01, "{}", length(0.0, 3.0));
}

#[test]
fn a_global_velocity_holds_its_course_while_the_robot_turns() {
    let mut world = world();
    world.put(yellow(1), Pose::from_mm_deg(0.0, 0.0, 0.0));
    let drive = Drive::Global(Twist { linear: Vector::new(1.0, 0.0), angular: 6.0 });
    lead(&mut world, yellow(1), Order { drive, ..Order::default() }, 2_000);
    let robot = world.robot(yellow(1)).unwrap();
    assert!(robot.pose.position.x() > 1.5 && robot.pose.position.y().abs() < 0.1, "{:?}", robot.pose);
    assert!((robot.turning - 6.0).abs() < 0.05);
}

#[test]
fn rim_speeds_on_the_wires_order_drive_ahead() {
    let mut world = world();
    world.put(blue(2), Pose::from_mm_deg(0.0, 0.0, 90.0));
    let wheels = [0.866, 0.707, -0.707, -0.866];
    for _ in 0..100 {
        let frame = ActuatorFrame::Omni { wheels, dribbler: 0.0, kick: protocol::robot_io::OmniKick::None };
        assert!(world.command(blue(2), &frame));
        run(&mut world, 10);
    }
    let robot = world.robot(blue(2)).unwrap();
    assert!((robot.velocity - Vector::new(0.0, 1.0)).norm() < 0.01, "{:?}", robot.velocity);
}

#[test]
fn speed_and_acceleration_limits_hold_for_every_order() {
    let mut world = world();
    world.put(yellow(1), Pose::from_mm_deg(-4000.0, -2000.0, 20.0));
    for step in 0..1_500 {
        world.order(yellow(1), local(1e9, -1e9, 1e9));
        let before = world.robot(yellow(1)).unwrap().velocity;
        world.step();
        let robot = world.robot(yellow(1)).unwrap();
        assert!(robot.velocity.norm() < 3.5001 && robot.turning.abs() <= 15.0, "step {step}");
        let at_board = run(&mut world, 0).len() + usize::from(robot_is_at_a_board(&world));
        let change = (world.robot(yellow(1)).unwrap().velocity - before).norm();
        assert!(change < 5.5 * 0.00101 || at_board > 0, "{change}");
    }
    world.order(yellow(1), local(f32::NAN, 0.0, 0.0));
    run(&mut world, 1_500);
    assert!(world.robot(yellow(1)).unwrap().velocity.norm() < 1e-3, "what is no number means: brake");
}

fn robot_is_at_a_board(world: &World) -> bool {
    let ([x, y], p) = (world.pitch().corner(), world.robots()[0].pose.position);
    p.x().abs() > x - 0.095 || p.y().abs() > y - 0.095
}

#[test]
fn a_robot_brakes_after_100_ms_without_orders() {
    let mut world = world();
    world.put(yellow(1), Pose::from_mm_deg(0.0, 0.0, 0.0));
    lead(&mut world, yellow(1), local(1.0, 0.0, 0.0), 1_000);
    run(&mut world, 85);
    assert!((world.robot(yellow(1)).unwrap().velocity.norm() - 1.0).abs() < 0.02);
    run(&mut world, 230);
    // The last order came 10 ms before; 1 m/s at 5.5 m/s² is gone 182 ms after it ran out.
    assert!(world.robot(yellow(1)).unwrap().velocity.norm() < 1e-3);
}

#[test]
fn a_crash_is_one_event_with_the_projected_closing_speed() {
    let mut world = world();
    world.put(yellow(1), Pose::from_mm_deg(-300.0, 0.0, 0.0)).push(Vector::new(2.0, 0.0), 0.0);
    world.put(blue(1), Pose::from_mm_deg(300.0, 90.0, 180.0)).push(Vector::new(-1.0, 0.0), 0.0);
    let mut crashes = Vec::new();
    for _ in 0..60 {
        world.order(yellow(1), local(2.0, 0.0, 0.0));
        world.order(blue(1), local(1.0, 0.0, 0.0));
        crashes.extend(run(&mut world, 10));
    }
    let [PhysicsEvent::Crash { robots, closing, velocities, .. }] = crashes[..] else {
        panic!("{crashes:?}")
    };
    assert_eq!(robots, [yellow(1), blue(1)]);
    // With an offset of half a diameter the line between them is at 30° to their course: 3 m/s · cos 30°.
    assert!((closing - 2.598).abs() < 0.02, "{closing}");
    assert!((velocities[0].x() - 2.0).abs() < 0.05, "{velocities:?}");
}

#[test]
fn two_free_robots_keep_their_momentum_in_a_collision() {
    let mut parameters = exact();
    // No traction: only the impact changes their speeds.
    (parameters.drive.forward, parameters.drive.side, parameters.drive.brake) = (0.1, 0.1, 0.1);
    let mut world = World::new(League::DivisionB, &parameters, 1);
    world.put_ball(Ball::at(Point::new(0.0, 2.5)));
    world.put(yellow(1), Pose::from_mm_deg(-100.0, 30.0, 0.0)).push(Vector::new(2.0, 0.0), 0.0);
    world.put(blue(1), Pose::from_mm_deg(100.0, 0.0, 180.0));
    run(&mut world, 30);
    let [one, two] = [world.robots()[0].velocity, world.robots()[1].velocity];
    assert!((one + two - Vector::new(2.0, 0.0)).norm() < 0.01, "{one:?} {two:?}");
    assert!(two.x() > 0.9, "the second one was hit: {two:?}");
}

#[test]
fn sensor_frames_have_odometry_and_health_but_no_position() {
    let mut parameters = exact();
    parameters.battery.energy = 1_000.0;
    let mut world = World::new(League::DivisionB, &parameters, 1);
    world.put(yellow(1), Pose::from_mm_deg(1000.0, 1000.0, 30.0));
    lead(&mut world, yellow(1), local(1.0, -0.5, 2.0), 1_000);
    world.sensors(yellow(1));
    lead(&mut world, yellow(1), local(1.0, -0.5, 2.0), 10);
    let seen = world.sensors(yellow(1)).unwrap();
    assert!(seen.pose.is_none() && seen.ball.is_none() && seen.opponents.is_empty());
    assert!(
        (seen.odometry.linear - Vector::new(1.0, -0.5)).norm() < 1e-3
            && (seen.odometry.angular - 2.0).abs() < 1e-3
    );
    let volts = seen.health.battery.unwrap();
    // Some 45 W for a second of 1,000 J from 16.8 to 14.0 V.
    assert!((volts - 16.67).abs() < 0.025, "{volts}");
    assert!(seen.health.kicker_ready && !seen.health.tipped);
    world.tip(yellow(1), true);
    lead(&mut world, yellow(1), local(1.0, 0.0, 0.0), 600);
    assert!(world.robot(yellow(1)).unwrap().velocity.norm() < 1e-3, "who lies on the side drives nowhere");
    assert!(world.sensors(yellow(1)).unwrap().health.tipped);
}

#[test]
fn boards_and_goal_walls_stop_robots() {
    let mut world = world();
    world.put(yellow(1), Pose::from_mm_deg(4400.0, 0.0, 0.0));
    lead(&mut world, yellow(1), local(2.0, 0.0, 0.0), 1_000);
    // The goal is 180 mm deep: back wall at 4.68 m.
    let x = world.robot(yellow(1)).unwrap().pose.position.x();
    assert!((x - 4.59).abs() < 0.003, "{x}");
    world.put(blue(1), Pose::from_mm_deg(0.0, 3100.0, 90.0));
    lead(&mut world, blue(1), local(2.0, 0.0, 0.0), 1_000);
    let y = world.robot(blue(1)).unwrap().pose.position.y();
    assert!((y - 3.21).abs() < 0.003, "{y}");
}
