//! `link`: a robot's end of the radio: seals its messages, opens what it receives, counts what it refuses;
//! [`crate::host_link`] is the other.
//!
//! A robot receives its teammates and its host, and trusts neither before they have answered its present boot
//! epoch: the host with a [`Welcome`](crate::host::Welcome), teammates with a [`Handshake`]. A
//! recording cannot, because it was made before the robot's epoch was known. Until then, and again when a
//! host or teammate with a newer epoch sends, its frames are refused as [`Refusal::Unauthenticated`]
//! (unauthenticated peer). The host's frames are refused as [`Refusal::Stale`] when they are older than
//! [`AGE_MAX`](crate::host_clock::AGE_MAX).

use crate::frame::{
    Frame, FrameBytes, HEADER_LEN, Refusal, RobotKeys, Sender, Sessions, TeamKeys, VERSION, decode, packet,
};
use crate::host::{HostMessage, PARTS_MAX, Telemetry, WorldPart};
use crate::host_clock::{Age, HostClock, ticks};
use crate::parts::PartsReport;
use crate::peer::PeerTable;
use crate::team::{Handshake, TEAM_MESSAGE_LEN_MAX, TeamMessage};
use crate::version::VersionReport;
use crate::{Duration, Instant, RobotId, TeamId};

/// A radio packet: one whole frame.
pub type Packet = FrameBytes;

/// An accepted frame: its sender, and its message decoded.
#[allow(clippy::large_enum_variant, reason = "one value at a time, on the stack, and no heap to box it on")]
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Received {
    /// A message of a teammate.
    Teammate(RobotId, TeamMessage),
    /// A message of the host, sent at most [`Link::age`] ago.
    Host(HostMessage),
    /// A frame for another receiver: not opened, without any effect here.
    Elsewhere,
}

/// One robot's end of the radio: seals its messages, opens received frames, counts what it refuses.
#[derive(Clone, Debug)]
pub struct Link {
    team: TeamId,
    me: RobotId,
    keys: RobotKeys,
    epoch: u32,
    counter: u32,
    sessions: Sessions,
    peer_table: PeerTable,
    /// State of the trusted host's clock.
    clock: Option<HostClock>,
    /// Age of the host's last frame that was opened.
    age: Duration,
    refused: [u32; Refusal::KINDS],
    /// Number of these that were its own messages, echoed.
    echoes: u32,
    snapshots: Snapshots,
}

impl Link {
    /// A link in the boot epoch `epoch` of robot `me`; a later boot must bring a larger one.
    pub fn new(team: TeamId, me: RobotId, keys: RobotKeys, epoch: u32) -> Self {
        Self {
            team,
            me,
            keys,
            epoch,
            counter: 0,
            sessions: Sessions::default(),
            peer_table: PeerTable::default(),
            clock: None,
            age: Duration(0),
            refused: [0; Refusal::KINDS],
            echoes: 0,
            snapshots: Snapshots::default(),
        }
    }

    /// The packet that carries `message`.
    pub fn seal(&mut self, message: &TeamMessage) -> Packet {
        let mut payload = [0; TEAM_MESSAGE_LEN_MAX];
        // A message always fits (tested with the longest there is); if it did not, silence is the safe
        // answer.
        let Ok(payload) = postcard::to_slice(message, &mut payload) else { return Packet::new() };
        self.seal_payload(payload)
    }

    /// The packet that reports what this robot runs to its host.
    pub fn seal_version(&mut self, report: &VersionReport) -> Packet {
        self.seal_payload(&report.payload())
    }

    /// The packet that reports to its host which parts of this robot work.
    pub fn seal_parts(&mut self, report: &PartsReport) -> Packet {
        self.seal_payload(&report.payload())
    }

    fn seal_payload(&mut self, payload: &[u8]) -> Packet {
        self.counter = self.counter.wrapping_add(1);
        let sender = Sender::Robot(self.me);
        // Telemetry goes to the host alone, and no teammate can send it in the robot's name.
        let key = if TeamMessage::is_for_host(payload) { &self.keys.host } else { &self.keys.team };
        let (team, epoch, counter) = (self.team, self.epoch, self.counter);
        packet(&Frame { team, sender, audience: None, epoch, counter, payload }, key)
    }

    /// The handshake for teammates that do not yet know our present boot epoch, if one is due.
    pub fn poll_handshake(&mut self, now: Instant) -> Option<Packet> {
        let handshake = self.peer_table.poll(now)?;
        Some(self.seal(&TeamMessage::Handshake(handshake)))
    }

    /// The sender and its message, or why the packet is refused (counted).
    pub fn open(&mut self, now: Instant, packet: &[u8]) -> Result<Received, Refusal> {
        let opened = self.try_open(now, packet);
        if let Err(refusal) = opened {
            count(&mut self.refused, refusal);
        }
        opened
    }

