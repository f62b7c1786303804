//! `sense`: conversion of raw sensor readings: encoder counts to rim speed, a gyroscope without its offset, a
//! break-beam sensor in daylight, and whether the robot is tipped. Sans-IO; SI units, fed at the pace of the
//! control loop.

use protocol::{Duration, Instant};
use rules::{BreakBeamSpec, ImuSpec, RobotSpec};

/// A wheel's encoder: a counter of 16 bits that wraps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Encoder {
    per_count: f32,
    last: Option<(Instant, u16)>,
    speed: f32,
    /// Time and count at which the wheel started to be driven hard without moving.
    stuck: Option<(Instant, u16)>,
}

impl Encoder {
    /// An encoder whose count is `per_count` m of rim; negative where it counts down forwards.
    pub const fn new(per_count: f32) -> Self {
        Self { per_count, last: None, speed: 0.0, stuck: None }
    }

    /// Rim speed since the last step, m/s, from the counter and from the duty cycle of that time; NaN once
    /// the wheel was driven hard for a while without moving. Then the encoder, its cable or the motor is
    /// broken, and the governor brakes the robot.
    pub fn step(&mut self, now: Instant, count: u16, rule_role: f32) -> f32 {
        if let Some((at, before)) = self.last {
            let micros = now.since(at).0;
            if micros > 0 {
                let counts = f32::from(count.wrapping_sub(before).cast_signed());
                self.speed = counts * self.per_count * (1e6 / micros as f32);
                self.last = Some((now, count));
            }
        } else {
            self.last = Some((now, count));
        }
        let hard = rule_role.abs() >= HARD;
        self.stuck = match self.stuck {
            Some((_, from)) if count.wrapping_sub(from).cast_signed().unsigned_abs() > SHAKES => None,
            // Broken stays broken until the wheel moves: the duty cycle falls because the wheel is broken.
            Some((since, _)) if !hard && now.since(since) < STUCK_FOR => None,
            None if hard => Some((now, count)),
            stuck => stuck,
        };
        let broken = self.stuck.is_some_and(|(since, _)| now.since(since) >= STUCK_FOR);
        if broken { f32::NAN } else { self.speed }
    }
}

/// A gyroscope's offset, determined while the robot stands after its start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turn {
    zero: Option<f32>,
    sum: f32,
    seen: u16,
    least: f32,
    most: f32,
}

impl Turn {
    /// Offset not known yet.
    pub const fn new() -> Self {
        Self { zero: None, sum: 0.0, seen: 0, least: f32::INFINITY, most: f32::NEG_INFINITY }
    }

    /// The rate without the sensor's offset, rad/s; `None` until it stood still for half a second, and for a
    /// reading of NaN.
    pub fn step(&mut self, rate: f32) -> Option<f32> {
        if !rate.is_finite() {
            return None;
        }
        if let Some(zero) = self.zero {
            return Some(rate - zero);
        }
        self.sum += rate;
        self.seen += 1;
        (self.least, self.most) = (self.least.min(rate), self.most.max(rate));
        let mean = self.sum / f32::from(self.seen);
        if self.most - self.least > UNREST || mean.abs() > ZERO_MAX {
            *self = Self::new();
        } else if self.seen >= STILL_SAMPLES {
            self.zero = Some(mean);
        }
        None
    }
}

impl Default for Turn {
    fn default() -> Self {
        Self::new()
    }
}

/// Detector of a robot that lies on its side.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Tilt {
    tipped: bool,
    otherwise_since: Option<Instant>,
}

impl Tilt {
    /// A detector that starts with the robot upright.
    pub const fn new() -> Self {
        Self { tipped: false, otherwise_since: None }
    }

    /// Whether the robot lies, from the upward part of the acceleration, g: 1 upright, 0 on its side. Short
    /// shocks are ignored; NaN is no reading.
    pub fn step(&mut self, now: Instant, up: f32) -> bool {
        let seems = if up.is_nan() { self.tipped } else { up < UPRIGHT };
        if seems == self.tipped {
            self.otherwise_since = None;
        } else {
            let since = *self.otherwise_since.get_or_insert(now);
            if now.since(since) >= TILT_FOR {
                (self.tipped, self.otherwise_since) = (seems, None);
            }
        }
        self.tipped
    }
}

/// A break-beam sensor whose lamp toggles with every step, so that daylight is distinguished from the lamp.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct BreakBeam {
    dark: Option<f32>,
    broken: bool,
}

impl BreakBeam {
    /// A sensor without readings.
    pub const fn new() -> Self {
        Self { dark: None, broken: false }
    }

    /// Whether the beam is interrupted, from the receiver's reading, 0 to 1, and whether the lamp is lit. A
    /// receiver that is blinded, or reads NaN, detects no ball, because the kicker fires by it.
    pub fn step(&mut self, lit: bool, level: f32) -> bool {
        if !lit {
            self.dark = Some(level);
        } else if let Some(dark) = self.dark {
            let lamp = level - dark;
            if !lamp.is_finite() || dark > BLIND {
                self.broken = false;
            } else if lamp < LAMP_HIDDEN {
                self.broken = true;
            } else if lamp > LAMP_SEEN {
                self.broken = false;
            }
        }
        self.broken
    }
}

