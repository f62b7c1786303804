//! `inbox`: what arrived from network, robots and the team's own strategy and waits for the event loop. A
//! bounded lane for each kind; referee, robots and strategy are read before vision. Sizes in bytes, lengths
//! in datagrams.
//!
//! A flood of one kind cannot delay another: the referee's newest packet waits for at most one camera frame
//! that is being handled. When a lane is full its oldest entry is dropped and counted. Memory is bounded by
//! [`LANE_BYTES_MAX`] of vision and as much of the referee; a datagram has as many bytes as UDP carries.

use std::collections::VecDeque;
use std::net::SocketAddr;
use std::sync::{Condvar, Mutex, PoisonError};
use std::time::{Duration, Instant};

use crate::referee::SenderAddress;
use crate::referee::remote::RemoteState;
use protocol::link::Packet;

/// Bytes of waiting datagrams of one kind: 16 of the longest.
const LANE_BYTES_MAX: usize = 1 << 20;
/// Camera frames that wait: 0.1 s of eight cameras at 80 Hz. Newer frames supersede older ones.
const VISION_MAX: usize = 64;
/// Packets of the referee that wait: more than a second of it.
const REFEREE_MAX: usize = 64;
/// Frames of robots that wait: 11 robots at 100 Hz for 0.2 s.
const ROBOTS_MAX: usize = 256;
/// Answers of the team's own strategy that wait: a newer one supersedes the others.
const ORDERS_MAX: usize = 1;
/// Notes for the operator that wait.
const NOTES_MAX: usize = 256;
/// Most referee packets and robot frames that are handled in a row while camera frames wait: a flood of one
/// kind must not block vision.
const URGENT_IN_ROW: u32 = 32;

/// Where mail comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Source {
    Vision,
    Referee,
    Robots,
    /// Another program's tracker.
    Tracker,
}

impl Source {
    /// Name for the operator.
    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::Vision => "vision",
            Self::Referee => "referee",
            Self::Robots => "robots",
            Self::Tracker => "tracker",
        }
    }
}

/// What the game controller answers.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum RemoteAnswer {
    /// The team's state; `None`: there is no connection.
    State(Option<RemoteState>),
    /// Why a request was not granted.
    Refused(String),
}

/// An entry for the event loop.
#[derive(Debug)]
pub(super) enum Mail {
    /// A datagram of the vision, and its sender.
    Vision(Vec<u8>, SocketAddr),
    /// A datagram of another program's tracker.
    Tracker(Vec<u8>),
    /// A datagram of the referee, and its sender.
    Referee(Vec<u8>, SenderAddress),
    /// A frame of a robot.
    Robot(Packet),
    /// An answer of the team's own strategy.
    Orders(String),
    /// A source is received now.
    Opened {
        /// The source.
        source: Source,
        /// Interfaces or port that it is received on.
        route: String,
    },
    /// Why a source cannot be received.
    Trouble(Source, String),
    /// A line for the operator.
    Note(String),
    /// An answer of the game controller to our remote control.
    Remote(RemoteAnswer),
    /// The robots' line is too slow, with the rate it would need.
    Slow(String),
}

/// Datagrams that were not used.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Dropped {
    /// Camera frames that newer ones replaced.
    pub(super) vision: u64,
    /// The same of the referee.
    pub(super) referee: u64,
    /// The same of robots.
    pub(super) robots: u64,
}

/// A queue that drops its oldest entry when full.
#[derive(Debug)]
struct Lane<T> {
    waiting: VecDeque<T>,
    most: usize,
    /// Bytes that wait.
    held: usize,
    dropped: u64,
}

/// Bytes of an entry.
trait Weighs {
    fn bytes(&self) -> usize {
        0
    }
}

impl<S> Weighs for (Vec<u8>, S) {
    fn bytes(&self) -> usize {
        self.0.len()
    }
}

impl Weighs for Packet {}
impl Weighs for String {}
impl Weighs for Mail {}

