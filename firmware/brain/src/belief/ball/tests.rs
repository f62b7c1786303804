//! Tests: against a reference in f64, consistency of the variance, and how soon it knows rest, kick and stop.

#![expect(clippy::needless_range_loop, reason = "matrices by their indices")]

extern crate std;

use std::println;
use std::vec::Vec;

use super::*;
use crate::belief::random::RandomStream;

const DT: f64 = 0.04;
const DECELERATION: f32 = 0.35;

/// Sights of a ball from a standing robot: range by a column of its image, bearings that sway together.
struct Eyes {
    random: RandomStream,
    sway: f64,
    walks: bool,
}

impl Eyes {
    fn new(seed: u64, walks: bool) -> Self {
        let mut random = RandomStream::new(seed);
        let sway = random.normal();
        Self { random, sway, walks }
    }

    fn amplitude(&self) -> f64 {
        f64::from(model::JOINT + if self.walks { model::SWAY } else { 0.0 })
    }

    /// A sight of a ball at `at`, with its variance and the lasting part of it.
    fn see(&mut self, at: [f64; 2]) -> (Point<Body>, f32, f32) {
        let keep = (-DT / f64::from(model::SWAY_TIME)).exp();
        self.sway = keep * self.sway + (1.0 - keep * keep).sqrt() * self.random.normal();
        let range = at[0].hypot(at[1]);
        let by_range = f64::from(model::range_variance(range as f32, model::BALL_SIZE));
        let pixel = f64::from(model::PIXEL);
        let bearing = at[1].atan2(at[0]) + self.amplitude() * self.sway + pixel * self.random.normal();
        let seen = range + by_range.sqrt() * self.random.normal();
        let across = 0.5 * range * range;
        let swayed = self.amplitude() * self.amplitude();
        let variance = 0.5 * by_range + across * (pixel * pixel + swayed);
        let point = Point::new((seen * bearing.cos()) as f32, (seen * bearing.sin()) as f32);
        (point, variance as f32, (15.0 * across * swayed) as f32)
    }
}

fn standing() -> Twist<Body> {
    Twist::default()
}

#[test]
fn a_resting_ball_a_metre_away_is_believed_at_rest() {
    for walks in [false, true] {
        let (mut at_rest, mut looks) = (0, 0);
        for seed in 0..200 {
            let mut eyes = Eyes::new(seed, walks);
            let mut filter: Option<BallFilter> = None;
            for step in 0..150 {
                let (point, variance, lasting) = eyes.see([1.0, 0.2]);
                let filter = filter.get_or_insert(BallFilter::seen(point, variance, DECELERATION));
                filter.predict(standing(), DT as f32);
                filter.see(point, variance, lasting);
                if step > 25 {
                    (at_rest, looks) =
                        (at_rest + u32::from(filter.velocity() == Vector::default()), looks + 1);
                }
            }
        }
        assert!(at_rest * 100 >= looks * 95, "walking {walks}: {at_rest} of {looks}");
    }
}

#[test]
fn a_kick_is_noticed_and_so_is_the_stop() {
    let (mut noticed, mut speeds, mut stopped) = (Vec::new(), Vec::new(), Vec::new());
    for seed in 0..100 {
        let mut eyes = Eyes::new(seed, false);
        let (mut x, mut v) = (0.6_f64, 0.0_f64);
        let (point, variance, _) = eyes.see([x, 0.0]);
        let mut filter = BallFilter::seen(point, variance, DECELERATION);
        let (mut rolls, mut rests) = (None, None);
        for step in 0..150 {
            if step == 40 {
                v = 0.75;
            }
            x += v * DT;
            v = (v - 0.35 * DT).max(0.0);
            let (point, variance, lasting) = eyes.see([x, 0.0]);
            filter.predict(standing(), DT as f32);
            filter.see(point, variance, lasting);
            if step > 40 && rolls.is_none() && filter.at_rest() < 0.5 {
                rolls = Some(step - 40);
            }
            if step == 60 {
                speeds.push(f64::from(filter.velocity().x()) - v);
            }
            if v == 0.0 && step > 40 && filter.at_rest() > 0.5 && rests.is_none() {
                rests = Some(step);
            }
        }
        noticed.push(rolls.unwrap_or(150));
        // 0.75 m/s at 0.35 m/s²: 2.14 s, 54 steps.
        stopped.push(rests.unwrap_or(150) - 94);
    }
    noticed.sort_unstable();
    stopped.sort_unstable();
    let rmse = (speeds.iter().map(|e| e * e).sum::<f64>() / speeds.len() as f64).sqrt();
    // Half of the kicks within a quarter of a second, nine of ten within half a second.
    assert!(noticed[50] <= 6 && noticed[90] <= 12, "{noticed:?}");
    // 0.15 m/s of 0.47 put the stop position 0.2 m off: about a grab's reach.
    assert!(rmse < 0.15, "{rmse} m/s after 0.8 s");
    assert!(stopped[50] <= 12 && stopped[90] <= 30, "{stopped:?}");
}

