//! `trace_file`: an open trace: its header, its records in order, and how it ends. Gzipped or not.

use std::fs::File;
use std::io::{BufReader, Read};
use std::path::Path;

use flate2::bufread::MultiGzDecoder;
use host::Host;
use host::record::header::RecordingHeader;
use host::record::recheck::Recheck;
use host::record::trace::{Reader, Record, RecordKind};
use protocol::frame::TeamKey;
use rules::League;

use super::ReadObserver;
use super::failure::{RecordedError, RecordingFailure, in_file};

/// The first bytes of every trace.
const TRACE: &[u8] = b"ONETWO_TRACE";

/// A trace whose header is read.
pub struct TraceFile<'f> {
    file: &'f Path,
    reader: Reader<Box<dyn Read>>,
    /// Settings of the hosts, as the recording program wrote them.
    pub header: RecordingHeader,
    /// The league of the match.
    pub league: League,
}

impl<'f> TraceFile<'f> {
    /// Opens a trace; any other file is refused.
    pub fn open(file: &'f Path) -> Result<Self, RecordingFailure> {
        let reader = Reader::new(open(file)?).map_err(in_file(file))?;
        let header = RecordingHeader::from_json(reader.header()).map_err(in_file(file))?;
        let league = header.league().map_err(in_file(file))?;
        Ok(Self { file, reader, header, league })
    }

    /// The path that it was opened by.
    pub const fn file(&self) -> &'f Path {
        self.file
    }

    /// Version of the file format.
    pub const fn version(&self) -> u32 {
        self.reader.version
    }

    /// Whether referees' records name their senders.
    pub const fn has_senders(&self) -> bool {
        self.reader.has_senders()
    }

    /// The hosts of the recording, to be fed with its records; sealed frames are opened with the key in
    /// `key_file`.
    pub fn recheck(
        &self,
        key_file: Option<&Path>,
        observer: &dyn ReadObserver,
    ) -> Result<Recheck, RecordingFailure> {
        let key = match key_file {
            Some(file) => {
                let read = host::shell::key::read(file).map_err(in_file(file))?;
                if let Some(warning) = read.warning {
                    observer.note(&format!("warning: {warning}"));
                }
                read.key
            }
            None if self.header.hosts.iter().any(|host| host.keyed) => {
                return Err(in_file(self.file)(RecordedError::NoKey));
            }
            None => TeamKey::ZERO,
        };
        Recheck::new(&self.header, key).map_err(in_file(self.file))
    }

    /// Place where the file is cut or damaged, once all of its records were read.
    pub fn damage(&self) -> Option<String> {
        self.reader.end().filter(|end| !end.is_whole()).map(ToString::to_string)
    }

    /// Place where it is cut or damaged, or breaks off unnoticed: a trace that is not compressed has no end
    /// mark. If packets to robots are missing after its last input, it was cut there: the hosts' decisions
    /// all come before.
    pub fn cut(&self, recheck: &Recheck) -> Result<Option<String>, RecordingFailure> {
        let unfinished = !is_gzipped(self.file)? && recheck.is_unfinished();
        Ok(self.damage().or_else(|| {
            unfinished.then(|| {
                "cut after its last input: the packets that followed are missing; all before was read"
                    .to_owned()
            })
        }))
    }
}

impl Iterator for TraceFile<'_> {
    type Item = Record;

    fn next(&mut self) -> Option<Record> {
        self.reader.next()
    }
}

/// True if a file begins as every trace does.
pub fn begins_as_trace(file: &Path) -> Result<bool, RecordingFailure> {
    Ok(begin(file)?.starts_with(TRACE))
}

/// The first bytes of a file, gunzipped where it is gzipped.
pub(super) fn begin(file: &Path) -> Result<Vec<u8>, RecordingFailure> {
    let mut begin = Vec::new();
    // Errors of decompression are reported by the reader of log files.
    let _ = open(file)?.take(TRACE.len() as u64).read_to_end(&mut begin);
    Ok(begin)
}

/// Every host of the recording in its current state.
pub fn hosts_of(recheck: &Recheck) -> Vec<&Host> {
    (0..).map_while(|number| recheck.host(number)).collect()
}

/// Name of a kind of record in reports.
pub fn record_label(kind: RecordKind) -> &'static str {
    match kind {
        RecordKind::Vision => "vision",
        RecordKind::Referee => "referee",
        RecordKind::Robot => "robots",
        RecordKind::Timeout => "deadlines",
        RecordKind::Sent => "sent",
        RecordKind::Halt => "halts",
        RecordKind::Orders => "strategy",
        RecordKind::Parameter => "parameters",
        RecordKind::Test => "tests",
        RecordKind::Lost => "lost",
    }
}

/// A file's bytes, gunzipped where they are gzipped.
fn open(file: &Path) -> Result<Box<dyn Read>, RecordingFailure> {
    Ok(if is_gzipped(file)? { Box::new(MultiGzDecoder::new(bytes(file)?)) } else { Box::new(bytes(file)?) })
}

fn bytes(file: &Path) -> Result<BufReader<File>, RecordingFailure> {
    foreign::open(file).map(BufReader::new).map_err(RecordedError::Open).map_err(in_file(file))
}

/// True if a file is gzipped: then it has an end mark, without which it is cut.
fn is_gzipped(file: &Path) -> Result<bool, RecordingFailure> {
    let mut begin = [0; 2];
    Ok(bytes(file)?.read_exact(&mut begin).is_ok() && begin == [0x1f, 0x8b])
}
