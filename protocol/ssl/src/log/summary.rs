//! `summary`: statistics of a log file. Messages by kind, spans of time, what could not be decoded, how it
//! ends.

use std::collections::BTreeMap;
use std::io::Read;

use super::{LogCounts, LogReader, MessageKind, Packet, PacketError};

/// Statistics of a file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Summary {
    /// Messages by the kind that the file names; a message of kind `Unknown` is counted there, even if its
    /// kind was found.
    pub kinds: BTreeMap<MessageKind, KindSummary>,
    /// Number of messages of kind `Unknown` whose kind was found.
    pub guessed: u64,
    /// Counters of the reader.
    pub counts: LogCounts,
    /// First and last time of any message, ns, Unix time.
    pub span_ns: Option<(i64, i64)>,
    /// Camera frames by camera.
    pub cameras: BTreeMap<u32, u64>,
    /// Names of trackers, by their id.
    pub trackers: BTreeMap<String, String>,
    /// The first message that could not be decoded: its number among all, from 0, and why.
    pub first_undecodable: Option<(u64, PacketError)>,
    /// Damage at the end of the file, as text; empty if whole.
    pub damage: String,
}

/// Statistics of one kind of messages.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct KindSummary {
    /// Number of messages of that kind.
    pub messages: u64,
    /// Total length of their payloads, bytes.
    pub bytes: u64,
    /// Number of those that could not be decoded.
    pub undecodable: u64,
    /// Least and greatest time, ns, Unix time.
    pub span_ns: (i64, i64),
}

impl Summary {
    /// Reads the file to its end.
    pub fn of<R: Read>(reader: &mut LogReader<R>) -> Self {
        let mut summary = Self::default();
        for (number, record) in (0..).zip(reader.by_ref()) {
            let time = record.timestamp_ns;
            let span = summary.span_ns.get_or_insert((time, time));
            *span = (span.0.min(time), span.1.max(time));
            let fresh = KindSummary { span_ns: (time, time), ..KindSummary::default() };
            let kind = summary.kinds.entry(record.kind).or_insert(fresh);
            kind.messages += 1;
            kind.bytes += record.payload.len() as u64;
            kind.span_ns = (kind.span_ns.0.min(time), kind.span_ns.1.max(time));
            match record.decode() {
                Ok(packet) => {
                    summary.guessed += u64::from(record.kind == MessageKind::Unknown);
                    summary.see(packet);
                }
                Err(error) => {
                    kind.undecodable += 1;
                    summary.first_undecodable.get_or_insert((number, error));
                }
            }
        }
        summary.counts = *reader.counts();
        summary.damage =
            reader.end().filter(|end| !end.is_whole()).map(ToString::to_string).unwrap_or_default();
        summary
    }

    /// Number of messages that could not be decoded, of all kinds.
    pub fn undecodable(&self) -> u64 {
        self.kinds.values().map(|kind| kind.undecodable).sum()
    }

    fn see(&mut self, packet: Option<Packet>) {
        let detection = match packet {
            Some(Packet::Vision(packet)) => packet.detection,
            Some(Packet::VisionLegacy(packet)) => packet.detection,
            Some(Packet::Tracker(packet)) => {
                self.trackers.entry(packet.uuid).or_insert(packet.source_name.unwrap_or_default());
                None
            }
            Some(Packet::Referee(_)) | None => None,
        };
        if let Some(detection) = detection {
            *self.cameras.entry(detection.camera_id).or_default() += 1;
        }
    }
}
