//! `reader`: reader of log files.
//!
//! Streams from any `Read`; holds one message at a time. For any input: every whole message before the first
//! damage is returned, nothing larger than [`PAYLOAD_MAX`] is allocated, and the end is reported.

use std::fmt;
use std::io::{self, Cursor, Read};

use super::{FILE_HEADER, LogError, MAGIC, MESSAGE_HEADER, MessageKind, PAYLOAD_MAX, Record, VERSION};

/// Reads messages from first to last; an iterator. Blank messages and the index are counted and skipped.
#[derive(Debug)]
pub struct LogReader<R> {
    source: Held<R>,
    /// Start of the next message, bytes from the (unzipped) file's start.
    at: u64,
    ahead: Option<Record>,
    last_ns: Option<i64>,
    counts: LogCounts,
    /// Damage after which another file begins.
    broken: Option<LogEnd>,
    end: Option<LogEnd>,
}

/// A source, and bytes of it that are read once more.
#[derive(Debug)]
struct Held<R> {
    held: Cursor<Vec<u8>>,
    source: R,
}

impl<R: Read> Read for Held<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        match self.held.read(buffer)? {
            0 => self.source.read(buffer),
            bytes => Ok(bytes),
        }
    }
}

/// Counters of the messages read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LogCounts {
    /// Number of messages returned.
    pub messages: u64,
    /// Number of blank messages skipped.
    pub blank: u64,
    /// Number of indices skipped: 0 or 1 in a valid file.
    pub index: u64,
    /// Number of files that were joined to the first one.
    pub joined: u64,
    /// Number of messages earlier than the one before them in their file.
    pub back_steps: u64,
    /// The largest such step, ns.
    pub largest_back_step_ns: u64,
}

/// End of a file. Positions and sizes are bytes of the unzipped file.
#[derive(Debug)]
pub enum LogEnd {
    /// The file ends after a whole message.
    Whole,
    /// The file ends within a message.
    Cut {
        /// Start of that message.
        at: u64,
        /// Number of its bytes that are there.
        bytes: u64,
    },
    /// At a message of an impossible size; the start of the next one is unknown.
    Size {
        /// Start of that message.
        at: u64,
        /// The size it declares.
        size: i32,
    },
    /// Within a message another file begins, which was joined to this one; it was read, too.
    Joined {
        /// Start of that message.
        at: u64,
        /// Start of the other file.
        next: u64,
    },
    /// The file cannot be read or gunzipped any further.
    Read {
        /// Start of the message that was being read.
        at: u64,
        /// Cause of the failure.
        error: io::Error,
    },
}

impl LogEnd {
    /// Returns whether the file ended as it should.
    pub const fn is_whole(&self) -> bool {
        matches!(self, Self::Whole)
    }
}

impl fmt::Display for LogEnd {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Whole => write!(f, "whole"),
            Self::Cut { at, bytes } => {
                write!(
                    f,
                    "cut: of the message at byte {at} only {bytes} bytes are there; all before it was read"
                )
            }
            Self::Size { at, size } => write!(
                f,
                "damaged: the message at byte {at} claims {size} bytes, at most {PAYLOAD_MAX} are possible; all before it \
                 was read"
            ),
            Self::Joined { at, next } => write!(
                f,
                "cut: the message at byte {at} breaks off at byte {next}, where another log file begins; all the rest was \
                 read"
            ),
            Self::Read { at, error } => {
                write!(f, "not readable from the message at byte {at} on: {error}; all before it was read")
            }
        }
    }
}

