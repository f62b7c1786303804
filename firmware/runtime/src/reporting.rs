//! `reporting`: a station that also reports to its host, once a second, what its robot runs, and twice a
//! second which of its parts have failed, once one is suspected.

use core::cell::Cell;
use core::sync::atomic::Ordering;

use brain::Station;
use protocol::link::Packet;
use protocol::parts::PartsReport;
use protocol::robot_io::{ActuatorFrame, SensorFrame};
use protocol::version::{VersionReport, hash_of, parse_hash, parts_of};
use protocol::{Duration, Instant};
use rules::RobotSpec;

use crate::controller::Controller;
use crate::mailboxes::Mailboxes;

/// What this image is, as `onetwo firmware` builds it; other builds do not know their sources. Each brain has
/// a case base of its own.
pub(crate) const IMAGE: VersionReport = VersionReport {
    version: parts_of(env!("CARGO_PKG_VERSION")),
    image: parse_hash(option_env!("ONETWO_IMAGE")),
    robot: hash_of(RobotSpec::TEXT.as_bytes()),
    case_base: 0,
};

/// Time between two reports: 280 bit/s of a channel that carries 1 Mb/s.
const REPORT_EVERY: Duration = Duration::millis(1_000);

/// Time between two reports of parts of which one is not right.
const PARTS_EVERY: Duration = Duration::millis(500);

/// A station, what it reports, and when it did so last.
pub(crate) struct Reporting<'s, 'a> {
    pub(crate) station: &'s mut Station<'a>,
    pub(crate) report: VersionReport,
    pub(crate) last: Instant,
    pub(crate) boxes: &'s Mailboxes,
    /// The newest report of parts, and when it went out.
    pub(crate) parts: (PartsReport, Instant),
}

impl Reporting<'_, '_> {
    /// The report of parts, if it is due: at once where a state is another, and again while one is not right.
    fn parts_packet(&mut self, now: Instant) -> Option<Packet> {
        let (last, at) = self.parts;
        let report = self.boxes.parts.lock(Cell::get);
        let due = !report.has_states_of(&last) || !report.is_ok() && now.since(at) >= PARTS_EVERY;
        let packet = if due { self.station.parts_packet(now, &report) } else { None };
        if packet.is_some() {
            self.parts = (report, now);
        }
        packet
    }
}

impl Controller for Reporting<'_, '_> {
    fn handle_packet(&mut self, now: Instant, packet: &[u8]) {
        self.station.handle_packet(now, packet);
    }
    fn handle_sensors(&mut self, now: Instant, sensors: &SensorFrame) {
        self.station.handle_sensors(now, sensors);
        let doubts = self.station.brain().belief().doubts_break_beam(now);
        self.boxes.beam_doubted.store(doubts, Ordering::Relaxed);
    }
    fn handle_timeout(&mut self, now: Instant) {
        self.station.handle_timeout(now);
    }
    fn poll_packet(&mut self, now: Instant) -> Option<Packet> {
        let packet = self.station.poll_packet(now);
        let packet = packet.or_else(|| self.parts_packet(now));
        if packet.is_some() || now.since(self.last) < REPORT_EVERY {
            return packet;
        }
        let packet = self.station.version_packet(now, &self.report)?;
        self.last = now;
        Some(packet)
    }
    fn poll_actuators(&mut self, now: Instant) -> Option<ActuatorFrame> {
        self.station.poll_actuators(now)
    }
    fn poll_timeout(&self) -> Option<Instant> {
        self.station.poll_timeout()
    }
}
