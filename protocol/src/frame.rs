//! Who sent these bytes, when, and are they genuine? The radio's envelope (DESIGN §6).
//!
//! ```text
//! version 1 | team 1 | sender 1 | epoch 4 LE | counter 4 LE | payload n | tag 8
//! ```
//!
//! The tag is SipHash-2-4 under the team's 128-bit key over all bytes before it, little endian. Checks run in the order
//! length → id → epoch and counter → tag → decode; the epoch and counter are [`Sessions`]' business, the payload is
//! its reader's. `protocol/SPEC.md` has worked bytes.

use core::hash::Hasher;

use siphasher::sip::SipHasher24;

use crate::{RobotId, TeamId};

/// The version of the layout; a frame of any other is refused.
pub const VERSION: u8 = 1;
/// Bytes before the payload.
pub const HEADER_LEN: usize = 11;
/// Bytes of the tag.
pub const TAG_LEN: usize = 8;
/// Bytes of a frame that are not payload.
pub const OVERHEAD: usize = HEADER_LEN + TAG_LEN;
/// The longest frame on the air (a part of the world; DESIGN §6).
pub const FRAME_LEN_MAX: usize = 120;
/// The longest payload.
pub const PAYLOAD_LEN_MAX: usize = FRAME_LEN_MAX - OVERHEAD;

/// A team's key; all zeros until one is provisioned.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct TeamKey(pub [u8; 16]);

impl TeamKey {
    /// The key before provisioning: it tells frames from noise, not friends from foes.
    pub const ZERO: Self = Self([0; 16]);

    fn tag(&self, bytes: &[u8]) -> [u8; TAG_LEN] {
        let mut hasher = SipHasher24::new_with_key(&self.0);
        hasher.write(bytes);
        hasher.finish().to_le_bytes()
    }
}

impl core::fmt::Debug for TeamKey {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str("TeamKey(..)")
    }
}

/// Who speaks on a team's air.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Sender {
    /// A robot of the team; 0–15 on the wire.
    Robot(RobotId),
    /// The team's host, one per team; 16 on the wire.
    Host,
}

impl Sender {
    /// Number of senders a team can have.
    pub const COUNT: usize = RobotId::COUNT + 1;

    /// `None` above 16.
    pub const fn new(number: u8) -> Option<Self> {
        match RobotId::new(number) {
            Some(robot) => Some(Self::Robot(robot)),
            None if number == HOST => Some(Self::Host),
            None => None,
        }
    }

    /// Its number on the wire, 0–16.
    pub const fn number(self) -> u8 {
        match self {
            Self::Robot(robot) => robot.number(),
            Self::Host => HOST,
        }
    }

    /// For arrays with one place per sender.
    pub const fn index(self) -> usize {
        match self {
            Self::Robot(robot) => robot.index(),
            Self::Host => RobotId::COUNT,
        }
    }
}

/// The host's number on the wire: the first that no robot has.
const HOST: u8 = RobotId::COUNT as u8;

/// A frame, its payload borrowed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Frame<'a> {
    /// Whose air this is.
    pub team: TeamId,
    /// Who speaks.
    pub sender: Sender,
    /// Which life of the sender: rises with every boot.
    pub epoch: u32,
    /// Rises with every frame of an epoch.
    pub counter: u32,
    /// postcard bytes.
    pub payload: &'a [u8],
}

/// Why a frame was refused; each kind is counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refusal {
    /// Shorter than an empty frame or longer than [`FRAME_LEN_MAX`].
    Length(usize),
    /// Another version of the layout.
    Version(u8),
    /// Another team's frame.
    Team(TeamId),
    /// No such sender, our own number, or one that does not speak to us.
    Sender(u8),
    /// An earlier life of the sender.
    Epoch {
        /// The epoch in the frame.
        seen: u32,
        /// The sender's current epoch.
        current: u32,
    },
    /// Not newer than the last frame of this epoch: a duplicate, a straggler or a replay.
    Counter {
        /// The counter in the frame.
        seen: u32,
        /// The last one accepted.
        last: u32,
    },
    /// The tag is not the key's.
    Tag,
    /// The payload is no message.
    Payload,
    /// A host or mate that has not shown that it knows this life of ours: a new one, or a recording.
    Stranger {
        /// The epoch in the frame.
        epoch: u32,
    },
}

impl Refusal {
    /// Number of kinds.
    pub const KINDS: usize = 9;

