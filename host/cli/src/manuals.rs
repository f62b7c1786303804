//! `onetwo manuals`: manual pages and completions of the command line, for release archives (`cargo xtask
//! release`). With the feature `manuals` alone.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Args, CommandFactory};
use clap_complete::Shell;

use crate::failure::Failure;
use crate::output::{print_text, printable_path};
use crate::picture::SnapshotError;
use crate::verbs::Cli;

/// Where to write.
#[derive(Debug, Args)]
pub(crate) struct ManualsArgs {
    /// Directory for `man/man1` and `completions`.
    directory: PathBuf,
}

/// Writes them.
pub(crate) fn run(args: &ManualsArgs) -> Result<ExitCode, Failure> {
    write(&args.directory).map_err(|error| Failure::Picture {
        file: args.directory.clone(),
        error: SnapshotError::Write(error),
    })?;
    print_text(&format!("manual pages and completions are in {}\n", printable_path(&args.directory)))?;
    Ok(ExitCode::SUCCESS)
}

fn write(directory: &Path) -> io::Result<()> {
    let (pages, completions) = (directory.join("man/man1"), directory.join("completions"));
    fs::create_dir_all(&pages)?;
    fs::create_dir_all(&completions)?;
    clap_mangen::generate_to(Cli::command(), &pages)?;
    for shell in [Shell::Bash, Shell::Zsh, Shell::Fish] {
        clap_complete::generate_to(shell, &mut Cli::command(), "onetwo", &completions)?;
    }
    Ok(())
}
