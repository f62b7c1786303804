//! `reporting`: a station that also reports to its host, once a second, what its robot runs.

use brain::Station;
use protocol::link::Packet;
use protocol::robot_io::{ActuatorFrame, SensorFrame};
use protocol::version::{VersionReport, hash_of, parse_hash, parts_of};
use protocol::{Duration, Instant};
use rules::RobotSpec;

use crate::controller::Controller;

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

/// A station, what it reports, and when it did so last.
pub(crate) struct Reporting<'s, 'a> {
    pub(crate) station: &'s mut Station<'a>,
    pub(crate) report: VersionReport,
    pub(crate) last: Instant,
}

impl Controller for Reporting<'_, '_> {
    fn handle_packet(&mut self, now: Instant, packet: &[u8]) {
        self.station.handle_packet(now, packet);
    }
    fn handle_sensors(&mut self, now: Instant, sensors: &SensorFrame) {
        self.station.handle_sensors(now, sensors);
    }
    fn handle_timeout(&mut self, now: Instant) {
        self.station.handle_timeout(now);
    }
    fn poll_packet(&mut self, now: Instant) -> Option<Packet> {
        let packet = self.station.poll_packet(now);
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
