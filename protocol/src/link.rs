//! How does a robot's message become a packet of the air, and which packets does it believe? One end of the radio.

use crate::frame::{FRAME_LEN_MAX, Frame, Refusal, Sessions, TeamKey};
use crate::team::{TEAM_MESSAGE_LEN_MAX, TeamMessage};
use crate::{RobotId, TeamId};

/// A packet of the air: one whole frame.
pub type Packet = heapless::Vec<u8, FRAME_LEN_MAX>;

/// One robot's end of the radio: seals what it says, opens what it hears, counts what it refuses.
#[derive(Clone, Debug)]
pub struct Link {
    team: TeamId,
    me: RobotId,
    key: TeamKey,
    epoch: u32,
    counter: u32,
    sessions: Sessions,
    refused: [u32; Refusal::KINDS],
}

impl Link {
    /// A link in the life `epoch` of robot `me`; a later boot must bring a larger one.
    pub fn new(team: TeamId, me: RobotId, key: TeamKey, epoch: u32) -> Self {
        Self { team, me, key, epoch, counter: 0, sessions: Sessions::default(), refused: [0; Refusal::KINDS] }
    }

    /// The packet that carries `message`.
    pub fn seal(&mut self, message: &TeamMessage) -> Packet {
        let mut payload = [0; TEAM_MESSAGE_LEN_MAX];
        let mut packet = Packet::new();
        // A message always fits (tested with the longest there is); if it did not, silence is the safe answer.
        let Ok(payload) = postcard::to_slice(message, &mut payload) else { return packet };
        self.counter = self.counter.wrapping_add(1);
        let frame =
            Frame { team: self.team, sender: self.me, epoch: self.epoch, counter: self.counter, payload };
        if packet.resize_default(FRAME_LEN_MAX).is_ok() {
            let len = frame.emit(&self.key, &mut packet).unwrap_or(0);
            packet.truncate(len);
        }
        packet
    }

    /// Who says what, or why the packet is not believed (counted).
    pub fn open(&mut self, packet: &[u8]) -> Result<(RobotId, TeamMessage), Refusal> {
        let opened = self.try_open(packet);
        if let Err(refusal) = opened {
            let count = &mut self.refused[refusal.kind()];
            *count = count.saturating_add(1);
        }
        opened
    }

    /// How many packets were refused, by [`Refusal::kind`].
    pub fn refused(&self) -> &[u32; Refusal::KINDS] {
        &self.refused
    }

    fn try_open(&mut self, packet: &[u8]) -> Result<(RobotId, TeamMessage), Refusal> {
        let frame = Frame::parse(packet, self.team)?;
        if frame.sender == self.me {
            return Err(Refusal::Sender(self.me.number()));
        }
        self.sessions.check(&frame)?;
        if !Frame::is_genuine(packet, &self.key) {
            return Err(Refusal::Tag);
        }
        self.sessions.accept(&frame);
        decode(frame.payload).map(|message| (frame.sender, message)).ok_or(Refusal::Payload)
    }
}

/// Reads a packet without being part of the team: for whoever watches the air from outside (the key is needed, order
/// and repetition are not judged).
pub fn overhear(packet: &[u8], team: TeamId, key: &TeamKey) -> Result<(RobotId, TeamMessage), Refusal> {
    let frame = Frame::parse(packet, team)?;
    if !Frame::is_genuine(packet, key) {
        return Err(Refusal::Tag);
    }
    decode(frame.payload).map(|message| (frame.sender, message)).ok_or(Refusal::Payload)
}

/// The message, if the payload is one to its last byte and its ids exist.
fn decode(payload: &[u8]) -> Option<TeamMessage> {
    let (message, rest) = postcard::take_from_bytes::<TeamMessage>(payload).ok()?;
    rest.is_empty().then_some(message)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::team::{Beacon, Progress, Role, Status};

    fn robot(n: u8) -> RobotId {
        RobotId::new(n).unwrap()
    }

    fn beacon(case_base: u32) -> TeamMessage {
        TeamMessage::Beacon(Beacon {
            pose: crate::quantized::WirePose::default(),
            ball: None,
            status: Status::AVAILABLE,
            case_base,
            cycle: None,
            progress: Progress::Idle,
            role: Role::None,
        })
    }

    fn link(me: u8, epoch: u32) -> Link {
        Link::new(TeamId(1), robot(me), TeamKey::ZERO, epoch)
    }

    #[test]
    fn what_one_seals_another_opens_once() {
        let (mut a, mut b) = (link(1, 0), link(2, 0));
        let packet = a.seal(&beacon(7));
        assert_eq!(b.open(&packet), Ok((robot(1), beacon(7))));
        assert_eq!(b.open(&packet), Err(Refusal::Counter { seen: 1, last: 1 }));
        assert_eq!(b.refused()[5], 1);
    }

    #[test]
    fn a_forged_packet_does_not_move_the_counter() {
        let (mut a, mut b) = (link(1, 0), link(2, 0));
        let good = a.seal(&beacon(7));
        let mut forged = good.clone();
        forged[7] = 200;
        assert_eq!(b.open(&forged), Err(Refusal::Tag));
        assert!(b.open(&good).is_ok());
    }

    #[test]
    fn frames_of_an_earlier_life_are_refused() {
        let (mut old, mut new, mut b) = (link(1, 4), link(1, 5), link(2, 0));
        let late = old.seal(&beacon(1));
        assert!(b.open(&new.seal(&beacon(2))).is_ok());
        assert_eq!(b.open(&late), Err(Refusal::Epoch { seen: 4, current: 5 }));
    }

    #[test]
    fn random_bytes_never_panic() {
        let mut b = link(2, 0);
        let mut state = 1_u64;
        for _ in 0..20_000 {
            let mut bytes = [0_u8; 90];
            for byte in &mut bytes {
                state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                *byte = (state >> 56) as u8;
            }
            (bytes[0], bytes[1], bytes[2]) = (1, 1, 3);
            let len = usize::from(bytes[89]) % 90;
            assert!(b.open(&bytes[..len]).is_err());
            let _ = decode(&bytes[..len]);
        }
    }
}
