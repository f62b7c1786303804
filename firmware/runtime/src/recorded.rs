//! `recorded`: a robot whose inputs and outputs are written down, each with its time.
//!
//! The same inputs at the same times give another brain of the same configuration the same outputs
//! (docs/architecture.md §2.4), so that a robot that ran by its own clock can be played again on a PC.

use protocol::Instant;
use protocol::journal::{Entry, Writer};
use protocol::link::Packet;
use protocol::robot_io::{ActuatorFrame, SensorFrame};

use crate::controller::Controller;

/// A controller and its journal.
pub(crate) struct Recorded<'m, C> {
    controller: C,
    journal: Writer<'m>,
}

impl<'m, C> Recorded<'m, C> {
    /// A controller that started at `now` in this boot epoch.
    pub(crate) fn new(now: Instant, epoch: u32, controller: C, mut journal: Writer<'m>) -> Self {
        journal.write(now, Entry::Start(epoch));
        Self { controller, journal }
    }
}

impl<C: Controller> Controller for Recorded<'_, C> {
    fn handle_packet(&mut self, now: Instant, packet: &[u8]) {
        self.journal.write(now, Entry::Packet(packet));
        self.controller.handle_packet(now, packet);
    }

    fn handle_sensors(&mut self, now: Instant, sensors: &SensorFrame) {
        self.journal.write(now, Entry::Sensors(sensors.clone()));
        self.controller.handle_sensors(now, sensors);
    }

    fn handle_timeout(&mut self, now: Instant) {
        self.journal.write(now, Entry::Timeout);
        self.controller.handle_timeout(now);
    }

    fn poll_packet(&mut self, now: Instant) -> Option<Packet> {
        let packet = self.controller.poll_packet(now)?;
        self.journal.write(now, Entry::Sent(&packet));
        Some(packet)
    }

    fn poll_actuators(&mut self, now: Instant) -> Option<ActuatorFrame> {
        let orders = self.controller.poll_actuators(now)?;
        self.journal.write(now, Entry::Ordered(orders));
        Some(orders)
    }

    fn poll_timeout(&self) -> Option<Instant> {
        self.controller.poll_timeout()
    }
}
