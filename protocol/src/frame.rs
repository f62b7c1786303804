//! `frame`: the radio's envelope: sender, epoch, counter, payload and tags that prove them genuine
//! (docs/architecture.md §6.1).
//!
//! ```text
//! version 1 | team 1 | sender 1 | epoch 4 LE | counter 4 LE | payload n | tag 8                    to one robot, or from one
//! version 1 | team 1 | 17       | epoch 4 LE | counter 4 LE | audience 2 LE | payload n | 3 for each robot in the audience
//! ```
//!
//! A tag is SipHash-2-4 under the receiver's key over all bytes before the tags, little endian; a short one
//! is its first three bytes. The host seals a frame for several robots once for each of them, so that no
//! robot's key makes a frame that another one accepts. Checks run in the order length → version, team, sender
//! → epoch and counter → tag → decode; epoch and counter are checked by [`Sessions`], the payload by its
//! reader. `protocol/SPEC.md` has worked bytes.

use crate::{RobotId, TeamId};

pub use crate::key::{Key, RobotKeys, TeamKey, TeamKeys};

/// The version of the layout; a frame of any other is refused.
pub const VERSION: u8 = 2;
/// Bytes before the payload of a frame with one tag.
pub const HEADER_LEN: usize = 11;
/// Bytes of the tag where there is one.
pub const TAG_LEN: usize = 8;
/// Bytes of each tag where there are several: a forgery passes once in 2²⁴ tries, 3.7 h at 1,250 frames a
/// second.
pub const SHORT_TAG_LEN: usize = 3;
/// Bytes that name the audience.
pub const AUDIENCE_LEN: usize = 2;
/// Bytes of a frame with one tag that are not payload.
pub const OVERHEAD: usize = HEADER_LEN + TAG_LEN;
/// The longest frame on the radio (a part of the world; docs/architecture.md §6.1).
pub const FRAME_LEN_MAX: usize = 120;
/// The bytes of one frame, sealed.
pub type FrameBytes = heapless::Vec<u8, FRAME_LEN_MAX>;
/// The longest payload, in a frame with one tag.
pub const PAYLOAD_LEN_MAX: usize = FRAME_LEN_MAX - OVERHEAD;

/// Sender of a frame in a team's radio network.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Sender {
    /// A robot of the team; 0–15 on the wire.
    Robot(RobotId),
    /// The team's host, one per team; 16 on the wire, or 17 to several robots.
    Host,
}

impl Sender {
    /// Number of senders a team can have.
    pub const COUNT: usize = RobotId::COUNT + 1;

    /// The sender of that number: 16 is the host; `None` above 16.
    pub const fn new(number: u8) -> Option<Self> {
        match RobotId::new(number) {
            Some(robot) => Some(Self::Robot(robot)),
            None if number == HOST => Some(Self::Host),
            None => None,
        }
    }

    /// Number on the wire, 0–16.
    pub const fn number(self) -> u8 {
        match self {
            Self::Robot(robot) => robot.number(),
            Self::Host => HOST,
        }
    }

    /// The robot, if it is one.
    pub const fn robot(self) -> Option<RobotId> {
        match self {
            Self::Robot(robot) => Some(robot),
            Self::Host => None,
        }
    }

    /// Index for arrays with one entry per sender.
    pub const fn index(self) -> usize {
        match self {
            Self::Robot(robot) => robot.index(),
            Self::Host => RobotId::COUNT,
        }
    }
}

/// The host's number on the wire: the first after the robots'.
const HOST: u8 = RobotId::COUNT as u8;
/// The host's number in a frame with an audience.
const HOST_TO_SEVERAL: u8 = HOST + 1;

/// A set of robots: bit n is robot n.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Audience(pub u16);

impl Audience {
    /// Returns whether that robot is in the audience.
    pub const fn has(self, robot: RobotId) -> bool {
        self.0 & (1 << robot.number()) != 0
    }

    /// Number of robots in it.
    pub const fn len(self) -> usize {
        self.0.count_ones() as usize
    }

