//! `recorder`: recording of a match: `X.log.gz` for the league's tools, `X.trace` for replaying every
//! decision (docs/architecture.md §7.4).
//!
//! Inputs and packets of one second of the match are in the files when the next second starts: a program that
//! is killed loses no more. Seconds are counted on the hosts' clock, so that the files of equal matches are
//! equal.
//!
//! The log holds the league's messages at Unix time (or at the hosts' clock, where the header has no Unix
//! time); the trace holds each host's inputs and packets, at its own clock.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use flate2::Compression;
use flate2::write::GzEncoder;
use protocol::{Duration, Instant};
use rules::Colour;
use ssl::log::{LogWriter, MessageKind, Sink};

use crate::Input;
use crate::radio::To;
use crate::record::header::RecordingHeader;
use crate::record::trace::{RecordKind, Writer};

/// One flush after the other, of both files. A flush ends a block of the compressed stream: at this interval
/// it costs 0.2 % of a log's bytes and 0.04 % of a trace's (a match of twelve robots; the tests below hold it
/// under 3 %).
const FLUSH_EVERY: Duration = Duration::millis(1_000);

/// Both files while they are written. The first error ends the writing, not the match; [`Recorder::finish`]
/// returns it.
pub struct Recorder {
    files: Option<Files>,
    zero_unix_ns: i64,
    hosts: Vec<Option<Colour>>,
    error: Option<io::Error>,
    /// When the files are flushed next.
    flush_due: Instant,
}

struct Files {
    log: LogWriter<Sink>,
    trace: Writer<GzEncoder<BufWriter<File>>>,
}

impl Files {
    /// Everything so far, as far as the system.
    fn flush(&mut self) -> io::Result<()> {
        self.log.flush()?;
        self.trace.flush()
    }
}

impl Recorder {
    /// Starts `stem`.log.gz and `stem`.trace, with that header.
    pub fn begin(stem: &Path, header: &RecordingHeader) -> io::Result<Self> {
        let [log, trace] = Self::files(stem);
        let log = LogWriter::create(&log)?;
        let trace = GzEncoder::new(BufWriter::new(File::create(trace)?), Compression::fast());
        let trace = Writer::new(trace, &header.to_json())?;
        Ok(Self {
            files: Some(Files { log, trace }),
            zero_unix_ns: (header.zero_unix_us.unwrap_or(0) as i64).saturating_mul(1000),
            hosts: header.hosts.iter().map(|host| host.colour().ok()).collect(),
            error: None,
            flush_due: Instant(0),
        })
    }

    /// The two files of a recording of that name.
    pub fn files(stem: &Path) -> [PathBuf; 2] {
        [".log.gz", ".trace"].map(|ending| {
            let mut name = stem.as_os_str().to_owned();
            name.push(ending);
            name.into()
        })
    }

    /// A league message was on the network: vision, referee or a tracker's.
    pub fn received(&mut self, now: Instant, kind: MessageKind, bytes: &[u8]) {
        let at_ns = self.zero_unix_ns.saturating_add((now.0 as i64).saturating_mul(1000));
        self.write(now, |files| files.log.write(at_ns, kind, bytes));
    }

    /// Something came to the host of that colour.
    pub fn input(&mut self, now: Instant, host: Colour, input: Input<'_>) {
        let sender;
        let (kind, bytes): (RecordKind, [&[u8]; 2]) = match input {
            Input::Vision(bytes) => (RecordKind::Vision, [&[], bytes]),
            Input::Referee(bytes, from) => {
                sender = from.to_bytes();
                (RecordKind::Referee, [&sender, bytes])
            }
            Input::Robot(bytes) => (RecordKind::Robot, [&[], bytes]),
            Input::Orders(line) => (RecordKind::Orders, [&[], line]),
            Input::Parameter(json) => (RecordKind::Parameter, [&[], json]),
            Input::Test(json) => (RecordKind::Test, [&[], json]),
            Input::Halt => (RecordKind::Halt, [&[], &[]]),
            Input::Timeout => (RecordKind::Timeout, [&[], &[]]),
        };
        let host = self.number(host);
        self.write(now, |files| files.trace.write(now, host, kind, &bytes));
    }

    /// The host of that colour sent a frame.
    pub fn sent(&mut self, now: Instant, host: Colour, to: To, packet: &[u8]) {
        let to = match to {
            To::All => u8::MAX,
            To::One(robot) => robot.number(),
        };
        let host = self.number(host);
        self.write(now, |files| files.trace.write(now, host, RecordKind::Sent, &[&[to], packet]));
    }

    /// Records were lost: the trace ends here with a mark for it. Nothing more may be written to it.
    pub fn lost(&mut self, now: Instant) {
        self.write(now, |files| files.trace.write(now, 0, RecordKind::Lost, &[]));
    }

    /// Whether an error has ended the writing.
    pub fn failed(&self) -> bool {
        self.error.is_some()
    }

    /// Closes both files; returns the first error.
    pub fn finish(mut self) -> io::Result<()> {
        if let Some(error) = self.error {
            return Err(error);
        }
        if let Some(files) = self.files.take() {
            files.log.close()?;
            files.trace.finish()?.finish()?.flush()?;
        }
        Ok(())
    }

    /// The number that records of that host have: its place in the header.
    fn number(&self, host: Colour) -> u8 {
        self.hosts.iter().position(|colour| *colour == Some(host)).unwrap_or(0) as u8
    }

