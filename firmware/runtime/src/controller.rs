//! `controller`: the interface of the brain that its task needs. The sans-IO methods of [`brain::Station`]
//! (docs/architecture.md §3.1), so that tests can substitute a simpler implementation.

use brain::Station;
use protocol::Instant;
use protocol::link::Packet;
use protocol::robot_io::{ActuatorFrame, SensorFrame};

/// Bytes, sensor frames and deadlines in; packets, orders and the next deadline out.
pub(crate) trait Controller {
    fn handle_packet(&mut self, now: Instant, packet: &[u8]);
    fn handle_sensors(&mut self, now: Instant, sensors: &SensorFrame);
    fn handle_timeout(&mut self, now: Instant);
    fn poll_packet(&mut self, now: Instant) -> Option<Packet>;
    fn poll_actuators(&mut self, now: Instant) -> Option<ActuatorFrame>;
    fn poll_timeout(&self) -> Option<Instant>;
}

impl Controller for Station<'_> {
    fn handle_packet(&mut self, now: Instant, packet: &[u8]) {
        Station::handle_packet(self, now, packet);
    }
    fn handle_sensors(&mut self, now: Instant, sensors: &SensorFrame) {
        Station::handle_sensors(self, now, sensors);
    }
    fn handle_timeout(&mut self, now: Instant) {
        Station::handle_timeout(self, now);
    }
    fn poll_packet(&mut self, now: Instant) -> Option<Packet> {
        Station::poll_packet(self, now)
    }
    fn poll_actuators(&mut self, now: Instant) -> Option<ActuatorFrame> {
        Station::poll_actuators(self, now)
    }
    fn poll_timeout(&self) -> Option<Instant> {
        Station::poll_timeout(self)
    }
}
