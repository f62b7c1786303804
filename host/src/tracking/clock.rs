//! `clock`: offset of vision's clock from ours. Vision stamps camera frames by a clock of its own: Unix
//! seconds, or a simulator's seconds from 0 (trap 1), which may run slower than ours, stop, jump and restart.
//! µs.
//!
//! Only differences are used. The packet with the least delay of the last few gives the offset of the two
//! clocks; vision's own delay from camera frame to packet is in the packet. A frame of another time is not
//! used until the old clock has fallen silent and the new one has continued for a few frames.

use protocol::{Duration, Instant};

use super::seen::Captured;

/// Frames of one clock are not farther apart without a reason, µs.
const JUMP_MIN_US: i64 = 1_000_000;
/// A clock that jumped far is followed when ours has been silent that long, µs: a dozen frames of 60 Hz.
const SILENCE_AFTER_JUMP_US: i64 = 200_000;
/// One that jumped back slightly could be late copies of the clock we follow, so it waits longer, µs.
const SILENCE_AFTER_STEP_US: i64 = 500_000;
/// Camera frames in order that confirm another clock.
const FRAMES_TO_BELIEVE: u32 = 5;
/// Window for the least delay; the last one to two windows count, µs: short enough to follow a simulator that
/// runs at nine tenths of real time (recorded; off by a tenth of the window at most), long enough to contain
/// eight frames of a 60 Hz camera.
const DELAY_WINDOW_US: i64 = 150_000;
/// Longest time of vision from camera frame to packet, µs; a larger difference is no processing time
/// (recorded: 0 and 10 ms).
const PROCESSING_MAX_US: i64 = 250_000;

/// The clock that a time belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Judgement {
    /// The clock we follow.
    Ours,
    /// A clock other than the one that is followed.
    Foreign,
    /// Another one, and ours is silent: follow it from now on, and reset the state.
    Restart,
}

/// Offset of vision's clock from ours.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Clock {
    /// Time of the newest camera frame, and its arrival.
    newest: Option<(Captured, i64)>,
    candidate: Option<CandidateClock>,
    least: LeastDifference,
}

/// Least difference of two clocks, by packets of the last moments.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct LeastDifference {
    /// Of the current and of the last window.
    least: Option<[i64; 2]>,
    stretch_start: i64,
}

impl LeastDifference {
    /// Takes the difference that a packet shows.
    pub(super) fn receive(&mut self, difference: i64, arrived: i64) {
        match &mut self.least {
            Some([current, _]) if arrived < self.stretch_start + DELAY_WINDOW_US => {
                *current = difference.min(*current);
            }
            Some([current, last]) => {
                // After a pause the window before is out of date.
                let just_before = arrived < self.stretch_start + 2 * DELAY_WINDOW_US;
                *last = if just_before { *current } else { difference };
                *current = difference;
                self.stretch_start = arrived;
            }
            None => {
                self.least = Some([difference; 2]);
                self.stretch_start = arrived;
            }
        }
    }

    /// The least one; `None` before the first packet.
    pub(super) fn get(&self) -> Option<i64> {
        self.least.map(|[current, last]| current.min(last))
    }
}

#[derive(Clone, Copy, Debug)]
struct CandidateClock {
    newest: Captured,
    images: u32,
}

impl Clock {
    /// Whether a camera frame of that time is of the clock we follow. `late` frames are judged by
    /// [`Self::late`].
    pub(super) fn judge(&mut self, captured: Captured, arrived: Instant) -> Judgement {
        let Some((newest, newest_arrived)) = self.newest else { return Judgement::Ours };
        let (ahead, passed) = (captured - newest, arrived.0 as i64 - newest_arrived);
        let reported = ahead > JUMP_MIN_US && (ahead - passed).abs() <= JUMP_MIN_US / 4 + passed / 4;
        if ahead.abs() <= JUMP_MIN_US || reported {
            Judgement::Ours
        } else {
            self.foreign(captured, passed, SILENCE_AFTER_JUMP_US)
        }
    }

    /// Whether the clock we follow still runs, for a camera frame that is too late by it.
    pub(super) fn late(&mut self, captured: Captured, arrived: Instant) -> Judgement {
        let passed = self.newest.map_or(0, |(_, newest_arrived)| arrived.0 as i64 - newest_arrived);
        self.foreign(captured, passed, SILENCE_AFTER_STEP_US)
    }

    fn foreign(&mut self, captured: Captured, silent: i64, patience: i64) -> Judgement {
        let follows = self.candidate.filter(|candidate| (captured - candidate.newest).abs() <= JUMP_MIN_US);
        let candidate = match follows {
            Some(candidate) if captured > candidate.newest => {
                CandidateClock { newest: captured, images: candidate.images + 1 }
            }
            Some(candidate) => candidate,
            None => CandidateClock { newest: captured, images: 1 },
        };
        self.candidate = Some(candidate);
        if candidate.images >= FRAMES_TO_BELIEVE && silent >= patience {
            *self = Self::default();
            return Judgement::Restart;
        }
        Judgement::Foreign
    }