impl<T: Weighs> Lane<T> {
    fn new(most: usize) -> Self {
        Self { waiting: VecDeque::with_capacity(most), most, held: 0, dropped: 0 }
    }

    fn push(&mut self, entry: T) {
        self.held += entry.bytes();
        while self.waiting.len() == self.most || self.held > LANE_BYTES_MAX {
            if self.take().is_none() {
                break;
            }
            self.dropped += 1;
        }
        self.waiting.push_back(entry);
    }

    fn take(&mut self) -> Option<T> {
        let entry = self.waiting.pop_front()?;
        self.held -= entry.bytes();
        Some(entry)
    }
}

/// The lanes, without threads.
#[derive(Debug)]
struct Lanes {
    referee: Lane<(Vec<u8>, SenderAddress)>,
    robots: Lane<Packet>,
    orders: Lane<String>,
    tracker: Lane<(Vec<u8>, ())>,
    vision: Lane<(Vec<u8>, SocketAddr)>,
    notes: Lane<Mail>,
    in_row: u32,
}

impl Lanes {
    fn new() -> Self {
        Self {
            referee: Lane::new(REFEREE_MAX),
            robots: Lane::new(ROBOTS_MAX),
            orders: Lane::new(ORDERS_MAX),
            tracker: Lane::new(VISION_MAX),
            vision: Lane::new(VISION_MAX),
            notes: Lane::new(NOTES_MAX),
            in_row: 0,
        }
    }

    fn put(&mut self, mail: Mail) {
        match mail {
            Mail::Vision(bytes, from) => self.vision.push((bytes, from)),
            Mail::Tracker(bytes) => self.tracker.push((bytes, ())),
            Mail::Referee(bytes, from) => self.referee.push((bytes, from)),
            Mail::Robot(packet) => self.robots.push(packet),
            Mail::Orders(line) => self.orders.push(line),
            note => self.notes.push(note),
        }
    }

    fn take(&mut self) -> Option<Mail> {
        if self.in_row < URGENT_IN_ROW || self.vision.waiting.is_empty() {
            self.in_row = self.in_row.saturating_add(1);
            if let Some((bytes, from)) = self.referee.take() {
                return Some(Mail::Referee(bytes, from));
            }
            if let Some(packet) = self.robots.take() {
                return Some(Mail::Robot(packet));
            }
            if let Some(line) = self.orders.take() {
                return Some(Mail::Orders(line));
            }
            if let Some((bytes, ())) = self.tracker.take() {
                return Some(Mail::Tracker(bytes));
            }
        }
        self.in_row = 0;
        let vision = self.vision.take().map(|(bytes, from)| Mail::Vision(bytes, from));
        vision.or_else(|| self.notes.take())
    }

    fn dropped(&self) -> Dropped {
        Dropped { vision: self.vision.dropped, referee: self.referee.dropped, robots: self.robots.dropped }
    }
}

/// The lanes between threads.
#[derive(Debug)]
pub(super) struct Inbox {
    lanes: Mutex<Lanes>,
    came: Condvar,
}

impl Inbox {
    pub(super) fn new() -> Self {
        Self { lanes: Mutex::new(Lanes::new()), came: Condvar::new() }
    }

    /// Adds an entry; never waits for the event loop.
    pub(super) fn put(&self, mail: Mail) {
        self.lanes.lock().unwrap_or_else(PoisonError::into_inner).put(mail);
        self.came.notify_one();
    }

    /// The most urgent entry, within `wait`.
    pub(super) fn take(&self, wait: Duration) -> Option<Mail> {
        let until = Instant::now() + wait;
        let mut lanes = self.lanes.lock().unwrap_or_else(PoisonError::into_inner);
        loop {
            if let Some(mail) = lanes.take() {
                return Some(mail);
            }
            let left = until.saturating_duration_since(Instant::now());
            if left.is_zero() {
                return None;
            }
            lanes = self.came.wait_timeout(lanes, left).unwrap_or_else(PoisonError::into_inner).0;
        }
    }

