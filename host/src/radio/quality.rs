//! `quality`: link quality of a robot. The measures of the league's table for radios (technical challenge
//! 2026): round trip, loss, data rate, interference, start-up; and those that operators watch during a match:
//! silence, battery, refusals.
//!
//! The table scores the quality of the data, so each measure names its source:
//! - round trip: now − departure of the newest snapshot the robot had − the robot's silence since; the robot
//!   states its silence in 0.1 ms, the snapshot's departure is that of its first part;
//! - loss down: parts of snapshots, by the robot's own counts; loss up: the robot's frames, by their
//!   counters;
//! - data rate: bytes of frames to and from this robot (to all counts for each) in whole seconds, without the
//!   link's own overhead;
//! - start-up: from the first frame of the robot's epoch to its first telemetry that names a snapshot.

use std::fmt::Write as _;

use protocol::host::{Condition, Telemetry};
use protocol::parts::PartsReport;
use protocol::station::StationReport;
use protocol::version::VersionReport;
use protocol::{Duration, Instant, RobotId};

use super::PRESENT;
use super::counters::Counters;

/// Duration of one data-rate sample.
const SECOND: Duration = Duration::millis(1_000);
/// A longer round trip is a snapshot number that was used again (256 snapshots take 2.5 s).
const TRIP_MAX: Duration = Duration::millis(1_000);

/// The link to one robot.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Quality {
    received_at: Option<Instant>,
    /// When the last telemetry came that named our epoch.
    present_at: Option<Instant>,
    telemetry: Option<(Instant, Telemetry)>,
    session: Option<Session>,
    welcomed: Option<Instant>,
    lives: u32,
    version: Option<VersionReport>,
    parts: PartsReport,
    station: Option<StationReport>,
    trip: Counters,
    down: Share,
    up: Share,
    rate: Counters,
    frames: Counters,
    window: Window,
    totals: LinkTotals,
    start_up: Option<Duration>,
}

/// Sums over all epochs of a robot that only rise, but for frames that come late: the difference of two
/// readings is what happened between them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LinkTotals {
    /// Frames received from it.
    pub frames: u64,
    /// Telemetry received from it.
    pub telemetry: u64,
    /// Bytes of frames, both directions.
    pub bytes: u64,
    /// Parts of our snapshots that it received, and those that it lost.
    pub down: (u64, u64),
    /// Frames of the robot that came, and those that were lost.
    pub up: (u64, u64),
    /// Round trips measured, and their sum, ms.
    pub trips: (u64, f64),
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Session {
    epoch: u32,
    counter: u32,
    since: Instant,
}

/// Numbers of frames received and lost.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Share {
    came: u64,
    lost: u64,
}

impl Share {
    fn lost_percent(self) -> Option<f64> {
        let all = self.came + self.lost;
        (all > 0).then(|| 100.0 * self.lost as f64 / all as f64)
    }
}

/// The second that is being counted.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Window {
    begin: Option<Instant>,
    bytes: u32,
    frames: u32,
}

impl Quality {
    /// When its newest frame was received.
    pub fn received_at(&self) -> Option<Instant> {
        self.received_at
    }

    /// Time since the robot's last frame.
    pub fn silence(&self, now: Instant) -> Option<Duration> {
        self.received_at.map(|received| now.since(received))
    }

    /// Whether its telemetry has named our epoch within [`PRESENT`].
    pub fn is_present(&self, now: Instant) -> bool {
        self.present_at.is_some_and(|at| now.since(at) <= PRESENT)
    }

    /// Newest telemetry, and when it came.
    pub fn telemetry(&self) -> Option<&(Instant, Telemetry)> {
        self.telemetry.as_ref()
    }

    /// Battery voltage, V, where the robot measures one.
    pub fn battery(&self) -> Option<f32> {
        let (_, telemetry) = self.telemetry?;
        (telemetry.battery > 0).then(|| f32::from(telemetry.battery) * 0.01)
    }

    /// Newest report of the robot on its body.
    pub fn condition(&self) -> Condition {
        self.telemetry.map_or(Condition::default(), |(_, telemetry)| telemetry.condition)
    }

    /// Statistics of round trips, ms.
    pub fn round_trip(&self) -> &Counters {
        &self.trip
    }

    /// Parts of our snapshots that it did not receive, percent.
    pub fn loss_down(&self) -> Option<f64> {
        self.down.lost_percent()
    }

    /// Frames of the robot that we did not receive, percent.
    pub fn loss_up(&self) -> Option<f64> {
        self.up.lost_percent()
    }

    /// kbit/s of frames, both directions, one value per second.
    pub fn data_rate(&self) -> &Counters {
        &self.rate
    }

    /// Frames received from it, one value per second.
    pub fn frame_rate(&self) -> &Counters {
        &self.frames
    }

    /// Sums so far, for rates over windows of the caller's choice.
    pub fn totals(&self) -> LinkTotals {
        LinkTotals { down: (self.down.came, self.down.lost), up: (self.up.came, self.up.lost), ..self.totals }
    }

    /// Time from its first frame to its first telemetry that names our epoch; of its present epoch.
    pub fn start_up(&self) -> Option<Duration> {
        self.start_up
    }

    /// What it runs, as it has reported since it booted last.
    pub fn version(&self) -> Option<VersionReport> {
        self.version
    }

    /// Which of its parts work, as it has reported since it booted last; all where it reported none.
    pub fn parts(&self) -> PartsReport {
        self.parts
    }

    /// Packets that its base station sent to it, and on which channel; none without a base station that
    /// counts them.
    pub fn station(&self) -> Option<StationReport> {
        self.station
    }

