//! `export`: a recording as a table, CSV or lines of JSON (docs/case-format.md §5.4).

use std::fs::File;
use std::io::{BufWriter, Write};
use std::process::ExitCode;

use clap::{Args, ValueEnum};
use feed::recording::{FieldSource, RecordedError, Row, Rows, columns, in_file};
use serde::Serializer as _;
use serde_json::Value;
use thiserror::Error;

use super::ReplayArgs;
use crate::Failure;
use crate::destination::{self, DestinationError, FileKind};
use crate::output::{lines, note};

/// Form of the table, and where its positions come from.
#[derive(Debug, Args)]
pub(super) struct ExportArgs {
    /// Print the tracked field, the referee and events as a table, one row per time stamp, columns with
    /// units in their names; with --out, write it to a file.
    #[arg(long, value_name = "FORM", value_enum,
        conflicts_with_all = ["watch", "at", "event", "problems", "team", "check", "compare", "json"])]
    export: Option<TableForm>,
    /// Where the positions come from: own (our tracker, on the recording's vision) or recorded (the first
    /// tracker whose packets are in the recording).
    #[arg(long, value_name = "SOURCE", value_enum, default_value = "own", requires = "export")]
    tracked: Tracked,
    /// With --tracked recorded: the tracker of this name or uuid.
    #[arg(long, value_name = "NAME", requires = "export")]
    tracker_name: Option<String>,
}

/// Form of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum TableForm {
    /// A header with the names of columns, then a line per row.
    Csv,
    /// A JSON object per row, one per line.
    Jsonl,
}

/// Where positions come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Tracked {
    Own,
    Recorded,
}

/// Why there is no table.
#[derive(Debug, Error)]
enum ExportError {
    #[error("{file}: no table: {what}")]
    Nothing { file: String, what: String },
}

impl ExportArgs {
    /// The form, where a table is wanted.
    pub(super) const fn form(&self) -> Option<TableForm> {
        self.export
    }

    fn source(&self) -> FieldSource {
        match self.tracked {
            Tracked::Own => FieldSource::Own,
            Tracked::Recorded => FieldSource::Recorded(self.tracker_name.clone()),
        }
    }
}

pub(super) fn run(args: &ReplayArgs, form: TableForm) -> Result<ExitCode, Failure> {
    let source = args.export.source();
    // Every robot of the file has its columns: they are looked up before the first row is written.
    let mut first = Rows::open(&args.file, source.clone())?;
    let mut found = 0_u64;
    let columns = columns(first.by_ref().inspect(|_| found += 1));
    if found == 0 || (args.export.tracked == Tracked::Recorded && !first.follows_tracker()) {
        let what = match source {
            FieldSource::Own => {
                "it has neither vision nor events of a referee; --tracked recorded reads packets of trackers"
                    .to_owned()
            }
            FieldSource::Recorded(_) if first.trackers.is_empty() => {
                "it has no packets of trackers; --tracked own tracks its vision".to_owned()
            }
            FieldSource::Recorded(_) => format!("no tracker of that name; it has {}", names(&first)),
        };
        return Err(ExportError::Nothing { file: foreign::printable_path(&args.file), what }.into());
    }
    let kind = if form == TableForm::Csv { FileKind::Csv } else { FileKind::Json };
    if let Some(out) = &args.out {
        destination::check(&[(out, kind)], &[&args.file])?;
    }
    let rows = Rows::open(&args.file, source)?;
    match &args.out {
        Some(out) => {
            let file = File::create(out).map_err(DestinationError::at(out))?;
            write(rows, form, &columns, BufWriter::new(file)).map_err(DestinationError::at(out))?;
        }
        None => write(rows, form, &columns, lines()).map_err(Failure::Output)?,
    }
    if args.export.tracked == Tracked::Recorded
        && first.trackers.len() > 1
        && args.export.tracker_name.is_none()
    {
        note!(
            "it has packets of several trackers, of which the first is exported: {}; choose with --tracker-name",
            names(&first)
        );
    }
    let damage = first.damage().map(RecordedError::Damaged);
    let undecodable = (first.undecodable > 0)
        .then(|| RecordedError::Damaged(format!("{} messages could not be decoded", first.undecodable)));
    match damage.or(undecodable) {
        Some(error) => Err(in_file(&args.file)(error).into()),
        None => Ok(ExitCode::SUCCESS),
    }
}

/// Trackers of a recording, for a message.
fn names(rows: &Rows<'_>) -> String {
    let names = rows.trackers.iter().map(|(uuid, name)| format!("{name} ({uuid})"));
    foreign::printable(&names.collect::<Vec<_>>().join(", ")).to_string()
}

fn write(
    rows: impl Iterator<Item = Row>,
    form: TableForm,
    columns: &[String],
    mut out: impl Write,
) -> std::io::Result<()> {
    if form == TableForm::Jsonl {
        for row in rows {
            serde_json::Serializer::new(&mut out).collect_map(row)?;
            writeln!(out)?;
        }
        return out.flush();
    }
    let mut table = csv::Writer::from_writer(out);
    table.write_record(columns)?;
    for row in rows {
        let cells: std::collections::HashMap<_, _> = row.into_iter().collect();
        table.write_record(columns.iter().map(|column| cells.get(column).map(plain).unwrap_or_default()))?;
    }
    table.flush()
}

fn plain(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}
