//! `outbox`: frames that wait for the robots' link. Only the newest snapshot waits, HALT has priority, and
//! memory is bounded. Sans-IO; sizes in bytes of frames.
//!
//! A *snapshot* is what the host sends at once: parts of the world and a command for every robot. One whose
//! sending has started is finished, so that a line that is too slow for all snapshots serves every robot with
//! fewer of them; of those behind it only the newest waits. *Side frames* (forwarded beacons of teammates,
//! welcomes) wait beside it, the newest of each sender and receiver; [`SIDE_PER_SNAPSHOT`] of them go between
//! two snapshots.
//!
//! The first snapshot with HALT drops everything that waits, including the unsent part of the snapshot that
//! was going out.

use std::collections::VecDeque;

use protocol::frame::{Sender, claimed_sender};
use protocol::link::Packet;

use crate::radio::To;

/// Side frames between two snapshots: beacons come at 20 Hz and snapshots at up to 100 Hz, so that on a fast
/// line none waits, and on a slow one a team's beacons do not displace its snapshots.
const SIDE_PER_SNAPSHOT: usize = 2;
/// Side frames that wait at most: the newest of 16 robots for each of 16, and a welcome for each.
const SIDE_MAX: usize = 272;

/// Frames queued for a link.
#[derive(Debug, Default)]
pub struct Outbox {
    /// The unsent part of the snapshot that is going out.
    going: VecDeque<(To, Packet)>,
    /// The newest snapshot behind it.
    next: Option<Vec<(To, Packet)>>,
    side: VecDeque<(To, Packet)>,
    /// Side frames since the last snapshot went out.
    sides: usize,
    halting: bool,
    /// Whether the frames that the link still has are older than a HALT.
    discard: bool,
    counts: OutCounts,
}

/// Counts of frames put into an outbox, and of those dropped.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct OutCounts {
    /// Number of snapshots added.
    pub snapshots: u64,
    /// Snapshots replaced by newer ones before their sending started.
    pub superseded: u64,
    /// Side frames replaced by newer ones, or dropped because too many waited.
    pub side_dropped: u64,
    /// Number of frames added.
    pub frames: u64,
    /// Bytes of the frames added.
    pub bytes: u64,
}

impl Outbox {
    /// Adds everything that the host sends at once. `halting`: it contains HALT.
    pub fn push(&mut self, batch: Vec<(To, Packet)>, halting: bool) {
        if batch.is_empty() {
            return;
        }
        let from_host = |packet: &Packet| claimed_sender(packet) == Some(Sender::Host);
        self.counts.frames += batch.len() as u64;
        self.counts.bytes += batch.iter().map(|(_, packet)| packet.len() as u64).sum::<u64>();
        // The host sends to all only parts of the world.
        let snapshot = batch.iter().any(|(to, packet)| *to == To::All && from_host(packet));
        if !snapshot {
            for frame in batch {
                self.put_aside(frame);
            }
            return;
        }
        if halting && !self.halting {
            self.counts.superseded += u64::from(self.next.is_some());
            self.counts.side_dropped += self.side.len() as u64;
            self.going.clear();
            self.next = None;
            self.side.clear();
            self.sides = SIDE_PER_SNAPSHOT;
            self.discard = true;
        }
        self.halting = halting;
        let (frames, side): (Vec<_>, Vec<_>) = batch.into_iter().partition(|(_, packet)| from_host(packet));
        for frame in side {
            self.put_aside(frame);
        }
        self.counts.snapshots += 1;
        self.counts.superseded += u64::from(self.next.replace(frames).is_some());
    }

    fn put_aside(&mut self, (to, packet): (To, Packet)) {
        let sender = claimed_sender(&packet);
        if let Some(old) =
            self.side.iter_mut().find(|(known, old)| *known == to && claimed_sender(old) == sender)
        {
            // It keeps its place in the queue.
            old.1 = packet;
            self.counts.side_dropped += 1;
            return;
        }
        if self.side.len() == SIDE_MAX {
            self.side.pop_front();
            self.counts.side_dropped += 1;
        }
        self.side.push_back((to, packet));
    }

    /// The next frame to send.
    pub fn take(&mut self) -> Option<(To, Packet)> {
        if let Some(frame) = self.going.pop_front() {
            return Some(frame);
        }
        if (self.next.is_none() || self.sides < SIDE_PER_SNAPSHOT)
            && let Some(frame) = self.side.pop_front()
        {
            self.sides += 1;
            return Some(frame);
        }
        self.going.extend(self.next.take()?);
        self.sides = 0;
        self.going.pop_front()
    }