    pub(super) fn report_station(&mut self, report: StationReport) {
        self.station = Some(report);
    }

    pub(super) fn report_parts(&mut self, report: PartsReport) {
        self.parts = report;
    }

    pub(super) fn report_version(&mut self, report: VersionReport) {
        self.version = Some(report);
    }

    /// Number of boots seen, including the first.
    pub fn lives(&self) -> u32 {
        self.lives
    }

    /// Frames it refused in this epoch, of any kind.
    pub fn refused(&self) -> u32 {
        self.telemetry.map_or(0, |(_, telemetry)| telemetry.refused.iter().copied().map(u32::from).sum())
    }

    /// A genuine frame of it came.
    pub(super) fn receive(&mut self, now: Instant, len: usize, epoch: u32, counter: u32) {
        self.received_at = Some(now);
        match &mut self.session {
            Some(session) if session.epoch == epoch => {
                self.up.came += 1;
                // Telemetry and beacons may overtake each other; a late frame was counted as lost.
                if let Some(ahead) = counter.checked_sub(session.counter) {
                    self.up.lost += u64::from(ahead.saturating_sub(1));
                    session.counter = counter;
                } else {
                    self.up.lost = self.up.lost.saturating_sub(1);
                }
            }
            session => {
                *session = Some(Session { epoch, counter, since: now });
                self.lives = self.lives.saturating_add(1);
                (self.telemetry, self.start_up, self.version) = (None, None, None);
                self.parts = PartsReport::default();
                self.up.came += 1;
            }
        }
        self.roll(now);
        self.window.frames += 1;
        self.totals.frames += 1;
        self.totals.bytes += len as u64;
        self.window.bytes += len as u32;
    }

    /// Takes its telemetry; `departed` is when the snapshot that it names went out.
    pub(super) fn report(&mut self, now: Instant, telemetry: Telemetry, departed: Option<Instant>) {
        self.present_at = Some(now);
        self.totals.telemetry += 1;
        if telemetry.received > 0
            && let (Some(departed), Some(session)) = (departed, self.session)
        {
            let held = Duration(u64::from(telemetry.silence) * 100);
            let trip = now.since(departed + held);
            let overdue = now.since(departed) > TRIP_MAX;
            if telemetry.silence < u16::MAX && !overdue {
                self.trip.add(trip.0 as f64 * 1e-3);
                self.totals.trips.0 += 1;
                self.totals.trips.1 += trip.0 as f64 * 1e-3;
                self.start_up = self.start_up.or(Some(now.since(session.since)));
            }
        }
        if let Some((_, before)) = self.telemetry {
            self.down.came += u64::from(telemetry.received.wrapping_sub(before.received));
            self.down.lost += u64::from(telemetry.lost.wrapping_sub(before.lost));
        }
        self.telemetry = Some((now, telemetry));
    }

    /// A frame was sent to it.
    pub(super) fn sent(&mut self, now: Instant, len: usize) {
        if self.received_at.is_some() {
            self.roll(now);
            self.window.bytes += len as u32;
            self.totals.bytes += len as u64;
        }
    }

    /// Whether it has not been welcomed for `every`.
    pub(super) fn wants_welcome(&self, now: Instant, every: Duration) -> bool {
        self.welcomed.is_none_or(|at| now.since(at) >= every)
    }

    pub(super) fn welcomed(&mut self, now: Instant) {
        self.welcomed = Some(now);
    }

    /// Closes the seconds that have passed; those without a frame count as empty.
    fn roll(&mut self, now: Instant) {
        let begin = *self.window.begin.get_or_insert(now);
        let mut over = now.since(begin).0 / SECOND.0;
        if over == 0 {
            return;
        }
        self.window.begin = Some(begin + SECOND * over);
        // Bounded: a robot that was off for an hour does not count as slow.
        over = over.min(10);
        for _ in 0..over {
            self.rate.add(f64::from(self.window.bytes) * 8.0 * 1e-3);
            self.frames.add(f64::from(self.window.frames));
            (self.window.bytes, self.window.frames) = (0, 0);
        }
    }
}

/// The league's table, a line a robot; `-` where nothing was measured.
pub fn table<'q>(rows: impl Iterator<Item = (RobotId, &'q Quality)>, foreign: u32) -> String {
    let mut text = String::from(
        "robot  RTT mean     var   max ms  loss down    up %  kbit/s mean      var  start-up ms  battery V  refused\n",
    );
    for (robot, quality) in rows {
        let (trip, rate) = (quality.round_trip(), quality.data_rate());
        let start_up = quality.start_up().map(|time| time.0 as f64 * 1e-3);
        let cells = [
            cell(trip.mean(), 2),
            cell(trip.variance(), 2),
            cell(trip.max(), 2),
            cell(quality.loss_down(), 2),
            cell(quality.loss_up(), 2),
            cell(rate.mean(), 1),
            cell(rate.variance(), 1),
            cell(start_up, 0),
            cell(quality.battery().map(f64::from), 2),
            quality.refused().to_string(),
        ];
        let widths = [10, 8, 9, 11, 8, 13, 9, 13, 11, 9];
        // Into a string writing never fails.
        let _ = write!(text, "{robot:>5}");
        for (cell, width) in cells.iter().zip(widths) {
            let _ = write!(text, "{cell:>width$}");
        }
        text.push('\n');
    }
    let verdict = if foreign == 0 { "no".to_owned() } else { format!("yes, {foreign} foreign frames") };
    let _ = writeln!(text, "interference: {verdict}");
    text
}

fn cell(value: Option<f64>, digits: usize) -> String {
    value.map_or_else(|| "-".to_owned(), |value| format!("{value:.digits$}"))
}