    /// Returns whether there is no robot.
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Every robot in it, lowest number first.
    pub fn robots(self) -> impl Iterator<Item = RobotId> {
        RobotId::all().filter(move |robot| self.has(*robot))
    }

    /// Number of its robots with a lower number.
    const fn before(self, robot: RobotId) -> usize {
        (self.0 & ((1 << robot.number()) - 1)).count_ones() as usize
    }
}

impl FromIterator<RobotId> for Audience {
    fn from_iter<I: IntoIterator<Item = RobotId>>(robots: I) -> Self {
        Self(robots.into_iter().fold(0, |set, robot| set | 1 << robot.number()))
    }
}

/// A frame, its payload borrowed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Frame<'a> {
    /// Team of the network.
    pub team: TeamId,
    /// The sender: a robot's number, or the host.
    pub sender: Sender,
    /// Robots for which it is sealed, if several: a short tag each. Only the host's frames have one.
    pub audience: Option<Audience>,
    /// The sender's boot epoch: rises with every boot.
    pub epoch: u32,
    /// Rises with every frame of an epoch.
    pub counter: u32,
    /// Payload in postcard encoding.
    pub payload: &'a [u8],
}

/// Reason why a frame was refused; each kind is counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Refusal {
    /// Shorter than an empty frame or longer than [`FRAME_LEN_MAX`].
    #[error("frame of {0} bytes")]
    Length(usize),
    /// Another version of the layout.
    #[error("frame of version {0}, this is {VERSION}")]
    Version(u8),
    /// A frame of another team's network.
    #[error("frame of team {}", .0.0)]
    Team(TeamId),
    /// No such sender, our own number, or one that does not send to us.
    #[error("frame from impossible sender {0}")]
    Sender(u8),
    /// An earlier boot epoch of the sender.
    #[error("frame of epoch {seen}, the sender is in {current}")]
    Epoch {
        /// The epoch in the frame.
        seen: u32,
        /// The sender's current epoch.
        current: u32,
    },
    /// Not newer than the last frame of this epoch: a duplicate, a late frame or a replay.
    #[error("frame {seen} is not after {last}")]
    Counter {
        /// The counter in the frame.
        seen: u32,
        /// The last one accepted.
        last: u32,
    },
    /// The tag does not fit the key.
    #[error("frame with a wrong tag")]
    Tag,
    /// The payload does not decode.
    #[error("frame whose payload is no message")]
    Payload,
    /// A sender that has not named our present boot epoch: a new one, or a recording.
    #[error("frame of a sender in epoch {epoch}, which has not named our epoch")]
    Unauthenticated {
        /// The epoch in the frame.
        epoch: u32,
    },
    /// The host's frame is older than [`crate::host_clock::AGE_MAX`]: withheld, or late.
    #[error("frame of the host that is too old")]
    Stale,
}

impl Refusal {
    /// Number of kinds of refusal.
    pub const KINDS: usize = 10;

    /// The kind's index in a table of counters.
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
            Self::Unauthenticated { .. } => 8,
            Self::Stale => 9,
        }
    }
}

/// The sender that a frame claims to be from, by its header alone; nothing is checked.
pub fn claimed_sender(bytes: &[u8]) -> Option<Sender> {
    match *bytes.get(SENDER_AT)? {
        HOST_TO_SEVERAL => Some(Sender::Host),
        number => Sender::new(number),
    }
}

/// Whether a frame claims to be the host's to several robots, by its header alone; nothing is checked.
pub fn claims_audience(bytes: &[u8]) -> bool {
    bytes.get(SENDER_AT) == Some(&HOST_TO_SEVERAL)
}

/// Offset of the sender: after version and team.
const SENDER_AT: usize = 2;

