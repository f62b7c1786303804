//! `robot_log`: a robot's log in a file, from pieces that arrive late, repeatedly or not at all.
//!
//! The file has the `defmt` frames that came whole, in their order, each with its zero at the end: a frame
//! with a gap in it would be decoded to another text than was logged, so it is left out.

use std::collections::BTreeMap;
use std::collections::btree_map::OccupiedEntry;
use std::fs::File;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use protocol::robot_log::{KEPT_MAX, LogReport};

use crate::destination::{self, DestinationError, FileKind};

/// The file, and what waits to be written.
#[derive(Debug)]
pub(super) struct LogFile {
    pub(super) path: PathBuf,
    file: File,
    pieces: Pieces,
}

impl LogFile {
    /// An empty file; refused where one of another kind is, or one that this command reads.
    pub(super) fn create(path: &Path, key: &Path) -> Result<Self, DestinationError> {
        destination::check(&[(path, FileKind::Bytes)], &[key])?;
        let file = File::create(path).map_err(DestinationError::at(path))?;
        Ok(Self { path: path.to_owned(), file, pieces: Pieces::default() })
    }

    /// Takes a piece of that start of the robot.
    pub(super) fn take(&mut self, start: u32, piece: &LogReport) -> Result<(), DestinationError> {
        let frames = self.pieces.take(start, piece);
        self.file.write_all(&frames).map_err(DestinationError::at(&self.path))
    }

    /// Writes what waits for bytes that will not come any more; the counts of all.
    pub(super) fn finish(&mut self) -> Result<LogCounts, DestinationError> {
        let frames = self.pieces.give_up(self.pieces.end);
        self.file.write_all(&frames).map_err(DestinationError::at(&self.path))?;
        Ok(self.pieces.counts)
    }

    /// Whether nothing is missing of what the robot has logged so far; as long as no piece came, too.
    pub(super) fn is_whole(&self) -> bool {
        self.pieces.next == self.pieces.end
    }

    /// Whether any piece came.
    pub(super) fn has_begun(&self) -> bool {
        self.pieces.start.is_some()
    }
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct LogCounts {
    /// Bytes in the file.
    pub(super) written: usize,
    pub(super) gaps: u32,
    /// Bytes of the gaps.
    pub(super) missing: u64,
}

/// Pieces of a log, put together.
#[derive(Debug, Default)]
struct Pieces {
    /// The robot's start.
    start: Option<u32>,
    /// Number of the byte that is next.
    next: u32,
    /// Number of bytes that the robot has logged.
    end: u32,
    /// Later pieces by the numbers of their first bytes.
    waiting: BTreeMap<u32, Vec<u8>>,
    /// The frame under way.
    frame: Vec<u8>,
    /// A gap is before the next byte, in this frame.
    is_cut: bool,
    /// Number of the byte after the last gap, which may grow.
    gap_end: Option<u32>,
    counts: LogCounts,
}

impl Pieces {
    /// The frames that are whole now.
    fn take(&mut self, start: u32, piece: &LogReport) -> Vec<u8> {
        let mut frames = Vec::new();
        if self.start != Some(start) {
            frames = self.give_up(self.end);
            *self = Self { start: Some(start), counts: self.counts, ..Self::default() };
        }
        let end = piece.at.saturating_add(piece.bytes.len() as u32);
        if end > self.next {
            let known = self.waiting.entry(piece.at).or_default();
            if known.len() < piece.bytes.len() {
                *known = piece.bytes.to_vec();
            }
        }
        self.end = self.end.max(end.saturating_add(piece.rest.into()));
        // A robot does not keep what is before that any more.
        frames.extend(self.give_up(self.end.saturating_sub(KEPT_MAX)));
        frames
    }

