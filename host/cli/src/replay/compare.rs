//! `compare`: two traces in step, and where they differ first. Exit code 1 where they differ.

use std::path::Path;
use std::process::ExitCode;

use feed::recording::{PlaySettings, RecordedError, comparable, compare, in_file};

use super::ReplayArgs;
use crate::Failure;
use crate::library;
use crate::output::{json_line, print_text};
use crate::progress::Progress;

/// Plays `args.file` and `other` in step, and prints what differs.
pub(super) fn run(args: &ReplayArgs, other: &Path) -> Result<ExitCode, Failure> {
    // What cannot be compared is reported before hosts are built: a host refuses another case base by itself.
    let league = comparable(&args.file, other)?;
    let library = library::of_league(league, args.directory.library.as_deref())?;
    let (bar, key_file) = (Progress::open(), args.key_file.as_deref());
    let with = PlaySettings { library: library.as_ref(), key_file, observer: &bar };
    let report = compare([&args.file, other], with)?;
    drop(bar);
    print_text(&if args.json { json_line(&report)? } else { report.text() })?;
    match report.damaged() {
        Some(i) => Err(in_file([&args.file, other][i])(RecordedError::Damaged(report.damage(i))).into()),
        None if report.same() => Ok(ExitCode::SUCCESS),
        None => Ok(ExitCode::FAILURE),
    }
}
