//! `trace`: trace file of a match, from which its decisions can be replayed: all inputs and outputs of each
//! host, in order (docs/architecture.md §7.4: `X.trace`).
//!
//! ```text
//! "ONETWO_TRACE" | version u32 | length u32, header: JSON in UTF-8 | records
//! record: time u64, µs | host u8 | kind u8 | length u32 | bytes            all integers little endian
//! ```
//! Kind 255 is no record: its 4 bytes are the CRC-32 of all before it, magic and header included. One is
//! written at each flush and at the end; a trace that does not end with one is cut. Versions 1 and 2 have
//! none.
//!
//! Bytes of a referee's record: the sender's address ([`SenderAddress::to_bytes`], 18 bytes), then the
//! datagram. Version 1 had no address there; its packets are read as [`SenderAddress::INTERNAL`]'s. A record
//! of kind [`RecordKind::Lost`] means that the recorder could not keep up from then on.
//!
//! The header is JSON with seed, commit and configuration. A file cut anywhere gives every whole record
//! before the cut, and reports the cut and its place. Compression is done by the file, not by this format:
//! where the stream ends before its own end mark (gzip's checksum) the trace is cut, even if the last record
//! is whole.

use std::fmt;
use std::io::{self, Read, Write};

use flate2::Crc;
use protocol::Instant;

use crate::referee::SenderAddress;

const MAGIC: &[u8; 12] = b"ONETWO_TRACE";
/// The version of the format.
pub const VERSION: u32 = 3;
/// The oldest version that is read.
const OLDEST_VERSION: u32 = 1;
/// Version 1 did not store a referee's address.
const SENDER_SINCE_VERSION: u32 = 2;
/// Version 2 had no checksums.
const CHECKSUM_SINCE_VERSION: u32 = 3;
/// Byte of a checksum, in the place of a record's kind.
const CHECKSUM: u8 = 255;
/// Bytes before those of a record: time, host, kind and length.
const RECORD_HEAD: usize = 14;
/// The longest record, bytes: a datagram and its sender.
pub const RECORD_LEN_MAX: usize = 65_536 + SenderAddress::LEN;
/// The longest header, bytes.
pub const HEADER_LEN_MAX: usize = 1 << 20;

/// Kinds of a record.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RecordKind {
    /// A datagram of the vision came in.
    Vision,
    /// A datagram of the referee came in.
    Referee,
    /// A frame of a robot came in.
    Robot,
    /// A deadline of the host had come.
    Timeout,
    /// The host sent a frame: the first byte is the robot it is for, 255 for all.
    Sent,
    /// The recorder could not keep up: later events are not recorded. No record follows it.
    Lost,
    /// The operator halted the host's robots.
    Halt,
    /// A line of the strategy in another program came in.
    Orders,
    /// The operator changed a parameter.
    Parameter,
    /// The operator began or ended a test of a kicker.
    Test,
}

impl RecordKind {
    fn from_byte(byte: u8) -> Option<Self> {
        use RecordKind as K;
        let first = [K::Vision, K::Referee, K::Robot, K::Timeout, K::Sent];
        let later = [K::Lost, K::Halt, K::Orders, K::Parameter, K::Test];
        first.iter().chain(&later).nth(usize::from(byte)).copied()
    }

    /// Whether it is an input of the host.
    pub fn is_input(self) -> bool {
        !matches!(self, Self::Sent | Self::Lost)
    }
}

/// One input or output.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Record {
    /// Time on the host's clock.
    pub at: Instant,
    /// Number of the host, where one recording holds several teams'.
    pub host: u8,
    /// Whether it is an input or output, and of what.
    pub kind: RecordKind,
    /// The sender, for packets of the referee; [`SenderAddress::INTERNAL`] for everything else.
    pub from: SenderAddress,
    /// Payload without the head, at most [`RECORD_LEN_MAX`].
    pub bytes: Vec<u8>,
}

/// Writes a trace record by record.
#[derive(Debug)]
pub struct Writer<W: Write> {
    out: W,
    /// Of all that was written.
    sum: Crc,
}

impl<W: Write> Writer<W> {
    /// Starts with the header, which is JSON.
    pub fn new(out: W, header: &str) -> io::Result<Self> {
        let mut writer = Self { out, sum: Crc::new() };
        writer.put(MAGIC)?;
        writer.put(&VERSION.to_le_bytes())?;
        writer.put(&len(header.as_bytes())?.to_le_bytes())?;
        writer.put(header.as_bytes())?;
        Ok(writer)
    }

    /// Adds a record at the end; fails where it exceeds [`RECORD_LEN_MAX`].
    pub fn write(&mut self, at: Instant, host: u8, kind: RecordKind, bytes: &[&[u8]]) -> io::Result<()> {
        let total: usize = bytes.iter().map(|part| part.len()).sum();
        if total > RECORD_LEN_MAX {
            return Err(io::Error::other(format!("a record of {total} bytes; at most {RECORD_LEN_MAX} fit")));
        }
        self.put(&record_head(at, host, kind as u8, total as u32))?;
        bytes.iter().try_for_each(|part| self.put(part))
    }

