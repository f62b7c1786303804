//! How is a match kept? `X.log.gz` for everybody's tools, `X.trace` so that every decision can be taken again (DESIGN §7).
//!
//! The log holds the league's messages at Unix time (what the hosts' clock shows, where the header knows no Unix time); the trace
//! holds what came to each host and what it sent, at its own clock.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use flate2::Compression;
use flate2::write::GzEncoder;
use protocol::Instant;
use rules::Colour;
use ssl::log::{LogWriter, MessageKind, Sink};

use crate::Input;
use crate::radio::To;
use crate::recording::RecordingHeader;
use crate::trace::{Kind, Writer};

/// Both files while they are written. The first error ends the writing, not the match; [`Recorder::finish`] tells it.
pub struct Recorder {
    files: Option<Files>,
    zero_unix_ns: i64,
    hosts: Vec<Option<Colour>>,
    error: Option<io::Error>,
}

struct Files {
    log: LogWriter<Sink>,
    trace: Writer<GzEncoder<BufWriter<File>>>,
}

impl Recorder {
    /// Begins `stem`.log.gz and `stem`.trace, with that header.
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

    /// A league message stood on the network, for everybody to hear: vision, referee or a tracker's.
    pub fn heard(&mut self, now: Instant, kind: MessageKind, bytes: &[u8]) {
        let at_ns = self.zero_unix_ns.saturating_add((now.0 as i64).saturating_mul(1000));
        self.write(|files| files.log.write(at_ns, kind, bytes));
    }

    /// Something came to the host of that colour.
    pub fn input(&mut self, now: Instant, host: Colour, input: Input<'_>) {
        let sender;
        let (kind, bytes): (Kind, [&[u8]; 2]) = match input {
            Input::Vision(bytes) => (Kind::Vision, [&[], bytes]),
            Input::Referee(bytes, from) => {
                sender = from.to_bytes();
                (Kind::Referee, [&sender, bytes])
            }
            Input::Robot(bytes) => (Kind::Robot, [&[], bytes]),
            Input::Halt => (Kind::Halt, [&[], &[]]),
            Input::Timeout => (Kind::Timeout, [&[], &[]]),
        };
        let host = self.number(host);
        self.write(|files| files.trace.write(now, host, kind, &bytes));
    }

    /// The host of that colour sent a frame.
    pub fn sent(&mut self, now: Instant, host: Colour, to: To, packet: &[u8]) {
        let to = match to {
            To::All => u8::MAX,
            To::One(robot) => robot.number(),
        };
        let host = self.number(host);
        self.write(|files| files.trace.write(now, host, Kind::Sent, &[&[to], packet]));
    }

    /// Records were lost: the trace ends here, and says so. Nothing more may be written to it.
    pub fn lost(&mut self, now: Instant) {
        self.write(|files| files.trace.write(now, 0, Kind::Lost, &[]));
    }

    /// Whether an error has ended the writing.
    pub fn failed(&self) -> bool {
        self.error.is_some()
    }

    /// Ends both files; tells the first thing that went wrong.
    pub fn finish(mut self) -> io::Result<()> {
        if let Some(error) = self.error {
            return Err(error);
        }
        if let Some(files) = self.files.take() {
            files.log.close()?;
            files.trace.into_inner().finish()?.flush()?;
        }
        Ok(())
    }

    /// The number that records of that host have: its place in the header.
    fn number(&self, host: Colour) -> u8 {
        self.hosts.iter().position(|colour| *colour == Some(host)).unwrap_or(0) as u8
    }

    fn write(&mut self, write: impl FnOnce(&mut Files) -> io::Result<()>) {
        if let Some(files) = &mut self.files
            && let Err(error) = write(files)
        {
            self.error = Some(error);
            self.files = None;
        }
    }
}
