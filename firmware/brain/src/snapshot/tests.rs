//! Parts lost, doubled, reordered, and numbers that wrap.

use super::*;
use geometry::{Angle, Point};
use protocol::quantized::{WirePoint, WirePose};

fn me() -> RobotId {
    RobotId::new(3).unwrap()
}

fn robot(side: Side, id: u8, x: i16, vx: i16) -> WireRobot {
    WireRobot {
        who: WireWho { side, id: RobotId::new(id).unwrap() },
        pose: WirePose { at: WirePoint { x, y: 0 }, heading: 0 },
        vx,
        vy: 0,
    }
}

fn part(snapshot: u8, part: u8, robots: &[WireRobot]) -> WorldPart {
    WorldPart {
        snapshot,
        part,
        parts: 2,
        phase: Phase::Run,
        placement: None,
        ball: Some(WireBall { at: WirePoint { x: 100, y: 0 }, height: 0, vx: 1000, vy: 0 }),
        robots: robots.iter().copied().collect(),
    }
}

fn ids(snapshot: &HostSnapshot, now: Instant) -> Vec<u8> {
    snapshot.others(now).map(|robot| robot.who.into()).collect()
}

extern crate std;
use std::vec::Vec;

#[test]
fn a_lost_part_leaves_ball_phase_and_the_robots_that_came() {
    let mut snapshot = HostSnapshot::new(me());
    let first = part(7, 0, &[robot(Side::Ours, 3, 500, 0), robot(Side::Theirs, 1, 900, 0)]);
    assert_eq!(snapshot.handle_part(Instant(10_000), &first), Taken::Begun);
    assert_eq!(snapshot.phase(), Some(Phase::Run));
    assert!(snapshot.ball(Instant(10_000)).is_some());
    assert_eq!(snapshot.own(Instant(10_000)).unwrap().position, Point::new(0.5, 0.0));
    assert_eq!(ids(&snapshot, Instant(10_000)), [0x81]);
}

#[test]
fn the_parts_of_a_snapshot_may_come_in_any_order_and_twice() {
    let mut snapshot = HostSnapshot::new(me());
    let (a, b) = (part(255, 0, &[robot(Side::Ours, 1, 0, 0)]), part(255, 1, &[robot(Side::Theirs, 2, 0, 0)]));
    assert_eq!(snapshot.handle_part(Instant(10_000), &b), Taken::Begun);
    assert_eq!(snapshot.handle_part(Instant(10_100), &b), Taken::Doubled);
    assert_eq!(snapshot.handle_part(Instant(10_200), &a), Taken::More);
    assert_eq!(ids(&snapshot, Instant(10_200)), [1, 0x82]);
    // 0 follows 255; parts of 255 after that are late.
    assert_eq!(snapshot.handle_part(Instant(20_000), &part(0, 1, &[])), Taken::Begun);
    assert_eq!(snapshot.handle_part(Instant(20_100), &a), Taken::Late);
    // A host that restarts is received again after some silence.
    assert_eq!(snapshot.handle_part(Instant(400_000), &part(200, 0, &[])), Taken::Begun);
}

#[test]
fn a_robot_missing_in_a_whole_snapshot_has_left_one_in_a_lost_part_stays_a_while() {
    let mut snapshot = HostSnapshot::new(me());
    let theirs = [robot(Side::Theirs, 1, 0, 0), robot(Side::Theirs, 2, 0, 0)];
    snapshot.handle_part(Instant(0), &part(1, 0, &theirs[..1]));
    snapshot.handle_part(Instant(0), &part(1, 1, &theirs[1..]));
    snapshot.handle_part(Instant(16_000), &part(2, 0, &theirs[..1]));
    assert_eq!(ids(&snapshot, Instant(16_000)), [0x81, 0x82]);
    snapshot.handle_part(Instant(16_000), &part(2, 1, &[]));
    assert_eq!(ids(&snapshot, Instant(16_000)), [0x81]);
    snapshot.handle_part(Instant(32_000), &part(3, 0, &[]));
    assert_eq!(ids(&snapshot, Instant(216_000)), [0x81]);
    assert!(ids(&snapshot, Instant(217_000)).is_empty());
}

#[test]
fn impossible_parts_change_nothing() {
    let mut snapshot = HostSnapshot::new(me());
    for (number, of) in [(0, 0), (2, 2), (0, 9), (255, 255)] {
        let odd = WorldPart { parts: of, ..part(1, number, &[robot(Side::Ours, 3, 0, 0)]) };
        assert_eq!(snapshot.handle_part(Instant(0), &odd), Taken::Malformed);
    }
    assert_eq!((snapshot.received(), snapshot.own(Instant(0))), (None, None));
}