    /// Writes a checksum and what is buffered: a reader of the file then finds every record so far.
    pub fn flush(&mut self) -> io::Result<()> {
        self.write_checksum()?;
        self.out.flush()
    }

    /// Ends the trace; returns the underlying writer.
    pub fn finish(mut self) -> io::Result<W> {
        self.write_checksum()?;
        Ok(self.out)
    }

    fn write_checksum(&mut self) -> io::Result<()> {
        let sum = self.sum.sum().to_le_bytes();
        self.put(&record_head(Instant(0), 0, CHECKSUM, sum.len() as u32))?;
        self.put(&sum)
    }

    fn put(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.sum.update(bytes);
        self.out.write_all(bytes)
    }
}

/// The bytes before a record's own.
fn record_head(at: Instant, host: u8, kind: u8, length: u32) -> [u8; RECORD_HEAD] {
    let mut head = [0; RECORD_HEAD];
    head[..8].copy_from_slice(&at.0.to_le_bytes());
    head[8] = host;
    head[9] = kind;
    head[10..].copy_from_slice(&length.to_le_bytes());
    head
}

fn len(bytes: &[u8]) -> io::Result<u32> {
    u32::try_from(bytes.len()).map_err(io::Error::other)
}

/// Reads a trace, record by record.
#[derive(Debug)]
pub struct Reader<R: Read> {
    from: R,
    /// The version of the format that the file has.
    pub version: u32,
    header: String,
    end: Option<TraceEnd>,
    /// Start of the next record, bytes of the uncompressed trace.
    at: u64,
    last: Option<Instant>,
    /// Of all that was read.
    sum: Crc,
    /// Start of what the next checksum is for; `None` where there is nothing since the last one.
    unsummed: Option<u64>,
}

/// End of a trace.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum TraceEnd {
    /// After a whole record.
    Whole,
    /// A gap where the recorder could not keep up.
    Lost {
        /// Time of the gap.
        at: Instant,
    },
    /// Within a record, or before the end of the compressed stream: the program that wrote it was killed, or
    /// the file was not copied whole.
    Cut {
        /// Start of the first missing record, bytes of the uncompressed trace.
        at: u64,
        /// Time of the last whole record.
        last: Option<Instant>,
    },
    /// At a record that is invalid, or cannot be read.
    Broken {
        /// Start of the record, bytes of the uncompressed trace.
        at: u64,
        /// Text on what is wrong with the record.
        what: String,
    },
}

impl TraceEnd {
    /// Whether the trace ended as it should.
    pub const fn is_whole(&self) -> bool {
        matches!(self, Self::Whole)
    }
}

impl fmt::Display for TraceEnd {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Whole => f.write_str("whole"),
            Self::Cut { at, last: Some(last) } => {
                let seconds = last.0 as f64 * 1e-6;
                write!(f, "cut at byte {at}, after the record at {seconds:.6} s; all before it was read")
            }
            Self::Cut { at, last: None } => write!(f, "cut at byte {at}, before its first record"),
            Self::Lost { at } => {
                let seconds = at.0 as f64 * 1e-6;
                write!(
                    f,
                    "the recorder could not keep up at {seconds:.6} s (is the disk slow or full?); all before it was read"
                )
            }
            Self::Broken { at, what } => {
                write!(f, "damaged at byte {at}: {what}; all before it was read")
            }
        }
    }
}

/// Why a file is no trace.
#[derive(Debug, thiserror::Error)]
pub enum TraceError {
    /// An error while reading.
    #[error("{0}")]
    Io(io::Error),
    /// A file that does not start as a trace does.
    #[error("it does not begin with ONETWO_TRACE: no trace of ours")]
    NotATrace,
    /// Another version of the format, which is not read.
    #[error(
        "a trace of version {0}, this program reads {OLDEST_VERSION} to {VERSION}: use the program that wrote it"
    )]
    Version(u32),
    /// The header is cut, too long or not UTF-8.
    #[error("its header is cut or damaged: the recording cannot be identified")]
    Header,
}

impl From<io::Error> for TraceError {
    fn from(error: io::Error) -> Self {
        if error.kind() == io::ErrorKind::UnexpectedEof { Self::Header } else { Self::Io(error) }
    }
}

impl<R: Read> Reader<R> {
    /// Reads and checks the header, up to the first record.
    pub fn new(mut from: R) -> Result<Self, TraceError> {
        let mut magic = [0; 12];
        match from.read_exact(&mut magic) {
            Ok(()) if &magic == MAGIC => {}
            Ok(()) => return Err(TraceError::NotATrace),
            Err(error) if error.kind() == io::ErrorKind::UnexpectedEof => return Err(TraceError::NotATrace),
            Err(error) => return Err(TraceError::Io(error)),
        }
        let mut label = [0; 4];
        from.read_exact(&mut label)?;
        let version = u32::from_le_bytes(label);
        if !(OLDEST_VERSION..=VERSION).contains(&version) {
            return Err(TraceError::Version(version));
        }
        from.read_exact(&mut label)?;
        let length = u32::from_le_bytes(label) as usize;
        if length > HEADER_LEN_MAX {
            return Err(TraceError::Header);
        }
        let mut header = vec![0; length];
        from.read_exact(&mut header)?;
        let mut sum = Crc::new();
        for bytes in [&magic[..], &version.to_le_bytes(), &label, &header] {
            sum.update(bytes);
        }
        let header = String::from_utf8(header).map_err(|_| TraceError::Header)?;
        let at = (MAGIC.len() + 2 * label.len() + header.len()) as u64;
        Ok(Self { from, version, header, end: None, at, last: None, sum, unsummed: Some(0) })
    }

