//! `cameras`: a clock for each camera. The cameras of a field may be on several computers whose clocks differ
//! by milliseconds to hours; their frames are put on the clock of one of them, the reference. µs.
//!
//! A camera's offset is first the difference of least delays: of all its packets in the last moments the
//! quickest was as quick as the reference's. Robots that drive from one camera's view into another's correct
//! it: a robot that appears ahead of where it was expected was seen later than the stamp says. The rest is
//! the camera's lateness, in the network. Differences below [`EQUAL_WITHIN_US`] are an offset only where such
//! robots show it: clocks set by NTP agree better, and packets' delays no better. Robots of a camera that is
//! late alone are carried on for its delay, so their velocity's noise counts that much.

use heapless::Vec;
use protocol::Instant;

use super::robots::Robots;
use super::seen::{CAMERAS_MAX, Captured, Frame};

/// Difference of clocks that counts as none, µs.
const EQUAL_WITHIN_US: i64 = 50_000;
/// Frames that show another clock, and the time for which they must, µs, where the camera's clock was known.
const FRAMES_TO_BELIEVE: u32 = 3;
const STEP_LASTS_US: i64 = 500_000;
/// A camera that has sent nothing for this time is no reference, µs: two frames of a slow one.
const SILENT_AFTER_US: i64 = 500_000;
/// The rate of a clock is measured over this time, µs.
const RATE_MIN_US: i64 = 300_000;
const RATE_MAX_US: i64 = 1_000_000;
/// Delays are compared within slots of this length, µs: a clock at nine tenths of real time runs 30 ms off in
/// one.
const SLOT_US: i64 = 300_000;
/// Packets overtake each other by less than this, µs; a larger step back is the clock's.
const OVERTAKEN_US: i64 = 250_000;
/// Share by which an offset follows a clock that drifts, a frame.
const DRIFT_SHARE: i64 = 16;
/// Frames expected a second are averaged by this weight of the newest gap.
const GAP_SHARE: f32 = 0.1;
/// Longest gap that is averaged, s.
const GAP_MAX_S: f32 = 2.0;
/// Robots that drive from view to view, for one correction, and where packets show that something differs.
const CROSSINGS: usize = 16;
const CROSSINGS_IF_DIFFERS: usize = 8;
/// Least correction, µs, where packets show that something differs, and where they do not.
const CORRECTION_MIN_US: i64 = 10_000;
const CORRECTION_ALONE_MIN_US: i64 = 40_000;
/// Difference of delays at which something differs, µs.
const DIFFERS_FROM_US: i64 = 15_000;
/// Unused frames are reported for this time after the last one, µs.
const REPORTED_FOR_US: i64 = 1_000_000;

/// Least difference between arrival and stamp, in the present slot and in the one before: number and
/// difference.
#[derive(Clone, Copy, Debug, Default)]
struct LeastBySlot([Option<(i64, i64)>; 2]);

impl LeastBySlot {
    fn receive(&mut self, difference: i64, arrived: i64) {
        let slot = arrived / SLOT_US;
        match &mut self.0[0] {
            Some((known, least)) if *known == slot => *least = difference.min(*least),
            newest => self.0[1] = newest.replace((slot, difference)),
        }
    }

    /// What this difference is greater by than the other's, in the newest slot before the present one that
    /// both have, else in the present one.
    fn beyond(&self, other: &Self) -> Option<i64> {
        let (present, _) = self.0[0]?;
        [present - 1, present].into_iter().find_map(|slot| Some(self.of(slot)? - other.of(slot)?))
    }

    /// The least difference of a slot.
    fn of(&self, slot: i64) -> Option<i64> {
        self.0.iter().flatten().find(|(known, _)| *known == slot).map(|(_, least)| *least)
    }
}

#[derive(Clone, Debug, Default)]
struct CameraClock {
    /// Stamp and arrival of the newest frame.
    newest: Option<(Captured, i64)>,
    /// An earlier frame, for the clock's rate.
    anchor: Option<(Captured, i64)>,
    rate: Option<f64>,
    least: LeastBySlot,
    /// Stamp minus time on the reference's clock.
    offset: i64,
    /// Delay of its packets beyond the reference's.
    late: i64,
    /// What the newest delays differ by from that.
    apart: i64,
    /// Since when, and in how many frames, the offset has been another.
    differs: Option<(i64, u32)>,
    /// When its clock stepped last.
    stepped: Option<i64>,
    crossings: Vec<i64, CROSSINGS>,
    /// Average time between frames, s.
    gap: f32,
    /// Whether a frame of it was used.
    used: Option<i64>,
    unused: Option<(i64, i64)>,
}

