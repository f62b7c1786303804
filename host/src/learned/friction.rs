//! `friction`: estimate of a rolling ball's deceleration. A parabola through the places of a ball on the
//! ground that no robot is near, along its line. m, s.

use geometry::{Field, Point, Vector};
use protocol::{Duration, Instant};

use super::samples::{Estimate, Samples};
use crate::world::World;

/// Samples kept: a few minutes of play.
const ROLLS_KEPT: usize = 25;
/// Number of rolls needed.
const ROLLS_MIN: usize = 5;
/// No robot's centre is nearer to the ball, m: a radius of 0.09 and its motion between two frames.
const ROBOT_CLEARANCE_M: f32 = 0.2;
/// A kicked ball slides for at most this time: 6.5 m/s × 2/7 at 3.9 m/s² are 0.48 s.
const SLIDING_TIME_MAX: Duration = Duration::millis(500);
/// Slower balls are stopped by the fibres of the field surface, and faster ones may still slide, m/s.
const SPEED_MIN_M_S: f32 = 0.25;
const SPEED_MAX_M_S: f32 = 5.0;
/// A roll of this duration gives its deceleration within 0.05 m/s² where places err by 2 mm.
const ROLL_TIME_MIN: Duration = Duration::millis(500);
/// A longer one counts as two.
const ROLL_TIME_DOUBLE: Duration = Duration::millis(1_500);
/// Number of camera frames needed.
const FRAMES_MIN: f64 = 20.0;
/// Cosine of the turn that ends a roll: 6°, the noise of the slowest.
const TURN_COS_MIN: f32 = 0.994;
/// Larger deviations from the parabola are no free roll, m (root of the mean square).
const PARABOLA_RMS_MAX_M: f64 = 0.008;
/// Deceleration of a rolling ball on field surfaces, m/s².
const DECELERATION_MIN_M_S2: f32 = 0.05;
const DECELERATION_MAX_M_S2: f32 = 1.5;

/// The field, as far as balls have rolled on it.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Friction {
    samples: Samples<ROLLS_KEPT>,
    roll: Option<Roll>,
}

/// A ball that rolls by itself.
#[derive(Clone, Copy, Debug)]
struct Roll {
    /// Start of the roll; the parabola's time counts from it.
    began: Instant,
    from: Point<Field>,
    along: Vector<Field>,
    newest: Instant,
    /// Sums of tᵏ for k = 0–4, of s·tᵏ for k = 0–2, and of s².
    times: [f64; 5],
    distances: [f64; 3],
    squares: f64,
}

impl Friction {
    /// Takes the field at the newest camera frame.
    pub(super) fn see(&mut self, world: &World) {
        let Some(ball) = world.ball.filter(|ball| ball.height <= 0.0 && ball.climb <= 0.0) else {
            self.end();
            return;
        };
        if self.roll.is_some_and(|roll| ball.seen <= roll.newest) {
            return;
        }
        let speed = ball.velocity.norm();
        let near = world.nearest(ball.position).is_some_and(|(_, off)| off < ROBOT_CLEARANCE_M);
        let slides =
            ball.kicked.is_some_and(|kick| kick.is_chip() || ball.seen.since(kick.at).0 < SLIDING_TIME_MAX.0);
        if near || slides || !(SPEED_MIN_M_S..SPEED_MAX_M_S).contains(&speed) {
            self.end();
            return;
        }
        let Some(along) = ball.velocity.unit() else { return };
        let turned = self.roll.is_some_and(|roll| roll.along.dot(along) < TURN_COS_MIN);
        if turned || self.roll.is_some_and(|roll| ball.seen.since(roll.began).0 > ROLL_TIME_DOUBLE.0) {
            self.end();
        }
        let roll = self.roll.get_or_insert(Roll {
            began: ball.seen,
            from: ball.position,
            along,
            newest: ball.seen,
            times: [0.0; 5],
            distances: [0.0; 3],
            squares: 0.0,
        });
        roll.newest = ball.seen;
        roll.add(ball.seen.since(roll.began).as_secs_f32(), (ball.position - roll.from).dot(roll.along));
    }

    fn end(&mut self) {
        if let Some(deceleration) = self.roll.take().and_then(|roll| roll.deceleration()) {
            self.samples.add(deceleration);
        }
    }

    pub(super) fn deceleration(&self) -> Option<Estimate> {
        self.samples.estimate(ROLLS_MIN)
    }
}