    /// Whether a packet is the host's to another robot of the team, by its first bytes: opening it has no
    /// effect.
    pub fn is_to_another(&self, packet: &[u8]) -> bool {
        let Some((head, rest)) = packet.split_first_chunk::<HEADER_LEN>() else { return false };
        let host = Sender::Host.number();
        head.starts_with(&[VERSION, self.team.0, host]) && !HostMessage::is_to_one(rest, self.me)
    }

    /// The epoch of the trusted host, if there is one; when it changes, numbers of the last host's frames are
    /// invalid.
    pub fn host_epoch(&self) -> Option<u32> {
        self.sessions.epoch(Sender::Host)
    }

    /// Maximum age of the host's last frame when it was opened.
    pub fn age(&self) -> Duration {
        self.age
    }

    /// Number of refused packets, by [`Refusal::kind`].
    pub fn refused(&self) -> &[u32; Refusal::KINDS] {
        &self.refused
    }

    /// Counters of received and lost parts of the host's snapshots.
    pub fn snapshots(&self) -> &Snapshots {
        &self.snapshots
    }

    /// A part of a snapshot came and was not opened: it is not lost. As its tag was not checked, a forged one
    /// may hide one that is.
    pub fn leave_snapshot_unopened(&mut self) {
        self.snapshots.unopened = self.snapshots.unopened.saturating_add(1);
    }

    /// Fills in the link's counters; all but condition, battery and silence.
    pub fn report(&self, now: Instant, telemetry: &mut Telemetry) {
        telemetry.host = self.host_epoch().unwrap_or(0);
        telemetry.clock = ticks(now);
        telemetry.received = self.snapshots.received as u16;
        telemetry.lost = self.snapshots.lost as u16;
        telemetry.snapshot = self.snapshots.newest().unwrap_or(0);
        telemetry.refused = self.refused.map(|count| count.min(u32::from(u16::MAX)) as u16);
        // A base station that sends to all echoes a robot's own messages; that is no sign of an attack.
        let sender = &mut telemetry.refused[Refusal::Sender(0).kind()];
        *sender = sender.saturating_sub(self.echoes.min(u32::from(u16::MAX)) as u16);
    }

    /// The first checks: length, team, sender, epoch and counter.
    fn envelope<'a>(&mut self, packet: &'a [u8]) -> Result<Frame<'a>, Refusal> {
        let frame = Frame::parse(packet, self.team)?;
        if frame.sender == Sender::Robot(self.me) {
            self.echoes = self.echoes.saturating_add(1);
            return Err(Refusal::Sender(self.me.number()));
        }
        self.sessions.check(&frame)?;
        Ok(frame)
    }

    /// Returns whether a frame is addressed to this robot; its tag is not checked.
    #[inline]
    fn is_for_me(&self, frame: &Frame<'_>) -> bool {
        match (frame.sender, frame.audience) {
            (Sender::Robot(_), _) => !TeamMessage::is_for_host(frame.payload),
            (Sender::Host, None) => HostMessage::is_to_one(frame.payload, self.me),
            (Sender::Host, Some(audience)) => audience.has(self.me) && HostMessage::is_to_all(frame.payload),
        }
    }

    fn try_open(&mut self, now: Instant, packet: &[u8]) -> Result<Received, Refusal> {
        let frame = self.envelope(packet)?;
        // Tags are expensive: a frame for another receiver is not opened.
        if !self.is_for_me(&frame) {
            return Ok(Received::Elsewhere);
        }
        let key = if frame.sender == Sender::Host { &self.keys.host } else { &self.keys.team };
        if !frame.is_genuine(packet, key, self.me) {
            return Err(Refusal::Tag);
        }
        match frame.sender {
            Sender::Robot(teammate) => {
                self.open_teammate(teammate, &frame).map(|message| Received::Teammate(teammate, message))
            }
            Sender::Host => self.open_host(now, &frame).map(Received::Host),
        }
    }

    fn open_teammate(&mut self, teammate: RobotId, frame: &Frame<'_>) -> Result<TeamMessage, Refusal> {
        self.peer_table.receive(teammate, frame.epoch);
        let message = decode::<TeamMessage>(frame.payload);
        if let Some(TeamMessage::Handshake(Handshake { teammates })) = &message
            && let Some(own) = teammates.iter().find(|own| own.who == self.me && own.boot_epoch == self.epoch)
        {
            self.peer_table.believe(teammate, frame.epoch, own.bond);
        } else if self.sessions.epoch(frame.sender) != Some(frame.epoch) {
            return Err(Refusal::Unauthenticated { epoch: frame.epoch });
        }
        self.sessions.accept(frame);
        message.ok_or(Refusal::Payload)
    }

    fn open_host(&mut self, now: Instant, frame: &Frame<'_>) -> Result<HostMessage, Refusal> {
        let message = host_message(frame.payload);
        let known = self.sessions.epoch(Sender::Host) == Some(frame.epoch);
        let mut clock = if known { self.clock } else { None };
        if let Some(HostMessage::Welcome(welcome)) = &message
            && (welcome.to, welcome.boot_epoch) == (self.me, self.epoch)
        {
            clock = Some(HostClock::learned(clock, now, welcome.offset));
        }
        // Without a welcome the host's clock is unknown.
        let age = clock.ok_or(Refusal::Unauthenticated { epoch: frame.epoch })?.age(now, frame.counter);
        if known {
            self.clock = if age == Age::Ahead && frame.audience.is_none() { None } else { clock };
        }
        let Age::Within(age) = age else { return Err(Refusal::Stale) };
        self.sessions.accept(frame);
        (self.clock, self.age) = (clock, age);
        let message = message.ok_or(Refusal::Payload)?;
        if !known {
            self.snapshots.forget();
        }
        if let HostMessage::World(part) = &message {
            self.snapshots.handle(part);
        }
        Ok(message)
    }
}