/// A camera, as far as its frames show.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraStatus {
    /// Number of the camera.
    pub camera: u32,
    /// Its clock is this far ahead of the reference's, ms; negative: behind. It is taken out.
    pub ahead_ms: i64,
    /// Its packets come this much later than the reference's, ms.
    pub late_ms: i64,
    /// Frames a second.
    pub rate: f32,
    /// None of its frames is used: their stamps are off by this, ms.
    pub unused_ms: Option<i64>,
}

#[derive(Clone, Debug, Default)]
pub(super) struct Cameras {
    cameras: [CameraClock; CAMERAS_MAX],
    reference: Option<usize>,
}

impl CameraClock {
    fn is_heard(&self, now: i64) -> bool {
        self.newest.is_some_and(|(_, arrived)| now - arrived <= SILENT_AFTER_US)
    }

    /// Takes a stamp; returns whether the clock stepped.
    fn receive(&mut self, stamp: Captured, sent: Captured, arrived: i64) -> bool {
        let mut stepped = false;
        if let Some((last, last_arrived)) = self.newest {
            if stamp <= last && last - stamp <= OVERTAKEN_US {
                // A copy, or packets that overtook each other.
                self.least.receive(arrived - sent, arrived);
                return false;
            }
            let (gap, passed) = (stamp - last, arrived - last_arrived);
            stepped = gap < 0 || gap > 2 * passed + EQUAL_WITHIN_US;
            let seconds = (gap.max(0) as f32 * 1e-6).min(GAP_MAX_S);
            let share = if self.gap == 0.0 { 1.0 } else { GAP_SHARE };
            self.gap += if stepped { 0.0 } else { (seconds - self.gap) * share };
        }
        if stepped {
            (self.anchor, self.rate, self.stepped) = (None, None, Some(arrived));
            self.least = LeastBySlot::default();
        }
        self.newest = Some((stamp, arrived));
        self.least.receive(arrived - sent, arrived);
        let (from, from_arrived) = *self.anchor.get_or_insert((stamp, arrived));
        let passed = arrived - from_arrived;
        if passed >= RATE_MIN_US {
            self.rate = Some((stamp - from) as f64 / passed as f64);
        }
        if passed >= RATE_MAX_US {
            self.anchor = Some((stamp, arrived));
        }
        stepped
    }

    /// Median of the crossings, when there are `enough`.
    fn median(&mut self, enough: usize) -> Option<i64> {
        if self.crossings.len() < enough {
            return None;
        }
        self.crossings.sort_unstable();
        let median = self.crossings[self.crossings.len() / 2];
        self.crossings.clear();
        Some(median)
    }
}

impl Cameras {
    /// Takes a frame's stamps, and puts the frame on the reference's clock. `false`: its clock is ahead, and
    /// by how much is not known yet.
    pub(super) fn receive(&mut self, frame: &mut Frame, sent: Option<Captured>, arrived: Instant) -> bool {
        let (now, camera) = (arrived.0 as i64, frame.camera as usize);
        let stepped = self.cameras[camera].receive(frame.at, sent.unwrap_or(frame.at), now);
        let keeps = |index: &usize| {
            let other = &self.cameras[*index];
            other.is_heard(now) && other.stepped.is_none_or(|at| now - at > STEP_LASTS_US)
        };
        let reference = match self.reference {
            Some(reference) if reference == camera && stepped => {
                (0..CAMERAS_MAX).filter(|index| *index != camera).find(keeps).unwrap_or(camera)
            }
            Some(reference) if self.cameras[reference].is_heard(now) => reference,
            _ => camera,
        };
        if self.reference.replace(reference) != Some(reference) {
            self.cameras[reference].differs = None;
        }
        let in_time = reference == camera || self.align(camera, reference, now);
        let own = &self.cameras[camera];
        (frame.at, frame.gap) = (frame.at - own.offset, own.gap);
        in_time && frame.at >= 0
    }

