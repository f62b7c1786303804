//! `library`: the case library that the command line names.

use std::cell::OnceCell;
use std::path::Path;

use arena::cases::{LibraryError, LibraryHandle};
use case_tools::{Finding, Library, Reduction};
use rules::League;

use crate::args::{DirectoryArgs, LibraryArgs};
use crate::output::note;
use crate::progress::Progress;

/// A library that a match of a league cannot have.
#[derive(Debug, thiserror::Error)]
pub(crate) enum MatchLibraryError {
    #[error(transparent)]
    Library(#[from] LibraryError),
    /// Its cases are of another field.
    #[error(
        "the library's cases are of the field of {library}, the match is one of {league}: give --league {library}, or cases for {league}"
    )]
    OtherField { library: &'static str, league: &'static str },
}

/// Opens the library that the command line names.
pub(crate) fn open(args: &LibraryArgs) -> Result<LibraryHandle, LibraryError> {
    match &args.directory.library {
        Some(directory) => read(directory),
        None => LibraryHandle::named(&args.league),
    }
}

/// The same with at most those of its cases that `reduction` keeps.
pub(crate) fn open_reduced(args: &LibraryArgs, reduction: Reduction) -> Result<LibraryHandle, LibraryError> {
    open(args)?.reduced(reduction)
}

/// One league's directory; with a bar as [`load`].
pub(crate) fn read(directory: &Path) -> Result<LibraryHandle, LibraryError> {
    with_bar(|on_progress| LibraryHandle::read(directory, on_progress))
}

/// The cases that come with a league, or those of a directory, which must be of its field; none if neither
/// exists.
pub(crate) fn of_league(
    league: League,
    directory: Option<&Path>,
) -> Result<Option<LibraryHandle>, MatchLibraryError> {
    match directory {
        Some(directory) => {
            let library_handle = read(directory)?;
            let library = library_handle.simulated_league()?;
            if library != league {
                return Err(MatchLibraryError::OtherField { library: library.name(), league: league.name() });
            }
            Ok(Some(library_handle))
        }
        None => case_library::league(league.name())
            .map(|_| LibraryHandle::named(league.name()))
            .transpose()
            .map_err(Into::into),
    }
}

/// The same for a match; a league without cases is noted: there, robots that the host leaves free play by the
/// reactive behaviour.
pub(crate) fn of_match(
    directory: &DirectoryArgs,
    league: League,
) -> Result<Option<LibraryHandle>, MatchLibraryError> {
    let library_handle = of_league(league, directory.library.as_deref())?;
    if library_handle.is_none() {
        note!("no cases come with {}: robots that are left free play reactively", league.name());
    }
    Ok(library_handle)
}

/// The libraries if no single one is named: the directory, or every built-in league.
pub(crate) fn all(directory: Option<&Path>) -> Result<Vec<LibraryHandle>, LibraryError> {
    match directory {
        Some(directory) => Ok(vec![read(directory)?]),
        None => Ok(LibraryHandle::all_built_in().collect()),
    }
}

/// Reads one league's directory; with a bar on a terminal's stderr where there are many files, and nothing in
/// a pipe.
pub(crate) fn load(directory: &Path) -> Result<Library, Vec<Finding>> {
    with_bar(|on_progress| case_tools::load_with_progress(directory, on_progress))
}

/// Calls a reader that reports its progress, and draws it.
fn with_bar<T>(read: impl FnOnce(&dyn Fn(usize, usize)) -> T) -> T {
    let progress = OnceCell::new();
    read(&|done, all| {
        if all >= BAR_FROM_STEPS {
            let line = progress.get_or_init(|| {
                let line = Progress::open();
                line.set_text("reading the library");
                line
            });
            line.set(done as u64, all as u64);
        }
    })
}

/// Number of load steps from which a progress bar is drawn: half a thousand files.
const BAR_FROM_STEPS: usize = 1000;
