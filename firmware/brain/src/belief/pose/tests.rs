//! Tests: against a reference in f64, consistency of the covariance, and recovery of a robot that was moved.

#![expect(clippy::needless_range_loop, reason = "matrices by their indices")]

extern crate std;

use std::f64::consts::PI;
use std::vec::Vec;

use protocol::robot_io::Sight;

use super::*;
use crate::belief::random::RandomStream;

const DT: f64 = 0.04;

/// A robot that walks at random, in a world as the filter assumes it.
struct Walk {
    random: RandomStream,
    x: f64,
    y: f64,
    heading: f64,
    sway: f64,
    speed: [f64; 3],
    steps: u32,
}

impl Walk {
    fn new(seed: u64) -> Self {
        let mut random = RandomStream::new(seed);
        let (x, y) = (random.between(-1.5, 1.5), random.between(-1.0, 1.0));
        let (heading, sway) = (random.between(-PI, PI), random.normal());
        Self { random, x, y, heading, sway, speed: [0.0; 3], steps: 0 }
    }

    /// Where its program believes that it starts.
    fn placed(&mut self) -> Pose<Field> {
        let (place, heading) = (f64::from(model::PLACING), f64::from(model::PLACING_HEADING));
        let x = self.x + place * self.random.normal();
        let y = self.y + place * self.random.normal();
        let heading = self.heading + heading * self.random.normal();
        Pose { position: Point::new(x as f32, y as f32), heading: Angle::new(heading as f32) }
    }

    /// A step: the odometry, and the landmarks seen.
    fn step(&mut self) -> (Twist<Body>, Vec<LandmarkSight>) {
        if self.steps.is_multiple_of(50) {
            let towards = (-self.y).atan2(-self.x) - self.heading;
            let turn = (towards.sin().atan2(towards.cos())).clamp(-0.8, 0.8) + self.random.between(-0.5, 0.5);
            self.speed = [self.random.between(0.05, 0.3), self.random.between(-0.1, 0.1), turn];
        }
        self.steps += 1;
        let [ahead, aside, turn] = self.speed;
        let squared = ahead * ahead + aside * aside;
        let (motion, pushed) = (f64::from(model::MOTION), f64::from(model::PUSHED));
        let place = ((motion * squared + pushed) * DT).sqrt();
        let turned = ((motion * turn * turn + f64::from(model::TURNED)) * DT).sqrt();
        let (s, c) = self.heading.sin_cos();
        self.x += (c * ahead - s * aside) * DT + place * self.random.normal();
        self.y += (s * ahead + c * aside) * DT + place * self.random.normal();
        self.heading += turn * DT + turned * self.random.normal();
        let keep = (-DT / f64::from(model::SWAY_TIME)).exp();
        self.sway = keep * self.sway + (1.0 - keep * keep).sqrt() * self.random.normal();
        let odometry = Twist { linear: Vector::new(ahead as f32, aside as f32), angular: turn as f32 };
        let mut seen = Vec::new();
        // In every fourth step one landmark after the other.
        if self.steps.is_multiple_of(4) {
            let index = (self.steps / 4) as usize % LANDMARKS.len();
            seen.push(self.sight(index));
        }
        (odometry, seen)
    }

    fn sight(&mut self, index: usize) -> LandmarkSight {
        let landmark = LANDMARKS[index];
        let (dx, dy) = (f64::from(landmark.x()) - self.x, f64::from(landmark.y()) - self.y);
        let range = dx.hypot(dy);
        let size = if index < model::MARKERS { model::MARKER_SIZE } else { model::GOAL_SIZE };
        let sigma = f64::from(model::range_variance(range as f32, size)).sqrt();
        let amplitude = f64::from(model::JOINT + model::SWAY);
        let bearing = dy.atan2(dx) - self.heading
            + amplitude * self.sway
            + f64::from(model::PIXEL) * self.random.normal();
        let range = (range + sigma * self.random.normal()).max(0.01);
        LandmarkSight { landmark: index as u8, sight: Sight::new(range as f32, Angle::new(bearing as f32)) }
    }
}

type Matrix = [[f64; 4]; 4];

fn product(a: &Matrix, b: &Matrix) -> Matrix {
    core::array::from_fn(|i| core::array::from_fn(|j| (0..4).map(|k| a[i][k] * b[k][j]).sum()))
}

fn transposed(a: &Matrix) -> Matrix {
    core::array::from_fn(|i| core::array::from_fn(|j| a[j][i]))
}

/// The same model in double precision, with whole matrices and Joseph's form.
struct Reference {
    state: [f64; 4],
    covariance: Matrix,
    amplitude: f64,
}