    /// Compares a camera's delays with the reference's.
    fn align(&mut self, camera: usize, reference: usize, now: i64) -> bool {
        let by = &self.cameras[reference];
        let heard = by.newest.map_or(0, |(_, at)| at);
        let Some(beyond) = self.cameras[camera].least.beyond(&by.least) else { return true };
        let base = by.offset - by.late;
        let rate_error = by.rate.map_or(0.0, |rate| (1.0 - rate).abs());
        let rate_known = by.rate.is_some();
        let tolerance = EQUAL_WITHIN_US + (rate_error * SLOT_US as f64) as i64;
        let own = &mut self.cameras[camera];
        let wanted = base + own.late - beyond;
        let by = wanted - own.offset;
        own.apart = by;
        if by.abs() <= tolerance {
            own.differs = None;
            if own.offset != 0 && rate_known {
                own.offset += by / DRIFT_SHARE;
            }
            return true;
        }
        let (since, frames) = own.differs.map_or((now, 1), |(since, frames)| (since, frames + 1));
        own.differs = Some((since, frames));
        let lasts = own.used.is_none() || now - since >= STEP_LASTS_US;
        // The reference must go on meanwhile: where all stop at once a simulator has started again.
        if frames >= FRAMES_TO_BELIEVE && rate_known && lasts && heard > since {
            own.offset = if wanted.abs() <= EQUAL_WITHIN_US { 0 } else { wanted };
            (own.differs, own.used) = (None, Some(now));
            own.crossings.clear();
            return true;
        }
        by < OVERTAKEN_US && (by < 0 || own.used.is_some())
    }

    /// Records whether a frame was used, or by how much it was off.
    pub(super) fn note(&mut self, camera: u32, arrived: Instant, unused_by: Option<i64>) {
        let now = arrived.0 as i64;
        let own = &mut self.cameras[camera as usize];
        match unused_by {
            None => own.used = Some(now),
            Some(by) => own.unused = Some((by, now)),
        }
    }

    /// Corrects offsets by robots that came from another camera's view; `robots` as they were before the
    /// frame.
    pub(super) fn compare(&mut self, frame: &Frame, robots: &Robots) {
        let Some(reference) = self.reference else { return };
        for seen in &frame.robots {
            let Some((other, micros)) = robots.crossing(seen, frame) else { continue };
            let own = frame.camera as usize;
            let (camera, micros) = if own == reference { (other as usize, -micros) } else { (own, micros) };
            if camera == reference {
                continue;
            }
            let clock = &mut self.cameras[camera];
            let _ = clock.crossings.push(micros);
            let differs = clock.offset != 0 || clock.late.abs().max(clock.apart.abs()) > DIFFERS_FROM_US;
            let (enough, least) = if differs {
                (CROSSINGS_IF_DIFFERS, CORRECTION_MIN_US)
            } else {
                (CROSSINGS, CORRECTION_ALONE_MIN_US)
            };
            let Some(median) = clock.median(enough) else { continue };
            if median.abs() >= least {
                // What the delays differ by is lateness, from now on.
                clock.offset -= median;
                clock.late -= median + clock.apart;
                (clock.apart, clock.differs) = (0, None);
            }
        }
    }

    /// The cameras heard lately; `now` on our clock.
    pub(super) fn status(&self, now: Instant) -> impl Iterator<Item = CameraStatus> {
        let now = now.0 as i64;
        let heard = self.cameras.iter().enumerate().filter(move |(_, clock)| clock.is_heard(now));
        heard.map(move |(camera, clock)| {
            let unused = clock.unused.filter(|(_, at)| {
                now - at < REPORTED_FOR_US && clock.used.is_none_or(|used| now - used > REPORTED_FOR_US)
            });
            CameraStatus {
                camera: camera as u32,
                ahead_ms: clock.offset / 1_000,
                late_ms: clock.late / 1_000,
                rate: if clock.gap > 0.0 { 1.0 / clock.gap } else { 0.0 },
                unused_ms: unused.map(|(by, _)| by / 1_000),
            }
        })
    }
}
