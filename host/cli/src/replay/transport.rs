//! `transport`: the time of a recording that is sent: when each packet is due. With the page it is paused,
//! moved and set to another speed there; every viewer follows this one clock.

use std::sync::atomic::Ordering;
use std::thread::sleep;
use std::time::{Duration, Instant};

use page::{Page, UserRequest};

use crate::stop::stopped_by_hand;

/// The clock of a recording. Times of the recording in µs.
pub(super) struct Transport {
    /// The time that was reached at `since`.
    at_us: u64,
    since: Instant,
    speed: f32,
    playing: bool,
    page: Option<Page>,
    /// When viewers were informed last.
    informed: Option<Instant>,
}

/// What a packet is waited for with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Due {
    /// It is due.
    Now,
    /// Packets from this time on are wanted in its place, µs.
    From(u64),
    /// The operator has ended the program.
    Stopped,
}

impl Transport {
    pub(super) fn new(speed: f32, page: Option<Page>) -> Self {
        Self { at_us: 0, since: Instant::now(), speed, playing: true, page, informed: None }
    }

    /// Whether a page steers it, which may go back after the last packet.
    pub(super) fn has_page(&self) -> bool {
        self.page.is_some()
    }

    /// Goes on from this time.
    pub(super) fn set(&mut self, at_us: u64) {
        (self.at_us, self.since, self.informed) = (at_us, Instant::now(), None);
    }

    /// Waits until a packet of this time is due.
    pub(super) fn wait_until(&mut self, at_us: u64) -> Due {
        loop {
            if stopped_by_hand().load(Ordering::Relaxed) {
                return Due::Stopped;
            }
            if let Some(from_us) = self.obey() {
                return Due::From(from_us);
            }
            self.inform();
            let poll = if self.has_page() { PAGE_POLL } else { WAIT_MAX };
            let left = self.time_to(at_us);
            if left == Some(Duration::ZERO) {
                break;
            }
            sleep(left.map_or(poll, |left| left.min(poll)));
        }
        // After a suspension of the program packets keep their intervals instead of leaving in a burst.
        let late_us = self.now_us().saturating_sub(at_us) as f32 / self.speed;
        if late_us > LATE_MAX.as_micros() as f32 {
            self.set(at_us);
        }
        Due::Now
    }

    /// Waits after the last packet, at this time, until the page goes elsewhere.
    pub(super) fn wait_at_end(&mut self, end_us: u64) -> Due {
        self.set(end_us);
        self.playing = false;
        match self.wait_until(u64::MAX) {
            // Played on from the end: from the start.
            Due::Now => Due::From(0),
            due => due,
        }
    }

    /// Time until then on this computer's clock; none while it is paused.
    fn time_to(&self, at_us: u64) -> Option<Duration> {
        let at_end = at_us == u64::MAX;
        let left_us = if at_end { 0 } else { at_us.saturating_sub(self.now_us()) };
        self.playing.then(|| Duration::from_secs_f64(left_us as f64 * 1e-6 / f64::from(self.speed)))
    }

    fn now_us(&self) -> u64 {
        let passed_s = if self.playing { self.since.elapsed().as_secs_f64() } else { 0.0 };
        self.at_us + (passed_s * f64::from(self.speed) * 1e6) as u64
    }

    /// Takes the page's requests; the time to go on from, if it was moved.
    fn obey(&mut self) -> Option<u64> {
        let mut from_us = None;
        while let Some(request) = self.page.as_ref().and_then(Page::next_request) {
            self.set(self.now_us());
            match request {
                UserRequest::Pause { on } => self.playing = !on,
                UserRequest::Speed { factor } => self.speed = factor,
                UserRequest::Seek { t } => {
                    let to_us = (t * 1e6) as u64;
                    self.set(to_us);
                    from_us = Some(to_us);
                }
                _ => {}
            }
        }
        from_us
    }

    /// Informs the viewers after a change, and again and again while it plays.
    fn inform(&mut self) {
        let Some(page) = &self.page else { return };
        if self.informed.is_some_and(|informed| informed.elapsed() < INFORM_EVERY) {
            return;
        }
        let at = self.now_us() as f64 * 1e-6;
        page.set_transport(page::Transport { at, playing: self.playing, speed: self.speed });
        self.informed = Some(Instant::now());
    }
}

/// Longest sleep between two checks for Ctrl-C: no operator notices the delay.
const WAIT_MAX: Duration = Duration::from_millis(100);
/// Longest sleep between two looks at the page's requests: a frame of a slow screen.
const PAGE_POLL: Duration = Duration::from_millis(20);
/// Viewers go on by themselves for this time: shorter than a second would let clocks drift apart visibly.
const INFORM_EVERY: Duration = Duration::from_millis(200);
/// A packet that is later than this was held up by a suspended program, not by the scheduler: loops of the
/// league's programs are 10 to 20 ms, and a loaded machine delays by 100 ms.
const LATE_MAX: Duration = Duration::from_millis(500);
