//! Keeps a match: `NAME.log.gz` for everybody's tools, `NAME.trace` so that every decision can be taken again (DESIGN §7).

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

use flate2::Compression;
use flate2::write::GzEncoder;
use host::radio::To;
use host::recording::{HostHeader, RecordingHeader};
use host::trace::{Kind, Writer};
use host::{HostSettings, Input};
use protocol::Instant;
use ssl::log::{LogWriter, MessageKind};

/// Both files while they are written. The first error ends the writing, not the match.
pub(super) struct Recorder {
    files: Option<Files>,
    zero_unix_ns: i64,
    error: Option<io::Error>,
}

type Zipped = GzEncoder<BufWriter<File>>;

struct Files {
    log: LogWriter<Zipped>,
    trace: Writer<Zipped>,
}

fn file(stem: &Path, ending: &str) -> PathBuf {
    let mut name = stem.as_os_str().to_owned();
    name.push(ending);
    name.into()
}

impl Recorder {
    /// Begins both files; the host's clock shows 0 now.
    pub(super) fn begin(stem: &Path, settings: &HostSettings) -> io::Result<Self> {
        let zero = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
        let header = RecordingHeader {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            commit: env!("ONETWO_COMMIT").to_owned(),
            seed: None,
            league: settings.league.name().to_owned(),
            zero_unix_us: Some(zero.as_micros() as u64),
            hosts: vec![HostHeader::of(settings, Instant(0))],
        };
        let zipped = |ending| -> io::Result<Zipped> {
            Ok(GzEncoder::new(BufWriter::new(File::create(file(stem, ending))?), Compression::fast()))
        };
        let trace = Writer::new(zipped(".trace")?, &header.to_json())?;
        let files = Files { log: LogWriter::new(zipped(".log.gz")?)?, trace };
        Ok(Self { files: Some(files), zero_unix_ns: zero.as_nanos() as i64, error: None })
    }

    /// Something came to the host.
    pub(super) fn input(&mut self, now: Instant, input: Input<'_>) {
        let at_ns = self.zero_unix_ns.saturating_add((now.0 as i64).saturating_mul(1000));
        self.write(|files| {
            let (kind, bytes, logged) = match input {
                Input::Vision(bytes) => (Kind::Vision, bytes, Some(MessageKind::Vision2014)),
                Input::Referee(bytes) => (Kind::Referee, bytes, Some(MessageKind::Refbox2013)),
                Input::Robot(bytes) => (Kind::Robot, bytes, None),
                Input::Timeout => (Kind::Timeout, &[][..], None),
            };
            if let Some(kind) = logged {
                files.log.write(at_ns, kind, bytes)?;
            }
            files.trace.write(now, 0, kind, &[bytes])
        });
    }

    /// Our tracker said something.
    pub(super) fn tracked(&mut self, now: Instant, bytes: &[u8]) {
        let at_ns = self.zero_unix_ns.saturating_add((now.0 as i64).saturating_mul(1000));
        self.write(|files| files.log.write(at_ns, MessageKind::Tracker2020, bytes));
    }

    /// The host sent a frame.
    pub(super) fn sent(&mut self, now: Instant, to: To, packet: &[u8]) {
        let to = match to {
            To::All => u8::MAX,
            To::One(robot) => robot.number(),
        };
        self.write(|files| files.trace.write(now, 0, Kind::Sent, &[&[to], packet]));
    }

    /// Ends both files; tells the first thing that went wrong.
    pub(super) fn finish(mut self) -> io::Result<()> {
        if let Some(error) = self.error {
            return Err(error);
        }
        if let Some(files) = self.files.take() {
            files.log.finish()?.finish()?.flush()?;
            files.trace.into_inner().finish()?.flush()?;
        }
        Ok(())
    }

    fn write(&mut self, write: impl FnOnce(&mut Files) -> io::Result<()>) {
        if let Some(files) = &mut self.files
            && let Err(error) = write(files)
        {
            eprintln!("recording  {error}: nothing more is kept; is the disk full?");
            self.error = Some(error);
            self.files = None;
        }
    }
}
