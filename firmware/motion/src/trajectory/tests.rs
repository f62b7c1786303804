//! Tests: a planned motion arrives, keeps its limits, and takes hardly longer than the best shares would.

extern crate std;

use core::fmt::Debug;

use geometry::{Field, math};
use rand_core::{RngCore, SeedableRng};
use rand_xoshiro::Xoshiro128PlusPlus;

use super::*;

/// A start, a velocity and an end.
type Task = (Point<Field>, Vector<Field>, Point<Field>);

/// Tasks of a large field; each second one is short, each fifth starts at standstill.
fn tasks(count: usize) -> impl Iterator<Item = Task> {
    let mut rng = Xoshiro128PlusPlus::seed_from_u64(5);
    let mut within = move |range: f32| ((rng.next_u32() >> 8) as f32 / 8_388_608.0 - 1.0) * range;
    (0..count).map(move |i| {
        let near = if i % 2 == 0 { 0.05 } else { 1.0 };
        let from = Point::new(within(6.0), within(4.5));
        let velocity = if i % 5 == 0 { Vector::default() } else { Vector::new(within(2.5), within(2.5)) };
        (from, velocity, from + Vector::new(within(12.0), within(9.0)) * near)
    })
}

/// It starts at the given state, ends at standstill at the given place, and its states are each other's
/// derivatives.
fn holds_together<M: Motion<Field> + Debug>(motion: &M, (from, velocity, to): Task) {
    let duration = motion.duration();
    assert!(duration.is_finite() && duration >= 0.0, "{motion:?}");
    if duration > 0.0 {
        let start = motion.at(0.0);
        assert!(start.position.distance(from) < 1e-3, "starts at {:?}: {motion:?}", start.position);
        assert!((start.velocity - velocity).norm() < 2e-3, "starts with {:?}: {motion:?}", start.velocity);
    }
    for late in [duration, duration + 1.0] {
        assert_eq!(motion.at(late), State::at_rest(to));
    }
    let almost = motion.at(duration * 0.9999);
    assert!(almost.position.distance(to) < 1e-3, "ends at {:?}: {motion:?}", almost.position);
    let steps = 400;
    let dt = duration / steps as f32;
    let (mut place, mut speed) = (from, velocity);
    let mut before = motion.at(0.0);
    for step in 1..=steps {
        let now = motion.at(dt * step as f32);
        let middle = motion.at(dt * (step as f32 - 0.5));
        // Integral by Simpson's rule.
        place += (before.velocity + middle.velocity * 4.0 + now.velocity) * (dt / 6.0);
        speed += middle.acceleration * dt;
        before = now;
        let (off, drift) = (place.distance(now.position), (speed - now.velocity).norm());
        assert!(off < 5e-3, "{off} m off at step {step}: {motion:?}");
        // A switch within the step may add its jump of up to twice the limit, four times in all.
        assert!(drift < 1e-2 + 30.0 * dt, "{drift} m/s off at step {step}: {motion:?}");
    }
}

#[test]
fn without_drag_it_arrives_at_rest_and_its_states_are_each_others_derivatives() {
    for limits in [FreeLimits::default(), FreeLimits { speed: 1.5, acceleration: 2.0, braking: 5.0 }] {
        for task in tasks(2_000) {
            holds_together(&limits.plan(task.0, task.1, task.2), task);
        }
    }
}

#[test]
fn with_drag_it_arrives_at_rest_and_its_states_are_each_others_derivatives() {
    for task in tasks(2_000) {
        holds_together(&DragLimits::default().plan(task.0, task.1, task.2), task);
    }
}

#[test]
fn motion_without_drag_keeps_the_documented_limits() {
    let limits = FreeLimits { speed: 2.0, acceleration: 3.0, braking: 4.0 };
    for (from, velocity, to) in tasks(2_000) {
        let motion = limits.plan(from, velocity, to);
        let fastest = math::sqrt(4.0 + velocity.dot(velocity));
        for step in 0..200 {
            let state = motion.at(motion.duration() * step as f32 / 200.0);
            assert!(state.acceleration.norm() <= 4.0 * 1.001);
            assert!(state.velocity.norm() <= fastest * 1.001);
            if velocity == Vector::default() {
                assert!(state.velocity.norm() <= 2.001);
            }
        }
    }
}

#[test]
fn motion_with_drag_keeps_the_documented_push_and_speed() {
    let limits = DragLimits::default();
    for (from, velocity, to) in tasks(2_000) {
        let motion = limits.plan(from, velocity, to);
        let fastest = math::sqrt(9.0 + velocity.dot(velocity));
        for step in 0..200 {
            let state = motion.at(motion.duration() * step as f32 / 200.0);
            // The motors' push equals acceleration plus drag.
            let push = state.acceleration + state.velocity * (3.5 / 3.0);
            assert!(push.norm() <= 3.5 * 1.001 && state.velocity.norm() <= fastest * 1.001);
        }
    }
}

