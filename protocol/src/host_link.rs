//! `host_link`: the host's end of the radio: seals snapshots and commands, opens robots' frames and tracks
//! which robots are present; [`crate::link`] is the robots'.
//!
//! **The counter is a clock.** It is the host's time in ticks of 64 µs ([`crate::host_clock`]), or one more
//! than the last where several frames go out in a tick; a robot takes a frame's age from it.
//!
//! **A robot is trusted** once its [`Telemetry`] names the host's present epoch, which no recording can.
//! Until then its telemetry leads to a welcome and to nothing else, and its beacons and handshakes are
//! refused. Telemetry comes under a key that only this robot and the host hold.

use crate::frame::{
    Audience, Frame, PAYLOAD_LEN_MAX, Refusal, Sender, Sessions, TeamKey, TeamKeys, decode, packet,
    packet_to_audience,
};
use crate::host::{HostMessage, Telemetry, Welcome};
use crate::host_clock::TICK_BITS;
use crate::link::{Packet, count};
use crate::parts::PartsReport;
use crate::pulses::{self, PulseOrder};
use crate::team::TeamMessage;
use crate::version::VersionReport;
use crate::{Instant, RobotId, TeamId};

/// The host's end of the radio: seals its messages, opens those of robots, counts what it refuses.
#[derive(Clone, Debug)]
pub struct HostLink {
    team: TeamId,
    keys: TeamKeys,
    epoch: u32,
    counter: u32,
    /// Start of the epoch, in ticks.
    zero: u64,
    audience: Audience,
    /// The newest telemetry of each robot that named our epoch, and the newest of its other frames.
    own: Sessions,
    shared: Sessions,
    /// For each robot, from its newest telemetry: its epoch, and the difference of our clock to its own,
    /// whether it named our epoch or not.
    newest: [Option<(u32, u32)>; RobotId::COUNT],
    refused: [u32; Refusal::KINDS],
}

/// Result of opening a packet.
#[allow(clippy::large_enum_variant, reason = "one value at a time, on the stack")]
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Opened {
    /// A message of a trusted robot.
    Believed(RobotId, TeamMessage),
    /// What a trusted robot runs.
    Version(RobotId, VersionReport),
    /// Which parts of a trusted robot work.
    Parts(RobotId, PartsReport),
    /// Genuine telemetry of a robot that has not named our epoch: new, led by another host, or recorded. It
    /// may be welcomed.
    Unauthenticated(RobotId, Telemetry),
}

impl HostLink {
    /// A link in the epoch `epoch` of the host, at least 1; a later start must bring a larger one (seconds of
    /// a calendar do).
    pub fn new(team: TeamId, key: TeamKey, epoch: u32) -> Self {
        Self {
            team,
            keys: key.of_team(),
            epoch: epoch.max(1),
            counter: 0,
            zero: 0,
            audience: Audience::default(),
            own: Sessions::default(),
            shared: Sessions::default(),
            newest: [None; RobotId::COUNT],
            refused: [0; Refusal::KINDS],
        }
    }

    /// Sets the robots for which parts of snapshots are sealed from now on.
    pub fn set_audience(&mut self, audience: Audience) {
        self.audience = audience;
    }

    /// The host's boot epoch, in every frame that it seals.
    pub fn epoch(&self) -> u32 {
        self.epoch
    }

    /// The packet that carries `message`; empty if it is addressed to no robot.
    pub fn seal(&mut self, now: Instant, message: &HostMessage) -> Packet {
        let mut payload = [0; PAYLOAD_LEN_MAX];
        // A message always fits (tested with the longest there is); if it did not, silence is the safe
        // answer.
        let Ok(payload) = postcard::to_slice(message, &mut payload) else { return Packet::new() };
        let to = match message {
            HostMessage::World(_) => None,
            HostMessage::Command(command) => Some(command.to),
            HostMessage::Welcome(welcome) => Some(welcome.to),
            HostMessage::Limits(limits) => Some(limits.to),
        };
        self.seal_payload(now, to, payload)
    }

    /// The packet that carries an order to the bring-up image of that robot.
    pub fn seal_order(&mut self, now: Instant, to: RobotId, order: &PulseOrder) -> Packet {
        let mut payload = [0; PAYLOAD_LEN_MAX];
        let written = postcard::to_slice(&(pulses::KIND, order), &mut payload);
        written.map_or(Packet::new(), |payload| self.seal_payload(now, Some(to), payload))
    }

    fn seal_payload(&mut self, now: Instant, to: Option<RobotId>, payload: &[u8]) -> Packet {
        self.count_up(now);
        let audience = if to.is_none() { Some(self.audience) } else { None };
        let (team, epoch, counter) = (self.team, self.epoch, self.counter);
        let frame = Frame { team, sender: Sender::Host, audience, epoch, counter, payload };
        match to {
            Some(robot) => packet(&frame, self.keys.of(robot)),
            None => packet_to_audience(&frame, &self.keys),
        }
    }

