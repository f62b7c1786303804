//! `journal`: everything a robot's brain took in and gave out, with the times at which it did, as bytes in a
//! memory that a PC can read afterwards.
//!
//! `magic 4 "1-2J" | used 4 LE | records`; a record is `length u16 LE | postcard` of [`Record`]. The magic is
//! written by the program that wants a journal; a robot that does not find it writes none. `used` counts the
//! bytes of whole records. A memory that is full keeps what it has, and ends with [`Entry::Full`].

use serde::{Deserialize, Serialize};

use crate::Instant;
use crate::robot_io::{ActuatorFrame, SensorFrame};

/// Mark of a memory that is to hold a journal.
pub const MAGIC: [u8; 4] = *b"1-2J";
/// Bytes before the first record.
pub const HEADER_LEN: usize = 8;
/// The longest record: a sensor frame of everything, or a packet, with its head.
const RECORD_LEN_MAX: usize = 256;

/// One thing that happened.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record<'a> {
    /// Time by the robot's clock.
    pub at: Instant,
    /// Input or output at that time.
    #[serde(borrow)]
    pub entry: Entry<'a>,
}

/// Input or output of a brain.
#[allow(clippy::large_enum_variant, reason = "one value at a time, on the stack, and no heap to box it on")]
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Entry<'a> {
    /// The brain started, in this boot epoch.
    Start(u32),
    /// A packet came in.
    Packet(&'a [u8]),
    /// A sensor frame came in.
    Sensors(SensorFrame),
    /// A deadline of the brain was due.
    Timeout,
    /// A packet was sent.
    Sent(&'a [u8]),
    /// Orders went to the actuators.
    Ordered(ActuatorFrame),
    /// The memory was full here.
    Full,
}

/// Writes a journal into a memory.
#[derive(Debug)]
pub struct Writer<'m> {
    /// Empty where no journal is wanted.
    memory: &'m mut [u8],
    used: usize,
}

impl<'m> Writer<'m> {
    /// A journal from the memory's beginning; none where its magic is missing.
    pub fn new(memory: &'m mut [u8]) -> Self {
        let is_wanted = memory.len() > HEADER_LEN + FULL_LEN && memory.starts_with(&MAGIC);
        let mut writer = Self { memory: if is_wanted { memory } else { &mut [] }, used: 0 };
        writer.close();
        writer
    }

    /// Appends a record; a full memory takes no more.
    pub fn write(&mut self, at: Instant, entry: Entry<'_>) {
        if self.memory.is_empty() {
            return;
        }
        let mut bytes = [0; RECORD_LEN_MAX];
        let record = postcard::to_slice(&Record { at, entry }, &mut bytes);
        let is_kept = record.is_ok_and(|record| self.put(record, FULL_LEN));
        if !is_kept {
            let full = postcard::to_slice(&Record { at, entry: Entry::Full }, &mut bytes);
            let _room = full.map(|full| self.put(full, 0));
            self.memory = &mut [];
        }
    }

    /// Appends a record, if as many bytes as `spare` are left behind it.
    fn put(&mut self, record: &[u8], spare: usize) -> bool {
        let begin = HEADER_LEN + self.used;
        let len = (record.len() as u16).to_le_bytes();
        let end = begin + len.len() + record.len();
        if end + spare > self.memory.len() {
            return false;
        }
        let Some(place) = self.memory.get_mut(begin..end) else { return false };
        place.iter_mut().zip(len.iter().chain(record)).for_each(|(to, from)| *to = *from);
        self.used = end - HEADER_LEN;
        self.close();
        true
    }

    /// Writes how many bytes are used.
    fn close(&mut self) {
        let used = (self.used as u32).to_le_bytes();
        let place = self.memory.iter_mut().skip(MAGIC.len());
        place.zip(used).for_each(|(to, from)| *to = from);
    }
}

/// Bytes of the record [`Entry::Full`] with the largest time, its length included.
const FULL_LEN: usize = 16;

/// Reason why the rest of a journal cannot be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum JournalError {
    /// The memory does not begin with the magic, or the journal claims to be longer than its memory.
    #[error("not a robot's journal: its header is missing or wrong")]
    Header,
    /// The record at this byte is cut off or no record.
    #[error("the robot's journal is damaged at byte {0}")]
    Record(usize),
}

