//! How is a match kept? `X.log.gz` for everybody's tools, `X.trace` so that every decision can be taken again (DESIGN §7).

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use flate2::Compression;
use flate2::write::GzEncoder;
use host::radio::To;
use host::recording::{HostHeader, RecordingHeader};
use host::trace::{Kind, Writer};
use host::{HostSettings, Input};
use protocol::Instant;
use rules::Colour;
use ssl::log::{LogWriter, MessageKind, Sink};

use super::Watcher;

/// Writes both files while a match is played. An error ends the writing, not the match; [`GameRecording::finish`] tells it.
pub struct GameRecording {
    log: LogWriter<Sink>,
    trace: Writer<GzEncoder<BufWriter<File>>>,
    colours: Vec<Colour>,
    error: Option<io::Error>,
}

impl GameRecording {
    /// Begins `stem`.log.gz and `stem`.trace.
    pub fn begin(stem: &Path, header: &RecordingHeader, hosts: &[&HostSettings]) -> io::Result<Self> {
        let [log, trace] = Self::files(stem);
        let log = LogWriter::create(&log)?;
        let trace = GzEncoder::new(BufWriter::new(File::create(trace)?), Compression::default());
        let trace = Writer::new(trace, &header.to_json())?;
        Ok(Self { log, trace, colours: hosts.iter().map(|host| host.us).collect(), error: None })
    }

    /// The two files of a recording of that name.
    pub fn files(stem: &Path) -> [PathBuf; 2] {
        ["log.gz", "trace"].map(|ending| {
            let mut name = stem.as_os_str().to_owned();
            name.push(".");
            name.push(ending);
            PathBuf::from(name)
        })
    }

    /// Ends both files.
    pub fn finish(mut self) -> io::Result<()> {
        if let Some(error) = self.error.take() {
            return Err(error);
        }
        self.log.close()?;
        self.trace.into_inner().finish()?.flush()
    }

    fn number(&self, host: Colour) -> u8 {
        self.colours.iter().position(|colour| *colour == host).unwrap_or(0) as u8
    }

    fn note(&mut self, done: io::Result<()>) {
        if let Err(error) = done {
            self.error.get_or_insert(error);
        }
    }
}

impl Watcher for GameRecording {
    fn vision(&mut self, now: Instant, bytes: &[u8]) {
        let done = self.log.write(now.0 as i64 * 1000, MessageKind::Vision2014, bytes);
        self.note(done);
    }

    fn referee(&mut self, now: Instant, bytes: &[u8]) {
        let done = self.log.write(now.0 as i64 * 1000, MessageKind::Refbox2013, bytes);
        self.note(done);
    }

    fn input(&mut self, now: Instant, host: Colour, input: Input<'_>) {
        let (kind, bytes): (Kind, &[u8]) = match input {
            Input::Vision(bytes) => (Kind::Vision, bytes),
            Input::Referee(bytes) => (Kind::Referee, bytes),
            Input::Robot(bytes) => (Kind::Robot, bytes),
            Input::Timeout => (Kind::Timeout, &[]),
        };
        let done = self.trace.write(now, self.number(host), kind, &[bytes]);
        self.note(done);
    }

    fn sent(&mut self, now: Instant, host: Colour, to: To, packet: &[u8]) {
        let to = match to {
            To::All => 255,
            To::One(robot) => robot.number(),
        };
        let done = self.trace.write(now, self.number(host), Kind::Sent, &[&[to], packet]);
        self.note(done);
    }
}

/// The header of a match's recording.
pub fn header(
    version: &str,
    commit: &str,
    seed: u64,
    league: &str,
    hosts: &[&HostSettings],
) -> RecordingHeader {
    RecordingHeader {
        version: version.to_owned(),
        commit: commit.to_owned(),
        seed: Some(seed),
        league: league.to_owned(),
        zero_unix_us: None,
        hosts: hosts
            .iter()
            .map(|host| {
                HostHeader::new((host.us, host.keeper, host.defending), &host.kick, &host.radio, Instant(0))
            })
            .collect(),
    }
}
