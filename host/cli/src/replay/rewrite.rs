//! `rewrite`: writes league log files: a part cut out of a recording, or several recordings joined.

use std::ops::Range;
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

/// Which parts of which files are written.
#[derive(Debug, Args)]
pub(super) struct RewriteArgs {
    /// Write the packets from FROM to before TO, seconds as --at counts them, to the league log file --out.
    #[arg(long, num_args = 2, value_names = ["FROM", "TO"], value_parser = moment_in_seconds, requires = "out",
        conflicts_with_all = ["watch", "at", "event", "problems", "team", "check", "compare", "json", "join", "export"])]
    cut: Option<Vec<f64>>,
    /// Append the packets of these recordings to those of FILE and write them to the league log file --out;
    /// one that starts before the end of the one before it is shifted to 1 s after that.
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
    #[error("--cut {0} {1}: FROM must be less than TO, in seconds")]
    Reversed(f64, f64),
    #[error("{}: the name of a league log file must end in .log or .log.gz", printable_path(.0))]
    Name(PathBuf),
}

/// The log file that is written; it is created with its first packet.
struct Output<'o> {
    file: &'o Path,
    writer: Option<LogWriter<Sink>>,
    packets: u64,
    /// Unix times of the first packet and of the latest, ns.
    span_ns: (i64, i64),
    /// The first damaged input, and its damage.
    damage: Option<(PathBuf, String)>,
}

pub(super) fn run(args: &ReplayArgs, out: &Path) -> Result<ExitCode, Failure> {
    let (from_s, to_s) = match args.rewrite.cut.as_deref() {
        Some(&[from_s, to_s]) => (from_s, to_s),
        _ => (0.0, f64::INFINITY),
    };
    if from_s >= to_s {
        return Err(RewriteError::Reversed(from_s, to_s).into());
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
    let mut output = Output { file: out, writer: None, packets: 0, span_ns: (0, 0), damage: None };
    let bar = Progress::open();
    let mut end_s = 0.0;
    for file in files {
        end_s = output.append(file, from_s..to_s, &bar)?;
    }
    drop(bar);
    let Some(writer) = output.writer else {
        let error = if args.rewrite.cut.is_some() {
            let asked = format!("it holds no packet from {from_s} s to {to_s} s; it ends after {end_s:.3} s");
            RecordedError::NotThere { asked, damage: output.damage.map(|(_, damage)| damage) }
        } else {
            RecordedError::Empty
        };
        return Err(in_file(&args.file)(error).into());
    };
    writer.close().map_err(DestinationError::at(out))?;
    let span_s = output.span_ns.1.saturating_sub(output.span_ns.0) as f64 * 1e-9;
    print_text(&format!("{}: {} packets, {span_s:.3} s\n", printable_path(out), output.packets))?;
    match output.damage {
        Some((file, damage)) => Err(in_file(&file)(RecordedError::Damaged(damage)).into()),
        None => Ok(ExitCode::SUCCESS),
    }
}

impl Output<'_> {
    /// Writes a file's packets of these seconds; returns the time of the last one read, s.
    fn append(&mut self, file: &Path, seconds: Range<f64>, bar: &Progress) -> Result<f64, Failure> {
        let mut packets = LeaguePackets::open(file)?;
        let (mut shift_ns, mut last_s) = (None, 0.0);
        for packet in packets.by_ref() {
            bar.add(1);
            last_s = packet.at.0 as f64 * 1e-6;
            if last_s < seconds.start {
                continue;
            }
            if last_s >= seconds.end {
                break;
            }
            let shift_ns = *shift_ns.get_or_insert_with(|| self.shift_ns(file, packet.unix_ns));
            let unix_ns = packet.unix_ns.saturating_add(shift_ns);
            if self.packets == 0 {
                self.span_ns = (unix_ns, unix_ns);
                self.writer = Some(LogWriter::create(self.file).map_err(DestinationError::at(self.file))?);
            }
            if let Some(writer) = &mut self.writer {
                let written = writer.write(unix_ns, packet.kind, &packet.bytes);
                written.map_err(DestinationError::at(self.file))?;
            }
            self.packets += 1;
            self.span_ns.1 = self.span_ns.1.max(unix_ns);
        }
        if self.damage.is_none() {
            self.damage = packets.damage().map(|damage| (file.to_owned(), damage));
        }
        Ok(last_s)
    }

    /// Time by which a file that starts at `unix_ns` is shifted to follow what is written, ns.
    fn shift_ns(&self, file: &Path, unix_ns: i64) -> i64 {
        if self.packets == 0 || unix_ns >= self.span_ns.1 {
            return 0;
        }
        let shift_ns = self.span_ns.1.saturating_add(JOIN_GAP_NS).saturating_sub(unix_ns);
        let shift_s = shift_ns as f64 * 1e-9;
        note!(
            "{} starts before the end of the file before it: shifted by {shift_s:.3} s",
            printable_path(file)
        );
        shift_ns
    }
}

/// Gap before a joined file that is shifted, ns: trackers see a pause, not robots that jump.
const JOIN_GAP_NS: i64 = 1_000_000_000;
