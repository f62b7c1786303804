//! `log`: the league's log files: `.log` and `.log.gz`, as its recorder writes and its players read.
//!
//! A file is `SSL_LOG_FILE`, an int32 version (1), and then messages: int64 receiver's time in ns, int32
//! type, int32 size, payload; all integers big-endian. An index of the messages may stand at the end of an
//! uncompressed file; a `.log.gz` is the whole file gzipped and has none. Files that were joined (`cat`),
//! gzipped or not, are read one after the other.
//!
//! Read with [`open`] or [`open_at`], write with [`LogWriter`], count with [`Summary`]. A file may end
//! anywhere and hold anything: every whole message is returned, and [`LogReader::end`] reports what was found
//! instead of an end.

mod error;
mod guess;
mod index;
mod open;
mod packet;
mod present;
mod reader;
mod summary;
mod writer;

pub use error::LogError;
pub use guess::guess;
pub use index::Index;
pub use open::{BACK_STEP_MESSAGES, Place, Source, open, open_at};
pub use packet::{Packet, PacketError};
pub use reader::{LogCounts, LogEnd, LogReader};
pub use summary::{KindSummary, Summary};
pub use writer::{LogWriter, Sink};

/// The first bytes of a file.
const MAGIC: &[u8; 12] = b"SSL_LOG_FILE";

/// The only version in use.
const VERSION: i32 = 1;

/// Bytes of the file's header: the magic and the version.
const FILE_HEADER: usize = 16;

/// Bytes before each payload: time, type, size.
const MESSAGE_HEADER: usize = 16;

/// Most bytes of a payload that are accepted: a message is a datagram, and a datagram's length has 16 bits. A
/// larger size counts as damage, so that damage cannot request gigabytes.
pub const PAYLOAD_MAX: usize = 65_535;

/// Kind of a message in a log file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum MessageKind {
    /// 0: no message; to be skipped.
    Blank,
    /// 1: unknown message; [`guess`] detects its type.
    Unknown,
    /// 2: vision until 2014, [`vision::legacy::WrapperPacket`](crate::vision::legacy::WrapperPacket).
    Vision2010,
    /// 3: referee packet, [`Referee`](crate::referee::Referee).
    Refbox2013,
    /// 4: present vision, [`vision::WrapperPacket`](crate::vision::WrapperPacket).
    Vision2014,
    /// 5: tracker packet, [`TrackerWrapperPacket`](crate::tracker::TrackerWrapperPacket).
    Tracker2020,
    /// 6: the [`Index`] at the end of a file.
    Index2021,
    /// A number not defined by the league.
    Other(i32),
}

impl MessageKind {
    /// The kind of a number.
    pub const fn from_number(number: i32) -> Self {
        match number {
            0 => Self::Blank,
            1 => Self::Unknown,
            2 => Self::Vision2010,
            3 => Self::Refbox2013,
            4 => Self::Vision2014,
            5 => Self::Tracker2020,
            6 => Self::Index2021,
            other => Self::Other(other),
        }
    }

    /// The number in the file.
    pub const fn number(self) -> i32 {
        match self {
            Self::Blank => 0,
            Self::Unknown => 1,
            Self::Vision2010 => 2,
            Self::Refbox2013 => 3,
            Self::Vision2014 => 4,
            Self::Tracker2020 => 5,
            Self::Index2021 => 6,
            Self::Other(number) => number,
        }
    }
}

impl std::fmt::Display for MessageKind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Blank => write!(f, "blank"),
            Self::Unknown => write!(f, "unknown"),
            Self::Vision2010 => write!(f, "vision of 2014"),
            Self::Refbox2013 => write!(f, "referee"),
            Self::Vision2014 => write!(f, "vision"),
            Self::Tracker2020 => write!(f, "tracker"),
            Self::Index2021 => write!(f, "index"),
            Self::Other(number) => write!(f, "type {number}"),
        }
    }
}

/// One message of a log file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Record {
    /// Time of reception by the recorder, ns, Unix time. Neighbours may step back half a millisecond (README,
    /// trap 6).
    pub timestamp_ns: i64,
    /// Kind of the message.
    pub kind: MessageKind,
    /// Bytes of the datagram.
    pub payload: Vec<u8>,
}

impl Record {
    /// The decoded message; `None` for blank messages and the index.
    pub fn decode(&self) -> Result<Option<Packet>, PacketError> {
        Packet::decode(self.kind, &self.payload)
    }
}
