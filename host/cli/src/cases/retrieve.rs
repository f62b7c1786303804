//! `onetwo cases retrieve`: the case that fits each situation. Problems in on stdin, answers out on stdout,
//! one a line (docs/case-format.md §5.1).

use std::io::stdin;
use std::process::ExitCode;

use arena::cases::{Answer, write_line};
use clap::Args;

use super::lines::for_each_problem;
use crate::Failure;
use crate::args::{LibraryArgs, SettingsArgs};
use crate::output;

/// Arguments of `cases retrieve`.
#[derive(Debug, Args)]
pub(crate) struct RetrieveArgs {
    #[command(flatten)]
    library: LibraryArgs,
    #[command(flatten)]
    settings: SettingsArgs,
}

pub(super) fn run(args: &RetrieveArgs) -> Result<ExitCode, Failure> {
    let chosen = args.settings.choose()?;
    let library_handle = crate::library::open(&args.library)?;
    let base = library_handle.base();
    let mut output = output::lines();
    for_each_problem(stdin().lock(), &mut output, |output, _, problem| match problem {
        Ok(problem) => {
            let retrieval = casebase::retrieve(&base, &problem, &chosen.settings);
            write_line(output, &Answer::new(&library_handle, &base, &problem, &chosen, &retrieval))
        }
        Err(error) => write_line(output, &Answer::Malformed { error }),
    })?;
    Ok(ExitCode::SUCCESS)
}
