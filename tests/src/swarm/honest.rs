//! `honest`: reference for the packets that a robot may accept. A second implementation of the rules of
//! `protocol/SPEC.md`, independent of the code under test.
//!
//! The age of a host frame is not judged: a robot that refuses one as stale brakes, which is always
//! permitted.
//!
//! No tag is computed here: a packet is genuine if a member of the team sent it, byte for byte, in this match
//! or in an earlier one; the swarm recorded all sent packets.

use std::collections::BTreeSet;

use protocol::RobotId;
use protocol::host::{HostMessage, Welcome};
use protocol::link::Packet;
use protocol::team::TeamMessage;

/// Everything that the team ever sent.
#[derive(Debug, Default)]
pub struct SentPackets {
    /// A frame to several robots as each of its receivers sees it: the bytes covered by its tag, and its own
    /// tag.
    all: BTreeSet<Vec<u8>>,
    /// The same in the order of sending.
    pub in_order: Vec<Packet>,
}

impl SentPackets {
    /// Adds a packet sent by a member of the team.
    pub fn add(&mut self, packet: &Packet) {
        let readers = RobotId::all().filter_map(|reader| seen_by(packet, reader));
        let mut changed = false;
        for seen in readers {
            changed |= self.all.insert(seen);
        }
        if changed {
            self.in_order.push(packet.clone());
        }
    }
}

/// The part of a packet that a receiver sees: all of it, or of a frame to several robots (sender 17) the
/// covered bytes and its own three bytes of tag; `None` if it is not among the receivers.
fn seen_by(packet: &[u8], reader: RobotId) -> Option<Vec<u8>> {
    if packet.get(2) != Some(&17) {
        return Some(packet.to_vec());
    }
    let audience = u16::from_le_bytes([*packet.get(11)?, *packet.get(12)?]);
    let of = |robots: u16| 3 * robots.count_ones() as usize;
    let covered = packet.len().checked_sub(of(audience))?;
    let own = covered + of(audience & ((1 << reader.number()) - 1));
    let addressed = audience & 1 << reader.number() != 0;
    addressed.then(|| [&packet[..covered], &packet[own..own + 3]].concat())
}

/// A message that the robot may believe.
#[allow(clippy::large_enum_variant, reason = "one value at a time")]
#[derive(Clone, Debug, PartialEq)]
pub enum Believed {
    /// A message of the host.
    Host(HostMessage),
    /// A message of a teammate.
    Teammate(RobotId, TeamMessage),
}

/// A boot epoch of a robot, as a receiver.
#[derive(Clone, Debug)]
pub struct Honest {
    me: RobotId,
    boot_epoch: u32,
    /// Epoch and counter of the newest accepted packet, by sender; 16 is the host.
    newest: [Option<(u32, u32)>; 17],
}

impl Honest {
    /// A receiver that has received nothing in this epoch.
    pub fn new(me: RobotId, boot_epoch: u32) -> Self {
        Self { me, boot_epoch, newest: [None; 17] }
    }

    /// Takes a received packet; returns its message if it may be accepted.
    pub fn receive(&mut self, packet: &Packet, sent_packets: &SentPackets) -> Option<Believed> {
        if !seen_by(packet, self.me).is_some_and(|seen| sent_packets.all.contains(&seen)) {
            return None;
        }
        // version, team, sender, epoch, counter, payload, tag; the host's number is 17 where an audience and
        // its tags follow.
        let several = packet[2] == 17;
        let sender = if several { 16 } else { usize::from(packet[2]) };
        let number =
            |at: usize| u32::from_le_bytes([packet[at], packet[at + 1], packet[at + 2], packet[at + 3]]);
        let this = (number(3), number(7));
        let payload = if several {
            let robots = u16::from_le_bytes([packet[11], packet[12]]).count_ones() as usize;
            &packet[13..packet.len() - 3 * robots]
        } else {
            &packet[11..packet.len() - 8]
        };
        if sender == self.me.index() || self.newest[sender].is_some_and(|newest| this <= newest) {
            return None;
        }
        let known = self.newest[sender].is_some_and(|(epoch, _)| epoch == this.0);
        if sender < 16 {
            let message: TeamMessage = postcard::from_bytes(payload).ok()?;
            if matches!(message, TeamMessage::Telemetry(_) | TeamMessage::Decision(_)) {
                // Sealed with a key that teammates do not have.
                return None;
            }
            let names_me = match &message {
                TeamMessage::Handshake(handshake) => handshake
                    .teammates
                    .iter()
                    .any(|teammate| (teammate.who, teammate.boot_epoch) == (self.me, self.boot_epoch)),
                TeamMessage::Beacon(_) | TeamMessage::Telemetry(_) | TeamMessage::Decision(_) => false,
            };
            if !known && !names_me {
                return None;
            }
            self.newest[sender] = Some(this);
            return Some(Believed::Teammate(RobotId::new(packet[2])?, message));
        }
        let message: HostMessage = postcard::from_bytes(payload).ok()?;
        let welcomes = |welcome: &Welcome| (welcome.to, welcome.boot_epoch) == (self.me, self.boot_epoch);
        if !known && !matches!(&message, HostMessage::Welcome(welcome) if welcomes(welcome)) {
            return None;
        }
        let for_another = match &message {
            HostMessage::World(_) => false,
            HostMessage::Command(command) => command.to != self.me,
            HostMessage::Welcome(welcome) => welcome.to != self.me,
            HostMessage::Limits(limits) => limits.to != self.me,
        };
        if for_another {
            return None;
        }
        self.newest[sender] = Some(this);
        Some(Believed::Host(message))
    }
}