/// A share of full voltage that moves any wheel that can be moved.
const HARD: f32 = 0.8;
/// A wheel that has not moved by then, at that duty cycle, is broken: the motor follows in 30 ms.
const STUCK_FOR: Duration = Duration::millis(200);
/// Counts by which a broken line, or a blocked wheel, may fluctuate.
const SHAKES: u16 = 8;
const IMU: ImuSpec = RobotSpec::OURS.imu;
/// Spread of a standing gyroscope's readings, rad/s.
const UNREST: f32 = IMU.unrest;
/// A larger offset is invalid, rad/s.
const ZERO_MAX: f32 = IMU.offset_max;
/// Number of readings for an offset: half a second of a millisecond each.
const STILL_SAMPLES: u16 = 500;
/// Upward part of the acceleration below which the robot lies, g: 60° from upright.
const UPRIGHT: f32 = 0.5;
/// Duration after which a kick or a bump is over.
const TILT_FOR: Duration = Duration::millis(300);
const BEAM: BreakBeamSpec = RobotSpec::OURS.break_beam;
/// Share of the receiver's range by which the lamp lifts it, with a ball in the beam and without.
const LAMP_HIDDEN: f32 = BEAM.hidden;
const LAMP_SEEN: f32 = BEAM.seen;
/// Daylight above which the lamp cannot be distinguished.
const BLIND: f32 = BEAM.blind;

#[cfg(test)]
mod tests {
    use super::*;

    fn ms(n: u64) -> Instant {
        Instant(1_000 * n)
    }

    #[test]
    fn counts_become_speed_across_the_counters_end_in_both_directions() {
        let mut encoder = Encoder::new(0.0001);
        assert_eq!(encoder.step(ms(0), 65_530, 0.0), 0.0);
        // 20 counts of 0.1 mm in a millisecond.
        assert!((encoder.step(ms(1), 14, 0.3) - 2.0).abs() < 1e-5);
        assert!((encoder.step(ms(3), 65_530, -0.3) + 1.0).abs() < 1e-5);
        // Two calls at one time: as before.
        assert!((encoder.step(ms(3), 65_530, -0.3) + 1.0).abs() < 1e-5);
        let mut mirrored = Encoder::new(-0.0001);
        mirrored.step(ms(0), 100, 0.0);
        assert!((mirrored.step(ms(1), 90, 0.0) - 1.0).abs() < 1e-5);
    }

    #[test]
    fn a_wheel_that_is_driven_hard_and_does_not_move_is_reported_and_heals_when_it_moves() {
        let mut encoder = Encoder::new(0.0001);
        // One channel is broken: the count fluctuates.
        for t in 0..200 {
            assert!(encoder.step(ms(t), (t % 2) as u16, 1.0).is_finite(), "{t} ms");
        }
        assert!(encoder.step(ms(200), 0, 1.0).is_nan());
        // The governor has braked: still broken.
        assert!(encoder.step(ms(300), 1, 0.0).is_nan());
        assert!(encoder.step(ms(301), 40, 0.0).is_finite());
        for t in 302..1_000 {
            assert!(encoder.step(ms(t), 40, 0.5).is_finite(), "half duty may stand against a load");
        }
    }

    #[test]
    fn a_wheel_that_moves_is_never_reported() {
        let mut encoder = Encoder::new(0.0001);
        for t in 0..5_000 {
            let rule_role = if t % 700 < 350 { 1.0 } else { -1.0 };
            assert!(
                encoder.step(ms(t), (t % 700).min(700 - t % 700) as u16, rule_role).is_finite(),
                "{t} ms"
            );
        }
    }

    #[test]
    fn a_zero_is_found_at_rest_and_taken_off() {
        let mut turn = Turn::new();
        let still = |n: u16| 0.01 + if n.is_multiple_of(2) { 0.005 } else { -0.005 };
        // Carried around first, then put down.
        for n in 0..300 {
            assert_eq!(turn.step(if n % 20 < 10 { 1.0 } else { 0.02 }), None);
        }
        for n in 0..600 {
            if turn.step(still(n)).is_some() {
                break;
            }
        }
        let rate = turn.step(2.01);
        assert!(rate.is_some_and(|rate| (rate - 2.0).abs() < 1e-3), "{rate:?}");
        assert_eq!(turn.step(f32::NAN), None);
    }

    #[test]
    fn a_robot_that_turns_steadily_while_it_starts_gets_no_zero() {
        let mut turn = Turn::new();
        assert!((0..5_000).all(|_| turn.step(0.5).is_none()));
    }

    #[test]
    fn lying_is_reported_after_a_while_and_blows_are_not() {
        let mut tilt = Tilt::new();
        assert!(!tilt.step(ms(0), 1.0));
        assert!(!tilt.step(ms(1), -8.0) && !tilt.step(ms(200), -1.0) && !tilt.step(ms(250), 1.0));
        assert!(!tilt.step(ms(1_000), 0.1) && !tilt.step(ms(1_299), 0.1));
        assert!(tilt.step(ms(1_300), 0.1) && tilt.step(ms(1_400), f32::NAN));
        assert!(tilt.step(ms(1_500), 0.9) && !tilt.step(ms(1_800), 0.9));
    }

    #[test]
    fn a_ball_is_distinguished_from_daylight_and_a_blinded_receiver_sees_none() {
        let mut barrier = BreakBeam::new();
        assert!(!barrier.step(true, 0.5), "nothing to compare with yet");
        for daylight in [0.0, 0.3, 0.6] {
            barrier.step(false, daylight);
            assert!(!barrier.step(true, daylight + 0.3), "free at {daylight}");
            barrier.step(false, daylight);
            assert!(barrier.step(true, daylight + 0.02), "ball at {daylight}");
            assert!(barrier.step(true, daylight + 0.12), "between the two it stays");
            barrier.step(true, daylight + 0.3);
            assert!(!barrier.step(true, daylight + 0.12), "between the two it stays");
        }
        barrier.step(false, 0.95);
        assert!(!barrier.step(true, 1.0));
        barrier.step(false, 0.1);
        assert!(!barrier.step(true, f32::NAN));
    }
}
