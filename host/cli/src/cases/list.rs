//! `onetwo cases list`: the stored cases and their purposes. The table, or one JSON list of all of them
//! (docs/case-format.md §5.2).

use std::io::{self, Write};
use std::process::ExitCode;

use arena::cases::LibraryHandle;
use casebase::Symmetry;
use clap::Args;
use serde::Serialize;

use crate::Failure;
use crate::args::DirectoryArgs;
use crate::output;

/// Arguments of `cases list`.
#[derive(Debug, Args)]
pub(crate) struct ListArgs {
    #[command(flatten)]
    directory: DirectoryArgs,
    /// The mirror images of the cases too, each with its id.
    #[arg(long)]
    all: bool,
    /// One JSON list instead of a table, mirror images included.
    #[arg(long)]
    json: bool,
}

pub(super) fn run(args: &ListArgs) -> Result<ExitCode, Failure> {
    let shelves = crate::library::all(args.directory.library.as_deref())?;
    let rows: Vec<Row<'_>> = shelves.iter().flat_map(rows).collect();
    let mut output = output::lines();
    let written = if args.json {
        write_json(&mut output, &rows)
    } else {
        let authored = Symmetry::Identity.label();
        let shown: Vec<_> = rows.iter().filter(|row| args.all || row.symmetry == authored).collect();
        write_table(&mut output, &shown).and_then(|()| match rows.len() - shown.len() {
            0 => Ok(()),
            copies => writeln!(output, "{} cases; --all lists their {copies} mirror images too", shown.len()),
        })
    };
    written.and_then(|()| output.flush()).map_err(Failure::Output)?;
    Ok(ExitCode::SUCCESS)
}

/// One stored case; the fields of docs/case-format.md §5.2.
#[derive(Debug, Serialize)]
struct Row<'a> {
    league: &'a str,
    id: u16,
    case: &'a str,
    symmetry: &'static str,
    region: &'a str,
    defending: &'static str,
    teammates: usize,
    opponents: usize,
}

fn rows(library_handle: &LibraryHandle) -> impl Iterator<Item = Row<'_>> {
    library_handle.base().cases().map(|case| {
        let name = library_handle.name(case.id());
        Row {
            league: library_handle.league(),
            id: case.id().0,
            case: name,
            symmetry: case.symmetry().label(),
            region: name.split_once('/').map_or(name, |(region, _)| region),
            defending: case.defending().label(),
            teammates: case.teammates(),
            opponents: case.opponents().count(),
        }
    })
}

/// A list with one case a line: for programs, and for `grep` and `diff`.
fn write_json(output: &mut impl Write, rows: &[Row<'_>]) -> io::Result<()> {
    output.write_all(b"[")?;
    for (index, row) in rows.iter().enumerate() {
        output.write_all(if index == 0 { b"\n" } else { b",\n" })?;
        serde_json::to_writer(&mut *output, row)?;
    }
    output.write_all(if rows.is_empty() { b"]\n" } else { b"\n]\n" })
}

fn write_table(output: &mut impl Write, rows: &[&Row<'_>]) -> io::Result<()> {
    let width =
        |column: fn(&Row<'_>) -> usize, least| rows.iter().map(|row| column(row)).fold(least, usize::max);
    let league = width(|row| row.league.chars().count(), "league".len());
    let case = width(|row| row.case.chars().count(), "case".len());
    writeln!(
        output,
        "{:league$}  {:>5}  {:case$}  {:8}  {:9}  {:>9}  {:>9}",
        "league", "id", "case", "symmetry", "defending", "teammates", "opponents"
    )?;
    for row in rows {
        writeln!(
            output,
            "{:league$}  {:>5}  {:case$}  {:8}  {:9}  {:>9}  {:>9}",
            row.league, row.id, row.case, row.symmetry, row.defending, row.teammates, row.opponents
        )?;
    }
    Ok(())
}
