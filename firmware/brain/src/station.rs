//! `Station`: brain plus radio endpoint; decodes received frames, encodes outgoing messages.
//!
//! `runtime`'s tasks on a board and the native simulator drive this same value, so that both send the same
//! bytes.

use casebase::CaseBase;
use protocol::frame::{RobotKeys, Sender, TeamKey, claimed_sender, claims_audience};
use protocol::link::{Link, Packet, Received};
use protocol::parts::PartsReport;
use protocol::robot_io::{ActuatorFrame, SensorFrame};
use protocol::team::TeamMessage;
use protocol::version::VersionReport;
use protocol::{Duration, Instant};

use crate::brain::PacketKind;
use crate::{Brain, BrainConfig};

/// A brain with its radio endpoint.
pub struct Station<'a> {
    brain: Brain<'a>,
    link: Link,
    /// When the brain sent last, and when handshakes were sent to teammates last.
    last_sent: Option<Instant>,
    last_handshake: Option<Instant>,
    /// Something has happened since the brain had no more messages.
    has_new_input: bool,
}

impl<'a> Station<'a> {
    /// A robot that starts at `now`.
    pub fn new(now: Instant, config: &BrainConfig, base: CaseBase<'a>) -> Self {
        Self::with_keys(now, config, base, TeamKey::ZERO.of_robot(config.robot))
    }

    /// As [`Station::new`], with keys of its own.
    // In its caller it would be built on the stack, which the caller then keeps: 5 kB of a robot's task.
    #[inline(never)]
    pub fn with_keys(now: Instant, config: &BrainConfig, base: CaseBase<'a>, keys: RobotKeys) -> Self {
        Self {
            brain: Brain::new(now, config, base),
            link: Link::new(config.team, config.robot, keys, config.epoch),
            last_sent: None,
            last_handshake: Some(now),
            has_new_input: true,
        }
    }

    /// Handles a packet; anything but a genuine, new message of this team is counted and dropped. Where steps
    /// are short nothing is sent before the next step, and packets for which it has no time are counted too.
    // In its caller it would be there twice, with its stack.
    #[inline(never)]
    pub fn handle_packet(&mut self, now: Instant, packet: &[u8]) {
        if !self.brain.has_short_steps() {
            self.has_new_input = true;
        }
        if self.link.is_to_another(packet) {
            self.brain.note_unopened();
            return;
        }
        let from = match claimed_sender(packet) {
            Some(Sender::Host) if claims_audience(packet) => PacketKind::Snapshot,
            Some(Sender::Host) => PacketKind::Command,
            _ => PacketKind::Beacon,
        };
        if !self.brain.takes_packet(now, from) {
            if from == PacketKind::Snapshot {
                self.link.leave_snapshot_unopened();
            }
            return;
        }
        let led_by = self.link.host_epoch();
        let opened = self.link.open(now, packet);
        if !matches!(opened, Ok(Received::Elsewhere)) {
            self.brain.note_opened(from);
        }
        match opened {
            Ok(Received::Teammate(from, message)) => self.brain.handle_team_message(now, from, &message),
            Ok(Received::Host(message)) => {
                if self.link.host_epoch() != led_by {
                    self.brain.handle_new_host();
                }
                self.brain.handle_host_message(now, self.link.age(), &message);
            }
            Ok(Received::Elsewhere) | Err(_) => {}
        }
    }

    /// Handles a sensor frame: one brain step.
    pub fn handle_sensors(&mut self, now: Instant, sensors: &SensorFrame) {
        self.has_new_input = true;
        self.brain.handle_sensors(now, sensors);
    }

    /// Handles the deadline announced by [`Station::poll_timeout`].
    pub fn handle_timeout(&mut self, now: Instant) {
        self.has_new_input = true;
        self.brain.handle_timeout(now);
    }

    /// The next packet to send. Call after every `handle_…` until `None`.
    pub fn poll_packet(&mut self, now: Instant) -> Option<Packet> {
        if !self.has_new_input {
            return None;
        }
        let packet = self.next_packet(now);
        self.has_new_input = packet.is_some();
        packet
    }

    fn next_packet(&mut self, now: Instant) -> Option<Packet> {
        let Some(mut message) = self.brain.poll_message(now) else {
            // One message a step, where steps are short: sealing costs time, and the next step comes soon.
            let waits = self.last_sent == Some(now)
                && self.last_handshake.is_some_and(|last| now.since(last) < SHAKE_HANDS_WITHIN);
            let handshake = if waits { None } else { self.link.poll_handshake(now) };
            if handshake.is_some() {
                self.last_handshake = Some(now);
            }
            return handshake;
        };
        self.last_sent = Some(now);
        if let TeamMessage::Telemetry(telemetry) = &mut message {
            self.link.report(now, telemetry);
        }
        Some(self.link.seal(&message))
    }

    /// The packet that reports what this robot runs; `None` without a host, and in a step with another
    /// message: sealing costs time.
    pub fn version_packet(&mut self, now: Instant, report: &VersionReport) -> Option<Packet> {
        let free = self.link.host_epoch().is_some() && self.last_sent != Some(now);
        free.then(|| self.link.seal_version(report))
    }

    /// The packet that reports which parts of this robot work; `None` as [`Self::version_packet`] is.
    pub fn parts_packet(&mut self, now: Instant, report: &PartsReport) -> Option<Packet> {
        let free = self.link.host_epoch().is_some() && self.last_sent != Some(now);
        free.then(|| self.link.seal_parts(report))
    }

    /// The actuator orders, if there are new ones.
    pub fn poll_actuators(&mut self, now: Instant) -> Option<ActuatorFrame> {
        self.brain.poll_actuators(now)
    }

    /// Time at which [`Station::handle_timeout`] must be called without an earlier input.
    pub fn poll_timeout(&self) -> Option<Instant> {
        self.brain.poll_timeout()
    }

    /// The brain, for reading only; frames reach it through the station.
    pub fn brain(&self) -> &Brain<'a> {
        &self.brain
    }

    /// The radio link, for its counters.
    pub fn link(&self) -> &Link {
        &self.link
    }
}

/// Handshakes wait for a step without other messages, but no longer than this: a walking robot sends in each.
const SHAKE_HANDS_WITHIN: Duration = Duration::millis(40);
