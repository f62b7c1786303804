//! `library`: the case library that the command line names.

use std::cell::OnceCell;
use std::path::Path;

use arena::cases::{LibraryError, LibraryHandle};
use case_tools::{Finding, Library, Reduction};

use crate::Failure;
use crate::args::LibraryArgs;
use crate::progress::Progress;

/// Opens the library that the command line names.
pub(crate) fn open(args: &LibraryArgs) -> Result<LibraryHandle, Failure> {
    match &args.directory.library {
        Some(directory) => read(directory),
        None => Ok(LibraryHandle::named(&args.league)?),
    }
}

/// The same with at most those of its cases that `reduction` keeps.
pub(crate) fn open_reduced(args: &LibraryArgs, reduction: Reduction) -> Result<LibraryHandle, Failure> {
    Ok(open(args)?.reduced(reduction)?)
}

/// One league's directory; with a bar as [`load`].
pub(crate) fn read(directory: &Path) -> Result<LibraryHandle, Failure> {
    Ok(with_bar(|on_progress| LibraryHandle::read(directory, on_progress))?)
}

/// The libraries if no single one is named: the directory, or every built-in league.
pub(crate) fn all(directory: Option<&Path>) -> Result<Vec<LibraryHandle>, Failure> {
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
        if all >= MANY {
            let line = progress.get_or_init(|| {
                let line = Progress::open();
                line.set_text("reading the library");
                line
            });
            line.set(done as u64, all as u64);
        }
    })
}

impl From<LibraryError> for Failure {
    fn from(error: LibraryError) -> Self {
        Self::Library(error)
    }
}

/// Number of load steps from which a progress bar is drawn: half a thousand files.
const MANY: usize = 1000;