    /// Whether referees' records name their senders.
    pub const fn has_senders(&self) -> bool {
        self.version >= SENDER_SINCE_VERSION
    }

    /// The header, as JSON.
    pub fn header(&self) -> &str {
        &self.header
    }

    /// End of the trace, once it is reached.
    pub fn end(&self) -> Option<&TraceEnd> {
        self.end.as_ref()
    }

    /// The next record; `None` of a checksum.
    fn read(&mut self) -> Result<Option<Record>, TraceEnd> {
        let (begin, last) = (self.at, self.last);
        let cut = || TraceEnd::Cut { at: begin, last };
        let broken = |what: String| TraceEnd::Broken { at: begin, what };
        // A compressed stream that stops in its middle is a cut file; anything else is damage.
        let failed = |error: io::Error| match error.kind() {
            io::ErrorKind::UnexpectedEof => cut(),
            _ => broken(error.to_string()),
        };
        let mut head = [0; RECORD_HEAD];
        match fill(&mut self.from, &mut head).map_err(failed)? {
            0 if self.has_checksums() && self.unsummed.is_some() => return Err(cut()),
            0 => return Err(TraceEnd::Whole),
            got if got < head.len() => return Err(cut()),
            _ => {}
        }
        let [t0, t1, t2, t3, t4, t5, t6, t7, host, kind, l0, l1, l2, l3] = head;
        let length = u32::from_le_bytes([l0, l1, l2, l3]) as usize;
        if kind == CHECKSUM && self.has_checksums() {
            let mut sum = [0; 4];
            let got = fill(&mut self.from, &mut sum).map_err(failed)?;
            if length == sum.len() && got < length {
                return Err(cut());
            }
            let is_own = head == record_head(Instant(0), 0, CHECKSUM, sum.len() as u32);
            if !is_own || u32::from_le_bytes(sum) != self.sum.sum() {
                let since = self.unsummed.unwrap_or(begin);
                return Err(broken(format!("the bytes from {since} on are not those that were written")));
            }
            self.sum.update(&head);
            self.sum.update(&sum);
            self.at += (head.len() + length) as u64;
            self.unsummed = None;
            return Ok(None);
        }
        let kind =
            RecordKind::from_byte(kind).ok_or_else(|| broken(format!("no record is of kind {kind}")))?;
        if length > RECORD_LEN_MAX {
            return Err(broken(format!("a record of {length} bytes; at most {RECORD_LEN_MAX} are written")));
        }
        let mut bytes = vec![0; length];
        if fill(&mut self.from, &mut bytes).map_err(failed)? < length {
            return Err(cut());
        }
        let at = Instant(u64::from_le_bytes([t0, t1, t2, t3, t4, t5, t6, t7]));
        self.sum.update(&head);
        self.sum.update(&bytes);
        self.unsummed.get_or_insert(begin);
        self.at += (head.len() + length) as u64;
        self.last = Some(at);
        let from = match kind {
            RecordKind::Lost => return Err(TraceEnd::Lost { at }),
            RecordKind::Referee if self.has_senders() => take_sender(&mut bytes)
                .ok_or_else(|| broken(format!("a referee's record of {length} bytes has no sender")))?,
            _ => SenderAddress::INTERNAL,
        };
        Ok(Some(Record { at, host, kind, from, bytes }))
    }

    const fn has_checksums(&self) -> bool {
        self.version >= CHECKSUM_SINCE_VERSION
    }
}

/// Takes the sender from the start of a referee's record.
fn take_sender(bytes: &mut Vec<u8>) -> Option<SenderAddress> {
    let (sender, packet) = bytes.split_first_chunk()?;
    let (sender, packet) = (SenderAddress::from_bytes(*sender), packet.to_vec());
    *bytes = packet;
    Some(sender)
}

/// Fills as much of `into` as there is data.
fn fill(from: &mut impl Read, into: &mut [u8]) -> io::Result<usize> {
    let mut done = 0;
    while done < into.len() {
        match from.read(&mut into[done..]) {
            Ok(0) => break,
            Ok(n) => done += n,
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
    Ok(done)
}

impl<R: Read> Iterator for Reader<R> {
    type Item = Record;

    fn next(&mut self) -> Option<Record> {
        while self.end.is_none() {
            match self.read() {
                Ok(Some(record)) => return Some(record),
                Ok(None) => {}
                Err(end) => self.end = Some(end),
            }
        }
        None
    }
}

#[cfg(test)]
mod tests;