/// The records of a journal, in their order; ends after the first error.
pub fn records(memory: &[u8]) -> Result<Records<'_>, JournalError> {
    let rest = memory.strip_prefix(&MAGIC).ok_or(JournalError::Header)?;
    let (used, rest) = rest.split_first_chunk().ok_or(JournalError::Header)?;
    let used = u32::from_le_bytes(*used) as usize;
    rest.get(..used).map(|rest| Records { rest, at: HEADER_LEN }).ok_or(JournalError::Header)
}

/// An iterator over a journal's records.
#[derive(Clone, Debug)]
pub struct Records<'a> {
    rest: &'a [u8],
    at: usize,
}

impl<'a> Iterator for Records<'a> {
    type Item = Result<Record<'a>, JournalError>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.rest.is_empty() {
            return None;
        }
        let taken = self.rest.split_first_chunk().and_then(|(len, rest)| {
            let (record, rest) = rest.split_at_checked(usize::from(u16::from_le_bytes(*len)))?;
            let (read, left) = postcard::take_from_bytes(record).ok()?;
            left.is_empty().then_some((read, record.len(), rest))
        });
        let Some((record, len, rest)) = taken else {
            self.rest = &[];
            return Some(Err(JournalError::Record(self.at)));
        };
        (self.rest, self.at) = (rest, self.at + 2 + len);
        Some(Ok(record))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::vec;
    use std::vec::Vec;

    fn memory(len: usize) -> Vec<u8> {
        let mut memory = vec![0; len];
        memory[..4].copy_from_slice(&MAGIC);
        memory
    }

    #[test]
    fn records_are_read_in_the_order_of_writing() {
        let mut memory = memory(1_000);
        let entries = [Entry::Start(7), Entry::Packet(&[1, 2, 3]), Entry::Timeout, Entry::Sent(&[9; 120])];
        let mut writer = Writer::new(&mut memory);
        for (n, entry) in entries.iter().enumerate() {
            writer.write(Instant(n as u64 * 1_000), entry.clone());
        }
        let read: Vec<_> = records(&memory).unwrap().map(Result::unwrap).collect();
        assert_eq!(read.iter().map(|record| record.entry.clone()).collect::<Vec<_>>(), entries);
        assert_eq!(read[3].at, Instant(3_000));
    }

    #[test]
    fn a_memory_without_the_magic_stays_as_it_is() {
        let mut memory = vec![5; 100];
        Writer::new(&mut memory).write(Instant(1), Entry::Timeout);
        assert_eq!(memory, [5; 100]);
        assert_eq!(records(&memory).unwrap_err(), JournalError::Header);
    }

    #[test]
    fn a_full_memory_says_so_and_keeps_what_came_before() {
        for len in 40..200 {
            let mut memory = memory(len);
            let mut writer = Writer::new(&mut memory);
            for n in 0..10 {
                writer.write(Instant(n), Entry::Packet(&[7; 30]));
            }
            let read: Vec<_> = records(&memory).unwrap().map(Result::unwrap).collect();
            let (last, before) = read.split_last().unwrap();
            assert_eq!(last.entry, Entry::Full, "{len} bytes");
            assert!(before.iter().all(|record| record.entry == Entry::Packet(&[7; 30])));
            assert_eq!(before.len(), (len - HEADER_LEN - FULL_LEN) / 35);
        }
    }

    #[test]
    fn a_journal_that_is_cut_off_or_damaged_ends_with_its_place() {
        let mut memory = memory(200);
        let mut writer = Writer::new(&mut memory);
        writer.write(Instant(1), Entry::Timeout);
        writer.write(Instant(2), Entry::Packet(&[1; 9]));
        memory[12] ^= 0xff;
        let read: Vec<_> = records(&memory).unwrap().collect();
        assert!(matches!(read.last(), Some(Err(JournalError::Record(_)))), "{read:?}");
        assert_eq!(records(&memory[..20]).unwrap_err(), JournalError::Header);
    }
}
