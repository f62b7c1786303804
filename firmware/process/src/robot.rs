//! `robot`: sans-IO core of a virtual robot. Brain, radio and body as a value: bytes and times in, bytes out.

use brain::{BrainConfig, Station};
use casebase::CaseBase;
use prost::Message as _;
use protocol::Instant;
use protocol::frame::RobotKeys;
use protocol::link::Packet;
use ssl::simulation::RobotControlResponse;

use crate::body::{SimulatedBody, TICK};

/// A robot in a simulator that is reached by the simulation protocol.
pub struct VirtualRobot<'a> {
    station: Station<'a>,
    body: SimulatedBody,
    tick: Instant,
    /// The command that has not been fetched yet.
    control: Option<Vec<u8>>,
    unreadable: u32,
}

impl<'a> VirtualRobot<'a> {
    /// A robot that starts at `now`.
    pub fn new(now: Instant, config: &BrainConfig, base: CaseBase<'a>, keys: RobotKeys) -> Self {
        Self {
            station: Station::with_keys(now, config, base, keys),
            body: SimulatedBody::new(config.robot),
            tick: now,
            control: None,
            unreadable: 0,
        }
    }

    /// Handles a radio frame.
    pub fn handle_frame(&mut self, now: Instant, frame: &[u8]) {
        self.station.handle_packet(now, frame);
    }

    /// Handles the simulator's answer.
    pub fn handle_response(&mut self, now: Instant, bytes: &[u8]) {
        match RobotControlResponse::decode(bytes) {
            Ok(response) => self.body.handle_response(now, &response),
            Err(_) => self.unreadable = self.unreadable.saturating_add(1),
        }
    }

    /// Handles the deadline announced by [`VirtualRobot::poll_timeout`]: the brain's own, and every [`TICK`]
    /// a sensor frame in and a command out.
    pub fn handle_timeout(&mut self, now: Instant) {
        if self.station.poll_timeout().is_some_and(|due| due <= now) {
            self.station.handle_timeout(now);
        }
        if self.tick > now {
            return;
        }
        self.station.handle_sensors(now, &self.body.sensors(now));
        if let Some(order) = self.station.poll_actuators(now) {
            self.body.obey(order);
        }
        self.control = Some(self.body.control().encode_to_vec());
        // A delayed process does not catch up: missed ticks are skipped.
        self.tick = if now.since(self.tick) < TICK { self.tick + TICK } else { now + TICK };
    }

    /// Time at which [`VirtualRobot::handle_timeout`] must be called.
    pub fn poll_timeout(&self) -> Instant {
        self.station.poll_timeout().map_or(self.tick, |due| due.min(self.tick))
    }

    /// The next frame to send. Call after everything handled, until `None`.
    pub fn poll_frame(&mut self, now: Instant) -> Option<Packet> {
        self.station.poll_packet(now)
    }

    /// The command to send to the simulator, if there is a new one.
    pub fn poll_control(&mut self) -> Option<Vec<u8>> {
        self.control.take()
    }

    /// The simulated body, for reading only.
    pub fn body(&self) -> &SimulatedBody {
        &self.body
    }

    /// The brain and its radio, read-only.
    pub fn station(&self) -> &Station<'a> {
        &self.station
    }

    /// Number of datagrams of the simulator that were no responses.
    pub fn unreadable(&self) -> u32 {
        self.unreadable
    }
}