    fn write(&mut self, now: Instant, write: impl FnOnce(&mut Files) -> io::Result<()>) {
        let Some(files) = &mut self.files else { return };
        let flushed = if now >= self.flush_due {
            self.flush_due = now + FLUSH_EVERY;
            files.flush()
        } else {
            Ok(())
        };
        if let Err(error) = flushed.and_then(|()| write(files)) {
            self.error = Some(error);
            self.files = None;
        }
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use flate2::bufread::MultiGzDecoder;
    use protocol::RobotId;
    use rules::League;

    use super::*;
    use crate::HostSettings;
    use crate::record::trace::{Reader, TraceEnd};

    /// Packets of the cameras and the referee of a real game, with their times.
    fn packets() -> Vec<(Instant, MessageKind, Vec<u8>)> {
        let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../protocol/ssl/tests/data");
        let log = ssl::log::open(&data.join("erforce_divB_realistic_22s.log.gz")).unwrap();
        let mut began = None;
        log.map(|record| {
            let since = record.timestamp_ns - *began.get_or_insert(record.timestamp_ns);
            (Instant(u64::try_from(since).unwrap_or(0) / 1000), record.kind, record.payload)
        })
        .collect()
    }

    fn begin(name: &str) -> (Recorder, PathBuf) {
        let settings = HostSettings::new(Colour::Blue, League::DivisionB, 7);
        let header = RecordingHeader::of(&settings);
        let stem = std::env::temp_dir().join(format!("onetwo-recorder-{}-{name}", std::process::id()));
        (Recorder::begin(&stem, &header).unwrap(), stem)
    }

    /// As a host with six robots records a packet: in, and a frame to each robot, which no compression makes
    /// shorter.
    fn record(recorder: &mut Recorder, now: Instant, kind: MessageKind, bytes: &[u8], noise: &mut u64) {
        recorder.received(now, kind, bytes);
        match kind {
            MessageKind::Vision2014 => recorder.input(now, Colour::Blue, Input::Vision(bytes)),
            MessageKind::Refbox2013 => recorder.input(
                now,
                Colour::Blue,
                Input::Referee(bytes, crate::referee::SenderAddress::INTERNAL),
            ),
            _ => return,
        }
        for robot in RobotId::all().take(6) {
            let mut frame = [0; 40];
            for byte in &mut frame[8..] {
                *noise =
                    noise.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                *byte = (*noise >> 56) as u8;
            }
            recorder.sent(now, Colour::Blue, To::One(robot), &frame);
        }
    }

    fn remove(stem: &Path) {
        for file in Recorder::files(stem) {
            fs::remove_file(file).unwrap();
        }
    }

    #[test]
    fn whatever_moment_a_recording_ends_at_its_files_hold_all_but_the_last_second() {
        let (mut recorder, stem) = begin("killed");
        let [log_file, trace_file] = Recorder::files(&stem);
        let (mut noise, mut looked, mut seconds) = (1, 0, 0);
        for (now, kind, bytes) in packets() {
            record(&mut recorder, now, kind, &bytes, &mut noise);
            if now.0 / 730_000 == looked {
                continue;
            }
            looked = now.0 / 730_000;
            seconds += 1;
            // Read while it is written: the file that a kill at this moment would leave.
            let within = |at: u64| at + FLUSH_EVERY.0 + 50_000 >= now.0;
            let trace = fs::read(&trace_file).unwrap();
            let mut reader = Reader::new(MultiGzDecoder::new(&trace[..])).unwrap();
            let last = reader.by_ref().last().map_or(0, |record| record.at.0);
            assert!(within(last), "trace: {last} of {} µs", now.0);
            assert!(matches!(reader.end(), Some(TraceEnd::Cut { .. })), "{:?}", reader.end());
            let mut log = ssl::log::open(&log_file).unwrap();
            let last = log.by_ref().last().map_or(0, |record| record.timestamp_ns / 1000);
            assert!(within(last as u64), "log: {last} of {} µs", now.0);
            assert!(!log.end().unwrap().is_whole());
        }
        assert!(seconds > 20, "{seconds}");
        recorder.finish().unwrap();
        let trace = fs::read(&trace_file).unwrap();
        let mut reader = Reader::new(MultiGzDecoder::new(&trace[..])).unwrap();
        assert!(reader.by_ref().count() > 1000);
        assert_eq!(reader.end(), Some(&TraceEnd::Whole));
        remove(&stem);
    }

    #[test]
    fn a_flush_every_second_costs_few_bytes() {
        let sizes = [true, false].map(|flushes| {
            let (mut recorder, stem) = begin(if flushes { "flushed" } else { "whole" });
            let mut noise = 1;
            for (now, kind, bytes) in packets() {
                if !flushes {
                    recorder.flush_due = Instant(u64::MAX);
                }
                record(&mut recorder, now, kind, &bytes, &mut noise);
            }
            recorder.finish().unwrap();
            let sizes = Recorder::files(&stem).map(|file| fs::metadata(file).unwrap().len() as f64);
            remove(&stem);
            sizes
        });
        let [log, trace] = [0, 1].map(|file| sizes[0][file] / sizes[1][file]);
        println!("with a flush a second a log has {log:.4} of its bytes without, a trace {trace:.4}");
        assert!((0.99..1.03).contains(&log) && (0.99..1.03).contains(&trace), "{log} {trace}");
    }
}
