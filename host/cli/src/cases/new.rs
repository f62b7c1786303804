//! `onetwo cases new`: draft of a case for a situation. One problem in, a case file out, to author from. It
//! passes `cases check` and is retrieved from its problem; the parts of the problem that it leaves out are
//! reported on stderr.

use std::io::{self, Read, stdin};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use arena::cases::LibraryError;
use arena::cases::problem::{self, Malformed};
use case_tools::{CASE_FILE_LEN_MAX, Files, SkeletonError, SourceFile, skeleton};
use casebase::Problem;
use clap::Args;
use thiserror::Error;

use super::lines::LINE_MAX;
use crate::Failure;
use crate::args::LibraryArgs;
use crate::destination::{self, DestinationError, FileKind};
use crate::output::{note, print_text, printable_path};

/// Arguments of `cases new`.
#[derive(Debug, Args)]
pub(crate) struct NewArgs {
    /// The situation: a file with one problem, or - for stdin.
    #[arg(long, value_name = "FILE|-")]
    from: PathBuf,
    /// The file to write: `<region>/<name>.toml` in a league's directory; stdout by default.
    #[arg(short, long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Overwrite an existing file.
    #[arg(long, requires = "out")]
    force: bool,
    #[command(flatten)]
    library: LibraryArgs,
}

pub(super) fn run(args: &NewArgs) -> Result<ExitCode, Failure> {
    let rules = rules(&args.library)?;
    let problem = read(&args.from)?;
    let draft = skeleton(&rules, &problem).map_err(|error| match error {
        SkeletonError::NoTeammate => Failure::from(DraftError::NoTeammate),
        SkeletonError::League(findings) => {
            let directory = rules.path.parent().map(Path::to_owned).unwrap_or_default();
            Failure::faulty_library(directory, findings)
        }
    })?;
    match &args.out {
        Some(file) => write(file, args.force, &draft.text)?,
        None => print_text(&draft.text)?,
    }
    for note in &draft.notes {
        note!("note: {note}");
    }
    for finding in &draft.findings {
        note!("note: line {}: {}; {}", finding.line, finding.message, finding.hint);
    }
    if !draft.retrieved {
        note!(
            "note: the draft is not retrieved from its own problem; the changes above make it another situation"
        );
    }
    Ok(ExitCode::SUCCESS)
}

/// `league.toml` of the selected league.
fn rules(args: &LibraryArgs) -> Result<SourceFile, Failure> {
    if let Some(directory) = &args.directory.library {
        let path = directory.join("league.toml");
        let text = foreign::read_text(&path, CASE_FILE_LEN_MAX)
            .map_err(|error| DraftError::Rules { file: path.clone(), error })?;
        return Ok(SourceFile { path, name: "league".to_owned(), text });
    }
    let league = case_library::league(&args.league);
    let league = league.ok_or_else(|| LibraryError::UnknownLeague(args.league.clone()))?;
    Ok(Files::from_texts(league.name, league.rules, &[]).rules)
}

/// Reads the one problem of a file.
fn read(from: &Path) -> Result<Problem, DraftError> {
    let most = LINE_MAX as u64;
    let (name, read) = if from == Path::new("-") {
        let mut bytes = Vec::new();
        let read = stdin().lock().take(most + 1).read_to_end(&mut bytes);
        ("stdin".to_owned(), read.map(|_| bytes))
    } else {
        (printable_path(from), foreign::read(from, most))
    };
    let fail = |error| DraftError::Problem { from: name.clone(), error };
    let bytes = read.map_err(|error| fail(ProblemError::Read(error)))?;
    if bytes.len() > LINE_MAX {
        return Err(fail(ProblemError::TooLong));
    }
    let text = std::str::from_utf8(&bytes).map_err(|_| fail(ProblemError::NotText))?;
    let text = text.trim_start_matches('\u{feff}').trim();
    if text.is_empty() {
        return Err(fail(ProblemError::Empty));
    }
    // One problem may be spread over lines; several problems are several lines.
    let first = text.lines().next().unwrap_or_default();
    problem::parse(text).map_err(|malformed| {
        if first.len() < text.len() && problem::parse(first).is_ok() {
            fail(ProblemError::Several)
        } else {
            fail(ProblemError::Malformed(malformed))
        }
    })
}

fn write(file: &Path, force: bool, text: &str) -> Result<(), DraftError> {
    if force {
        return Ok(destination::write(file, FileKind::Toml, text.as_bytes())?);
    }
    destination::write_new(file, text).map_err(|error| DraftError::Write { file: file.to_owned(), error })
}

#[derive(Debug, Error)]
enum DraftError {
    #[error(transparent)]
    Destination(#[from] DestinationError),
    #[error("the problem has no teammate, and a case needs one; add who plays the ball to \"teammates\"")]
    NoTeammate,
    #[error(
        "cannot read {}: {error}; --library takes one league's directory, the one that holds league.toml",
        printable_path(file)
    )]
    Rules { file: PathBuf, error: io::Error },
    #[error("{from}: {error}")]
    Problem { from: String, error: ProblemError },
    #[error("cannot write {}: {error}; {}", printable_path(file), remedy(error))]
    Write { file: PathBuf, error: io::Error },
}

/// Remedy for a file that could not be written.
fn remedy(error: &io::Error) -> &'static str {
    match error.kind() {
        io::ErrorKind::AlreadyExists => "--force writes over it",
        io::ErrorKind::NotFound => "create its directory first",
        _ => "choose another --out",
    }
}

/// A fault of the problem of a draft.
#[derive(Debug, Error)]
enum ProblemError {
    #[error("{0}")]
    Read(io::Error),
    #[error("more than {LINE_MAX} bytes; give one problem")]
    TooLong,
    #[error("not UTF-8; give one problem as JSON")]
    NotText,
    #[error("holds no problem; give one as JSON")]
    Empty,
    #[error("holds more than one problem; keep the line that the case is for")]
    Several,
    #[error("{0}")]
    Malformed(Malformed),
}
