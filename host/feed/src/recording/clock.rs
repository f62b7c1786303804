//! `clock`: the time in a league log file, and how often something comes in it, where the recorder's clock
//! was set while it recorded. Times in s since the file's first message.
//!
//! Time is summed from differences between neighbours, so that a step of the clock affects one difference and
//! not all later ones. How much of a jump forward was played is told by the cameras' own times.

use std::collections::BTreeMap;

use protocol::Instant;
use serde::Serialize;
use ssl::vision::FrameHead;

/// A message this much earlier than the one before it means that the recorder's clock was set back, ns. A
/// smaller step is a matter of order: recorders write messages of the same time in any order, half a
/// millisecond apart; 20 ms is more than the time of one camera frame at 60 Hz.
const STEP_BACK_NS: i64 = 20_000_000;
/// If no message comes for longer than this, s, the recording was paused, or its clock was set forward.
/// Sources of a match send at 1 Hz or faster.
const PAUSE_S: f64 = 2.0;

/// A step of the recorder's clock, or a pause of the recording.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ClockStep {
    /// Time of the step on the summed clock.
    pub at_s: f64,
    /// By how much; negative: set back. Positive: set forward, or nothing was recorded for this time.
    pub by_s: f64,
    /// The part of it that was played, as far as is known: none of it where the clock was set back, all of a
    /// pause; by the cameras' own times where they tell.
    pub played_s: f64,
}

/// Sums a log file's time.
#[derive(Debug, Default)]
pub struct LogClock {
    last_ns: Option<i64>,
    /// Since the first message; falls by fractions of a millisecond where neighbours are out of order.
    counted_ns: i64,
    /// The greatest of it.
    now_ns: i64,
    /// Of each camera: time of its last frame by its own clock, s, and on the summed clock, ns.
    cameras: BTreeMap<u32, (f64, i64)>,
    /// The last message came after the clock was set forward.
    set_forward: bool,
    /// Steps of the recorder's clock, the first of them.
    pub steps: Vec<ClockStep>,
    /// Steps beyond those that are listed.
    pub steps_more: u64,
}

/// Whether this difference between neighbours, ns, is a pause or a step forward.
fn is_jump(difference_ns: i64) -> bool {
    difference_ns as f64 * 1e-9 > PAUSE_S
}

/// A longer pause of a recording is none, ns: the recorder's clock was set (from 1970, where it has no
/// battery).
const PAUSE_MAX_NS: i64 = 12 * 3600 * 1_000_000_000;
/// Clocks that differ by less, ns, agree: frames come this late, and the first after a pause, too.
const SAME_NS: i64 = 1_000_000_000;
/// Most cameras whose times are kept.
const CAMERAS_MAX: usize = 64;
/// Number of steps that are listed; beyond it they are only counted.
const STEPS_LISTED: usize = 20;

impl LogClock {
    /// The time of a message with the recorder's time stamp. Never falls.
    pub fn read(&mut self, timestamp_ns: i64) -> Instant {
        self.read_beside(timestamp_ns, None, None)
    }

    /// The same with the camera frame that the message has, and the one that follows a jump of the time
    /// stamp.
    pub fn read_beside(
        &mut self,
        timestamp_ns: i64,
        own: Option<&FrameHead>,
        next: Option<&FrameHead>,
    ) -> Instant {
        let difference = self.difference(timestamp_ns);
        self.last_ns = Some(timestamp_ns);
        self.set_forward = false;
        if difference <= -STEP_BACK_NS {
            self.step(difference, 0);
            // The true duration is not known: it counts as no longer than between any two messages.
            self.counted_ns = self.now_ns;
        } else {
            let played = if is_jump(difference) { self.played(difference, next) } else { difference };
            if is_jump(difference) {
                self.set_forward = played < difference;
                self.step(difference, played);
            }
            self.counted_ns = self.counted_ns.saturating_add(played);
        }
        self.now_ns = self.now_ns.max(self.counted_ns);
        if let Some(head) = own
            && (self.cameras.len() < CAMERAS_MAX || self.has_camera(head.camera_id))
        {
            self.cameras.insert(head.camera_id, (head.t_capture, self.counted_ns));
        }
        self.now()
    }