impl<R: Read> LogReader<R> {
    /// Reads the file's header.
    pub fn new(mut source: R) -> Result<Self, LogError> {
        let mut header = [0; FILE_HEADER];
        let bytes = fill(&mut source, &mut header).map_err(|(_, error)| LogError::Read(error))?;
        let begins = header[..bytes].to_vec();
        if begins.starts_with(&LEGACY_QT[..bytes.min(LEGACY_QT.len())]) && bytes >= LEGACY_QT.len() {
            return Err(LogError::LegacyQt);
        }
        if !begins.starts_with(&MAGIC[..bytes.min(MAGIC.len())]) {
            return Err(LogError::NotALog { begins });
        }
        if bytes < FILE_HEADER {
            return Err(LogError::Short { bytes });
        }
        match i32::from_be_bytes([header[12], header[13], header[14], header[15]]) {
            VERSION => Ok(Self::from_message(source, FILE_HEADER as u64)),
            0 => Err(LogError::LegacyQt),
            version => Err(LogError::Version(version)),
        }
    }

    /// Continues reading from a message's first byte, which is byte `at` of the file.
    pub(super) fn from_message(source: R, at: u64) -> Self {
        let source = Held { held: Cursor::default(), source };
        Self { source, at, ahead: None, last_ns: None, counts: LogCounts::default(), broken: None, end: None }
    }

    /// End of the file; `None` until the iterator gave its last message.
    pub fn end(&self) -> Option<&LogEnd> {
        self.end.as_ref()
    }

    /// Counts of the messages read so far.
    pub fn counts(&self) -> &LogCounts {
        &self.counts
    }

    /// Start of the next unread message, bytes of the unzipped file.
    pub(super) fn position(&self) -> u64 {
        self.at
    }

    /// Skips messages until the first of `timestamp_ns` or later, which is returned next.
    pub fn skip_to(&mut self, timestamp_ns: i64) {
        while let Some(record) = self.next() {
            if record.timestamp_ns >= timestamp_ns {
                self.ahead = Some(record);
                return;
            }
        }
    }

    fn read_message(&mut self) -> Result<Record, LogEnd> {
        loop {
            let at = self.at;
            let mut header = [0; MESSAGE_HEADER];
            match fill(&mut self.source, &mut header) {
                Ok(0) => return Err(self.broken.take().unwrap_or(LogEnd::Whole)),
                Ok(MESSAGE_HEADER) => {}
                Ok(bytes) => return Err(LogEnd::Cut { at, bytes: bytes as u64 }),
                Err((bytes, error)) => return Err(broken_off(at, bytes as u64, error)),
            }
            if header == *FILE_BEGIN {
                self.at += FILE_HEADER as u64;
                self.counts.joined += 1;
                self.last_ns = None;
                continue;
            }
            let (timestamp_ns, kind, size) = parse_header(&header);
            let length = usize::try_from(size).unwrap_or(usize::MAX);
            if size >= 0 && matches!(kind, MessageKind::Blank | MessageKind::Index2021) {
                // An index may be large; it is not kept.
                let skipped = io::copy(&mut self.source.by_ref().take(length as u64), &mut io::sink());
                let skipped = skipped.map_err(|error| broken_off(at, MESSAGE_HEADER as u64, error))?;
                if skipped < length as u64 {
                    return Err(LogEnd::Cut { at, bytes: MESSAGE_HEADER as u64 + skipped });
                }
                self.at += (MESSAGE_HEADER + length) as u64;
                let passed =
                    if kind == MessageKind::Blank { &mut self.counts.blank } else { &mut self.counts.index };
                *passed += 1;
                continue;
            }
            if length > PAYLOAD_MAX {
                if self.find_next_file(&header) {
                    continue;
                }
                return Err(LogEnd::Size { at, size });
            }
            let mut payload = vec![0; length];
            match fill(&mut self.source, &mut payload) {
                Ok(bytes) if bytes == length => {}
                Ok(bytes) => return Err(LogEnd::Cut { at, bytes: (MESSAGE_HEADER + bytes) as u64 }),
                Err((bytes, error)) => return Err(broken_off(at, (MESSAGE_HEADER + bytes) as u64, error)),
            }
            if payload.windows(FILE_HEADER).any(|bytes| bytes == FILE_BEGIN)
                && self.find_next_file(&[&header, &payload[..]].concat())
            {
                continue;
            }
            self.at += (MESSAGE_HEADER + length) as u64;
            self.count(timestamp_ns);
            return Ok(Record { timestamp_ns, kind, payload });
        }
    }