impl Reference {
    fn at(pose: Pose<Field>) -> Self {
        let (place, heading) = (f64::from(model::PLACING).powi(2), f64::from(model::PLACING_HEADING).powi(2));
        let mut covariance = [[0.0; 4]; 4];
        for (i, variance) in [place, place, heading, 1.0].into_iter().enumerate() {
            covariance[i][i] = variance;
        }
        let (x, y) = (pose.position.x(), pose.position.y());
        let state = [x, y, pose.heading.radians(), 0.0].map(f64::from);
        Self { state, covariance, amplitude: 0.0 }
    }

    fn predict(&mut self, odometry: Twist<Body>) {
        let (vx, vy) = (f64::from(odometry.linear.x()), f64::from(odometry.linear.y()));
        let turn = f64::from(odometry.angular);
        let (s, c) = self.state[2].sin_cos();
        let (dx, dy) = ((c * vx - s * vy) * DT, (s * vx + c * vy) * DT);
        let keep = (-DT / f64::from(model::SWAY_TIME)).exp();
        self.state =
            [self.state[0] + dx, self.state[1] + dy, self.state[2] + turn * DT, keep * self.state[3]];
        let f = [[1.0, 0.0, -dy, 0.0], [0.0, 1.0, dx, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, keep]];
        self.covariance = product(&product(&f, &self.covariance), &transposed(&f));
        let motion = f64::from(model::MOTION);
        let place = (motion * (vx * vx + vy * vy) + f64::from(model::PUSHED)) * DT;
        let heading = (motion * turn * turn + f64::from(model::TURNED)) * DT;
        for (i, variance) in [place, place, heading, 1.0 - keep * keep].into_iter().enumerate() {
            self.covariance[i][i] += variance;
        }
        self.amplitude = f64::from(model::JOINT + model::SWAY);
    }

    fn see(&mut self, seen: LandmarkSight) {
        let landmark = LANDMARKS[usize::from(seen.landmark)];
        let off = |state: &[f64; 4]| (f64::from(landmark.x()) - state[0], f64::from(landmark.y()) - state[1]);
        let size =
            if usize::from(seen.landmark) < model::MARKERS { model::MARKER_SIZE } else { model::GOAL_SIZE };
        let (dx, dy) = off(&self.state);
        let range = dx.hypot(dy);
        let innovation = f64::from(seen.sight.range()) - range;
        let variance = f64::from(model::range_variance(range as f32, size));
        self.update([-dx / range, -dy / range, 0.0, 0.0], innovation, variance);
        let (dx, dy) = off(&self.state);
        let squared = dx * dx + dy * dy;
        let expected = dy.atan2(dx) - self.state[2] + self.amplitude * self.state[3];
        let off = f64::from(seen.sight.bearing().radians()) - expected;
        let h = [dy / squared, -dx / squared, -1.0, self.amplitude];
        self.update(h, off.sin().atan2(off.cos()), f64::from(model::PIXEL).powi(2));
    }

    fn update(&mut self, h: [f64; 4], innovation: f64, variance: f64) {
        let ph: [f64; 4] = core::array::from_fn(|i| (0..4).map(|j| self.covariance[i][j] * h[j]).sum());
        let s = (0..4).map(|i| ph[i] * h[i]).sum::<f64>() + variance;
        if innovation * innovation >= f64::from(GATE) * s {
            return;
        }
        let gain = ph.map(|value| value / s);
        for i in 0..4 {
            self.state[i] += gain[i] * innovation;
        }
        // (1 − K H) P (1 − K H)ᵀ + K R Kᵀ.
        let keep: Matrix =
            core::array::from_fn(|i| core::array::from_fn(|j| f64::from(u8::from(i == j)) - gain[i] * h[j]));
        self.covariance = product(&product(&keep, &self.covariance), &transposed(&keep));
        for i in 0..4 {
            for j in 0..4 {
                self.covariance[i][j] += gain[i] * variance * gain[j];
            }
        }
    }
}

fn off(filter: &PoseFilter, walk: &Walk) -> [f64; 3] {
    let pose = filter.pose();
    let turned = f64::from(pose.heading.radians()) - walk.heading;
    [
        f64::from(pose.position.x()) - walk.x,
        f64::from(pose.position.y()) - walk.y,
        turned.sin().atan2(turned.cos()),
    ]
}

/// One step of the walk, taken in by the filter.
fn follow(filter: &mut PoseFilter, walk: &mut Walk) {
    let (odometry, seen) = walk.step();
    filter.predict(odometry, DT as f32);
    for sight in seen {
        filter.see(sight);
    }
}

/// Whether the estimate is off by more than 0.3 m or 0.3 rad.
fn is_lost(filter: &PoseFilter, walk: &Walk) -> bool {
    let [x, y, heading] = off(filter, walk);
    x.hypot(y) > 0.3 || heading.abs() > 0.3
}

