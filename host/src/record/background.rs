//! `background`: a [`Recorder`] on a thread of its own behind a bounded queue, so that compression and a slow
//! disk never delay the control loop. Sizes in bytes.
//!
//! Where the disk cannot keep up, league messages are dropped and counted, and the trace ends at the first
//! record that was dropped, with a mark for it: decisions after a gap could not be replayed.

use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::{self, JoinHandle};

use protocol::Instant;
use protocol::link::Packet;
use rules::Colour;
use ssl::log::MessageKind;

use super::Recorder;
use crate::Input;
use crate::radio::To;
use crate::referee::SenderAddress;

/// Bytes that wait at most: 16 s of a match (four cameras, eleven robots: 0.5 MB/s), which bounds the memory
/// used.
const QUEUE_BYTES_MAX: usize = 8 << 20;
/// Size of an entry beside its payload, bytes.
const ENTRY_LEN: usize = 96;

/// A recorder that never blocks its caller.
pub struct BackgroundRecorder {
    queue: Sender<Entry>,
    shared: Arc<Shared>,
    room: usize,
    /// The trace has ended because a record was dropped, at.
    ended: Option<Instant>,
    dropped: u64,
    thread: JoinHandle<io::Result<()>>,
}

#[derive(Default)]
struct Shared {
    waiting: AtomicUsize,
    failed: AtomicBool,
}

/// An entry of the queue.
enum Entry {
    Received(Instant, MessageKind, Vec<u8>),
    Input(Instant, Colour, Owned),
    Sent(Instant, Colour, To, Packet),
    Lost(Instant),
}

enum Owned {
    Vision(Vec<u8>),
    Referee(Vec<u8>, SenderAddress),
    Robot(Vec<u8>),
    Orders(Vec<u8>),
    Parameter(Vec<u8>),
    Test(Vec<u8>),
    Halt,
    Timeout,
}

impl Owned {
    fn of(input: Input<'_>) -> Self {
        match input {
            Input::Vision(bytes) => Self::Vision(bytes.to_vec()),
            Input::Referee(bytes, from) => Self::Referee(bytes.to_vec(), from),
            Input::Robot(bytes) => Self::Robot(bytes.to_vec()),
            Input::Orders(line) => Self::Orders(line.to_vec()),
            Input::Parameter(json) => Self::Parameter(json.to_vec()),
            Input::Test(json) => Self::Test(json.to_vec()),
            Input::Halt => Self::Halt,
            Input::Timeout => Self::Timeout,
        }
    }

    fn input(&self) -> Input<'_> {
        match self {
            Self::Vision(bytes) => Input::Vision(bytes),
            Self::Referee(bytes, from) => Input::Referee(bytes, *from),
            Self::Robot(bytes) => Input::Robot(bytes),
            Self::Orders(line) => Input::Orders(line),
            Self::Parameter(json) => Input::Parameter(json),
            Self::Test(json) => Input::Test(json),
            Self::Halt => Input::Halt,
            Self::Timeout => Input::Timeout,
        }
    }
}

impl Entry {
    fn len(&self) -> usize {
        ENTRY_LEN
            + match self {
                Self::Received(_, _, bytes) => bytes.len(),
                Self::Input(
                    _,
                    _,
                    Owned::Vision(bytes)
                    | Owned::Referee(bytes, _)
                    | Owned::Robot(bytes)
                    | Owned::Orders(bytes)
                    | Owned::Parameter(bytes)
                    | Owned::Test(bytes),
                ) => bytes.len(),
                _ => 0,
            }
    }
}

impl BackgroundRecorder {
    /// Takes over a recorder; at most 8 MiB wait for it.
    pub fn start(recorder: Recorder) -> io::Result<Self> {
        Self::with_room(recorder, QUEUE_BYTES_MAX)
    }

    fn with_room(recorder: Recorder, room: usize) -> io::Result<Self> {
        let (queue, entries) = channel();
        let shared = Arc::new(Shared::default());
        let theirs = shared.clone();
        let thread = thread::Builder::new()
            .name("recorder".to_owned())
            .spawn(move || write(recorder, &entries, &theirs))?;
        Ok(Self { queue, shared, room, ended: None, dropped: 0, thread })
    }

    /// A league message was received from the network.
    pub fn received(&mut self, now: Instant, kind: MessageKind, bytes: &[u8]) {
        if self.has_room(bytes.len()) {
            self.put(Entry::Received(now, kind, bytes.to_vec()));
        } else {
            self.dropped += 1;
        }
    }

    /// Something came to the host of that colour.
    pub fn input(&mut self, now: Instant, host: Colour, input: Input<'_>) {
        let len = match input {
            Input::Vision(bytes)
            | Input::Referee(bytes, _)
            | Input::Robot(bytes)
            | Input::Orders(bytes)
            | Input::Parameter(bytes)
            | Input::Test(bytes) => bytes.len(),
            Input::Halt | Input::Timeout => 0,
        };
        if self.has_record_room(now, len) {
            self.put(Entry::Input(now, host, Owned::of(input)));
        }
    }

    /// Time at which the trace has ended because a record was dropped.
    pub fn sent(&mut self, now: Instant, host: Colour, to: To, packet: &Packet) {
        if self.has_record_room(now, 0) {
            self.put(Entry::Sent(now, host, to, packet.clone()));
        }
    }

    /// Whether an error has ended the writing.
    pub fn failed(&self) -> bool {
        self.shared.failed.load(Ordering::Relaxed)
    }

