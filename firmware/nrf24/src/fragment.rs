//! `fragment`: cuts a radio frame into payloads of at most 32 bytes, and joins them. Pure; times in µs.
//!
//! ```text
//! number 5 bits, index 2 bits, last 1 bit | up to 31 bytes of the frame without its version and team
//! ```
//!
//! Version and team stand in the address of every packet ([`crate::Channel`]), so they are left out and put
//! back. A frame is joined from fragments of one number in their order without a gap, or not at all; the
//! frame's own tag is the last check. A number whose frame is complete, or broke off, is not begun again
//! within the assembler's patience.

use protocol::frame::{FRAME_LEN_MAX, VERSION};
use protocol::link::Packet;
use protocol::{Duration, Instant, TeamId};

/// The chip's longest payload, bytes (PS 7.3.4).
pub const PAYLOAD_MAX: usize = 32;
/// Bytes of a fragment before its part of the frame.
pub const HEADER: usize = 1;
/// Bytes of a frame in one fragment.
pub const DATA_MAX: usize = PAYLOAD_MAX - HEADER;
/// Bytes of a frame that are left out: version and team.
pub const ELIDED: usize = 2;
/// Fragments of the longest frame.
pub const FRAGMENTS_MAX: usize = 4;
/// Numbers of frames before they come again.
const NUMBERS: u8 = 32;

const _: () = assert!((FRAME_LEN_MAX - ELIDED).div_ceil(DATA_MAX) <= FRAGMENTS_MAX);

/// A payload for the chip.
pub type Payload = heapless::Vec<u8, PAYLOAD_MAX>;
/// The payloads of one frame.
pub type Fragments = heapless::Vec<Payload, FRAGMENTS_MAX>;

/// A payload without any part of a frame: it asks a robot for its answer. Successive ones differ by `count`:
/// the chip takes a packet that equals the last one for its repeat, and gives the same answer again (PS
/// 7.3.3.2).
pub fn question(count: u32) -> Payload {
    let mut payload = Payload::new();
    let _room = payload.push(((count % u32::from(NUMBERS)) as u8) << 3 | LAST_FRAGMENT_BIT);
    payload
}

/// Reason why a frame is not sent.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NotSent {
    /// The frame has this many bytes: shorter than a frame's header or longer than a frame.
    #[error("{0} bytes are no frame: it has 3 to {FRAME_LEN_MAX}")]
    Length(usize),
    /// The frame is of another version or team than those of the channel.
    #[error("a frame of another version or team; set the team of the base station")]
    Foreign,
}

/// Cuts frames; numbers them.
#[derive(Clone, Debug)]
pub struct Cutter {
    team: TeamId,
    number: u8,
}

impl Cutter {
    /// For frames of this team.
    pub const fn new(team: TeamId) -> Self {
        Self { team, number: 0 }
    }

    /// The payloads of `frame`, in the order in which they are to be sent.
    pub fn cut(&mut self, frame: &[u8]) -> Result<Fragments, NotSent> {
        let [version, team, data @ ..] = frame else { return Err(NotSent::Length(frame.len())) };
        if frame.len() > FRAME_LEN_MAX || data.is_empty() {
            return Err(NotSent::Length(frame.len()));
        }
        if *version != VERSION || *team != self.team.0 {
            return Err(NotSent::Foreign);
        }
        self.number = (self.number + 1) % NUMBERS;
        let mut fragments = Fragments::new();
        let count = data.len().div_ceil(DATA_MAX);
        for (index, part) in data.chunks(DATA_MAX).enumerate() {
            let last = if index + 1 == count { LAST_FRAGMENT_BIT } else { 0 };
            let mut payload = Payload::new();
            // Both fit: the assertion above counts them.
            let _room = payload.push(self.number << 3 | (index as u8) << 1 | last);
            let _room = payload.extend_from_slice(part);
            let _room = fragments.push(payload);
        }
        Ok(fragments)
    }
}

/// Counts of fragments that an assembler took and dropped.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Joined {
    /// Frames that are complete.
    pub frames: u32,
    /// Frames begun and given up: a fragment is missing, or came too late.
    pub broken: u32,
    /// Fragments without their frame's beginning, of a frame that was complete already, or of a wrong length.
    pub stray: u32,
}

/// Joins the fragments of one sender, one frame at a time.
#[derive(Clone, Debug)]
pub struct Assembler {
    team: TeamId,
    /// Longest time from a frame's first fragment to its last.
    patience: Duration,
    frame: Packet,
    /// Number, index awaited, and when it began.
    partial: Option<(u8, u8, Instant)>,
    /// Time of the last first fragment of each number.
    begun: [Option<Instant>; NUMBERS as usize],
    joined: Joined,
}

impl Assembler {
    /// For frames of this team. `patience` must be shorter than the time in which the sender's numbers come
    /// round: 32 of its frames.
    pub const fn new(team: TeamId, patience: Duration) -> Self {
        Self {
            team,
            patience,
            frame: Packet::new(),
            partial: None,
            begun: [None; NUMBERS as usize],
            joined: Joined { frames: 0, broken: 0, stray: 0 },
        }
    }

    /// Takes a payload; returns the frame that it completes.
    pub fn push(&mut self, now: Instant, payload: &[u8]) -> Option<Packet> {
        let (head, data) = payload.split_first()?;
        if data.is_empty() {
            // A question.
            return None;
        }
        let (number, index, is_last) = (head >> 3, head >> 1 & 3, head & LAST_FRAGMENT_BIT != 0);
        if self.partial.is_some_and(|(_, _, since)| now.since(since) > self.patience) {
            self.give_up();
        }
        if data.len() > DATA_MAX || (!is_last && data.len() != DATA_MAX) {
            self.joined.stray = self.joined.stray.saturating_add(1);
            return None;
        }
        let awaited = match self.partial {
            // The chip was asked again for what it had given.
            Some((own, next, _)) if own == number && index < next => return None,
            Some((own, next, _)) if own == number && index == next => true,
            _ => false,
        };
        if !awaited {
            let slot = self.begun.get_mut(usize::from(number))?;
            let is_again = slot.is_some_and(|at| now.since(at) <= self.patience);
            if index != 0 || is_again {
                self.joined.stray = self.joined.stray.saturating_add(1);
                return None;
            }
            *slot = Some(now);
            self.give_up();
            let _room = self.frame.extend_from_slice(&[VERSION, self.team.0]);
        }
        if self.frame.extend_from_slice(data).is_err() {
            self.partial = Some((number, index, now));
            self.give_up();
            return None;
        }
        if is_last {
            self.partial = None;
            self.joined.frames = self.joined.frames.wrapping_add(1);
            return Some(core::mem::take(&mut self.frame));
        }
        let since = self.partial.filter(|_| awaited).map_or(now, |(_, _, since)| since);
        self.partial = Some((number, index + 1, since));
        None
    }

    /// Counts since the start.
    pub fn joined(&self) -> Joined {
        self.joined
    }

    fn give_up(&mut self) {
        if self.partial.take().is_some() {
            self.joined.broken = self.joined.broken.saturating_add(1);
        }
        self.frame.clear();
    }
}

/// The bit of a frame's last fragment.
const LAST_FRAGMENT_BIT: u8 = 1;

#[cfg(test)]
mod tests;