#[test]
fn it_is_the_reference_in_double_precision_within_a_millimetre() {
    for seed in 0..20 {
        let mut walk = Walk::new(seed);
        let placed = walk.placed();
        let mut filter = PoseFilter::at(placed, model::PLACING, model::PLACING_HEADING);
        let mut reference = Reference::at(placed);
        for step in 0..1_000 {
            let (odometry, seen) = walk.step();
            filter.predict(odometry, DT as f32);
            reference.predict(odometry);
            for sight in seen {
                filter.see(sight);
                reference.see(sight);
            }
            let pose = filter.pose();
            let place = (f64::from(pose.position.x()) - reference.state[0])
                .hypot(f64::from(pose.position.y()) - reference.state[1]);
            let turned = f64::from(pose.heading.radians()) - reference.state[2];
            assert!(place < 0.001, "seed {seed}, step {step}: {place} m");
            assert!(turned.sin().abs() < 0.001, "seed {seed}, step {step}: {turned} rad");
            for i in 0..4 {
                let (own, other) = (f64::from(filter.covariance()[i][i]), reference.covariance[i][i]);
                assert!((own / other - 1.0).abs() < 0.02, "seed {seed}, step {step}, {i}: {own} {other}");
            }
        }
    }
}

/// Normalised squared error of x, y and heading.
fn squared_error(filter: &PoseFilter, walk: &Walk) -> f64 {
    let e = off(filter, walk);
    let p: [[f64; 3]; 3] =
        core::array::from_fn(|i| core::array::from_fn(|j| f64::from(filter.covariance()[i][j])));
    let minor = |i: usize, j: usize| {
        let (r, c) = ([(i + 1) % 3, (i + 2) % 3], [(j + 1) % 3, (j + 2) % 3]);
        p[r[0]][c[0]] * p[r[1]][c[1]] - p[r[0]][c[1]] * p[r[1]][c[0]]
    };
    let determinant: f64 = (0..3).map(|j| p[0][j] * minor(0, j)).sum();
    (0..3).map(|i| (0..3).map(|j| e[i] * minor(i, j) * e[j]).sum::<f64>()).sum::<f64>() / determinant
}

#[test]
fn its_covariance_is_that_of_its_errors() {
    // NEES of three degrees of freedom: 400 runs have a mean of 3 with a deviation of √(6 / 400) = 0.122.
    for seconds in [2, 10, 30] {
        let mut sum = 0.0;
        for seed in 0..400 {
            let mut walk = Walk::new(1_000 + seed);
            let mut filter = PoseFilter::at(walk.placed(), model::PLACING, model::PLACING_HEADING);
            for _ in 0..seconds * 25 {
                let (odometry, seen) = walk.step();
                filter.predict(odometry, DT as f32);
                for sight in seen {
                    filter.see(sight);
                }
            }
            sum += squared_error(&filter, &walk);
        }
        let mean = sum / 400.0;
        // 99.7 %.
        assert!((mean - 3.0).abs() < 3.0 * 0.122, "after {seconds} s: {mean}");
    }
}

#[test]
fn a_robot_that_is_carried_away_finds_itself_again() {
    let mut lost = 0;
    for seed in 0..50 {
        let mut walk = Walk::new(seed);
        let mut filter = PoseFilter::at(walk.placed(), model::PLACING, model::PLACING_HEADING);
        for step in 0..750 {
            if step == 250 {
                (walk.x, walk.y, walk.heading) = (-walk.x, walk.y - 1.0, walk.heading + 2.0);
            }
            follow(&mut filter, &mut walk);
        }
        lost += u32::from(is_lost(&filter, &walk));
    }
    assert!(lost <= 1, "{lost} of 50 are lost after 20 s");
}

#[test]
fn without_any_pose_to_start_from_two_landmarks_are_enough() {
    let mut lost = 0;
    for seed in 0..50 {
        let mut walk = Walk::new(seed);
        let mut filter = PoseFilter::default();
        for _ in 0..500 {
            follow(&mut filter, &mut walk);
        }
        lost += u32::from(is_lost(&filter, &walk));
    }
    assert!(lost <= 1, "{lost} of 50 are lost after 20 s");
}

#[test]
fn sights_that_are_nonsense_make_no_estimate_infinite() {
    let mut filter = PoseFilter::default();
    for i in 0..2_000_u32 {
        let twist = Twist { linear: Vector::new(0.3, -0.2), angular: 2.0 };
        filter.predict(twist, 0.04);
        let sight = Sight::new((i % 70) as f32, Angle::new(i as f32));
        filter.see(LandmarkSight { landmark: (i % 256) as u8, sight });
        assert!(
            filter.pose().position.is_finite() && filter.covariance().iter().flatten().all(|v| v.is_finite())
        );
    }
}
