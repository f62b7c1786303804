//! `stamps`: check of packet stamps against the referee's clock. Compares the difference between stamps with
//! the difference between arrivals on our own clock, µs, so that the two clocks need not agree.
//!
//! A [`StampClock`] is the offset between the two. It follows drift of [`DRIFT_PPM`] and no more: a forged
//! stamp cannot pull it away faster than 1 ms a second. Right after its start it takes the least delayed
//! packet as reference, since packets queued by the system come late.

use protocol::{Duration, Instant};

/// Largest deviation of a stamp from its expected value: networks delay packets by milliseconds, a loaded
/// machine by tens of them.
pub const WINDOW: Duration = Duration::millis(300);
/// Drift between two clocks that is followed, parts per million: NTP corrects at 500 at most.
const DRIFT_PPM: i128 = 1_000;

/// Offset of a referee's clock from ours.
#[derive(Clone, Copy, Debug)]
pub(super) struct StampClock {
    /// Stamp minus arrival, µs.
    offset: i128,
    started: Instant,
    followed: Instant,
}

impl StampClock {
    /// Initialised by its first packet.
    pub(super) fn new(stamp: u64, now: Instant) -> Self {
        Self { offset: difference(stamp, now), started: now, followed: now }
    }

    /// Difference of a stamp that arrives now from its expected value, µs; negative: behind.
    pub(super) fn ahead(&self, stamp: u64, now: Instant) -> i64 {
        let ahead = difference(stamp, now) - self.offset;
        ahead.clamp(i128::from(i64::MIN), i128::from(i64::MAX)) as i64
    }

    /// Whether the difference is within the window.
    pub(super) fn fits(&self, stamp: u64, now: Instant) -> bool {
        self.ahead(stamp, now).unsigned_abs() <= WINDOW.0
    }

    /// A packet of this clock: drift is followed.
    pub(super) fn follow(&mut self, stamp: u64, now: Instant) {
        let ahead = i128::from(self.ahead(stamp, now));
        let passed = i128::from(now.since(self.followed).0);
        let settling = now.since(self.started).0 <= WINDOW.0;
        let most = if settling && ahead > 0 { ahead } else { passed * DRIFT_PPM / 1_000_000 };
        self.offset += ahead.clamp(-most, most);
        self.followed = self.followed.max(now);
    }

    /// Lead of this clock over that one, µs.
    pub(super) fn ahead_of(&self, other: &Self) -> i64 {
        (self.offset - other.offset).clamp(i128::from(i64::MIN), i128::from(i64::MAX)) as i64
    }
}

fn difference(stamp: u64, now: Instant) -> i128 {
    i128::from(stamp) - i128::from(now.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    const S: u64 = 1_000_000;
    const EPOCH: u64 = 1_795_220_000 * S;

    #[test]
    fn stamps_are_held_to_our_own_clock_not_to_each_other() {
        let clock = StampClock::new(EPOCH, Instant(7 * S));
        assert_eq!(clock.ahead(EPOCH + 2 * S, Instant(9 * S)), 0);
        assert_eq!(clock.ahead(EPOCH + 49 * S / 10, Instant(7 * S)), 4_900_000);
        assert_eq!(clock.ahead(EPOCH, Instant(8 * S)), -1_000_000);
        assert!(clock.fits(EPOCH + S - WINDOW.0, Instant(8 * S)));
        assert!(!clock.fits(EPOCH + S - WINDOW.0 - 1, Instant(8 * S)));
        // No number of the wire overflows.
        for stamp in [0, u64::MAX] {
            assert!(!clock.fits(stamp, Instant(u64::MAX)));
            StampClock::new(stamp, Instant(0)).follow(u64::MAX - stamp, Instant(u64::MAX));
        }
    }

    #[test]
    fn forged_stamps_pull_the_clock_by_a_millisecond_a_second_at_most() {
        let mut clock = StampClock::new(EPOCH, Instant(0));
        // A minute of packets at 1 kHz, each stamped as far ahead as the window allows.
        for ms in 1..60_000 {
            let now = Instant(S + ms * 1_000);
            let mut forged = EPOCH + now.0;
            while clock.fits(forged + 1_000, now) {
                forged += 1_000;
            }
            clock.follow(forged, now);
        }
        let pulled = -clock.ahead(EPOCH + 61 * S, Instant(61 * S));
        assert!((0..=65_000).contains(&pulled), "{pulled} µs");
    }

    #[test]
    fn a_queue_that_is_emptied_at_the_start_sets_the_clock_by_its_last_packet() {
        let mut clock = StampClock::new(EPOCH, Instant(0));
        // 250 ms of packets that waited arrive at once.
        for late in 1..=10 {
            clock.follow(EPOCH + late * 25_000, Instant(late));
        }
        assert_eq!(clock.ahead(EPOCH + 250_000, Instant(10)), 0);
    }
}
