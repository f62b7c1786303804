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
    pub fn step(&mut self, now: Instant, count: u16, duty: f32) -> f32 {
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
        let hard = duty.abs() >= STALL_DUTY;
        self.stuck = match self.stuck {
            Some((_, from)) if count.wrapping_sub(from).cast_signed().unsigned_abs() > SHAKE_COUNTS => None,
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
pub struct GyroOffset {
    zero: Option<f32>,
    sum: f32,
    seen: u16,
    least: f32,
    most: f32,
}

impl GyroOffset {
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
        if self.most - self.least > STANDING_SPREAD_MAX || mean.abs() > ZERO_MAX {
            *self = Self::new();
        } else if self.seen >= STILL_SAMPLES {
            self.zero = Some(mean);
        }
        None
    }
}

impl Default for GyroOffset {
    fn default() -> Self {
        Self::new()
    }
}

/// Detector of a robot that lies on its side.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Tilt {
    tipped: bool,
    contrary_since: Option<Instant>,
}

impl Tilt {
    /// A detector that starts with the robot upright.
    pub const fn new() -> Self {
        Self { tipped: false, contrary_since: None }
    }

    /// Returns whether the robot lies, from the upward part of the acceleration, g: 1 upright, 0 on its side.
    /// Short shocks are ignored; NaN is no reading.
    pub fn step(&mut self, now: Instant, up: f32) -> bool {
        let seems = if up.is_nan() { self.tipped } else { up < TIPPED_BELOW_G };
        if seems == self.tipped {
            self.contrary_since = None;
        } else {
            let since = *self.contrary_since.get_or_insert(now);
            if now.since(since) >= TILT_DEBOUNCE {
                (self.tipped, self.contrary_since) = (seems, None);
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

    /// Returns whether the beam is interrupted, from the receiver's reading, 0 to 1, and whether the lamp is
    /// lit. A receiver that is blinded, or reads NaN, detects no ball, because the kicker fires by it.
    pub fn step(&mut self, lit: bool, level: f32) -> bool {
        if !lit {
            self.dark = Some(level);
        } else if let Some(dark) = self.dark {
            let lamp = level - dark;
            if !lamp.is_finite() || dark > DAYLIGHT_MAX {
                self.broken = false;
            } else if lamp < LAMP_LIFT_WITH_BALL {
                self.broken = true;
            } else if lamp > LAMP_LIFT_FREE {
                self.broken = false;
            }
        }
        self.broken
    }
}

/// Duty cycle from which any wheel moves that can be moved, share of full voltage.
const STALL_DUTY: f32 = 0.8;
/// Time at [`STALL_DUTY`] without motion after which a wheel is broken: a motor follows in 30 ms.
const STUCK_FOR: Duration = Duration::millis(200);
/// Encoder counts by which a broken line, or a blocked wheel, may fluctuate.
const SHAKE_COUNTS: u16 = 8;
const IMU: ImuSpec = RobotSpec::OURS.imu;
/// Largest spread of a standing gyroscope's readings, rad/s.
const STANDING_SPREAD_MAX: f32 = IMU.unrest;
/// Largest valid offset of a gyroscope, rad/s.
const ZERO_MAX: f32 = IMU.offset_max;
/// Number of readings that give an offset: half a second, one a millisecond.
const STILL_SAMPLES: u16 = 500;
/// Upward part of the acceleration below which the robot lies, g: 60° from upright.
const TIPPED_BELOW_G: f32 = 0.5;
/// Time that a change of the tilt must last: kicks and bumps are shorter.
const TILT_DEBOUNCE: Duration = Duration::millis(300);
const BEAM: BreakBeamSpec = RobotSpec::OURS.break_beam;
/// Rise of the receiver's level by the lamp with a ball in the beam, at most, as a share of its range.
const LAMP_LIFT_WITH_BALL: f32 = BEAM.hidden;
/// The same of a free beam, at least.
const LAMP_LIFT_FREE: f32 = BEAM.seen;
/// Level of daylight above which the lamp does not show, share of the receiver's range.
const DAYLIGHT_MAX: f32 = BEAM.blind;

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
    fn a_stalled_wheel_reads_nan_until_it_moves_again() {
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
    fn a_wheel_that_moves_always_reads_a_speed() {
        let mut encoder = Encoder::new(0.0001);
        for t in 0..5_000 {
            let duty = if t % 700 < 350 { 1.0 } else { -1.0 };
            assert!(encoder.step(ms(t), (t % 700).min(700 - t % 700) as u16, duty).is_finite(), "{t} ms");
        }
    }

    #[test]
    fn a_gyroscopes_offset_is_found_at_rest_and_subtracted() {
        let mut turn = GyroOffset::new();
        // Carried around first, then put down.
        for n in 0..300 {
            assert_eq!(turn.step(if n % 20 < 10 { 1.0 } else { 0.02 }), None);
        }
        for n in 0..600 {
            if turn.step(if n % 2 == 0 { 0.015 } else { 0.005 }).is_some() {
                break;
            }
        }
        let rate = turn.step(2.01);
        assert!(rate.is_some_and(|rate| (rate - 2.0).abs() < 1e-3), "{rate:?}");
        assert_eq!(turn.step(f32::NAN), None);
    }

    #[test]
    fn a_robot_that_turns_steadily_while_it_starts_gets_no_offset() {
        let mut turn = GyroOffset::new();
        assert!((0..5_000).all(|_| turn.step(0.5).is_none()));
    }

    #[test]
    fn a_robot_is_tipped_after_300_ms_on_its_side_and_not_after_a_blow() {
        let mut tilt = Tilt::new();
        assert!(!tilt.step(ms(0), 1.0));
        assert!(!tilt.step(ms(1), -8.0) && !tilt.step(ms(200), -1.0) && !tilt.step(ms(250), 1.0));
        assert!(!tilt.step(ms(1_000), 0.1) && !tilt.step(ms(1_299), 0.1));
        assert!(tilt.step(ms(1_300), 0.1) && tilt.step(ms(1_400), f32::NAN));
        assert!(tilt.step(ms(1_500), 0.9) && !tilt.step(ms(1_800), 0.9));
    }

    #[test]
    fn daylight_is_no_ball_and_a_blinded_receiver_sees_none() {
        let mut beam = BreakBeam::new();
        assert!(!beam.step(true, 0.5), "nothing to compare with yet");
        for daylight in [0.0, 0.3, 0.6] {
            beam.step(false, daylight);
            assert!(!beam.step(true, daylight + 0.3), "free at {daylight}");
            beam.step(false, daylight);
            assert!(beam.step(true, daylight + 0.02), "ball at {daylight}");
            assert!(beam.step(true, daylight + 0.12), "between the two it stays");
            beam.step(true, daylight + 0.3);
            assert!(!beam.step(true, daylight + 0.12), "between the two it stays");
        }
        beam.step(false, 0.95);
        assert!(!beam.step(true, 1.0));
        beam.step(false, 0.1);
        assert!(!beam.step(true, f32::NAN));
    }
}
