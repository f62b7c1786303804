//! `onetwo cases evidence`: what became of a library's cases in recordings, and the successful plays, as one
//! `evidence.jsonl` for `cases learn --from`, `cases draft` and the page's workbench.

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Args;
use feed::recording::{OpenLibrary, collect};

use crate::Failure;
use crate::args::LibraryArgs;
use crate::destination::{self, FileKind};
use crate::library;
use crate::output::{print_text, printable_path};
use crate::progress::Progress;

/// Arguments of `cases evidence`.
#[derive(Debug, Args)]
pub(crate) struct EvidenceArgs {
    /// Recordings: traces (.trace), league logs (.log, .log.gz), what `trial --record` wrote, or
    /// evidence.jsonl.
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    #[command(flatten)]
    library: LibraryArgs,
    /// The file to write; beside a library's directory the workbench finds it as evidence.jsonl.
    #[arg(short, long, value_name = "FILE")]
    out: PathBuf,
    /// The key of the team that recorded a trace, if it had one: 32 hexadecimal digits in a file.
    #[arg(long, value_name = "FILE")]
    key_file: Option<PathBuf>,
}

pub(super) fn run(args: &EvidenceArgs) -> Result<ExitCode, Failure> {
    let inputs = args.files.iter().chain(&args.library.directory.library).chain(&args.key_file);
    let inputs: Vec<_> = inputs.map(PathBuf::as_path).collect();
    destination::check(&[(&args.out, FileKind::Json)], &inputs)?;
    let known = OpenLibrary::of(library::open(&args.library)?)?;
    let collected = collect(&args.files, &known, args.key_file.as_deref(), true, &Progress::open())?;
    destination::write(&args.out, FileKind::Json, collected.to_jsonl().as_bytes())?;
    let of_cases = || collected.evidence.0.iter().filter(|(key, _)| !key.case.is_empty());
    let plays: u64 = of_cases().map(|(_, counts)| counts.plays).sum();
    let to_goal: u64 = of_cases().map(|(_, counts)| counts.to_goal).sum();
    let cases: BTreeSet<&str> = of_cases().map(|(key, _)| key.case.as_str()).collect();
    let goals = collected.plays.iter().filter(|play| play.goal).count();
    print_text(&format!(
        "{}: {plays} plays of {} cases, {to_goal} to goal; {} successful plays, {goals} with a goal\n",
        printable_path(&args.out),
        cases.len(),
        collected.plays.len()
    ))?;
    Ok(ExitCode::SUCCESS)
}