    /// Whether a message of that time stamp comes after a pause, or after the clock was set forward.
    pub fn jumps(&self, timestamp_ns: i64) -> bool {
        is_jump(self.difference(timestamp_ns))
    }

    /// Whether a frame of that camera was read.
    pub fn has_camera(&self, camera: u32) -> bool {
        self.cameras.contains_key(&camera)
    }

    /// Whether the clock was set forward before the last message.
    pub fn was_set_forward(&self) -> bool {
        self.set_forward
    }

    fn difference(&self, timestamp_ns: i64) -> i64 {
        self.last_ns.map_or(0, |last| timestamp_ns.saturating_sub(last))
    }

    /// The part of a jump that was played, ns: by the time that passed between two frames of a camera, where
    /// that is less. A jump longer than any pause of a recording is the clock's, whatever cameras say: one
    /// computer may serve both.
    fn played(&self, jump: i64, next: Option<&FrameHead>) -> i64 {
        let by_camera = next.and_then(|head| {
            let (captured, counted) = self.cameras.get(&head.camera_id)?;
            let since_ns =
                (head.t_capture - captured) * 1e9 - self.counted_ns.saturating_sub(*counted) as f64;
            Some(since_ns as i64)
        });
        match by_camera {
            Some(played) if (-SAME_NS..jump - SAME_NS).contains(&played) => played.max(0),
            _ if jump > PAUSE_MAX_NS => 0,
            _ => jump,
        }
    }

    /// The time of the last message.
    pub fn now(&self) -> Instant {
        Instant(u64::try_from(self.now_ns / 1000).unwrap_or(0))
    }

    fn step(&mut self, by_ns: i64, played_ns: i64) {
        let [at_s, by_s, played_s] = [self.now_ns, by_ns, played_ns].map(|ns| ns as f64 * 1e-9);
        let step = ClockStep { at_s, by_s, played_s };
        if self.steps.len() < STEPS_LISTED { self.steps.push(step) } else { self.steps_more += 1 }
    }
}

/// Rate of a message while it comes: pauses (and steps of the clock, which look the same) are left out.
#[derive(Clone, Copy, Debug, Default)]
pub struct Rate {
    last_s: Option<f64>,
    first_s: f64,
    differences: u64,
    usual: u64,
    usual_s: f64,
}

impl Rate {
    /// Records a message at `at_s`; returns the time since the one before.
    pub fn came(&mut self, at_s: f64) -> Option<f64> {
        let Some(last) = self.last_s.replace(at_s) else {
            self.first_s = at_s;
            return None;
        };
        let difference = at_s - last;
        self.differences += 1;
        if difference <= PAUSE_S {
            self.usual += 1;
            self.usual_s += difference;
        }
        Some(difference)
    }