#[test]
fn a_ball_that_leaves_the_legs_may_roll_at_once() {
    let mut filter = BallFilter::held(DECELERATION);
    assert_eq!(filter.velocity(), Vector::default());
    filter.released();
    for step in 1..=5 {
        let x = 0.13 + 0.7 * DT * f64::from(step);
        filter.predict(standing(), DT as f32);
        filter.see(Point::new(x as f32, 0.0), 2e-4, 0.0);
    }
    let speed = filter.velocity().x();
    assert!((0.5..0.9).contains(&speed), "{speed}");
}

/// The same in double precision, axis by axis with whole matrices.
struct Reference {
    weight: [f64; 2],
    /// Of each model and axis: place and velocity, with their covariance.
    state: [[[f64; 2]; 2]; 2],
    covariance: [[[f64; 2]; 2]; 2],
}

impl Reference {
    fn seen(at: Point<Body>, variance: f64) -> Self {
        let place = [[f64::from(at.x()), 0.0], [f64::from(at.y()), 0.0]];
        let rest = [[variance, 0.0], [0.0, 0.0]];
        let roll = [[variance, 0.0], [0.0, f64::from(KICKED)]];
        Self { weight: [0.5, 0.5], state: [place, place], covariance: [rest, roll] }
    }

    fn predict(&mut self) {
        let roll = &self.state[1];
        let stops = f64::from(if roll[0][1].hypot(roll[1][1]) < f64::from(SLOW_BALL_SPEED) {
            STOP_RATE_SLOW
        } else {
            STOP_RATE
        }) * DT;
        let starts = f64::from(STARTS) * DT;
        let chain = [[1.0 - starts, starts], [stops, 1.0 - stops]];
        let next: [f64; 2] = core::array::from_fn(|j| (0..2).map(|i| chain[i][j] * self.weight[i]).sum());
        let share = |i: usize, j: usize| chain[i][j] * self.weight[i] / next[j];
        // A resting ball that starts has the velocity of a kick.
        let mut from_rest = self.covariance[0];
        from_rest[1][1] = f64::from(KICKED);
        let given = [[self.covariance[0], from_rest], [self.covariance[1], self.covariance[1]]];
        let before = self.state;
        let mut states = self.state;
        for j in 0..2 {
            for axis in 0..2 {
                for k in 0..2 {
                    states[j][axis][k] = (0..2).map(|i| share(i, j) * before[i][axis][k]).sum();
                }
            }
            let mut covariance = [[0.0; 2]; 2];
            for i in 0..2 {
                for (a, row) in covariance.iter_mut().enumerate() {
                    for (b, cell) in row.iter_mut().enumerate() {
                        // The mean of both axes.
                        let spread: f64 = (0..2)
                            .map(|axis| {
                                let off = |k: usize| before[i][axis][k] - states[j][axis][k];
                                0.5 * off(a) * off(b)
                            })
                            .sum();
                        *cell += share(i, j) * (given[i][j][a][b] + spread);
                    }
                }
            }
            self.covariance[j] = covariance;
        }
        // At rest there is no velocity.
        for axis in &mut states[0] {
            axis[1] = 0.0;
        }
        self.covariance[0] = [[self.covariance[0][0][0], 0.0], [0.0, 0.0]];
        (self.state, self.weight) = (states, next);
        let range = self.state[0][0][0].hypot(self.state[0][1][0]);
        let unknown = (f64::from(model::PUSHED) + 0.5 * f64::from(model::TURNED) * range * range) * DT;
        self.covariance[0][0][0] += unknown;
        let roll = &mut self.state[1];
        let speed = roll[0][1].hypot(roll[1][1]);
        let lost = (f64::from(DECELERATION) * DT).min(speed);
        let slower = if speed > 0.0 { 1.0 - lost / speed } else { 0.0 };
        for axis in roll.iter_mut() {
            axis[0] += axis[1] * 0.5 * (1.0 + slower) * DT;
            axis[1] *= slower;
        }
        let p = self.covariance[1];
        self.covariance[1] = [
            [p[0][0] + DT * (2.0 * p[0][1] + DT * p[1][1]) + unknown, p[0][1] + DT * p[1][1]],
            [p[0][1] + DT * p[1][1], p[1][1] + f64::from(ROLLING) * DT],
        ];
    }

    fn see(&mut self, at: Point<Body>, variance: f64, lasting: f64) {
        let at = [f64::from(at.x()), f64::from(at.y())];
        let mut likelihood = [0.0; 2];
        for i in 0..2 {
            let off: [f64; 2] = core::array::from_fn(|axis| at[axis] - self.state[i][axis][0]);
            let p = self.covariance[i];
            let s = p[0][0] + variance;
            likelihood[i] = (-0.5 * (off[0] * off[0] + off[1] * off[1]) / s).exp() / s;
            let s = if i == 0 { s + lasting } else { s };
            let gain = [p[0][0] / s, p[0][1] / s];
            for axis in 0..2 {
                for k in 0..2 {
                    self.state[i][axis][k] += gain[k] * off[axis];
                }
            }
            for a in 0..2 {
                for b in 0..2 {
                    self.covariance[i][a][b] -= gain[a] * p[0][b];
                }
            }
        }
        let sum: f64 = (0..2).map(|i| self.weight[i] * likelihood[i]).sum();
        let rest = (self.weight[0] * likelihood[0] / sum)
            .clamp(f64::from(PROBABILITY_MIN), 1.0 - f64::from(PROBABILITY_MIN));
        self.weight = [rest, 1.0 - rest];
    }
}