/// Counters of the host's snapshots. Every robot is sent every part, so a missing part was lost.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Snapshots {
    /// Parts received in this boot epoch.
    pub received: u32,
    /// Parts never received: of snapshots that are over, or whole snapshots between two received ones (as
    /// many parts as the later one). 256 snapshots missed in a row cannot be distinguished from none; a
    /// caller that relies on it must check the silence too.
    pub lost: u32,
    /// Parts that came since the last opened one and were left unopened: they are not lost.
    unopened: u8,
    now: Option<Now>,
}

/// The snapshot being received.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Now {
    number: u8,
    parts: u8,
    /// Bits of the parts received.
    came: u8,
}

const _: () = assert!(PARTS_MAX <= u8::BITS as usize, "a bit for each part");

impl Snapshots {
    /// The newest snapshot of which a part was received.
    pub fn newest(&self) -> Option<u8> {
        self.now.map(|now| now.number)
    }

    /// Another host: its numbers are unrelated to the last one's.
    fn forget(&mut self) {
        self.now = None;
    }

    fn handle(&mut self, part: &WorldPart) {
        let bit = 1_u8.checked_shl(u32::from(part.part)).unwrap_or(0);
        self.received = self.received.saturating_add(1);
        match &mut self.now {
            Some(now) if now.number == part.snapshot => now.came |= bit,
            _ => {
                if let Some(last) = self.now {
                    let missing = u32::from(last.parts).saturating_sub(last.came.count_ones());
                    let between = part.snapshot.wrapping_sub(last.number).wrapping_sub(1);
                    let skipped = u32::from(between) * u32::from(part.parts);
                    let lost = (missing + skipped).saturating_sub(u32::from(self.unopened));
                    self.lost = self.lost.saturating_add(lost);
                }
                self.unopened = 0;
                self.now = Some(Now { number: part.snapshot, parts: part.parts, came: bit });
            }
        }
    }
}

/// Reads a robot's packet without being part of the team: for an observer of the radio channel (the keys are
/// needed, order and repetition are not judged). The host's packets are refused as those of a sender that
/// does not send to us.
pub fn overhear(packet: &[u8], team: TeamId, keys: &TeamKeys) -> Result<(RobotId, TeamMessage), Refusal> {
    let frame = Frame::parse(packet, team)?;
    let Sender::Robot(robot) = frame.sender else { return Err(Refusal::Sender(frame.sender.number())) };
    let key = if TeamMessage::is_for_host(frame.payload) { keys.of(robot) } else { keys.team() };
    if !frame.is_genuine(packet, key, robot) {
        return Err(Refusal::Tag);
    }
    decode(frame.payload).map(|message| (robot, message)).ok_or(Refusal::Payload)
}

/// Opens as [`overhear`] does, but the host's packets, read in `reader`'s place.
pub fn overhear_host(
    packet: &[u8],
    team: TeamId,
    keys: &RobotKeys,
    reader: RobotId,
) -> Result<HostMessage, Refusal> {
    let frame = Frame::parse(packet, team)?;
    if frame.sender != Sender::Host {
        return Err(Refusal::Sender(frame.sender.number()));
    }
    if !frame.is_genuine(packet, &keys.host, reader) {
        return Err(Refusal::Tag);
    }
    host_message(frame.payload).ok_or(Refusal::Payload)
}

pub(crate) fn count(refused: &mut [u32; Refusal::KINDS], refusal: Refusal) {
    // There is one counter for each kind.
    if let Some(count) = refused.get_mut(refusal.kind()) {
        *count = count.saturating_add(1);
    }
}

fn host_message(payload: &[u8]) -> Option<HostMessage> {
    HostMessage::read(payload).filter(HostMessage::is_sound)
}

#[cfg(test)]
mod tests;
