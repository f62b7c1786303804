//! `honest`: reference for the packets that a robot may accept. The rules of `protocol/SPEC.md` once more,
//! apart from the code that keeps them.
//!
//! How old a frame of the host is, is not judged: a robot that refuses one as stale brakes, which it may always do.
//!
//! Nobody here computes a tag: a packet is genuine if somebody of the team said it, byte for byte, in this match or in an
//! earlier one; the swarm saw them say it.

use std::collections::BTreeSet;

use protocol::RobotId;
use protocol::host::{HostMessage, Welcome};
use protocol::link::Packet;
use protocol::team::TeamMessage;

/// Everything that the team ever said.
#[derive(Debug, Default)]
pub struct Sayings {
    /// A frame to several robots as each of its readers sees it: what its tag covers, and its own tag.
    all: BTreeSet<Vec<u8>>,
    /// The same in the order it was said.
    pub in_order: Vec<Packet>,
}

impl Sayings {
    /// Somebody of the team said this.
    pub fn add(&mut self, packet: &Packet) {
        let readers = RobotId::all().filter_map(|reader| seen_by(packet, reader));
        let mut news = false;
        for seen in readers {
            news |= self.all.insert(seen);
        }
        if news {
            self.in_order.push(packet.clone());
        }
    }
}

/// What a reader sees of a packet: all of it, or of a frame to several robots (sender 17) what is covered and its own three bytes;
/// nothing if it is not among them.
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

/// What may be believed of a packet.
#[allow(clippy::large_enum_variant, reason = "one value at a time")]
#[derive(Clone, Debug, PartialEq)]
pub enum Believed {
    /// The host says this.
    Host(HostMessage),
    /// A mate says this.
    Mate(RobotId, TeamMessage),
}

/// A life of a robot, as a listener.
#[derive(Clone, Debug)]
pub struct Honest {
    me: RobotId,
    life: u32,
    /// Epoch and counter of the newest packet believed, by sender; 16 is the host.
    newest: [Option<(u32, u32)>; 17],
}

impl Honest {
    /// Nothing heard yet in this life.
    pub fn new(me: RobotId, life: u32) -> Self {
        Self { me, life, newest: [None; 17] }
    }

    /// The robot hears this; what it may believe of it.
    pub fn hear(&mut self, packet: &Packet, sayings: &Sayings) -> Option<Believed> {
        if !seen_by(packet, self.me).is_some_and(|seen| sayings.all.contains(&seen)) {
            return None;
        }
        // version, team, sender, epoch, counter, payload, tag; the host's number is 17 where an audience and its tags follow.
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
            if matches!(message, TeamMessage::Telemetry(_)) {
                // Under a key that teammates have not.
                return None;
            }
            let names_me = match &message {
                TeamMessage::Greeting(greeting) => {
                    greeting.mates.iter().any(|mate| (mate.who, mate.life) == (self.me, self.life))
                }
                TeamMessage::Beacon(_) | TeamMessage::Telemetry(_) => false,
            };
            if !known && !names_me {
                return None;
            }
            self.newest[sender] = Some(this);
            return Some(Believed::Mate(RobotId::new(packet[2])?, message));
        }
        let message: HostMessage = postcard::from_bytes(payload).ok()?;
        let welcomes = |welcome: &Welcome| (welcome.to, welcome.life) == (self.me, self.life);
        if !known && !matches!(&message, HostMessage::Welcome(welcome) if welcomes(welcome)) {
            return None;
        }
        let for_another = match &message {
            HostMessage::World(_) => false,
            HostMessage::Command(command) => command.to != self.me,
            HostMessage::Welcome(welcome) => welcome.to != self.me,
        };
        if for_another {
            return None;
        }
        self.newest[sender] = Some(this);
        Some(Believed::Host(message))
    }
}
