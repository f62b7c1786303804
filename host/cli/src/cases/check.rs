//! Is a library sound? Every error and warning as `file:line: error[CODE]: message; mend`, then one line of summary a
//! league (DESIGN §4.1). Exit 1 on errors, and with `--strict` on warnings.

use std::io::{self, BufWriter, Write, stdout};
use std::path::Path;
use std::process::ExitCode;

use case_library::LEAGUES;
use case_tools::{Finding, Severity};
use clap::Args;

use crate::Failure;
use crate::args::FolderArgs;

/// What `cases check` may be told.
#[derive(Debug, Args)]
pub(crate) struct CheckArgs {
    #[command(flatten)]
    folder: FolderArgs,
    /// Warnings fail too.
    #[arg(long)]
    strict: bool,
}

pub(super) fn run(args: &CheckArgs) -> Result<ExitCode, Failure> {
    let reports = match &args.folder.library {
        Some(folder) => vec![Report::of(folder)?],
        None => built_in(),
    };
    let mut output = BufWriter::new(stdout().lock());
    let written = reports.iter().try_for_each(|report| report.write(&mut output));
    written.and_then(|()| output.flush()).map_err(Failure::Output)?;
    let fails = |finding: &Finding| args.strict || finding.severity == Severity::Error;
    let failed = reports.iter().flat_map(|report| &report.findings).any(fails);
    Ok(if failed { ExitCode::FAILURE } else { ExitCode::SUCCESS })
}
