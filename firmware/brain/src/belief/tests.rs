//! `tests`: tests of the world model.

use super::*;
use geometry::{Angle, Twist};
use protocol::robot_io::{BallSight, Health};

fn seen(x: f32) -> SensorFrame {
    SensorFrame {
        pose: Some(Pose::default()),
        ball: Some(BallSight { position: Point::new(x, 0.0), sigma: 0.0, age: Duration(0) }),
        opponents: heapless::Vec::new(),
        ball_contact: false,
        busy: false,
        odometry: Twist::default(),
        health: Health::default(),
        camera: None,
    }
}

#[test]
fn two_sights_of_a_ball_tell_its_speed_and_where_it_will_rest() {
    let me = RobotId::new(1).unwrap();
    let mut belief = Belief::new(League::FourLegged);
    let teammates = Teammates::default();
    belief.update(Instant(40_000), me, &seen(0.0), &teammates);
    belief.update(Instant(80_000), me, &seen(0.028), &teammates);
    let ball = belief.ball.unwrap();
    assert!((ball.velocity.x() - 0.7).abs() < 1e-4);
    // s = v²/2a = 0.49/0.7 = 0.7 m further on
    assert!((ball.rest.x() - 0.728).abs() < 1e-3);
    assert!(ball.rolls_towards(Point::new(0.6, 0.1), 0.2));
    assert!(!ball.rolls_towards(Point::new(-0.6, 0.1), 0.2));
}

#[test]
fn an_opponent_that_walks_will_be_farther_on_where_its_velocity_is_followed() {
    let me = RobotId::new(1).unwrap();
    let walks = |needed: bool| {
        let mut belief = Belief::new(League::FourLegged).following_opponents(needed);
        let mut place = Point::new(1.0, 0.5);
        // 3 s at 0.25 m/s: the velocity is smoothed over one second.
        for step in 0..75 {
            place += Vector::new(-0.25, 0.0) * 0.04;
            let opponents = heapless::Vec::from_slice(&[place]).unwrap();
            let frame = SensorFrame { opponents, ..seen(0.0) };
            belief.update(Instant(40_000 * step), me, &frame, &Teammates::default());
        }
        belief.opponent_after(place, 2.0).x() - place.x()
    };
    assert!((walks(true) + 0.5).abs() < 0.05, "{}", walks(true));
    assert_eq!(walks(false), 0.0);
    let mut hosted = Belief::new(League::DivisionB);
    let pose = Pose { position: Point::new(1.0, 0.0), heading: Angle::ZERO };
    let _ = hosted.others.push(Other { side: Side::Theirs, id: me, pose, velocity: Vector::new(0.0, 2.0) });
    assert_eq!(hosted.opponent_after(pose.position, 0.5), Point::new(1.0, 1.0));
}

#[test]
fn without_a_fresh_sight_or_report_there_is_no_ball() {
    let me = RobotId::new(1).unwrap();
    let mut belief = Belief::new(League::FourLegged);
    belief.update(Instant(40_000), me, &seen(0.5), &Teammates::default());
    let blind = SensorFrame { ball: None, ..seen(0.0) };
    belief.update(Instant(80_000), me, &blind, &Teammates::default());
    assert!(belief.ball.is_some());
    belief.update(Instant(900_000), me, &blind, &Teammates::default());
    assert_eq!(belief.ball, None);
}

#[test]
fn a_sensor_that_says_nan_is_not_believed() {
    let me = RobotId::new(1).unwrap();
    let mut belief = Belief::new(League::FourLegged);
    let mut mad = seen(f32::NAN);
    mad.pose = Some(Pose { position: Point::new(f32::INFINITY, 0.0), heading: geometry::Angle::ZERO });
    belief.update(Instant(40_000), me, &mad, &Teammates::default());
    assert_eq!(belief.ball, None);
    assert_eq!(belief.pose, Pose::default());
}
