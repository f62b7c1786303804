//! `rewrite`: parts of recordings as new league log files: one cut out of a longer one, several joined.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Args;
use feed::recording::{LeaguePackets, RecordedError, in_file};
use foreign::printable_path;
use ssl::log::{LogWriter, Sink};
use thiserror::Error;

use super::ReplayArgs;
use crate::Failure;
use crate::args::parsers::moment_in_seconds;
use crate::destination::{self, DestinationError, FileKind};
use crate::output::{note, print_text};
use crate::progress::Progress;

/// What of which files is written.
#[derive(Debug, Args)]
pub(super) struct RewriteArgs {
    /// Write the packets from FROM to before TO, seconds as --at counts them, to the league log file --out.
    #[arg(long, num_args = 2, value_names = ["FROM", "TO"], value_parser = moment_in_seconds, requires = "out",
        conflicts_with_all = ["watch", "at", "event", "problems", "team", "check", "compare", "json", "join", "export"])]
    cut: Option<Vec<f64>>,
    /// Write the packets of FILE, then those of these recordings, to the league log file --out; one that
    /// begins before the end of the one before it is moved to 1 s after it.
    #[arg(long, num_args = 1.., value_name = "FILE", requires = "out",
        conflicts_with_all = ["watch", "at", "event", "problems", "team", "check", "compare", "json", "export"])]
    join: Option<Vec<PathBuf>>,
}

impl RewriteArgs {
    /// Whether a log file is to be written.
    pub(super) const fn is_wanted(&self) -> bool {
        self.cut.is_some() || self.join.is_some()
    }
}

/// Why no log file is written.
#[derive(Debug, Error)]
enum RewriteError {
    #[error("--cut {0} {1}: FROM has to be less than TO, in seconds")]
    Backwards(f64, f64),
    #[error("{}: a league log file is called .log or .log.gz; name it so", printable_path(.0))]
    Name(PathBuf),
}

/// What was written.
struct Written {
    writer: LogWriter<Sink>,
    packets: u64,
    /// Of the first and the last packet, ns.
    span_ns: (i64, i64),
    damage: Option<(PathBuf, String)>,
}

pub(super) fn run(args: &ReplayArgs, out: &Path) -> Result<ExitCode, Failure> {
    let (from_s, to_s) = match args.rewrite.cut.as_deref() {
        Some(&[from_s, to_s]) => (from_s, to_s),
        _ => (0.0, f64::INFINITY),
    };
    if from_s >= to_s {
        return Err(RewriteError::Backwards(from_s, to_s).into());
    }
    let name = out.file_name().map(|name| name.to_string_lossy().to_lowercase()).unwrap_or_default();
    if ![".log", ".log.gz"].iter().any(|ending| name.ends_with(ending)) {
        return Err(RewriteError::Name(out.to_owned()).into());
    }
    let files: Vec<&Path> =
        std::iter::once(&args.file).chain(args.rewrite.join.iter().flatten()).map(PathBuf::as_path).collect();
    destination::check(&[(out, FileKind::LeagueLog)], &files)?;
    // A file that cannot be read is reported before anything is written.
    for file in &files {
        LeaguePackets::open(file)?;
    }
    let (bar, mut written) = (Progress::open(), None);
    for file in files {
        let mut packets = LeaguePackets::open(file)?;
        let mut moved_ns: Option<i64> = None;
        let mut last_us = 0;
        for packet in packets.by_ref() {
            bar.add(1);
            last_us = packet.at.0;
            let at_s = last_us as f64 * 1e-6;
            if at_s < from_s {
                continue;
            }
            if at_s >= to_s {
                break;
            }
            let written = match &mut written {
                Some(written) => written,
                None => written.insert(Written::begin(out, packet.unix_ns)?),
            };
            let moved_ns = *moved_ns.get_or_insert_with(|| written.make_room(file, packet.unix_ns));
            let unix_ns = packet.unix_ns.saturating_add(moved_ns);
            written.writer.write(unix_ns, packet.kind, &packet.bytes).map_err(DestinationError::at(out))?;
            written.packets += 1;
            written.span_ns.1 = written.span_ns.1.max(unix_ns);
        }
        let damage = packets.damage();
        match &mut written {
            Some(written) if damage.is_some() => {
                written.damage = written.damage.take().or(damage.map(|damage| (file.to_owned(), damage)));
            }
            None if args.rewrite.cut.is_some() => {
                let end_s = last_us as f64 * 1e-6;
                let asked =
                    format!("it holds no packet from {from_s} s to {to_s} s; it ends after {end_s:.3} s");
                return Err(in_file(file)(RecordedError::NotThere { asked, damage }).into());
            }
            _ => {}
        }
    }
    drop(bar);
    let Some(written) = written else { return Err(in_file(&args.file)(RecordedError::Empty).into()) };
    let Written { writer, packets, span_ns, damage } = written;
    writer.close().map_err(DestinationError::at(out))?;
    let span_s = span_ns.1.saturating_sub(span_ns.0) as f64 * 1e-9;
    print_text(&format!("{}: {packets} packets, {span_s:.3} s\n", printable_path(out)))?;
    match damage {
        Some((file, damage)) => Err(in_file(&file)(RecordedError::Damaged(damage)).into()),
        None => Ok(ExitCode::SUCCESS),
    }
}

impl Written {
    fn begin(out: &Path, unix_ns: i64) -> Result<Self, DestinationError> {
        let writer = LogWriter::create(out).map_err(DestinationError::at(out))?;
        Ok(Self { writer, packets: 0, span_ns: (unix_ns, unix_ns), damage: None })
    }

    /// Time, ns, by which a file that begins at `unix_ns` has to be moved so that it follows what is written.
    fn make_room(&self, file: &Path, unix_ns: i64) -> i64 {
        if self.packets == 0 || unix_ns >= self.span_ns.1 {
            return 0;
        }
        let moved_ns = self.span_ns.1.saturating_add(JOIN_GAP_NS).saturating_sub(unix_ns);
        let moved_s = moved_ns as f64 * 1e-9;
        note!("{} begins before the end of what it follows: moved by {moved_s:.3} s", printable_path(file));
        moved_ns
    }
}

/// Time between two joined files of which the later begins too early, ns: trackers then see a pause, not
/// robots that jump.
const JOIN_GAP_NS: i64 = 1_000_000_000;