impl Roll {
    fn add(&mut self, t: f32, s: f32) {
        let (t, s) = (f64::from(t), f64::from(s));
        let mut power = 1.0;
        for k in 0..5 {
            self.times[k] += power;
            if k < 3 {
                self.distances[k] += s * power;
            }
            power *= t;
        }
        self.squares += s * s;
    }

    /// Deceleration by least squares, m/s², where the ball rolled for long enough and its deceleration is
    /// plausible.
    fn deceleration(&self) -> Option<f32> {
        if self.newest.since(self.began).0 < ROLL_TIME_MIN.0 || self.times[0] < FRAMES_MIN {
            return None;
        }
        let [n, t1, t2, t3, t4] = self.times;
        let [s0, s1, s2] = self.distances;
        // Cramer's rule for s = a + b t + c t².
        let det = n * (t2 * t4 - t3 * t3) - t1 * (t1 * t4 - t2 * t3) + t2 * (t1 * t3 - t2 * t2);
        if det.abs() < 1e-9 {
            return None;
        }
        let a = (s0 * (t2 * t4 - t3 * t3) - t1 * (s1 * t4 - s2 * t3) + t2 * (s1 * t3 - s2 * t2)) / det;
        let b = (n * (s1 * t4 - s2 * t3) - s0 * (t1 * t4 - t2 * t3) + t2 * (t1 * s2 - t2 * s1)) / det;
        let c = (n * (t2 * s2 - t3 * s1) - t1 * (t1 * s2 - t2 * s1) + s0 * (t1 * t3 - t2 * t2)) / det;
        let residual = (self.squares - a * s0 - b * s1 - c * s2) / n;
        let deceleration = (-2.0 * c) as f32;
        let rolls = residual < PARABOLA_RMS_MAX_M * PARABOLA_RMS_MAX_M
            && (DECELERATION_MIN_M_S2..=DECELERATION_MAX_M_S2).contains(&deceleration);
        rolls.then_some(deceleration)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::{Ball, BallModels, Robot};
    use geometry::Pose;
    use protocol::{RobotId, Who};
    use rules::Colour;

    /// Balls that roll from 2 m/s with that deceleration, seen at 75 Hz with 3 mm of noise; `followed`: a
    /// robot is beside the ball.
    fn learn(deceleration: f32, balls: u64, followed: bool) -> Option<Estimate> {
        let mut learned = Friction::default();
        let mut noise = 99_u32;
        for n in 0..balls {
            for frame in 0..100_u64 {
                let at = Instant(n * 10_000_000 + frame * 13_333);
                let t = (frame as f32 * 0.013_333).min(2.0 / deceleration);
                let distance = 2.0 * t - 0.5 * deceleration * t * t;
                noise = noise.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                let jitter = 0.003 * ((noise >> 16) as f32 / 32_768.0 - 1.0);
                let place = Point::new(-3.0 + distance + jitter, 1.0);
                let velocity = Vector::new((2.0 - deceleration * t).max(0.0), 0.0);
                let mut world = World::empty(at, BallModels::default());
                world.ball = Some(Ball { velocity, ..Ball::at_rest(place, at) });
                if followed {
                    let pose = Pose { position: place + Vector::new(0.0, 0.15), ..Pose::default() };
                    let who = Who { colour: Colour::Blue, id: RobotId::ZERO };
                    let (velocity, confidence) = (Vector::default(), 1.0);
                    world.put(Robot { who, pose, velocity, angular: 0.0, confidence, seen: at });
                }
                learned.see(&world);
            }
            learned.see(&World::empty(Instant(n * 10_000_000 + 2_000_000), BallModels::default()));
        }
        learned.deceleration()
    }

    #[test]
    fn decelerations_of_0_2_to_1_m_s2_are_known_within_a_tenth_after_ten_balls() {
        for truth in [0.2, 0.35, 0.6, 1.0] {
            let known = learn(truth, 10, false).unwrap();
            assert!((known.value - truth).abs() < 0.1 * truth + 0.01, "{truth}: {known:?}");
        }
    }

    #[test]
    fn balls_beside_robots_and_too_few_balls_teach_nothing() {
        assert_eq!(learn(0.35, 10, true), None);
        assert_eq!(learn(0.35, 4, false), None);
        assert_eq!(learn(3.0, 10, false), None, "no ball rolls like that");
    }
}