#[test]
fn it_is_the_reference_in_double_precision() {
    for seed in 0..20 {
        let mut eyes = Eyes::new(seed, seed % 2 == 0);
        let (mut at, mut v) = ([0.8_f64, -0.2_f64], [0.0_f64, 0.0]);
        let (point, variance, _) = eyes.see(at);
        let mut filter = BallFilter::seen(point, variance, DECELERATION);
        let mut reference = Reference::seen(point, f64::from(variance));
        for step in 0..200 {
            if step % 90 == 45 {
                v = [0.5, 0.4];
            }
            let speed = v[0].hypot(v[1]);
            for (place, v) in at.iter_mut().zip(&mut v) {
                *place += *v * DT;
                *v *= if speed > 0.0 { (1.0 - 0.35 * DT / speed).max(0.0) } else { 0.0 };
            }
            let (point, variance, lasting) = eyes.see(at);
            filter.predict(standing(), DT as f32);
            reference.predict();
            let apart = (f64::from(filter.at_rest()) - reference.weight[0]).abs();
            assert!(apart < 0.01, "seed {seed}, step {step}: {} {}", filter.at_rest(), reference.weight[0]);
            filter.see(point, variance, lasting);
            reference.see(point, f64::from(variance), f64::from(lasting));
            let place = filter.place();
            let other: [f64; 2] = core::array::from_fn(|axis| {
                (0..2).map(|i| reference.weight[i] * reference.state[i][axis][0]).sum()
            });
            let off = (f64::from(place.x()) - other[0]).hypot(f64::from(place.y()) - other[1]);
            assert!(off < 0.002, "seed {seed}, step {step}: {off} m");
        }
    }
}

#[test]
fn its_variance_is_that_of_its_errors() {
    // NEES of two degrees of freedom: 2,000 runs have a mean of 2 with a deviation of √(4 / 2,000) = 0.045. A
    // ball that starts and stops as the filter assumes it, with errors that do not last. Two models in place
    // of one for every history make it up to a sixth too cautious; bolder than its errors it must not be.
    for seconds in [1, 4] {
        let (mut sum, runs) = (0.0, 2_000);
        for seed in 0..runs {
            let mut random = RandomStream::new(seed);
            let (mut at, mut v) = ([0.9_f64, 0.3_f64], [0.0_f64; 2]);
            let variance = 0.002_f64;
            let seen = |at: [f64; 2], random: &mut RandomStream| {
                let off = |random: &mut RandomStream| variance.sqrt() * random.normal();
                Point::<Body>::new((at[0] + off(random)) as f32, (at[1] + off(random)) as f32)
            };
            let kick =
                |random: &mut RandomStream| [(); 2].map(|()| f64::from(KICKED).sqrt() * random.normal());
            if random.share() < 0.5 {
                v = kick(&mut random);
            }
            let mut filter = BallFilter::seen(seen(at, &mut random), variance as f32, DECELERATION);
            for _ in 0..seconds * 25 {
                let speed = v[0].hypot(v[1]);
                let stops =
                    f64::from(if speed < f64::from(SLOW_BALL_SPEED) { STOP_RATE_SLOW } else { STOP_RATE })
                        * DT;
                match speed > 0.0 {
                    true if random.share() < stops => v = [0.0; 2],
                    false if random.share() < f64::from(STARTS) * DT => v = kick(&mut random),
                    _ => {}
                }
                let range = at[0].hypot(at[1]);
                let unknown =
                    (f64::from(model::PUSHED) + 0.5 * f64::from(model::TURNED) * range * range) * DT;
                let speed = v[0].hypot(v[1]);
                let share = if speed > 0.0 { (1.0 - 0.35 * DT / speed).max(0.0) } else { 0.0 };
                for (place, v) in at.iter_mut().zip(&mut v) {
                    *place += *v * 0.5 * (1.0 + share) * DT + unknown.sqrt() * random.normal();
                    *v *= share;
                }
                filter.predict(standing(), DT as f32);
                filter.see(seen(at, &mut random), variance as f32, 0.0);
            }
            let place = filter.place();
            let off = (f64::from(place.x()) - at[0]).powi(2) + (f64::from(place.y()) - at[1]).powi(2);
            sum += off / f64::from(filter.variance());
        }
        let mean = sum / f64::from(runs as u32);
        println!("after {seconds} s: {mean}");
        let (least, most) = (2.0 * 5.0 / 6.0, 2.0 + 3.0 * 0.045);
        assert!((least..most).contains(&mean), "after {seconds} s: {mean}");
    }
}
