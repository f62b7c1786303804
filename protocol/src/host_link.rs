//! How do the host's pictures and commands become packets of the air, and which robots' packets does it believe? The
//! host's end of the radio; [`crate::link`] is the robots'.

use crate::frame::{Frame, PAYLOAD_LEN_MAX, Refusal, Sender, Sessions, TeamKey};
use crate::host::HostMessage;
use crate::link::{Packet, count, decode, packet};
use crate::team::TeamMessage;
use crate::{RobotId, TeamId};

/// The host's end of the radio: seals what it says, opens what robots say, counts what it refuses.
#[derive(Clone, Debug)]
pub struct HostLink {
    team: TeamId,
    key: TeamKey,
    epoch: u32,
    counter: u32,
    sessions: Sessions,
    refused: [u32; Refusal::KINDS],
}

impl HostLink {
    /// A link in the life `epoch` of the host; a later start must bring a larger one (seconds of a calendar do).
    pub fn new(team: TeamId, key: TeamKey, epoch: u32) -> Self {
        Self { team, key, epoch, counter: 0, sessions: Sessions::default(), refused: [0; Refusal::KINDS] }
    }

    /// The packet that carries `message`.
    pub fn seal(&mut self, message: &HostMessage) -> Packet {
        let mut payload = [0; PAYLOAD_LEN_MAX];
        // A message always fits (tested with the longest there is); if it did not, silence is the safe answer.
        let Ok(payload) = postcard::to_slice(message, &mut payload) else { return Packet::new() };
        self.counter = self.counter.wrapping_add(1);
        let frame = Frame {
            team: self.team,
            sender: Sender::Host,
            epoch: self.epoch,
            counter: self.counter,
            payload,
        };
        packet(&frame, &self.key)
    }

    /// Which robot says what, or why the packet is not believed (counted). A host's packet is refused by its sender, 16:
    /// there is a second host on this air, or this one hears itself.
    pub fn open(&mut self, packet: &[u8]) -> Result<(RobotId, TeamMessage), Refusal> {
        let opened = self.try_open(packet);
        if let Err(refusal) = opened {
            count(&mut self.refused, refusal);
        }
        opened
    }

    /// How many packets were refused, by [`Refusal::kind`].
    pub fn refused(&self) -> &[u32; Refusal::KINDS] {
        &self.refused
    }

    /// The life in which that robot spoke last; what it is welcomed with.
    pub fn life(&self, robot: RobotId) -> Option<u32> {
        self.sessions.epoch(Sender::Robot(robot))
    }

    /// The number of that robot's last frame in this life.
    pub fn counter(&self, robot: RobotId) -> Option<u32> {
        self.sessions.counter(Sender::Robot(robot))
    }

    fn try_open(&mut self, packet: &[u8]) -> Result<(RobotId, TeamMessage), Refusal> {
        let frame = Frame::parse(packet, self.team)?;
        let Sender::Robot(robot) = frame.sender else { return Err(Refusal::Sender(frame.sender.number())) };
        self.sessions.check(&frame)?;
        if !Frame::is_genuine(packet, &self.key) {
            return Err(Refusal::Tag);
        }
        self.sessions.accept(&frame);
        decode(frame.payload).map(|message| (robot, message)).ok_or(Refusal::Payload)
    }
}