    /// Per second; 0 for a single message.
    pub fn hz(&self) -> f64 {
        let whole_s = self.last_s.unwrap_or(self.first_s) - self.first_s;
        // A message rarer than every pause has no usual differences.
        let (n, seconds) =
            if self.usual_s > 0.0 { (self.usual, self.usual_s) } else { (self.differences, whole_s) };
        if seconds > 0.0 { n as f64 / seconds } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 75 messages a second for 8 s; from `at` s on the recorder's clock is set by `by` s.
    fn rate_with(at: f64, by: f64) -> (f64, f64, Vec<ClockStep>) {
        let (mut clock, mut rate) = (LogClock::default(), Rate::default());
        for n in 0..600 {
            let true_s = f64::from(n) / 75.0;
            let stamp = true_s + if true_s >= at { by } else { 0.0 };
            let now = clock.read(1_700_000_000_000_000_000 + (stamp * 1e9) as i64);
            rate.came(now.0 as f64 * 1e-6);
        }
        (rate.hz(), clock.now().0 as f64 * 1e-6, clock.steps)
    }

    #[test]
    fn a_clock_that_steps_back_or_forward_changes_no_rate() {
        for by in [0.0, -0.05, -1.0, -4.0, -3600.0, 4.0, 3600.0] {
            let (hz, end, steps) = rate_with(4.0, by);
            assert!((hz - 75.0).abs() < 0.3, "{by} s: {hz} a second");
            let whole = 599.0 / 75.0 + if by > 0.0 { by } else { 0.0 };
            assert!((end - whole).abs() < 0.02, "{by} s: ends after {end} s");
            assert_eq!(steps.len(), usize::from(by != 0.0), "{by} s");
            if let Some(step) = steps.first() {
                assert!((step.by_s - by).abs() < 0.02 && (step.at_s - 4.0).abs() < 0.02, "{step:?}");
            }
        }
    }

    /// 60 frames a second for 4 s by a camera of a right clock; before the `at`-th the recorder's clock is
    /// set by `by` s, and the recording pauses for `pause` s.
    fn span_with(at: u32, by: f64, pause: f64, camera_too: bool) -> (f64, Vec<ClockStep>) {
        let mut clock = LogClock::default();
        for n in 0..240 {
            let late = n >= at;
            let true_s = f64::from(n) / 60.0 + if late { pause } else { 0.0 };
            let stamp = 1e6 + true_s + if late { by } else { 0.0 };
            let t_capture = true_s + if late && camera_too { by } else { 0.0 };
            let head = FrameHead { frame_number: n, t_capture, t_sent: 0.0, camera_id: 1 };
            let stamp_ns = (stamp * 1e9) as i64;
            let next = clock.jumps(stamp_ns).then_some(head).filter(|_| clock.has_camera(1));
            clock.read_beside(stamp_ns, Some(&head), next.as_ref());
        }
        (clock.now().0 as f64 * 1e-6, clock.steps)
    }

    #[test]
    fn a_step_forward_is_not_time_played_and_a_pause_is() {
        let whole = 239.0 / 60.0;
        for (by, pause) in [(3600.0, 0.0), (86_400.0, 0.0), (1.79e9, 0.0), (3600.0, 5.0), (0.0, 300.0)] {
            let (span, steps) = span_with(60, by, pause, false);
            assert!((span - whole - pause).abs() < 0.03, "{by} s, pause of {pause} s: {span} s");
            let step = steps[0];
            assert!(
                (step.by_s - by - pause).abs() < 0.03 && (step.played_s - pause).abs() < 0.03,
                "{step:?}"
            );
        }
    }

    #[test]
    fn a_clock_of_1970_counts_nothing_even_where_the_camera_has_it_too() {
        assert!((span_with(3, 1.79e9, 0.0, true).0 - 239.0 / 60.0).abs() < 0.03);
        // Before the first frame there is none to compare with.
        assert!((span_with(0, 1.79e9, 0.0, false).0 - 239.0 / 60.0).abs() < 0.03);
        let mut clock = LogClock::default();
        clock.read(0);
        assert_eq!(clock.read(1_790_000_000_000_000_000), Instant(0));
        assert!(clock.was_set_forward());
    }

    #[test]
    fn neighbours_out_of_order_are_no_step_and_the_clock_never_falls() {
        let mut clock = LogClock::default();
        let mut last = Instant(0);
        for (stamp_us, now_us) in [(0, 0), (1000, 1000), (500, 1000), (900, 1000), (2000, 2000), (1600, 2000)]
        {
            let now = clock.read(stamp_us * 1000);
            assert_eq!(now, Instant(now_us));
            assert!(now >= last);
            last = now;
        }
        assert!(clock.steps.is_empty());
    }

    #[test]
    fn any_stamps_at_all_are_taken() {
        let mut clock = LogClock::default();
        for stamp in [i64::MAX, i64::MIN, 0, -1, i64::MAX, i64::MAX, i64::MIN] {
            clock.read(stamp);
        }
        for n in 0..100 {
            clock.read(if n % 2 == 0 { 0 } else { 5_000_000_000 });
        }
        assert_eq!(clock.steps.len(), STEPS_LISTED);
        assert!(clock.steps_more > 50);
    }

    #[test]
    fn what_comes_every_ten_seconds_has_a_rate_too() {
        let mut rate = Rate::default();
        assert_eq!(rate.hz(), 0.0);
        for n in 0..7 {
            rate.came(f64::from(n) * 10.0);
        }
        assert!((rate.hz() - 0.1).abs() < 1e-9);
    }
}
