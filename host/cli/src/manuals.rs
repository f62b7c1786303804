//! `onetwo manuals`: manual pages and completions of the command line, for release archives (`cargo xtask
//! release`). With the feature `manuals` alone.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Args, Command};
use clap_complete::Shell;

use crate::Failure;
use crate::output::{print_text, printable_path};
use crate::picture::{SnapshotError, Unwritten};

/// Where to write.
#[derive(Debug, Args)]
pub(crate) struct ManualsArgs {
    /// Directory for `man/man1` and `completions`.
    directory: PathBuf,
}

pub(crate) fn run(args: &ManualsArgs, program: Command) -> Result<ExitCode, Failure> {
    write(&args.directory, program)
        .map_err(|error| Unwritten { file: args.directory.clone(), error: SnapshotError::Write(error) })?;
    print_text(&format!("manual pages and completions are in {}\n", printable_path(&args.directory)))?;
    Ok(ExitCode::SUCCESS)
}

fn write(directory: &Path, mut program: Command) -> io::Result<()> {
    let (pages, completions) = (directory.join("man/man1"), directory.join("completions"));
    fs::create_dir_all(&pages)?;
    fs::create_dir_all(&completions)?;
    for shell in [Shell::Bash, Shell::Zsh, Shell::Fish] {
        clap_complete::generate_to(shell, &mut program, "onetwo", &completions)?;
    }
    clap_mangen::generate_to(program, &pages)
}
