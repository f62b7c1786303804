//! Tests: the closed form agrees with small steps.

use geometry::Field;

use super::*;

fn kicked(speed: f32) -> BallPath<Field> {
    BallModel::default().kicked(Point::new(1.0, -2.0), Vector::new(0.6 * speed, 0.8 * speed))
}

/// Distance and speed of a kicked ball by steps of 10 µs in doubles.
fn stepped(model: BallModel, speed: f64, until: impl Fn(f64, f64, f64) -> bool) -> (f64, f64, f64) {
    let (mut t, mut d, mut v) = (0.0, 0.0, speed);
    let dt = 1e-5;
    while v > 0.0 && !until(t, d, v) {
        let a = if v > speed * f64::from(model.switch) { model.slide } else { model.roll };
        v -= f64::from(a) * dt;
        d += v * dt;
        t += dt;
    }
    (t, d, v.max(0.0))
}

#[test]
fn a_kick_of_six_metres_per_second_by_hand() {
    // c = 5/7: rolls from 30/7 m/s; t_s = (12/7) / 3.9, d_s = (36 − 900/49) / 7.8, then (900/49) / 0.7 more.
    let path = kicked(6.0);
    assert!((path.slide_time - 0.439_56).abs() < 1e-4);
    assert!((path.slide_distance - 2.260_6).abs() < 1e-3);
    assert!((path.rest_distance() - (2.260_6 + 26.239)).abs() < 1e-2);
    assert!((path.duration() - (0.439_56 + 12.244_9)).abs() < 1e-3);
    assert!(path.rest().distance(Point::new(1.0 + 0.6 * 28.5, -2.0 + 0.8 * 28.5)) < 0.01);
}

#[test]
fn distance_and_speed_are_those_of_small_steps() {
    for speed in [0.2_f32, 1.5, 4.0, 6.5] {
        let path = kicked(speed);
        for time in [0.0_f32, 0.05, 0.3, 0.7, 2.0, 9.0, 20.0] {
            let (_, d, v) = stepped(BallModel::default(), f64::from(speed), |t, _, _| t >= f64::from(time));
            let (distance, now) = path.progress(time);
            assert!((f64::from(distance) - d).abs() < 2e-3, "{speed} m/s after {time} s: {distance}, {d}");
            assert!((f64::from(now) - v).abs() < 1e-3, "{speed} m/s after {time} s: {now}, {v}");
            let state = path.at(time);
            assert!((state.position.distance(Point::new(1.0, -2.0)) - distance).abs() < 1e-5);
        }
    }
}

#[test]
fn the_time_to_a_distance_is_the_inverse_of_the_way() {
    for speed in [0.2_f32, 1.5, 4.0, 6.5] {
        let path = kicked(speed);
        for share in [0.0_f32, 0.01, 0.1, 0.5, 0.9, 0.999] {
            let distance = share * path.rest_distance();
            let time = path.time_to(distance).unwrap();
            assert!((path.progress(time).0 - distance).abs() < 1e-3, "{speed} m/s, {share}");
        }
        assert_eq!(path.time_to(path.rest_distance() + 0.01), None);
        assert_eq!(path.time_to(-0.01), None);
    }
}

#[test]
fn a_kick_for_an_arrival_arrives_so_fast_sliding_or_rolling() {
    let model = BallModel::default();
    for (distance, arrival) in [(3.0, 1.0), (6.0, 2.0), (0.2, 3.0), (0.5, 0.0), (1.0, 5.0)] {
        let kick = model.kick_speed(distance, arrival);
        let path = model.kicked(Point::<Field>::new(0.0, 0.0), Vector::new(kick, 0.0));
        // The inverse loses digits where the ball is nearly stationary.
        let (_, _, v) = stepped(model, f64::from(kick), |_, d, _| d >= f64::from(distance));
        assert!((v - arrival as f64).abs() < 0.02, "{distance} m, {arrival} m/s: {kick} m/s gives {v}");
        assert!(path.rest_distance() >= distance - 1e-3);
    }
    assert_eq!(model.kick_speed(0.0, 0.0), 0.0);
}

#[test]
fn a_ball_seen_late_rolls_and_one_whose_kick_was_seen_slides_to_its_switch() {
    let model = BallModel::default();
    let (at, v) = (Point::<Field>::new(0.0, 0.0), Vector::new(2.0, 0.0));
    assert!((model.rolling(at, v).rest_distance() - 4.0 / 0.7).abs() < 1e-4);
    // From 4 m/s the switch is at 20/7 m/s: a ball kicked at that speed rolls at 2 m/s.
    assert_eq!(model.moving(at, v, 20.0 / 7.0), model.rolling(at, v).clone());
    // At 3 m/s it slides on for (3 − 20/7) / 3.9 s.
    let sliding = model.moving(at, Vector::new(3.0, 0.0), 20.0 / 7.0);
    assert!((sliding.slide_time - (3.0 - 20.0 / 7.0) / 3.9).abs() < 1e-6);
}

#[test]
fn what_is_no_number_rests() {
    let model = BallModel::default();
    let path = model.kicked(Point::<Field>::new(f32::NAN, 0.0), Vector::new(f32::INFINITY, 1.0));
    assert_eq!((path.duration(), path.rest()), (0.0, Point::new(0.0, 0.0)));
    let still = model.kicked(Point::<Field>::new(1.0, 1.0), Vector::new(0.0, 0.0));
    assert_eq!((still.rest(), still.time_to(0.0)), (Point::new(1.0, 1.0), Some(0.0)));
}

#[test]
fn ball_models_of_the_wire_are_taken_with_either_sign_and_refused_if_impossible() {
    // Values of grSim and of ER-Force.
    assert_eq!(
        BallModel::from_wire(-14.0, -0.7, 0.7),
        Some(BallModel { slide: 14.0, roll: 0.7, switch: 0.7 })
    );
    assert!(BallModel::from_wire(3.9, 0.35, 0.69).is_some());
    for (slide, roll, switch) in [(0.0, 0.35, 0.7), (3.9, f64::NAN, 0.7), (3.9, 0.35, 1.5), (1e9, 0.35, 0.5)]
    {
        assert_eq!(BallModel::from_wire(slide, roll, switch), None);
    }
}
