//! `packets`: the league's packets of a recording, of a log file or of a trace, in order, each with its bytes
//! and times.

use std::path::Path;

use host::record::trace::RecordKind;
use protocol::Instant;
use ssl::log::MessageKind;

use super::failure::RecordingFailure;
use super::log_messages::LogMessages;
use super::trace_file::{TraceFile, begins_as_trace};

/// A datagram of the league's network as it was recorded.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LeaguePacket {
    /// Since the start of a log file, or on the clock of a trace's hosts.
    pub at: Instant,
    /// Time of its reception, ns, Unix time; of a simulated match since its start.
    pub unix_ns: i64,
    /// Kind of message that the file names.
    pub kind: MessageKind,
    /// The datagram.
    pub bytes: Vec<u8>,
}

/// Reads a recording; an iterator over its packets. Of a trace these are the packets of its first host:
/// every host receives the same ones.
pub struct LeaguePackets<'f>(Source<'f>);

enum Source<'f> {
    Log(Box<LogMessages>),
    Trace {
        file: Box<TraceFile<'f>>,
        /// Unix time of the hosts' instant 0, µs.
        zero_unix_us: u64,
    },
}

impl<'f> LeaguePackets<'f> {
    /// Opens a league log file or a trace, gzipped or not.
    pub fn open(file: &'f Path) -> Result<Self, RecordingFailure> {
        Ok(Self(if begins_as_trace(file)? {
            let file = Box::new(TraceFile::open(file)?);
            Source::Trace { zero_unix_us: file.header.zero_unix_us.unwrap_or(0), file }
        } else {
            Source::Log(Box::new(LogMessages::open(file)?))
        }))
    }

    /// Damage of the file, if it is not whole; known after the last packet.
    pub fn damage(&self) -> Option<String> {
        match &self.0 {
            Source::Log(messages) => messages.damage(),
            Source::Trace { file, .. } => file.damage(),
        }
    }
}

impl Iterator for LeaguePackets<'_> {
    type Item = LeaguePacket;

    fn next(&mut self) -> Option<LeaguePacket> {
        match &mut self.0 {
            Source::Log(messages) => {
                let (at, record) = messages.next()?;
                let (unix_ns, kind, bytes) = (record.timestamp_ns, record.kind, record.payload);
                Some(LeaguePacket { at, unix_ns, kind, bytes })
            }
            Source::Trace { file, zero_unix_us } => loop {
                let record = file.next()?;
                let kind = match record.kind {
                    RecordKind::Vision if record.host == 0 => MessageKind::Vision2014,
                    RecordKind::Referee if record.host == 0 => MessageKind::Refbox2013,
                    _ => continue,
                };
                let unix_us = zero_unix_us.saturating_add(record.at.0);
                let unix_ns = i64::try_from(unix_us.saturating_mul(1000)).unwrap_or(i64::MAX);
                return Some(LeaguePacket { at: record.at, unix_ns, kind, bytes: record.bytes });
            },
        }
    }
}