impl<'a> Frame<'a> {
    /// Reads the envelope; the tag is not checked yet, see [`Frame::is_genuine`].
    pub fn parse(bytes: &'a [u8], team: TeamId) -> Result<Self, Refusal> {
        let short = Refusal::Length(bytes.len());
        if bytes.len() > FRAME_LEN_MAX {
            return Err(short);
        }
        let (Some((head, rest)), true) = (bytes.split_first_chunk::<HEADER_LEN>(), bytes.len() >= OVERHEAD)
        else {
            return Err(short);
        };
        let [version, seen_team, sender, e0, e1, e2, e3, c0, c1, c2, c3] = *head;
        if version != VERSION {
            return Err(Refusal::Version(version));
        }
        if seen_team != team.0 {
            return Err(Refusal::Team(TeamId(seen_team)));
        }
        let (sender, audience, rest) = if sender == HOST_TO_SEVERAL {
            let (names, rest) = rest.split_first_chunk::<AUDIENCE_LEN>().ok_or(short)?;
            (Sender::Host, Some(Audience(u16::from_le_bytes(*names))), rest)
        } else {
            (Sender::new(sender).ok_or(Refusal::Sender(sender))?, None, rest)
        };
        let payload = rest.len().checked_sub(tags_len(audience)).and_then(|n| rest.get(..n)).ok_or(short)?;
        let epoch = u32::from_le_bytes([e0, e1, e2, e3]);
        let counter = u32::from_le_bytes([c0, c1, c2, c3]);
        Ok(Self { team, sender, audience, epoch, counter, payload })
    }

    /// Returns whether `bytes`, the whole of this frame, carry the tag that `key` gives; where there are
    /// several, in `reader`'s place.
    pub fn is_genuine(&self, bytes: &[u8], key: &Key, reader: RobotId) -> bool {
        let covered_len = bytes.len().wrapping_sub(tags_len(self.audience));
        let Some((covered, tags)) = bytes.split_at_checked(covered_len) else { return false };
        let seen = match self.audience {
            None => tags.first_chunk().map(|tag| u64::from_le_bytes(*tag)),
            Some(audience) if audience.has(reader) => {
                let at = SHORT_TAG_LEN * audience.before(reader);
                tags.get(at..).and_then(<[u8]>::first_chunk).map(|[a, b, c]| short_tag([*a, *b, *c]))
            }
            Some(_) => None,
        };
        let kept = if self.audience.is_none() { u64::MAX } else { SHORT_TAG_BITS };
        // One comparison of the whole tag: the time must not reveal the number of matching bytes.
        seen.is_some_and(|seen| (seen ^ key.tag(covered)) & kept == 0)
    }

    /// The frame with one tag; `None` if it is too long or has an audience.
    pub fn emit(&self, key: &Key) -> Option<FrameBytes> {
        let mut out = FrameBytes::new();
        self.write(key, &mut out).map(|()| out)
    }

    /// The frame to its audience, with a tag for each; `None` if it is too long or has no audience.
    pub fn emit_to_audience(&self, keys: &TeamKeys) -> Option<FrameBytes> {
        let mut out = FrameBytes::new();
        self.write_to_audience(keys, &mut out).map(|()| out)
    }

    /// Appends the frame of [`Self::emit`] to `out`.
    #[inline]
    pub(crate) fn write(&self, key: &Key, out: &mut FrameBytes) -> Option<()> {
        if self.audience.is_some() {
            return None;
        }
        self.write_covered(out)?;
        let tag = key.tag(out).to_le_bytes();
        out.extend_from_slice(&tag).ok()
    }

    /// Appends the frame of [`Self::emit_to_audience`] to `out`.
    pub(crate) fn write_to_audience(&self, keys: &TeamKeys, out: &mut FrameBytes) -> Option<()> {
        let audience = self.audience?;
        self.write_covered(out)?;
        let covered = out.len();
        for robot in audience.robots() {
            let [a, b, c, ..] = keys.of(robot).tag(out.get(..covered)?).to_le_bytes();
            out.extend_from_slice(&[a, b, c]).ok()?;
        }
        Some(())
    }

