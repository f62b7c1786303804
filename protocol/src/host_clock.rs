//! `host_clock`: maximum age of a frame of the host, on a robot's clock. Ticks of 64 µs, wrapping after 76 h.
//!
//! The counter of the host's frames is its clock ([`crate::host_link::HostLink::seal`]). A robot's telemetry
//! carries the robot's clock, and a welcome the host's clock at that telemetry's arrival less this reading:
//! the `offset`. Since no frame arrives before it was sent, the offset is never less than the true difference
//! of the clocks, so
//!
//! ```text
//! age = own clock now + offset − counter of the frame
//! ```
//!
//! is never less than the true age, however long either frame was delayed or withheld: it is the sum of both
//! latencies, up and down. The smallest offset counts. It grows by 1/1024 of the time since it was learned,
//! more than two clocks drift apart (crystals 100 ppm, a slewed system clock 500 ppm).

use crate::{Duration, Instant};

/// Maximum accepted age of the host's frames: beyond it the host is silent.
pub const AGE_MAX: Duration = Duration::millis(200);
/// The host's counters may run ahead of its clock by this many ticks (20 ms): it sends at most 40 frames at
/// once. A frame that is further ahead proves that the robot's clock stood still.
const AHEAD_MAX: u32 = 312;

/// A clock's reading in ticks, wrapping.
pub const fn ticks(at: Instant) -> u32 {
    (at.0 >> TICK_BITS) as u32
}

/// A tick is 2⁶ µs, so that a shift replaces a division.
pub(crate) const TICK_BITS: u32 = 6;

/// A robot's estimate of its host's clock.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HostClock {
    /// Upper bound of the host's clock less the robot's, when it was learned.
    offset: u32,
    /// Time of that reading, on the robot's clock.
    learned: u32,
}

/// Age of a frame by its counter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Age {
    /// Maximum age of the frame, by both clocks.
    Within(Duration),
    /// Older than [`AGE_MAX`]: not obeyed.
    Stale,
    /// From the future: one of the clocks has stood still since the offset was learned.
    Ahead,
}

impl HostClock {
    /// State after a welcome with this offset; `known` is the earlier state for the same host.
    pub const fn learned(known: Option<Self>, now: Instant, offset: u32) -> Self {
        let learned = ticks(now);
        let offset = match known {
            Some(known) if !is_before(offset, known.offset_at(learned)) => known.offset_at(learned),
            _ => offset,
        };
        Self { offset, learned }
    }

    /// Age of a frame with this counter.
    pub const fn age(&self, now: Instant, counter: u32) -> Age {
        let now = ticks(now);
        let age = now.wrapping_add(self.offset_at(now)).wrapping_sub(counter);
        if age <= AGE_MAX_TICKS {
            Age::Within(Duration((age as u64) << TICK_BITS))
        } else if age <= u32::MAX / 2 {
            Age::Stale
        } else if age >= AHEAD_MAX.wrapping_neg() {
            Age::Within(Duration(0))
        } else {
            Age::Ahead
        }
    }

    /// The offset with the drift since it was learned.
    const fn offset_at(self, now: u32) -> u32 {
        self.offset.wrapping_add(now.wrapping_sub(self.learned) >> 10).wrapping_add(1)
    }
}

/// The same in ticks.
const AGE_MAX_TICKS: u32 = (AGE_MAX.0 >> TICK_BITS) as u32;

const fn is_before(a: u32, b: u32) -> bool {
    a.wrapping_sub(b) > u32::MAX / 2
}

#[cfg(test)]
mod tests {
    use super::*;

    const fn ms(n: u64) -> Instant {
        Instant(n * 1000)
    }

    fn within(age: Age) -> Option<u64> {
        match age {
            Age::Within(age) => Some(age.0),
            Age::Stale | Age::Ahead => None,
        }
    }

    #[test]
    fn a_frames_age_is_the_round_trip_whatever_the_clocks_show() {
        // The host's clock is 7 s ahead; 20 ms up, 30 ms down. Both clocks wrap in between.
        for start in [0, 3_600_000, 274_877_900 - 50, 274_877_900 - 7_000] {
            let host = |at: u64| ticks(ms(start + at + 7_000));
            let robot = |at: u64| ms(start + at);
            let offset = host(120).wrapping_sub(ticks(robot(100)));
            let clock = HostClock::learned(None, robot(150), offset);
            let age = within(clock.age(robot(230), host(200))).unwrap();
            assert!((50_000..50_400).contains(&age), "start {start}: {age}");
        }
    }

    #[test]
    fn the_smallest_offset_counts_and_grows_by_a_thousandth() {
        let clock = HostClock::learned(None, ms(0), 1_000);
        let worse = HostClock::learned(Some(clock), ms(100), 5_000);
        assert_eq!(worse.offset, 1_000 + 1 + 1);
        let better = HostClock::learned(Some(worse), ms(200), 900);
        assert_eq!(better.offset, 900);
        // After ten seconds without a welcome the bound is ten milliseconds wider.
        let age = within(better.age(ms(10_200), ticks(ms(10_200)).wrapping_add(900))).unwrap();
        assert!((9_700..10_100).contains(&age), "{age}");
    }

    #[test]
    fn two_hundred_milliseconds_are_within_and_more_is_stale() {
        let clock = HostClock::learned(None, ms(1_000), 0);
        let now = ms(1_000);
        assert!(matches!(clock.age(now, ticks(ms(801))), Age::Within(_)));
        assert_eq!(clock.age(now, ticks(ms(799))), Age::Stale);
        assert_eq!(clock.age(now, ticks(ms(1_019))), Age::Within(Duration(0)));
        assert_eq!(clock.age(now, ticks(ms(1_025))), Age::Ahead);
    }
}