    /// The kind's place in a table of counters.
    pub fn kind(self) -> usize {
        match self {
            Self::Length(_) => 0,
            Self::Version(_) => 1,
            Self::Team(_) => 2,
            Self::Sender(_) => 3,
            Self::Epoch { .. } => 4,
            Self::Counter { .. } => 5,
            Self::Tag => 6,
            Self::Payload => 7,
            Self::Stranger { .. } => 8,
        }
    }
}

impl core::fmt::Display for Refusal {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Length(n) => write!(f, "frame of {n} bytes"),
            Self::Version(v) => write!(f, "frame of version {v}, this is {VERSION}"),
            Self::Team(t) => write!(f, "frame of team {}", t.0),
            Self::Sender(s) => write!(f, "frame from impossible sender {s}"),
            Self::Epoch { seen, current } => write!(f, "frame of epoch {seen}, the sender is in {current}"),
            Self::Counter { seen, last } => write!(f, "frame {seen} is not after {last}"),
            Self::Tag => f.write_str("frame with a wrong tag"),
            Self::Payload => f.write_str("frame whose payload is no message"),
            Self::Stranger { epoch } => {
                write!(f, "frame of a sender in epoch {epoch}, which has not named our life")
            }
        }
    }
}

impl core::error::Error for Refusal {}

/// Who a frame claims to be from, by its header alone; nothing is checked.
pub fn claimed_sender(bytes: &[u8]) -> Option<Sender> {
    bytes.get(SENDER_AT).and_then(|number| Sender::new(*number))
}

/// Where the sender stands: after version and team.
const SENDER_AT: usize = 2;

impl<'a> Frame<'a> {
    /// Reads the envelope; the tag is not looked at yet, see [`Frame::is_genuine`].
    pub fn parse(bytes: &'a [u8], team: TeamId) -> Result<Self, Refusal> {
        if bytes.len() > FRAME_LEN_MAX {
            return Err(Refusal::Length(bytes.len()));
        }
        let (Some((head, rest)), true) = (bytes.split_first_chunk::<HEADER_LEN>(), bytes.len() >= OVERHEAD)
        else {
            return Err(Refusal::Length(bytes.len()));
        };
        let payload = rest.split_last_chunk::<TAG_LEN>().ok_or(Refusal::Length(bytes.len()))?.0;
        let [version, seen_team, sender, e0, e1, e2, e3, c0, c1, c2, c3] = *head;
        if version != VERSION {
            return Err(Refusal::Version(version));
        }
        if seen_team != team.0 {
            return Err(Refusal::Team(TeamId(seen_team)));
        }
        let sender = Sender::new(sender).ok_or(Refusal::Sender(sender))?;
        let epoch = u32::from_le_bytes([e0, e1, e2, e3]);
        let counter = u32::from_le_bytes([c0, c1, c2, c3]);
        Ok(Self { team, sender, epoch, counter, payload })
    }

    /// Whether `bytes`, a whole frame, end in the tag that `key` gives.
    pub fn is_genuine(bytes: &[u8], key: &TeamKey) -> bool {
        match bytes.split_last_chunk::<TAG_LEN>() {
            Some((covered, tag)) => {
                // No early exit: the time must not tell how many bytes were right.
                key.tag(covered).iter().zip(tag).fold(0, |difference, (a, b)| difference | (a ^ b)) == 0
            }
            None => false,
        }
    }

    /// Writes the frame; gives its length, or `None` if `out` is too short for it.
    pub fn emit(&self, key: &TeamKey, out: &mut [u8]) -> Option<usize> {
        let covered = HEADER_LEN + self.payload.len();
        let (covered, rest) = out.split_at_mut_checked(covered)?;
        let tag = rest.first_chunk_mut::<TAG_LEN>()?;
        let (head, rest) = covered.split_first_chunk_mut::<HEADER_LEN>()?;
        let (epoch, counter) = (self.epoch.to_le_bytes(), self.counter.to_le_bytes());
        *head = [
            VERSION,
            self.team.0,
            self.sender.number(),
            epoch[0],
            epoch[1],
            epoch[2],
            epoch[3],
            counter[0],
            counter[1],
            counter[2],
            counter[3],
        ];
        rest.get_mut(..self.payload.len())?.copy_from_slice(self.payload);
        *tag = key.tag(covered);
        Some(covered.len() + TAG_LEN)
    }
}

/// What a receiver remembers of every sender: its epoch and the last counter accepted.
#[derive(Clone, Debug, Default)]
pub struct Sessions {
    last: [Option<(u32, u32)>; Sender::COUNT],
}