    /// The robot and its message, or why the packet is refused (counted). A host's packet is refused by its
    /// sender, 16: there is a second host on this channel, or this one receives itself.
    pub fn open(&mut self, now: Instant, packet: &[u8]) -> Result<Opened, Refusal> {
        let opened = self.try_open(now, packet);
        if let Err(refusal) = opened {
            count(&mut self.refused, refusal);
        }
        opened
    }

    /// Number of refused packets, by [`Refusal::kind`].
    pub fn refused(&self) -> &[u32; Refusal::KINDS] {
        &self.refused
    }

    /// The welcome for that robot, by its newest telemetry.
    pub fn welcome(&self, robot: RobotId) -> Option<Welcome> {
        let (boot_epoch, offset) = self.newest[robot.index()]?;
        Some(Welcome { to: robot, boot_epoch, offset })
    }

    /// The boot epoch in which that robot is trusted.
    pub fn boot_epoch(&self, robot: RobotId) -> Option<u32> {
        self.own.epoch(Sender::Robot(robot))
    }

    /// The clock's reading, or one more than the last; after 76 h a new epoch starts, for which robots are
    /// welcomed again.
    fn count_up(&mut self, now: Instant) {
        let clock = self.clock(now).max(u64::from(self.counter) + 1);
        if let Ok(counter) = u32::try_from(clock) {
            self.counter = counter;
        } else {
            (self.epoch, self.counter, self.zero) = (self.epoch.saturating_add(1), 1, now.0 >> TICK_BITS);
        }
    }

    /// The clock's reading, in ticks since the epoch started.
    fn clock(&self, now: Instant) -> u64 {
        (now.0 >> TICK_BITS).saturating_sub(self.zero)
    }

    fn try_open(&mut self, now: Instant, packet: &[u8]) -> Result<Opened, Refusal> {
        let frame = Frame::parse(packet, self.team)?;
        let Sender::Robot(robot) = frame.sender else { return Err(Refusal::Sender(frame.sender.number())) };
        // Every frame of an epoch before the trusted one is refused; the counters of telemetry and of what
        // teammates could have sent in its name rise each by itself.
        if let Some(current) = self.own.epoch(frame.sender).filter(|current| frame.epoch < *current) {
            return Err(Refusal::Epoch { seen: frame.epoch, current });
        }
        if TeamMessage::is_for_host(frame.payload) {
            self.open_own(now, packet, &frame, robot)
        } else {
            self.open_shared(packet, &frame, robot)
        }
    }

    /// Telemetry and reports, under the robot's own key.
    fn open_own(
        &mut self,
        now: Instant,
        packet: &[u8],
        frame: &Frame<'_>,
        robot: RobotId,
    ) -> Result<Opened, Refusal> {
        self.own.check(frame)?;
        if !frame.is_genuine(packet, self.keys.of(robot), robot) {
            return Err(Refusal::Tag);
        }
        let version = VersionReport::read(frame.payload).map(|report| Opened::Version(robot, report));
        let parts = PartsReport::read(frame.payload).map(|report| Opened::Parts(robot, report));
        let known = self.own.epoch(frame.sender) == Some(frame.epoch);
        if let Some(report) = version.or(parts).filter(|_| known) {
            self.own.accept(frame);
            return Ok(report);
        }
        let telemetry = match decode(frame.payload) {
            Some(TeamMessage::Telemetry(telemetry)) => telemetry,
            // Only telemetry proves that a robot is live.
            Some(_) if self.own.epoch(frame.sender) != Some(frame.epoch) => {
                return Err(Refusal::Unauthenticated { epoch: frame.epoch });
            }
            Some(message) => {
                self.own.accept(frame);
                return Ok(Opened::Believed(robot, message));
            }
            None => return Err(Refusal::Payload),
        };
        let Telemetry { host, clock, .. } = telemetry;
        let offset = ((now.0 >> TICK_BITS).saturating_sub(self.zero) as u32).wrapping_sub(clock);
        self.newest[robot.index()] = Some((frame.epoch, offset));
        if host != self.epoch {
            return Ok(Opened::Unauthenticated(robot, telemetry));
        }
        if self.own.epoch(frame.sender) != Some(frame.epoch) {
            // Its messages to teammates before it knew us may be recordings.
            self.shared.accept(frame);
        }
        self.own.accept(frame);
        Ok(Opened::Believed(robot, TeamMessage::Telemetry(telemetry)))
    }

    /// Beacons and handshakes, under the key that all robots hold.
    fn open_shared(&mut self, packet: &[u8], frame: &Frame<'_>, robot: RobotId) -> Result<Opened, Refusal> {
        if self.own.epoch(frame.sender) != Some(frame.epoch) {
            return Err(Refusal::Unauthenticated { epoch: frame.epoch });
        }
        self.shared.check(frame)?;
        if !frame.is_genuine(packet, self.keys.team(), robot) {
            return Err(Refusal::Tag);
        }
        self.shared.accept(frame);
        decode(frame.payload).map(|message| Opened::Believed(robot, message)).ok_or(Refusal::Payload)
    }
}

#[cfg(test)]
mod tests;