/// Time of one axis by steps of 0.1 ms in doubles: brakes where it must, speeds up where it may.
fn driven(distance: f64, speed: f64, limits: FreeLimits) -> f64 {
    let [v_max, a, b] = [limits.speed, limits.acceleration, limits.braking].map(f64::from);
    let (mut left, mut v, mut t, dt) = (distance, speed, 0.0, 1e-4);
    while (left.abs() > 2e-3 || v.abs() > 2e-2) && t < 60.0 {
        let ahead = left.signum();
        let along = v * ahead;
        if along < 0.0 {
            v += ahead * b * dt;
        } else if along * along / (2.0 * b) >= left.abs() || along > v_max + b * dt {
            v -= ahead * b * dt;
        } else if along < v_max {
            v += ahead * a * dt;
        }
        left -= v * dt;
        t += dt;
    }
    t
}

#[test]
fn the_time_of_one_axis_is_that_of_driving_it_by_small_steps() {
    let limits = FreeLimits { speed: 2.0, acceleration: 3.0, braking: 4.0 };
    for distance in [0.01_f32, 0.3, 1.0, 5.0] {
        for speed in [-3.0_f32, -1.0, 0.0, 0.5, 1.9, 3.0, 5.0] {
            let time = limits.time(
                Point::<Field>::new(0.0, 0.0),
                Vector::new(speed, 0.0),
                Point::new(distance, 0.0),
            );
            let by_steps = driven(f64::from(distance), f64::from(speed), limits);
            assert!(
                (f64::from(time) - by_steps).abs() < 0.04,
                "{distance} m, {speed} m/s: {time}, {by_steps}"
            );
        }
    }
}

#[test]
fn with_drag_a_straight_way_takes_as_long_as_its_two_pushes_by_hand() {
    // From standstill by d = 1 to standstill: e^t2 = 1 + √(1 − e^−d), t1 = t2 + d (Kalmár-Nagy's formulas
    // with v0 = 0, u = 1).
    let limits = DragLimits { speed: 1.0, acceleration: 1.0 };
    let time = limits.time(Point::<Field>::new(0.0, 0.0), Vector::default(), Point::new(1.0, 0.0));
    let second = (1.0 + (1.0 - (-1.0_f64).exp()).sqrt()).ln();
    assert!((f64::from(time) - (2.0 * second + 1.0)).abs() < 1e-3, "{time}");
}

/// The least over 2,000 angles of the slower axis's time, each axis planned alone with its share.
fn best_of_all_angles(task: Task, alone: impl Fn(f32, f32, f32) -> f32) -> f32 {
    let (offset, velocity) = (task.2 - task.0, task.1);
    let times = (1..2_000).map(|i| {
        let (s, c) = math::sin_cos(i as f32 / 2_000.0 * math::FRAC_PI_2);
        alone(offset.x(), velocity.x(), c).max(alone(offset.y(), velocity.y(), s))
    });
    times.fold(f32::INFINITY, f32::min)
}

fn excess<L: CalcMotion>(limits: &L, alone: impl Fn(f32, f32, f32) -> f32) -> (f32, f32) {
    let (mut sum, mut worst, mut count) = (0.0, 0.0_f32, 0);
    for task in tasks(1_000) {
        let best = best_of_all_angles(task, &alone);
        let over = limits.time(task.0, task.1, task.2) / best - 1.0;
        assert!(over > -0.002, "{task:?}: faster than any share");
        (sum, worst, count) = (sum + over, worst.max(over), count + 1);
    }
    (sum / count as f32, worst)
}

#[test]
fn both_take_hardly_longer_than_the_best_of_all_angles() {
    let free = FreeLimits::default();
    let origin = Point::<Field>::new(0.0, 0.0);
    let (mean, worst) = excess(&free, |d, v, share| {
        let FreeLimits { speed, acceleration, braking } = free;
        let scaled =
            FreeLimits { speed: speed * share, acceleration: acceleration * share, braking: braking * share };
        scaled.time(origin, Vector::new(v, 0.0), Point::new(d, 0.0))
    });
    assert!(mean < 0.003 && worst < 0.05, "without drag: mean {mean}, worst {worst}");
    let drag = DragLimits::default();
    // An axis with a share of the push: the same equation with a smaller limit and a smaller final speed.
    let (mean, worst) = excess(&drag, |d, v, share| {
        let scaled = DragLimits { speed: drag.speed * share, acceleration: drag.acceleration * share };
        scaled.time(origin, Vector::new(v, 0.0), Point::new(d, 0.0))
    });
    assert!(mean < 0.003 && worst < 0.05, "with drag: mean {mean}, worst {worst}");
}

#[test]
fn what_is_surely_longer_is_longer_wherever_in_the_circle_it_goes() {
    let mut reported = 0;
    for (i, (from, velocity, centre)) in tasks(20_000).enumerate() {
        let (within, radius) = ((i % 40) as f32 * 0.1, (i % 3) as f32 * 0.2);
        let to = centre + Vector::polar(radius * 0.999, geometry::Angle::new(i as f32));
        let free = FreeLimits { speed: 2.5, acceleration: 3.0, braking: 4.0 };
        if free.is_surely_longer(from, velocity, centre, radius, within) {
            assert!(free.time(from, velocity, to) >= within, "{from:?} {velocity:?} {to:?} {within}");
            reported += 1;
        }
        let drag = DragLimits::default();
        if drag.is_surely_longer(from, velocity, centre, radius, within) {
            assert!(drag.time(from, velocity, to) >= within, "{from:?} {velocity:?} {to:?} {within}");
            reported += 1;
        }
    }
    assert!(reported > 10_000, "{reported}");
}