    /// True once after the first snapshot with HALT came: frames that the link has taken and not sent are to
    /// be discarded.
    pub fn take_discard(&mut self) -> bool {
        std::mem::take(&mut self.discard)
    }

    /// Number of frames that wait.
    pub fn waiting(&self) -> usize {
        self.going.len() + self.next.as_ref().map_or(0, Vec::len) + self.side.len()
    }

    /// The counts so far.
    pub fn counts(&self) -> OutCounts {
        self.counts
    }
}

#[cfg(test)]
mod tests {
    use protocol::RobotId;

    use super::*;

    /// A frame with that sender's number; `mark` distinguishes it from others.
    fn frame(to: To, sender: u8, mark: u8) -> (To, Packet) {
        let mut bytes = [0; 40];
        (bytes[2], bytes[39]) = (sender, mark);
        (to, Packet::from_slice(&bytes).unwrap())
    }

    fn robot(number: u8) -> RobotId {
        RobotId::new(number).unwrap()
    }

    const HOST: u8 = 16;
    /// The host's number in frames to several robots.
    const HOST_TO_SEVERAL: u8 = 17;

    /// Two parts of the world and a command for each of six robots.
    fn snapshot(mark: u8) -> Vec<(To, Packet)> {
        let parts = [frame(To::All, HOST_TO_SEVERAL, mark), frame(To::All, HOST_TO_SEVERAL, mark)];
        let commands = (0..6).map(|number| frame(To::One(robot(number)), HOST, mark));
        parts.into_iter().chain(commands).collect()
    }

    fn mark(frame: &(To, Packet)) -> u8 {
        frame.1[39]
    }

    #[test]
    fn a_slow_consumer_gets_whole_snapshots_the_newest_each_time_and_halt_first() {
        let mut outbox = Outbox::default();
        let mut taken = Vec::new();
        // Ten frames in, one out, for a hundred snapshots and beacons of six robots.
        for number in 0..100_u8 {
            outbox.push(snapshot(number), false);
            outbox.push((0..6).map(|sender| frame(To::All, sender, number)).collect(), false);
            taken.extend(outbox.take());
            assert!(outbox.waiting() <= 8 + 8 + 6, "{}", outbox.waiting());
        }
        assert_eq!(taken.len(), 100);
        // Every snapshot whose sending started was finished, in order, and each was the newest at its start.
        let snapshots: Vec<_> = taken.iter().filter(|(_, packet)| packet[2] >= HOST).collect();
        for frames in snapshots.chunks_exact(8) {
            assert!(frames.iter().all(|frame| mark(frame) == mark(frames[0])));
            let receivers: Vec<_> = frames.iter().map(|(to, _)| *to).collect();
            assert_eq!(receivers[2..], (0..6).map(|n| To::One(robot(n))).collect::<Vec<_>>());
        }
        let (begun, counts) = (snapshots.len().div_ceil(8) as u64, outbox.counts());
        assert!(begun > 8 && counts.superseded >= 100 - begun - 1, "{begun} {counts:?}");
        assert!(taken.len() - snapshots.len() >= 16, "beacons are passed on too");

        outbox.push(snapshot(200), true);
        assert!(outbox.take_discard() && !outbox.take_discard(), "what the link holds is stale, once");
        assert_eq!(outbox.waiting(), 8, "nothing stands before HALT");
        let halts: Vec<_> = std::iter::from_fn(|| outbox.take()).collect();
        assert!(halts.len() == 8 && halts.iter().all(|frame| mark(frame) == 200));
    }

    #[test]
    fn halt_that_goes_on_is_sent_to_every_robot_too() {
        // A HALT after each frame sent: no robot starves behind the first ones.
        let mut outbox = Outbox::default();
        let mut served = [0; 6];
        for number in 0..200 {
            outbox.push(snapshot(number), true);
            if let Some((To::One(to), _)) = outbox.take() {
                served[to.index()] += 1;
            }
        }
        assert!(served.iter().all(|times| *times >= 20), "{served:?}");
    }

    #[test]
    fn of_side_frames_the_newest_of_each_sender_waits_and_their_number_is_bounded() {
        let mut outbox = Outbox::default();
        for number in 0..250 {
            for sender in 0..16 {
                for to in 0..16 {
                    outbox.push(vec![frame(To::One(robot(to)), sender, number)], false);
                }
            }
        }
        assert_eq!(outbox.waiting(), 256);
        let all: Vec<_> = std::iter::from_fn(|| outbox.take()).collect();
        assert!(all.len() == 256 && all.iter().all(|frame| mark(frame) == 249));
        assert_eq!(outbox.counts().side_dropped, 249 * 256);
    }
}