    /// The frames that are whole now that bytes before that number will not come any more.
    fn give_up(&mut self, before: u32) -> Vec<u8> {
        let mut frames = Vec::new();
        loop {
            let first = self.waiting.first_key_value().map_or(u32::MAX, |(at, _)| *at);
            if let Some(missing) = first.min(before).checked_sub(self.next).filter(|missing| *missing > 0) {
                self.counts.gaps += u32::from(self.gap_end != Some(self.next));
                self.counts.missing += u64::from(missing);
                self.next += missing;
                (self.gap_end, self.is_cut) = (Some(self.next), true);
                self.frame.clear();
            }
            let next = self.waiting.first_entry().filter(|first| *first.key() <= self.next);
            let Some((at, bytes)) = next.map(OccupiedEntry::remove_entry) else { break };
            let new = bytes.get((self.next - at) as usize..).unwrap_or_default();
            self.next = self.next.saturating_add(new.len() as u32);
            for byte in new {
                if *byte != 0 {
                    self.frame.push(*byte);
                    continue;
                }
                if !self.is_cut && !self.frame.is_empty() {
                    frames.append(&mut self.frame);
                    frames.push(0);
                }
                self.frame.clear();
                self.is_cut = false;
            }
        }
        self.counts.written += frames.len();
        frames
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A log of frames of 1 to 20 bytes.
    fn logged(frames: usize) -> Vec<u8> {
        let frame = |n: usize| (0..=n * 7 % 20).map(|_| 1 + (n % 250) as u8).chain([0]).collect::<Vec<_>>();
        (0..frames).flat_map(frame).collect()
    }

    /// Of a robot that logs the next ones later.
    fn piece(log: &[u8], at: usize, len: usize) -> LogReport {
        let bytes = log.iter().skip(at).take(len).copied().collect();
        LogReport { host: 5, at: at as u32, rest: 0, bytes }
    }

    #[test]
    fn pieces_in_any_order_repeated_and_overlapping_are_the_log() {
        let log = logged(24);
        let (mut pieces, mut file) = (Pieces::default(), Vec::new());
        for at in [64, 0, 64, 20, 9, 40, 72, 104, 136, 168, 131, 230, 0, 200] {
            file.extend(pieces.take(1, &piece(&log, at, 32)));
        }
        assert_eq!(file, log);
        assert_eq!(pieces.counts, LogCounts { written: log.len(), gaps: 0, missing: 0 });
    }

    #[test]
    fn frames_with_a_gap_are_left_out_once_the_robot_has_overwritten_it_or_at_the_end() {
        let log = logged(300);
        let count = log.len() / 32;
        let missing = [10, 11, 50, count - 3];
        let (mut pieces, mut file) = (Pieces::default(), Vec::new());
        for n in (0..count).filter(|n| !missing.contains(n)) {
            let before = file.len();
            file.extend(pieces.take(1, &piece(&log, 32 * n, 32)));
            let is_waiting = (10..43).contains(&n) || (50..82).contains(&n) || n > count - 3;
            assert_eq!(file.len() > before, !is_waiting, "{n}");
        }
        file.extend(pieces.give_up(pieces.end));
        let mut end = 0;
        let is_whole = |frame: &&[u8]| {
            let first = end / 32;
            end += frame.len();
            end <= 32 * count && !(first..=(end - 1) / 32).any(|n| missing.contains(&n))
        };
        let whole: Vec<_> = log.split_inclusive(|byte| *byte == 0).filter(is_whole).collect();
        assert_eq!(file, whole.concat());
        assert_eq!(pieces.counts, LogCounts { written: file.len(), gaps: 3, missing: 128 });
    }

    #[test]
    fn a_new_start_begins_its_log_after_the_last_ones() {
        let log = logged(30);
        let mut pieces = Pieces::default();
        let mut file = pieces.take(1, &piece(&log, 0, 32));
        file.extend(pieces.take(2, &piece(&log, 0, 32)));
        let whole = &log[..=log[..32].iter().rposition(|byte| *byte == 0).unwrap()];
        assert_eq!(file, [whole, whole].concat());
        assert_eq!(pieces.counts.gaps, 0);
    }
}
