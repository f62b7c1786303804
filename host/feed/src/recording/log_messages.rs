//! `log_messages`: messages of a league log file, each with its time since the file's start.

use std::collections::VecDeque;
use std::path::Path;

use protocol::Instant;
use ssl::log::{LogReader, MessageKind, Record, Source};
use ssl::vision::FrameHead;

use super::clock::{ClockStep, LogClock};
use super::failure::{RecordingFailure, in_file};

/// Reads a league log file; an iterator over its messages with their times.
///
/// Where the recorder's clock jumps forward, the next camera frame is looked up before the jump's message is
/// given out: its own time says how much of the jump was played.
pub struct LogMessages {
    reader: LogReader<Source>,
    /// Messages that were read to look for a camera frame, each with the number of files joined before it.
    ahead: VecDeque<(Record, u64)>,
    clock: LogClock,
    /// Unix time of the start, ns.
    began_ns: Option<i64>,
    /// Number of files joined before the last message, and the time at which the first of them begins, s.
    joined: u64,
    joined_at_s: Option<f64>,
}

impl LogMessages {
    /// Opens a `.log` or `.log.gz`.
    pub fn open(file: &Path) -> Result<Self, RecordingFailure> {
        let reader = ssl::log::open(file).map_err(in_file(file))?;
        let (ahead, clock) = (VecDeque::new(), LogClock::default());
        Ok(Self { reader, ahead, clock, began_ns: None, joined: 0, joined_at_s: None })
    }

    /// Damage of the file, if it is not whole; known after the last message.
    pub fn damage(&self) -> Option<String> {
        self.reader.end().filter(|end| !end.is_whole()).map(ToString::to_string)
    }

    /// Number of messages that are earlier than the one before them.
    pub fn back_steps(&self) -> u64 {
        self.reader.counts().back_steps
    }

    /// Number of files that were joined to the first, and the time at which the first of them begins, s.
    pub fn joined(&self) -> (u64, Option<f64>) {
        (self.joined, self.joined_at_s)
    }

    /// Steps of the recorder's clock, the first of them, and the number of the others.
    pub fn clock_steps(&self) -> (&[ClockStep], u64) {
        (&self.clock.steps, self.clock.steps_more)
    }

    /// Unix time of the file's start, s: by the last message, where the clock was not set before the first.
    pub fn began_unix_s(&self) -> f64 {
        self.began_ns.unwrap_or_default() as f64 * 1e-9
    }

    /// The next camera frame whose camera has been there before.
    fn look_ahead(&mut self) -> Option<FrameHead> {
        let mut heads = self.ahead.iter().filter_map(|(record, _)| frame(record));
        if let Some(head) = heads.find(|head| self.clock.has_camera(head.camera_id)) {
            return Some(head);
        }
        while self.ahead.len() < AHEAD_MAX {
            let record = self.reader.next()?;
            let head = frame(&record);
            self.ahead.push_back((record, self.reader.counts().joined));
            if let Some(head) = head.filter(|head| self.clock.has_camera(head.camera_id)) {
                return Some(head);
            }
        }
        None
    }
}

impl Iterator for LogMessages {
    type Item = (Instant, Record);

    fn next(&mut self) -> Option<Self::Item> {
        let (record, joined) = match self.ahead.pop_front() {
            Some(ahead) => ahead,
            None => (self.reader.next()?, self.reader.counts().joined),
        };
        let own = frame(&record);
        let next = if self.clock.jumps(record.timestamp_ns) {
            own.filter(|head| self.clock.has_camera(head.camera_id)).or_else(|| self.look_ahead())
        } else {
            None
        };
        let at = self.clock.read_beside(record.timestamp_ns, own.as_ref(), next.as_ref());
        let begin = record.timestamp_ns.saturating_sub(at.0.saturating_mul(1000) as i64);
        if self.began_ns.is_none() || self.clock.was_set_forward() {
            self.began_ns = Some(begin);
        }
        if joined > self.joined {
            self.joined = joined;
            self.joined_at_s.get_or_insert(at.0 as f64 * 1e-6);
        }
        Some((at, record))
    }
}

/// The head of a camera frame of any year.
fn frame(record: &Record) -> Option<FrameHead> {
    let is_vision =
        matches!(record.kind, MessageKind::Vision2014 | MessageKind::Vision2010 | MessageKind::Unknown);
    let head = if is_vision { FrameHead::of(&record.payload) } else { None };
    head.filter(|head| head.t_capture.is_finite())
}

/// Most messages that are read ahead for a camera frame: some ten seconds of a match.
const AHEAD_MAX: usize = 4096;