    /// What was dropped since the start.
    pub(super) fn dropped(&self) -> Dropped {
        self.lanes.lock().unwrap_or_else(PoisonError::into_inner).dropped()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn from() -> SenderAddress {
        SenderAddress::INTERNAL
    }

    /// The longest packets of vision and referee that are usual, bytes.
    const VISION_LEN: usize = 10_240;

    fn vision(bytes: Vec<u8>) -> Mail {
        Mail::Vision(bytes, ([127, 0, 0, 1], 10_020).into())
    }

    fn held(lanes: &Lanes) -> usize {
        lanes.vision.waiting.iter().map(|(bytes, _)| bytes.len()).sum::<usize>()
            + lanes.referee.waiting.iter().map(|(bytes, _)| bytes.len()).sum::<usize>()
    }

    #[test]
    fn finding_3_a_referee_s_packet_waits_for_one_camera_frame_however_many_came_before() {
        let mut lanes = Lanes::new();
        // A slow consumer: a thousand frames of vision come while it takes one.
        let mut frames = 0_u32;
        for round in 0..50_u32 {
            for _ in 0..1_000 {
                frames += 1;
                let mut bytes = vec![0; VISION_LEN];
                bytes[..4].copy_from_slice(&frames.to_le_bytes());
                lanes.put(vision(bytes));
                assert!(held(&lanes) <= VISION_MAX * VISION_LEN);
            }
            lanes.put(Mail::Referee(vec![round as u8], from()));
            assert!(
                matches!(lanes.take(), Some(Mail::Referee(bytes, _)) if bytes == [round as u8]),
                "{round}"
            );
            // The newest vision frames are left, in order.
            let Some(Mail::Vision(bytes, _)) = lanes.take() else { panic!("vision waits") };
            let number = u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]);
            assert_eq!(number, frames - VISION_MAX as u32 + 1);
        }
        let dropped = lanes.dropped();
        assert_eq!(u64::from(frames), dropped.vision + 50 + lanes.vision.waiting.len() as u64);
        assert_eq!(dropped.referee, 0);
    }

    #[test]
    fn datagrams_of_any_length_are_taken_and_a_flood_of_them_takes_two_megabytes() {
        let mut lanes = Lanes::new();
        for length in [9_000, 20_000, 65_507] {
            lanes.put(vision(vec![0; length]));
            lanes.put(Mail::Referee(vec![0; length], from()));
            assert!(matches!(lanes.take(), Some(Mail::Referee(bytes, _)) if bytes.len() == length));
            assert!(matches!(lanes.take(), Some(Mail::Vision(bytes, _)) if bytes.len() == length));
        }
        for _ in 0..1_000 {
            lanes.put(vision(vec![0; 65_507]));
            lanes.put(Mail::Referee(vec![0; 65_507], from()));
            assert!(held(&lanes) <= 2 * LANE_BYTES_MAX);
        }
        assert_eq!((lanes.dropped().vision, lanes.dropped().referee), (984, 984));
    }

    #[test]
    fn a_flood_of_the_referee_s_port_keeps_its_newest_and_does_not_blind_the_robots() {
        let mut lanes = Lanes::new();
        for number in 0..10_000_u32 {
            lanes.put(Mail::Referee(number.to_le_bytes().to_vec(), from()));
        }
        lanes.put(vision(vec![7]));
        let taken: Vec<_> = std::iter::from_fn(|| lanes.take()).collect();
        assert_eq!(taken.len(), REFEREE_MAX + 1);
        let frame = taken.iter().position(|mail| matches!(mail, Mail::Vision(..)));
        assert_eq!(frame, Some(URGENT_IN_ROW as usize));
        let Some(Mail::Referee(last, _)) = taken.last() else { panic!("the referee's") };
        assert_eq!(last[..], 9_999_u32.to_le_bytes());
        assert_eq!(lanes.dropped().referee, 10_000 - REFEREE_MAX as u64);
    }
}
