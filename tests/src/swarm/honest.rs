//! Which packets may a robot believe? The rules of `protocol/SPEC.md` once more, apart from the code that keeps them.
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
    all: BTreeSet<Packet>,
    /// The same in the order it was said.
    pub in_order: Vec<Packet>,
}

impl Sayings {
    /// Somebody of the team said this.
    pub fn add(&mut self, packet: &Packet) {
        if self.all.insert(packet.clone()) {
            self.in_order.push(packet.clone());
        }
    }
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
        if !sayings.all.contains(packet) {
            return None;
        }
        // version, team, sender, epoch, counter, payload, tag.
        let sender = usize::from(packet[2]);
        let number =
            |at: usize| u32::from_le_bytes([packet[at], packet[at + 1], packet[at + 2], packet[at + 3]]);
        let this = (number(3), number(7));
        let payload = &packet[11..packet.len() - 8];
        if sender == self.me.index() || self.newest[sender].is_some_and(|newest| this <= newest) {
            return None;
        }
        let known = self.newest[sender].is_some_and(|(epoch, _)| epoch == this.0);
        if sender < 16 {
            let message: TeamMessage = postcard::from_bytes(payload).ok()?;
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
        let welcome = HostMessage::Welcome(Welcome { to: self.me, life: self.life });
        if !known && message != welcome {
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