    /// Writes the bytes that tags cover.
    #[inline]
    fn write_covered(&self, out: &mut FrameBytes) -> Option<()> {
        let ([e0, e1, e2, e3], [c0, c1, c2, c3]) = (self.epoch.to_le_bytes(), self.counter.to_le_bytes());
        let sender = if self.audience.is_some() { HOST_TO_SEVERAL } else { self.sender.number() };
        out.extend_from_slice(&[VERSION, self.team.0, sender, e0, e1, e2, e3, c0, c1, c2, c3]).ok()?;
        if let Some(Audience(robots)) = self.audience {
            out.extend_from_slice(&robots.to_le_bytes()).ok()?;
        }
        out.extend_from_slice(self.payload).ok()
    }
}

const fn tags_len(audience: Option<Audience>) -> usize {
    match audience {
        None => TAG_LEN,
        Some(audience) => SHORT_TAG_LEN * audience.len(),
    }
}

/// The bits of a tag that a short one has.
const SHORT_TAG_BITS: u64 = (1 << (8 * SHORT_TAG_LEN)) - 1;

fn short_tag([a, b, c]: [u8; SHORT_TAG_LEN]) -> u64 {
    u64::from(u32::from_le_bytes([a, b, c, 0]))
}

/// State of every sender at a receiver: its epoch and the last counter accepted.
#[derive(Clone, Debug, Default)]
pub struct Sessions {
    last: [Option<(u32, u32)>; Sender::COUNT],
}

impl Sessions {
    /// Refuses a frame that is not newer than the last. Called before the tag is computed.
    pub fn check(&self, frame: &Frame<'_>) -> Result<(), Refusal> {
        match self.last[frame.sender.index()] {
            Some((current, _)) if frame.epoch < current => Err(Refusal::Epoch { seen: frame.epoch, current }),
            Some((current, last)) if frame.epoch == current && frame.counter <= last => {
                Err(Refusal::Counter { seen: frame.counter, last })
            }
            _ => Ok(()),
        }
    }

    /// The sender's current epoch, if it was received.
    pub fn epoch(&self, sender: Sender) -> Option<u32> {
        self.last[sender.index()].map(|(epoch, _)| epoch)
    }

    /// The sender's last counter, if it was received.
    pub fn counter(&self, sender: Sender) -> Option<u32> {
        self.last[sender.index()].map(|(_, counter)| counter)
    }

    /// Records a frame that was checked and found genuine.
    pub fn accept(&mut self, frame: &Frame<'_>) {
        self.last[frame.sender.index()] = Some((frame.epoch, frame.counter));
    }
}

/// The bytes of a frame; empty if it is too long for one.
pub(crate) fn packet(frame: &Frame<'_>, key: &Key) -> FrameBytes {
    let mut out = FrameBytes::new();
    if frame.write(key, &mut out).is_none() {
        out.clear();
    }
    out
}

/// The bytes as of [`packet`], with a tag for each of its audience.
pub(crate) fn packet_to_audience(frame: &Frame<'_>, keys: &TeamKeys) -> FrameBytes {
    let mut out = FrameBytes::new();
    if frame.write_to_audience(keys, &mut out).is_none() {
        out.clear();
    }
    out
}

/// Decodes a message that ends with the payload's last byte and whose ids exist.
pub(crate) fn decode<'a, T: serde::Deserialize<'a>>(payload: &'a [u8]) -> Option<T> {
    let (message, rest) = postcard::take_from_bytes::<T>(payload).ok()?;
    rest.is_empty().then_some(message)
}

/// Reads a genuine report of a robot to its host whose payload begins with `kind`. Order and repetition are
/// the reader's to judge ([`Sessions`]).
pub fn open_report<'a, T: serde::Deserialize<'a>>(
    packet: &'a [u8],
    (team, keys): (TeamId, &TeamKeys),
    kind: u8,
) -> Result<(Frame<'a>, RobotId, T), Refusal> {
    let frame = Frame::parse(packet, team)?;
    let Sender::Robot(robot) = frame.sender else { return Err(Refusal::Sender(frame.sender.number())) };
    if !frame.is_genuine(packet, keys.of(robot), robot) {
        return Err(Refusal::Tag);
    }
    let (_, report) =
        decode::<(u8, T)>(frame.payload).filter(|read| read.0 == kind).ok_or(Refusal::Payload)?;
    Ok((frame, robot, report))
}

#[cfg(test)]
mod tests;