    /// Goes to the beginning of the next joined file, in `begun` (the bytes from `at` on that were read) or
    /// after it; false if there is none.
    fn find_next_file(&mut self, begun: &[u8]) -> bool {
        let (at, mut next) = (self.at, self.at);
        let mut bytes = begun.to_vec();
        loop {
            if let Some(place) = bytes.windows(FILE_HEADER).position(|bytes| bytes == FILE_BEGIN) {
                bytes.drain(..place);
                next += place as u64;
                // Bytes that were held already come after these.
                let rest = self.source.held.position() as usize;
                bytes.extend_from_slice(&self.source.held.get_ref()[rest..]);
                self.source.held = Cursor::new(bytes);
                self.at = next;
                self.broken.get_or_insert(LogEnd::Joined { at, next });
                return true;
            }
            let passed = bytes.len().saturating_sub(FILE_HEADER - 1);
            bytes.drain(..passed);
            next += passed as u64;
            let mut more = [0; 4096];
            match fill(&mut self.source, &mut more) {
                Ok(0) | Err(_) => return false,
                Ok(count) => bytes.extend_from_slice(&more[..count]),
            }
        }
    }

    fn count(&mut self, timestamp_ns: i64) {
        self.counts.messages += 1;
        if let Some(last) = self.last_ns.filter(|last| *last > timestamp_ns) {
            self.counts.back_steps += 1;
            let step = last.abs_diff(timestamp_ns);
            self.counts.largest_back_step_ns = self.counts.largest_back_step_ns.max(step);
        }
        self.last_ns = Some(timestamp_ns);
    }
}

impl<R: Read> Iterator for LogReader<R> {
    type Item = Record;

    fn next(&mut self) -> Option<Record> {
        if let Some(record) = self.ahead.take() {
            return Some(record);
        }
        if self.end.is_some() {
            return None;
        }
        match self.read_message() {
            Ok(record) => Some(record),
            Err(end) => {
                self.end = Some(end);
                None
            }
        }
    }
}

/// First bytes of a file of the version that is read: the magic and the version.
pub(super) const FILE_BEGIN: &[u8; FILE_HEADER] = b"SSL_LOG_FILE\0\0\0\x01";

/// Time, type and size before a payload.
pub(super) fn parse_header(header: &[u8; MESSAGE_HEADER]) -> (i64, MessageKind, i32) {
    let [t0, t1, t2, t3, t4, t5, t6, t7, k0, k1, k2, k3, s0, s1, s2, s3] = *header;
    (
        i64::from_be_bytes([t0, t1, t2, t3, t4, t5, t6, t7]),
        MessageKind::from_number(i32::from_be_bytes([k0, k1, k2, k3])),
        i32::from_be_bytes([s0, s1, s2, s3]),
    )
}

/// Reads until the buffer is full or the source ends; returns the number of bytes read.
pub(super) fn fill(source: &mut impl Read, buffer: &mut [u8]) -> Result<usize, (usize, io::Error)> {
    let mut filled = 0;
    while filled < buffer.len() {
        match source.read(&mut buffer[filled..]) {
            Ok(0) => break,
            Ok(bytes) => filled += bytes,
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            Err(error) => return Err((filled, error)),
        }
    }
    Ok(filled)
}

/// A gzip stream that stops in its middle is a cut file; anything else is damage.
fn broken_off(at: u64, bytes: u64, error: io::Error) -> LogEnd {
    match error.kind() {
        io::ErrorKind::UnexpectedEof => LogEnd::Cut { at, bytes },
        _ => LogEnd::Read { at, error },
    }
}

/// Start of the string `SSL_LOG_FILE` as Qt writes it: 24 bytes of UTF-16.
const LEGACY_QT: [u8; 12] = [0, 0, 0, 24, 0, b'S', 0, b'S', 0, b'L', 0, b'_'];
