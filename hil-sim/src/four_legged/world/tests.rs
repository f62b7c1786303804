//! Tests of the physics, against hand calculations and counted frequencies.

use geometry::{Pose, Twist, Vector};
use protocol::robot_io::{LeggedKick, LeggedPrimitive};

use super::*;

/// An attacker at the origin facing +x, the ball in its grasp, and the robots `others`.
fn world(seed: u64, others: &[Walker]) -> LeggedWorld {
    let mut walkers = vec![Walker::at(Side::Attackers, Pose::default())];
    walkers.extend_from_slice(others);
    LeggedWorld::new(Parameters::four_legged(), seed, Point::new(0.15, 0.0), walkers)
}

fn order(world: &mut LeggedWorld, primitive: LeggedPrimitive) {
    walk(world, Twist::default(), primitive);
}

fn walk(world: &mut LeggedWorld, walk: Twist<geometry::Body>, primitive: LeggedPrimitive) {
    world.command(0, &ActuatorFrame::Legged { walk, primitive });
}

/// Runs for `seconds`; returns all events.
fn run(world: &mut LeggedWorld, seconds: f32) -> Vec<WorldEvent> {
    let steps = (seconds / STEP + 0.5) as u32;
    let mut events = Vec::new();
    (0..steps).for_each(|_| world.step());
    world.take_events(&mut events);
    events
}

/// A world whose first robot holds the ball.
fn holding(others: &[Walker]) -> LeggedWorld {
    (0..100)
        .map(|seed| {
            let mut world = world(seed, others);
            order(&mut world, LeggedPrimitive::Grab);
            run(&mut world, 0.5);
            world
        })
        .find(|world| world.holder() == Some(0))
        .unwrap()
}

fn opponent(x: f32, y: f32, heading: f32) -> Walker {
    Walker::at(Side::Opponents, Pose::from_mm_deg(x, y, heading))
}

#[test]
fn grabs_have_the_configured_success_and_duration() {
    let mut kept = 0_u32;
    for seed in 0..2_000 {
        let mut world = world(seed, &[]);
        order(&mut world, LeggedPrimitive::Grab);
        assert!(run(&mut world, 0.49).is_empty());
        match run(&mut world, 0.01)[..] {
            [WorldEvent::Grabbed { robot: 0 }] => kept += 1,
            [WorldEvent::GrabFailed { robot: 0 }] => assert_eq!(world.holder(), None),
            ref other => panic!("{other:?}"),
        }
    }
    // Binomial deviation √(2000·¾·¼) = 19.4; four of them.
    assert!(kept.abs_diff(1_500) < 78, "{kept}");
}

#[test]
fn a_ball_behind_the_robot_or_too_fast_is_not_grabbed() {
    for (place, velocity) in [((-0.17, 0.0), (0.0, 0.0)), ((0.2, 0.0), (0.0, 0.0)), ((0.16, 0.0), (0.0, 0.9))]
    {
        for seed in 0..8 {
            let mut world = world(seed, &[]);
            world.ball.position = Point::new(place.0, place.1);
            world.ball.velocity = Vector::new(velocity.0, velocity.1);
            order(&mut world, LeggedPrimitive::Grab);
            assert!(run(&mut world, 0.5).contains(&WorldEvent::GrabFailed { robot: 0 }));
        }
    }
}

#[test]
fn a_robot_carries_the_ball_at_half_speed() {
    let mut world = holding(&[]);
    walk(&mut world, Twist { linear: Vector::new(1.0, 0.0), angular: 0.0 }, LeggedPrimitive::None);
    run(&mut world, 4.0);
    // 0.15 m/s after 0.25 s of acceleration: 4·0.15 − ½·0.25·0.15 = 0.581 m.
    let robot = world.walkers[0].pose.position.x();
    assert!((robot - 0.581).abs() < 0.003, "{robot}");
    assert!((world.ball.position.x() - robot - 0.13).abs() < 1e-6);
}

#[test]
fn kicks_have_the_configured_distance_and_scatter() {
    let start = holding(&[]);
    let mut rests = Vec::new();
    for seed in 0..400 {
        let mut world = start.clone();
        world.kicks = Stream::new(seed, "kicks");
        order(&mut world, LeggedPrimitive::Kick(LeggedKick::ForwardHard));
        let events = run(&mut world, 0.4);
        let Some(WorldEvent::Kicked { from, rest, .. }) = events.last() else { panic!("{events:?}") };
        run(&mut world, 6.0);
        assert!(world.ball.position.distance(*rest) < 2e-3 || !world.field.contains(*rest));
        rests.push(*rest - *from);
    }
    let n = rests.len() as f32;
    let mean = rests.iter().map(|r| r.norm()).sum::<f32>() / n;
    let angle_sd = math_sd(rests.iter().map(|r| r.angle().to_degrees()));
    // A normal cut at ±2 keeps its mean and 0.88 of its deviation; standard error of the mean 0.57/20 =
    // 0.028.
    assert!((mean - 2.15).abs() < 0.11, "mean {mean}");
    assert!((angle_sd - 8.8).abs() < 1.3, "deviation {angle_sd}");
}