    /// Updates the offset by a new camera frame of the clock we follow; `sent` is when vision sent it
    /// ([`plausible`]).
    pub(super) fn receive(&mut self, captured: Captured, sent: Option<Captured>, arrived: Instant) {
        let arrived = arrived.0 as i64;
        if self.newest.is_none_or(|(newest, _)| captured > newest) {
            self.newest = Some((captured, arrived));
            self.candidate = None;
        }
        let difference = arrived - sent.unwrap_or(captured);
        self.least.receive(difference, arrived);
    }

    /// The moment `captured` on our clock.
    pub(super) fn ours(&self, captured: Captured) -> Instant {
        Instant((captured + self.least.get().unwrap_or(0)).max(0) as u64)
    }

    /// Age of the newest camera frame when its packet came.
    pub(super) fn delay(&self) -> Duration {
        let delay =
            |(captured, arrived): (Captured, i64)| Instant(arrived.max(0) as u64).since(self.ours(captured));
        self.newest.map_or(Duration(0), delay)
    }
}

/// When a frame was sent, where that can be: after it was taken, and soon.
pub(super) fn plausible(sent: Option<Captured>, captured: Captured) -> Option<Captured> {
    sent.filter(|sent| (captured..=captured + PROCESSING_MAX_US).contains(sent))
}

#[cfg(test)]
mod tests {
    use super::*;

    const TICK: i64 = 16_000;

    /// Camera frames of a clock that is at `start` when ours is at 0 and runs at `rate`, each `delay(i)` µs
    /// in transit.
    fn run(
        clock: &mut Clock,
        start: i64,
        rate: f64,
        images: std::ops::Range<i64>,
        delay: impl Fn(i64) -> i64,
    ) {
        for i in images {
            let captured = start + ((i * TICK) as f64 * rate) as i64;
            let arrived = Instant((i * TICK + delay(i)) as u64);
            match clock.judge(captured, arrived) {
                Judgement::Foreign => {}
                Judgement::Ours | Judgement::Restart => clock.receive(captured, None, arrived),
            }
        }
    }

    #[test]
    fn the_quickest_packet_reports_how_the_clocks_lie() {
        for start in [0, 1_795_220_511_000_000] {
            let mut clock = Clock::default();
            run(&mut clock, start, 1.0, 10..60, |i| 2_000 + (i * 7_919) % 9_000);
            let off = clock.ours(start + 60 * TICK).0 as i64 - 60 * TICK;
            assert!((2_000..3_500).contains(&off), "{off}");
        }
    }

    #[test]
    fn what_vision_needed_itself_counts_as_delay() {
        let mut clock = Clock::default();
        clock.receive(1_000_000, Some(1_010_000), Instant(5_011_000));
        assert_eq!(clock.ours(1_000_000), Instant(5_001_000));
        assert_eq!(clock.delay(), Duration(10_000));
    }

    #[test]
    fn trap_01_a_simulators_slow_clock_does_not_look_like_a_growing_delay() {
        let mut clock = Clock::default();
        run(&mut clock, 800_000, 0.88, 0..3_600, |_| 1_000);
        assert!(clock.delay() < Duration::millis(40), "{:?}", clock.delay());
    }

    #[test]
    fn a_restarted_clock_is_followed_after_a_fifth_of_a_second() {
        let mut clock = Clock::default();
        run(&mut clock, 50_000_000, 1.0, 0..100, |_| 0);
        let mut followed = None;
        for i in 100..140 {
            let (captured, arrived) = ((i - 100) * TICK, Instant((i * TICK) as u64));
            match clock.judge(captured, arrived) {
                Judgement::Restart => {
                    followed = Some(i);
                    break;
                }
                judged => assert_eq!(judged, Judgement::Foreign),
            }
        }
        assert_eq!(followed, Some(99 + 200_000 / TICK + 1));
    }

    #[test]
    fn another_clock_beside_ours_is_never_followed() {
        let mut clock = Clock::default();
        for i in 0..1_000 {
            let arrived = Instant((i * TICK) as u64);
            assert_eq!(clock.judge(i * TICK, arrived), Judgement::Ours);
            clock.receive(i * TICK, None, arrived);
            if i > 0 {
                assert_eq!(clock.judge(1_795_220_511_000_000 + i * TICK, arrived), Judgement::Foreign);
                assert_eq!(clock.late(i * TICK - 100_000, arrived), Judgement::Foreign);
            }
        }
    }

    #[test]
    fn after_a_minute_without_vision_the_same_clock_goes_on() {
        let mut clock = Clock::default();
        run(&mut clock, 7_000_000, 1.0, 0..100, |_| 0);
        let minute = 60_000_000;
        assert_eq!(
            clock.judge(7_000_000 + 99 * TICK + minute, Instant((99 * TICK + minute) as u64)),
            Judgement::Ours
        );
        // A single frame from the far future is not.
        assert_eq!(
            clock.judge(7_000_000 + 99 * TICK + minute, Instant((100 * TICK) as u64)),
            Judgement::Foreign
        );
    }
}
