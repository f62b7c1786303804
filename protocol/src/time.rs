//! `time`: instants and durations, given by the caller: microseconds since the robot's start. Nothing here
//! reads a clock.

use core::ops::{Add, AddAssign, Mul, Sub};

use serde::{Deserialize, Serialize};

/// A moment, µs since the start of the sender's clock.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Default, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Instant(pub u64);

/// A duration, µs; never negative.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Default, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Duration(pub u64);

impl Instant {
    /// Time since `earlier`; zero if it is in the future.
    pub const fn since(self, earlier: Self) -> Duration {
        Duration(self.0.saturating_sub(earlier.0))
    }

    /// Seconds since the start of the clock (exact to the microsecond for the first 16 seconds, then to
    /// 2⁻²⁴).
    pub fn as_secs_f32(self) -> f32 {
        Duration(self.0).as_secs_f32()
    }
}

impl Duration {
    /// The duration of `ms` milliseconds.
    pub const fn millis(ms: u64) -> Self {
        Self(ms * 1000)
    }

    /// The duration in seconds, rounded to f32.
    pub fn as_secs_f32(self) -> f32 {
        // The first hour in one instruction of a robot's processor; the same number in both branches.
        let micros = u32::try_from(self.0).map_or_else(|_| self.0 as f32, |micros| micros as f32);
        micros * 1e-6
    }

    /// Duration from seconds; negative or NaN gives zero.
    pub fn from_secs_f32(seconds: f32) -> Self {
        Self((seconds * 1e6) as u64)
    }
}

impl Add<Duration> for Instant {
    type Output = Self;
    fn add(self, d: Duration) -> Self {
        Self(self.0.saturating_add(d.0))
    }
}
impl AddAssign<Duration> for Instant {
    fn add_assign(&mut self, d: Duration) {
        *self = *self + d;
    }
}
impl Sub<Duration> for Instant {
    type Output = Self;
    fn sub(self, d: Duration) -> Self {
        Self(self.0.saturating_sub(d.0))
    }
}
impl Add for Duration {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(self.0.saturating_add(other.0))
    }
}
impl Mul<u64> for Duration {
    type Output = Self;
    fn mul(self, k: u64) -> Self {
        Self(self.0.saturating_mul(k))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn time_never_runs_below_zero() {
        assert_eq!(Instant(3).since(Instant(5)), Duration(0));
        assert_eq!(Instant(3) - Duration(5), Instant(0));
        assert_eq!(Duration::from_secs_f32(-1.0), Duration(0));
    }

    #[test]
    fn seconds_are_the_same_number_on_both_sides_of_an_hour() {
        for micros in [0, 1, 16_777_217, 0xffff_ff7f, 0xffff_ffff, 0x1_0000_0000, 0x1_0000_0101, u64::MAX] {
            assert_eq!(Duration(micros).as_secs_f32(), micros as f32 * 1e-6, "{micros}");
        }
    }
}