impl Sessions {
    /// Would this frame be news? To be asked before the tag is computed.
    pub fn check(&self, frame: &Frame<'_>) -> Result<(), Refusal> {
        match self.last[frame.sender.index()] {
            Some((current, _)) if frame.epoch < current => Err(Refusal::Epoch { seen: frame.epoch, current }),
            Some((current, last)) if frame.epoch == current && frame.counter <= last => {
                Err(Refusal::Counter { seen: frame.counter, last })
            }
            _ => Ok(()),
        }
    }

    /// The sender's current epoch, if it was heard.
    pub fn epoch(&self, sender: Sender) -> Option<u32> {
        self.last[sender.index()].map(|(epoch, _)| epoch)
    }

    /// The sender's last counter, if it was heard.
    pub fn counter(&self, sender: Sender) -> Option<u32> {
        self.last[sender.index()].map(|(_, counter)| counter)
    }

    /// Remembers a frame that was checked and found genuine.
    pub fn accept(&mut self, frame: &Frame<'_>) {
        self.last[frame.sender.index()] = Some((frame.epoch, frame.counter));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEAM: TeamId = TeamId(3);

    fn frame(epoch: u32, counter: u32) -> Frame<'static> {
        Frame { team: TEAM, sender: Sender::new(2).unwrap(), epoch, counter, payload: b"abc" }
    }

    #[test]
    fn a_frame_has_the_bytes_of_the_specification() {
        let mut out = [0; FRAME_LEN_MAX];
        let n = frame(0x0102_0304, 5).emit(&TeamKey::ZERO, &mut out).unwrap();
        assert_eq!(n, OVERHEAD + 3);
        assert_eq!(&out[..14], &[1, 3, 2, 4, 3, 2, 1, 5, 0, 0, 0, b'a', b'b', b'c']);
        assert_eq!(Frame::parse(&out[..n], TEAM), Ok(frame(0x0102_0304, 5)));
        assert!(Frame::is_genuine(&out[..n], &TeamKey::ZERO));
    }

    #[test]
    fn every_flipped_bit_is_noticed() {
        let mut out = [0; FRAME_LEN_MAX];
        let n = frame(1, 1).emit(&TeamKey::ZERO, &mut out).unwrap();
        for bit in 0..n * 8 {
            out[bit / 8] ^= 1 << (bit % 8);
            assert!(!Frame::is_genuine(&out[..n], &TeamKey::ZERO), "bit {bit}");
            out[bit / 8] ^= 1 << (bit % 8);
        }
    }

    #[test]
    fn the_order_of_refusals_is_length_then_id() {
        assert_eq!(Frame::parse(&[0; 18], TEAM), Err(Refusal::Length(18)));
        assert_eq!(Frame::parse(&[0; 121], TEAM), Err(Refusal::Length(121)));
        assert_eq!(Frame::parse(&[9; 19], TEAM), Err(Refusal::Version(9)));
        let mut bytes = [0; 19];
        bytes[0] = VERSION;
        assert_eq!(Frame::parse(&bytes, TEAM), Err(Refusal::Team(TeamId(0))));
        (bytes[1], bytes[2]) = (3, 17);
        assert_eq!(Frame::parse(&bytes, TEAM), Err(Refusal::Sender(17)));
    }

    #[test]
    fn a_counter_must_rise_and_a_new_epoch_starts_over() {
        let mut sessions = Sessions::default();
        sessions.accept(&frame(7, 10));
        assert_eq!(sessions.check(&frame(7, 10)), Err(Refusal::Counter { seen: 10, last: 10 }));
        assert_eq!(sessions.check(&frame(6, 99)), Err(Refusal::Epoch { seen: 6, current: 7 }));
        assert_eq!(sessions.check(&frame(7, 11)), Ok(()));
        assert_eq!(sessions.check(&frame(8, 0)), Ok(()));
    }

    #[test]
    fn sixteen_robots_and_a_host_can_speak() {
        assert_eq!(Sender::new(15), RobotId::new(15).map(Sender::Robot));
        assert_eq!(Sender::new(16), Some(Sender::Host));
        assert_eq!(Sender::new(17), None);
        for n in 0..Sender::COUNT {
            let sender = Sender::new(n as u8).unwrap();
            assert_eq!((usize::from(sender.number()), sender.index()), (n, n));
        }
    }

    #[test]
    fn a_frame_that_does_not_fit_is_not_written() {
        assert_eq!(frame(1, 1).emit(&TeamKey::ZERO, &mut [0; 21]), None);
    }
}
