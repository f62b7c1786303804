//! `ball`: tests: the ball bounces on robots, goals and boards, and passes through nothing.

use super::*;

#[test]
fn at_8_m_per_s_the_ball_tunnels_through_no_robot() {
    // Head-on and grazing, flat front and back, in steps of a tenth of a millimetre over one step's 8 mm.
    for (heading, offset) in
        [(180.0, 0.0), (0.0, 0.0), (90.0, 0.0), (180.0, 0.05), (0.0, 0.1), (45.0, -0.105)]
    {
        for phase in 0..80 {
            let mut world = world();
            world.put(yellow(1), Pose::from_mm_deg(0.0, 0.0, heading));
            let start = -0.5 - phase as f32 * 0.0001;
            world.put_ball(Ball::rolling(Point::new(start, offset), Vector::new(8.0, 0.0)));
            let mut nearest = f32::MAX;
            for _ in 0..120 {
                world.step();
                nearest = nearest.min(overlap(&world));
            }
            assert!(nearest > -1e-4, "heading {heading}, offset {offset}, phase {phase}: {nearest}");
            let through = world.ball.velocity.x() > 7.9;
            assert!(!through, "heading {heading}, offset {offset}, phase {phase}: {:?}", world.ball);
        }
    }
}

/// Distance between ball and hull, negative where they overlap.
fn overlap(world: &World) -> f32 {
    let robot = &world.robots()[0];
    let own = robot.to_body(world.ball.position - robot.pose.position);
    surface::hull(&robot.body, robot.half_front, own).distance - 0.0215
}

#[test]
fn at_8_m_per_s_the_ball_tunnels_through_no_goal_wall() {
    for phase in 0..80 {
        for y in [0.0, 0.3, -0.47] {
            let mut world = world();
            world.put_ball(Ball::rolling(Point::new(4.0 - phase as f32 * 0.0001, y), Vector::new(8.0, 1.0)));
            let mut hits = 0;
            for _ in 0..400 {
                hits += run(&mut world, 1).len();
                let p = world.ball.position;
                let inside = p.x() < 4.5 || p.y().abs() < 0.5;
                assert!(p.x() < 4.68 && inside, "phase {phase}, y {y}: {p:?}");
            }
            assert!(hits > 0, "phase {phase}, y {y}");
        }
    }
}

#[test]
fn a_post_sends_the_ball_back_into_the_field() {
    let mut world = world();
    world.put_ball(Ball::rolling(Point::new(4.0, 0.51), Vector::new(4.0, 0.0)));
    let events = run(&mut world, 400);
    assert!(matches!(events[..], [PhysicsEvent::GoalHit { speed, .. }] if speed > 3.8), "{events:?}");
    assert!(world.ball.velocity.x() < 0.0 && world.ball.position.x() < 4.5, "{:?}", world.ball);
}

#[test]
fn a_ball_bounces_off_a_robots_back_with_the_hulls_restitution() {
    let mut world = world();
    world.put(yellow(1), Pose::from_mm_deg(0.0, 0.0, 0.0));
    world.put_ball(Ball { velocity: Vector::new(2.0, 0.0), ..Ball::at(Point::new(-0.2, 0.0)) });
    let mut fastest = 0.0_f32;
    for _ in 0..100 {
        world.order(yellow(1), Order::default());
        world.step();
        fastest = fastest.max(-world.ball.velocity.x());
    }
    // It hits with √(4 − 2·3.9·0.0885) = 1.820 m/s; 0.4 and 2.5/(2.5 + 0.046) of (1 + e): 1.4·0.98193 − 1 =
    // 0.3747 of it.
    assert!((fastest - 1.820 * 0.374_7).abs() < 0.01, "{fastest}");
    let robot = world.robot(yellow(1)).unwrap();
    assert!(robot.pose.position.x() > 0.0, "the robot took the rest, and brakes: {:?}", robot.pose);
}

#[test]
fn a_chip_flies_over_a_robot_and_a_flat_kick_does_not() {
    let crossed = |ball: Ball| {
        let mut world = world();
        world.put(blue(1), Pose::from_mm_deg(0.0, 0.0, 0.0));
        world.put_ball(ball);
        run(&mut world, 600);
        world.ball.position.x() > 0.3
    };
    let from = Point::new(-0.6, 0.0);
    assert!(!crossed(Ball::rolling(from, Vector::new(4.0, 0.0))));
    assert!(crossed(Ball { velocity: Vector::new(3.0, 0.0), climb: 3.0, ..Ball::at(from) }));
    // Too low: 0.6 m take 0.2 s at 3 m/s, after which a climb of 1.2 m/s gives a height of only 0.044 m.
    assert!(!crossed(Ball { velocity: Vector::new(3.0, 0.0), climb: 1.2, ..Ball::at(from) }));
}