    /// When the trace had to end because the disk could not keep up.
    pub fn trace_ended(&self) -> Option<Instant> {
        self.ended
    }

    /// League messages and records that were dropped.
    pub fn dropped(&self) -> u64 {
        self.dropped
    }

    /// Bytes in the queue.
    pub fn waiting(&self) -> usize {
        self.shared.waiting.load(Ordering::Relaxed)
    }

    /// Writes what is queued and closes both files; returns the first error.
    pub fn finish(self) -> io::Result<()> {
        drop(self.queue);
        self.thread.join().unwrap_or_else(|_| Err(io::Error::other("the recorder's thread ended by a fault")))
    }

    fn has_room(&self, bytes: usize) -> bool {
        self.waiting().saturating_add(bytes + ENTRY_LEN) <= self.room
    }

    /// Whether a record of the trace may be queued; the first that may not ends the trace.
    fn has_record_room(&mut self, now: Instant, bytes: usize) -> bool {
        if self.ended.is_none() && self.has_room(bytes) {
            return true;
        }
        self.dropped += 1;
        if self.ended.is_none() {
            self.ended = Some(now);
            self.put(Entry::Lost(now));
        }
        false
    }

    fn put(&mut self, entry: Entry) {
        self.shared.waiting.fetch_add(entry.len(), Ordering::Relaxed);
        // A thread that has ended is reported by `failed`.
        let _ = self.queue.send(entry);
    }
}

fn write(mut recorder: Recorder, entries: &Receiver<Entry>, shared: &Shared) -> io::Result<()> {
    for entry in entries {
        match &entry {
            Entry::Received(now, kind, bytes) => recorder.received(*now, *kind, bytes),
            Entry::Input(now, host, input) => recorder.input(*now, *host, input.input()),
            Entry::Sent(now, host, to, packet) => recorder.sent(*now, *host, *to, packet),
            Entry::Lost(now) => recorder.lost(*now),
        }
        shared.waiting.fetch_sub(entry.len(), Ordering::Relaxed);
        if recorder.failed() {
            shared.failed.store(true, Ordering::Relaxed);
        }
    }
    recorder.finish()
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use rules::League;

    use super::*;
    use crate::HostSettings;
    use crate::record::header::RecordingHeader;
    use crate::record::trace::{Reader, RecordKind, TraceEnd};

    fn recorder(name: &str) -> (Recorder, PathBuf) {
        let stem = std::env::temp_dir().join(format!("onetwo-{name}-{}", std::process::id()));
        let settings = HostSettings::new(Colour::Blue, League::DivisionB, 1);
        (Recorder::begin(&stem, &RecordingHeader::of(&settings)).unwrap(), stem)
    }

    fn read(stem: &std::path::Path) -> (Vec<RecordKind>, Option<TraceEnd>) {
        let [log, trace] = Recorder::files(stem);
        let bytes = flate2::read::MultiGzDecoder::new(std::fs::File::open(&trace).unwrap());
        let mut reader = Reader::new(bytes).unwrap();
        let kinds = reader.by_ref().map(|record| record.kind).collect();
        let end = reader.end().cloned();
        for file in [log, trace] {
            std::fs::remove_file(file).unwrap();
        }
        (kinds, end)
    }

    #[test]
    fn what_is_put_in_is_on_the_disk_after_the_end() {
        let (recorder, stem) = recorder("background-whole");
        let mut background = BackgroundRecorder::start(recorder).unwrap();
        let from = SenderAddress::INTERNAL;
        for input in [Input::Vision(b"v"), Input::Referee(b"r", from), Input::Halt, Input::Timeout] {
            background.input(Instant(1), Colour::Blue, input);
        }
        background.sent(Instant(2), Colour::Blue, To::All, &Packet::from_slice(b"f").unwrap());
        assert_eq!((background.dropped(), background.trace_ended()), (0, None));
        background.finish().unwrap();
        let kinds = vec![
            RecordKind::Vision,
            RecordKind::Referee,
            RecordKind::Halt,
            RecordKind::Timeout,
            RecordKind::Sent,
        ];
        assert_eq!(read(&stem), (kinds, Some(TraceEnd::Whole)));
    }

    #[test]
    fn a_disk_that_stands_still_costs_bounded_memory_and_ends_the_trace_with_a_mark() {
        let (recorder, stem) = recorder("background-full");
        let room = 100_000;
        // No thread takes anything: a disk that blocks.
        let (queue, entries) = channel();
        let shared = Arc::new(Shared::default());
        let thread = thread::spawn(|| Ok(()));
        let mut background =
            BackgroundRecorder { queue, shared: shared.clone(), room, ended: None, dropped: 0, thread };
        for number in 0..1_000 {
            background.received(Instant(number), MessageKind::Vision2014, &[0; 1_000]);
            background.input(Instant(number), Colour::Blue, Input::Vision(&[0; 1_000]));
            assert!(background.waiting() <= room + ENTRY_LEN, "{}", background.waiting());
        }
        let ended = background.trace_ended().unwrap();
        assert!(ended.0 < 60 && background.dropped() > 1_800, "{ended:?} {}", background.dropped());
        background.finish().unwrap();
        // The disk works again: what was queued is whole, and the trace has its end mark.
        write(recorder, &entries, &shared).unwrap();
        let (kinds, end) = read(&stem);
        assert_eq!((kinds.len() as u64, end), (ended.0, Some(TraceEnd::Lost { at: ended })));
    }
}