fn math_sd(values: impl Iterator<Item = f32>) -> f32 {
    let values: Vec<f32> = values.collect();
    let mean = values.iter().sum::<f32>() / values.len() as f32;
    let squares = values.iter().map(|v| (v - mean) * (v - mean)).sum::<f32>();
    geometry::math::sqrt(squares / values.len() as f32)
}

#[test]
fn side_kicks_go_sideways_and_a_pass_goes_the_ordered_distance() {
    let kicked = |kick| {
        let mut world = holding(&[]);
        order(&mut world, LeggedPrimitive::Kick(kick));
        let events = run(&mut world, 0.41);
        let Some(WorldEvent::Kicked { from, rest, .. }) =
            events.iter().find(|e| matches!(e, WorldEvent::Kicked { .. }))
        else {
            panic!("{events:?}")
        };
        *rest - *from
    };
    assert!((kicked(LeggedKick::Left).angle().to_degrees() - 75.0).abs() <= 20.5);
    assert!((kicked(LeggedKick::Right).angle().to_degrees() + 75.0).abs() <= 20.5);
    let pass = kicked(LeggedKick::Pass(1.0)).norm();
    assert!((0.4..=1.6).contains(&pass), "{pass}");
    assert!(kicked(LeggedKick::Pass(50.0)).norm() <= 2.15 * 1.6 + 1e-3);
    assert!(kicked(LeggedKick::Pass(f32::NAN)).norm() <= 0.2 * 1.6 + 1e-3);
}

#[test]
fn a_kick_without_the_ball_moves_nothing() {
    let mut world = world(0, &[]);
    order(&mut world, LeggedPrimitive::Kick(LeggedKick::ForwardSoft));
    assert_eq!(run(&mut world, 0.4), [WorldEvent::KickedNothing { robot: 0 }]);
    assert_eq!(world.ball.velocity, Vector::default());
}

#[test]
fn a_grab_at_a_held_ball_touches_it_and_succeeds_half_as_often() {
    let mut world = holding(&[opponent(290.0, 0.0, 180.0)]);
    assert!(run(&mut world, 0.01).contains(&WorldEvent::Touched { robot: 1 }));
    let mut taken = 0_u32;
    for seed in 0..1_000 {
        let mut fight = world.clone();
        fight.grabs = Stream::new(seed, "grabs");
        let grab = ActuatorFrame::Legged { walk: Twist::default(), primitive: LeggedPrimitive::Grab };
        fight.command(1, &grab);
        let events = run(&mut fight, 0.5);
        let stolen = events.contains(&WorldEvent::Stolen { by: 1, from: 0 });
        assert_eq!(fight.holder(), Some(usize::from(stolen)));
        taken += u32::from(stolen);
    }
    // ¾ · ½ of 1,000, four deviations of √(1000·0.375·0.625) = 15.3.
    assert!(taken.abs_diff(375) < 62, "{taken}");
}

#[test]
fn a_crashed_robot_releases_the_ball() {
    let mut world = holding(&[]);
    walk(&mut world, Twist { linear: Vector::new(1.0, 0.0), angular: 0.0 }, LeggedPrimitive::Grab);
    world.let_go(0);
    assert_eq!(world.holder(), None);
    run(&mut world, 1.0);
    assert_eq!(world.walkers[0].pose.position, Point::default());
}

#[test]
fn a_ball_bounces_off_a_side_and_stops_between_the_legs() {
    let shot = |from: (f32, f32), velocity: (f32, f32)| {
        let mut world = world(0, &[]);
        world.ball = LeggedBall {
            position: Point::new(from.0, from.1),
            velocity: Vector::new(velocity.0, velocity.1),
        };
        let touched = run(&mut world, 1.0).contains(&WorldEvent::Touched { robot: 0 });
        assert!(touched);
        world.ball
    };
    // Hits the left side from 0.2 m: √(1 − 0.7·0.0375) = 0.987 m/s there, 30 % of it back: 0.296²/0.7 = 0.125
    // m.
    let side = shot((0.0, 0.2), (0.0, -1.0));
    assert!((side.position.y() - (0.1625 + 0.125)).abs() < 0.006, "{side:?}");
    let front = shot((0.3, 0.0), (-0.5, 0.0));
    assert!((front.position.x() - 0.13).abs() < 1e-3 && front.velocity.norm() < 1e-3, "{front:?}");
}

#[test]
fn robots_do_not_stay_overlapped() {
    let crowd = [opponent(100.0, 20.0, 90.0), opponent(-80.0, 0.0, 0.0), opponent(0.0, 0.0, 45.0)];
    let mut world = world(0, &crowd);
    for walker in &mut world.walkers {
        walker.wanted = Twist { linear: Vector::new(0.3, 0.0), angular: 0.5 };
    }
    run(&mut world, 1.0);
    for i in 0..4 {
        for j in i + 1..4 {
            let apart = world.walkers[i].pose.position.distance(world.walkers[j].pose.position);
            assert!(apart > 0.239, "{i} and {j}: {apart}");
        }
    }
}