#[test]
fn a_ball_that_falls_on_a_robot_does_not_stay_there() {
    let mut world = world();
    world.put(blue(1), Pose::from_mm_deg(0.0, 0.0, 0.0));
    world.put_ball(Ball { height: 0.5, ..Ball::at(Point::new(0.01, 0.02)) });
    let events = run(&mut world, 2_000);
    assert!(events.iter().any(|event| matches!(event, PhysicsEvent::Touched { .. })));
    assert!(world.ball.height == 0.0 && overlap(&world) >= -1e-4, "{:?}", world.ball);
}

#[test]
fn the_bar_sends_a_chip_back_and_a_higher_one_passes_above_the_goal() {
    let ball = |height| Ball { velocity: Vector::new(3.0, 0.0), height, ..Ball::at(Point::new(4.4, 0.0)) };
    let mut world = world();
    world.put_ball(ball(0.155));
    let events = run(&mut world, 40);
    assert!(matches!(events[..], [PhysicsEvent::GoalHit { .. }]), "{events:?}");
    assert!(world.ball.velocity.x() < -1.0);
    world.put_ball(Ball { climb: 1.0, ..ball(0.3) });
    let events = run(&mut world, 90);
    assert!(events.is_empty() && world.ball.position.x() > 4.6, "{events:?} {:?}", world.ball);
}

#[test]
fn boards_hold_a_rolling_ball_and_a_flying_one_leaves() {
    let mut world = world();
    world.put_ball(Ball::rolling(Point::new(0.0, 2.0), Vector::new(0.5, 6.0)));
    let events = run(&mut world, 3_000);
    assert!(events.iter().any(|event| matches!(event, PhysicsEvent::BoardHit(_))));
    assert!(world.ball.position.y() < 3.3);
    world.put_ball(Ball { velocity: Vector::new(0.0, 5.0), climb: 2.0, ..Ball::at(Point::new(0.0, 2.5)) });
    run(&mut world, 5_000);
    let y = world.ball.position.y();
    assert!(y > 3.3 && y <= 5.3, "outside, where a person fetches it: {y}");
}

#[test]
fn a_ball_squeezed_between_two_robots_stays_slow() {
    let mut world = world();
    world.put(yellow(1), Pose::from_mm_deg(-200.0, 0.0, 0.0));
    world.put(blue(1), Pose::from_mm_deg(200.0, 3.0, 180.0));
    world.put_ball(Ball::at(Point::new(0.0, 0.0)));
    for _ in 0..2_000 {
        world.order(yellow(1), dribble(local(1.5, 0.0, 0.0)));
        world.order(blue(1), dribble(local(1.5, 0.0, 0.0)));
        world.step();
        assert!(world.ball.velocity.norm() < 4.0, "{:?}", world.ball);
    }
    let gap = world.robots()[0].pose.position.distance(world.robots()[1].pose.position);
    assert!(gap > 0.17, "{gap}");
}

#[test]
fn the_simulator_makes_room_for_a_ball_and_pulls_ball_and_robot() {
    let mut world = world();
    world.put(yellow(1), Pose::from_mm_deg(50.0, 0.0, 0.0));
    world.put_ball(Ball::at(Point::new(0.0, 0.0)));
    world.make_room_for_ball();
    assert!(overlap(&world) >= 0.0 && world.robots()[0].pose.position.x() > 0.11);
    world.drag_ball(Point::new(-0.5, 0.0));
    run(&mut world, 500);
    world.drag_ball(Point::new(-0.5, 0.0));
    run(&mut world, 500);
    assert!(world.ball.position.distance(Point::new(-0.5, 0.0)) < 0.003, "{:?}", world.ball);
    world.drag_robot(yellow(1), Point::new(1.0, 0.0), Some(Angle::degrees(90.0)));
    run(&mut world, 500);
    world.drag_robot(yellow(1), Point::new(1.0, 0.0), Some(Angle::degrees(90.0)));
    run(&mut world, 500);
    let pose = world.robots()[0].pose;
    assert!(
        pose.position.distance(Point::new(1.0, 0.0)) < 0.05 && (pose.heading.to_degrees() - 90.0).abs() < 3.0
    );
}

#[test]
fn the_fastest_ball_hits_a_robot_at_any_phase_of_the_neighbour_search() {
    for phase in 0..24 {
        let mut world = world();
        world.put(yellow(1), Pose::from_mm_deg(0.0, 0.0, 180.0)).push(Vector::new(-3.0, 0.0), 0.0);
        run(&mut world, phase);
        world.put_ball(Ball::rolling(Point::new(-1.0, 0.0), Vector::new(20.0, 0.0)));
        let events = run(&mut world, 60);
        assert!(matches!(events[..], [PhysicsEvent::Touched { .. }, ..]), "phase {phase}: {events:?}");
        assert!(world.ball.velocity.x() < 0.0, "phase {phase}: {:?}", world.ball);
    }
}