#[test]
fn between_snapshots_the_own_pose_goes_on_by_odometry() {
    let mut snapshot = HostSnapshot::new(me());
    snapshot.handle_part(Instant(0), &part(1, 0, &[robot(Side::Ours, 3, 0, 0)]));
    // A quarter circle to the left in one second, with 1 m of arc: radius 2/π.
    let twist = Twist { linear: Vector::new(1.0, 0.0), angular: core::f32::consts::FRAC_PI_2 };
    for step in 0..=50 {
        snapshot.handle_odometry(Instant(step * 10_000), twist);
    }
    // Half of it after 0.5 s: r sin 45°, r (1 − cos 45°).
    let own = snapshot.own(Instant(500_000)).unwrap();
    assert!(own.position.distance(Point::new(0.450_16, 0.186_46)) < 2e-3, "{own:?}");
    assert!((own.heading - Angle::degrees(45.0)).abs() < 0.02);
    assert_eq!(snapshot.own(Instant(500_001)), None, "too long on its own");
}

#[test]
fn a_small_error_is_taken_out_bit_by_bit_and_a_large_one_at_once() {
    let mut snapshot = HostSnapshot::new(me());
    snapshot.handle_part(Instant(0), &part(1, 0, &[robot(Side::Ours, 3, 0, 0)]));
    snapshot.handle_part(Instant(16_000), &part(2, 0, &[robot(Side::Ours, 3, 20, 0)]));
    assert!((snapshot.own(Instant(16_000)).unwrap().position.x() - 0.002).abs() < 1e-6);
    snapshot.handle_part(Instant(32_000), &part(3, 0, &[robot(Side::Ours, 3, 900, 0)]));
    assert!((snapshot.own(Instant(32_000)).unwrap().position.x() - 0.9).abs() < 1e-6);
}

#[test]
fn a_robot_that_begins_to_turn_does_not_take_the_hosts_heading_that_lags() {
    let (mut turns, mut stands) = (HostSnapshot::new(me()), HostSnapshot::new(me()));
    let lags =
        WireRobot { pose: WirePose { heading: -300, ..WirePose::default() }, ..robot(Side::Ours, 3, 0, 0) };
    for (snapshot, angular) in [(&mut turns, 5.0), (&mut stands, 0.0)] {
        snapshot.handle_part(Instant(0), &part(1, 0, &[robot(Side::Ours, 3, 0, 0)]));
        snapshot.handle_odometry(Instant(10_000), Twist { linear: Vector::default(), angular });
        snapshot.handle_part(Instant(10_000), &part(2, 0, &[lags]));
    }
    let off = |snapshot: &HostSnapshot, by: f32| {
        (snapshot.own(Instant(10_000)).unwrap().heading - Angle::new(by)).to_degrees()
    };
    // It has turned by 0.05 rad, and the host shows 17 degrees less.
    assert!(off(&turns, 0.05).abs() < 0.1, "{}", off(&turns, 0.05));
    assert!(off(&stands, 0.0) < -17.0, "{}", off(&stands, 0.0));
}

#[test]
fn robots_go_on_by_their_velocity_and_the_ball_slows_down() {
    let mut snapshot = HostSnapshot::new(me());
    snapshot.handle_part(Instant(0), &part(1, 0, &[robot(Side::Theirs, 1, 0, 2000)]));
    let later = Instant(100_000);
    let other = snapshot.others(later).next().unwrap();
    assert!((other.pose.position.x() - 0.2).abs() < 1e-6);
    // 0.1 + 1 m/s · 0.1 s − 0.35/2 · 0.01 = 0.198 25 m, 0.965 m/s.
    let ball = snapshot.ball(later).unwrap();
    assert!((ball.position.x() - 0.198_25).abs() < 1e-5 && (ball.velocity.x() - 0.965).abs() < 1e-5);
}

#[test]
fn odometry_that_is_not_a_number_moves_nothing() {
    let mut snapshot = HostSnapshot::new(me());
    snapshot.handle_part(Instant(0), &part(1, 0, &[robot(Side::Ours, 3, 500, 0)]));
    snapshot.handle_odometry(Instant(10_000), Twist { linear: Vector::new(f32::NAN, 0.0), angular: 0.0 });
    snapshot
        .handle_odometry(Instant(20_000), Twist { linear: Vector::new(0.0, 0.0), angular: f32::INFINITY });
    assert_eq!(snapshot.own(Instant(20_000)).unwrap().position, Point::new(0.5, 0.0));
}