#[test]
fn a_time_within_a_bound_is_the_time_and_none_is_over_it() {
    let (free, drag) = (FreeLimits::default(), DragLimits::default());
    for (i, (from, velocity, to)) in tasks(20_000).enumerate() {
        let within = (i % 50) as f32 * 0.1;
        let bounded =
            [free.time_within(from, velocity, to, within), drag.time_within(from, velocity, to, within)];
        for (bounded, time) in
            bounded.into_iter().zip([free.time(from, velocity, to), drag.time(from, velocity, to)])
        {
            assert_eq!(bounded, (time <= within).then_some(time), "{from:?} {velocity:?} {to:?}");
        }
    }
}

#[test]
fn odd_numbers_are_answered_and_no_numbers_rest() {
    let at = |x, y| Point::<Field>::new(x, y);
    let tiny = f32::from_bits(1);
    let odd = [0.0, -0.0, tiny, -tiny, 1e-30, 1e-7, 1.0, -1e-3, 999.0, -1_000.0];
    for (i, a) in odd.into_iter().enumerate() {
        for (j, b) in odd.into_iter().enumerate() {
            for c in odd {
                let task = (at(c, b), Vector::new(a, odd[(i + j) % 10]), at(b, a));
                for motion in [FreeLimits::default().plan(task.0, task.1, task.2).duration(), {
                    DragLimits::default().plan(task.0, task.1, task.2).duration()
                }] {
                    assert!(motion.is_finite() && motion >= 0.0, "{task:?}: {motion}");
                }
            }
        }
    }
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e30] {
        for (from, velocity, to) in [
            (at(1.0, 2.0), Vector::new(bad, 0.0), at(0.0, 0.0)),
            (at(1.0, 2.0), Vector::default(), at(0.0, bad)),
        ] {
            let free = FreeLimits::default().plan(from, velocity, to);
            let drag = DragLimits::default().plan(from, velocity, to);
            assert_eq!((free.duration(), free.at(0.0)), (0.0, State::at_rest(from)));
            assert_eq!((drag.duration(), drag.at(0.0)), (0.0, State::at_rest(from)));
        }
        let limits = FreeLimits { speed: -bad, ..FreeLimits::default() };
        assert!(limits.plan(at(0.0, 0.0), Vector::default(), at(1.0, 1.0)).duration().is_finite());
    }
    assert_eq!(FreeLimits::default().plan(at(1.0, 2.0), Vector::default(), at(1.0, 2.0)).duration(), 0.0);
    assert_eq!(DragLimits::default().plan(at(1.0, 2.0), Vector::default(), at(1.0, 2.0)).duration(), 0.0);
}

#[test]
fn a_hundred_thousand_tasks_are_all_solved() {
    let (free, drag) = (FreeLimits::default(), DragLimits::default());
    for (from, velocity, to) in tasks(100_000) {
        for time in [free.time(from, velocity, to), drag.time(from, velocity, to)] {
            // The longest path at 3 m/s a little above its axis' share, turning round first.
            assert!((0.0..20.0).contains(&time), "{from:?} {velocity:?} {to:?}: {time}");
        }
    }
}

#[test]
fn a_turn_takes_the_way_round_that_is_sooner_there() {
    use geometry::Angle;
    let limits = TurnLimits { rate: 6.0, acceleration: 30.0 };
    // A quarter turn from standstill reaches the limit: d/v + v/a.
    let quarter = limits.plan(Angle::ZERO, 0.0, Angle::degrees(90.0));
    assert!((quarter.duration() - (math::FRAC_PI_2 / 6.0 + 6.0 / 30.0)).abs() < 1e-5);
    let (_, rate, _) = quarter.at(0.05);
    assert!((rate - 1.5).abs() < 1e-4);
    // Already turning right fast, a left turn of 170° is sooner made to the right.
    let round = limits.plan(Angle::degrees(0.0), -6.0, Angle::degrees(170.0));
    assert!(round.at(0.1).1 < 0.0 && round.at(0.3).1 < 0.0);
    for (from, rate, to) in [(0.3, 2.0, -3.0), (3.0, -4.0, -3.0), (1.0, 0.0, 1.0), (-2.0, 9.0, 2.0)] {
        let turn = limits.plan(Angle::new(from), rate, Angle::new(to));
        let (heading, rate, _) = turn.at(turn.duration() + 0.1);
        assert!((heading - Angle::new(to)).abs() < 1e-4 && rate == 0.0);
    }
    assert_eq!(limits.plan(Angle::ZERO, f32::NAN, Angle::HALF_TURN).duration(), 0.0);
}
