//! `library`: a case library: built in, or one league's directory read at run time (docs/case-format.md §5).

use std::cell::OnceCell;
use std::path::Path;

use case_library::{LEAGUES, League};
use case_tools::{Files, Finding, Library, Reduction};
use casebase::{CaseBase, KickId, Symmetry};
use protocol::CaseId;

use crate::Failure;
use crate::args::LibraryArgs;
use crate::progress::Progress;

/// One opened library.
#[derive(Clone, Copy, Debug)]
pub(crate) enum LibraryHandle {
    /// Built into this program; with the case base over its table, which is checked once.
    BuiltIn(&'static League, CaseBase<'static>),
    /// Read from a directory, or made from files of one. It is kept until the program ends, because the case
    /// base borrows from it. The last is the directory of a library that is whole.
    Directory(&'static Library, CaseBase<'static>, Option<&'static Path>),
}

impl LibraryHandle {
    /// Opens the library that the command line names.
    pub(crate) fn open(args: &LibraryArgs) -> Result<Self, Failure> {
        match &args.directory.library {
            Some(directory) => Self::read(directory),
            None => case_library::league(&args.league)
                .map(Self::built_in)
                .ok_or_else(|| Failure::UnknownLeague(args.league.clone())),
        }
    }

    /// The same with at most those of its cases that `reduction` keeps.
    pub(crate) fn open_reduced(args: &LibraryArgs, reduction: Reduction) -> Result<Self, Failure> {
        let whole = Self::open(args)?;
        if reduction == Reduction::NONE {
            return Ok(whole);
        }
        let refused = |findings| Failure::FaultyLibrary {
            directory: args.directory.library.clone().unwrap_or_else(|| args.league.clone().into()),
            findings,
        };
        let files = match (&args.directory.library, &whole) {
            (Some(directory), _) => Files::read(directory).map_err(refused)?,
            (None, Self::BuiltIn(league, _)) => built_in_files(league),
            (None, Self::Directory(..)) => return Ok(whole),
        };
        let library = case_tools::build_reduced(&files, reduction).map_err(refused)?;
        let library: &'static Library = Box::leak(Box::new(library));
        Ok(Self::Directory(library, library.base(), None))
    }

    /// One league's directory.
    pub(crate) fn read(directory: &Path) -> Result<Self, Failure> {
        if !directory.is_dir() {
            return Err(Failure::missing_directory(directory));
        }
        let library: &'static Library = Box::leak(Box::new(
            load(directory)
                .map_err(|findings| Failure::FaultyLibrary { directory: directory.to_owned(), findings })?,
        ));
        let directory: &'static Path = Box::leak(directory.to_owned().into_boxed_path());
        Ok(Self::Directory(library, library.base(), Some(directory)))
    }

    /// The directory that it was read from.
    pub(crate) const fn directory(&self) -> Option<&'static Path> {
        match self {
            Self::BuiltIn(..) => None,
            Self::Directory(_, _, directory) => *directory,
        }
    }

    /// Its files: those of its directory as they are now, or those of a built-in league.
    pub(crate) fn files(&self) -> Result<Files, Vec<Finding>> {
        match self {
            Self::BuiltIn(league, _) => Ok(built_in_files(league)),
            Self::Directory(library, _, None) => Ok(case_library::league(&library.league)
                .map_or_else(|| Files::from_texts(&library.league, "", &[]), built_in_files)),
            Self::Directory(_, _, Some(directory)) => Files::read(directory),
        }
    }

    /// A built-in league's.
    pub(crate) fn built_in(league: &'static League) -> Self {
        Self::BuiltIn(league, league.base())
    }

    /// The libraries if no single one is named: the directory, or every built-in league.
    pub(crate) fn all(directory: Option<&Path>) -> Result<Vec<Self>, Failure> {
        match directory {
            Some(directory) => Ok(vec![Self::read(directory)?]),
            None => Ok(LEAGUES.iter().map(Self::built_in).collect()),
        }
    }

    /// The case base over the table.
    pub(crate) const fn base(&self) -> CaseBase<'_> {
        match self {
            Self::BuiltIn(_, base) | Self::Directory(_, base, _) => *base,
        }
    }

    /// The same for the lifetime of the program: built in, or kept until its end.
    pub(crate) const fn lasting_base(&self) -> CaseBase<'static> {
        match self {
            Self::BuiltIn(_, base) | Self::Directory(_, base, _) => *base,
        }
    }

    /// The league's name.
    pub(crate) fn league(&self) -> &str {
        match self {
            Self::BuiltIn(league, _) => league.name,
            Self::Directory(library, ..) => &library.league,
        }
    }

    /// `region/name` of every authored case, in order.
    pub(crate) fn names(&self) -> Vec<String> {
        match self {
            Self::BuiltIn(league, _) => league.names.iter().map(ToString::to_string).collect(),
            Self::Directory(library, ..) => library.names.clone(),
        }
    }

    /// `region/name` of the authored case that a stored one descends from.
    pub(crate) fn name(&self, id: CaseId) -> &str {
        let authored = authored(id);
        match self {
            Self::BuiltIn(league, _) => league.names[authored],
            Self::Directory(library, ..) => &library.names[authored],
        }
    }

    /// The league's name for a kind of kick.
    pub(crate) fn kick(&self, kind: KickId) -> &str {
        let kind = usize::from(kind.0);
        match self {
            Self::BuiltIn(league, _) => league.kicks[kind],
            Self::Directory(library, ..) => &library.kicks[kind],
        }
    }

    /// Intent of a stored case, as its author wrote it.
    pub(crate) fn intent(&self, id: CaseId) -> Option<String> {
        let authored = authored(id);
        let source = match self {
            Self::BuiltIn(league, _) => league.sources[authored],
            Self::Directory(library, ..) => &library.sources[authored],
        };
        let table: toml::Table = source.parse().ok()?;
        Some(table.get("intent")?.as_str()?.to_owned())
    }
}

/// The files of a built-in league.
fn built_in_files(league: &League) -> Files {
    let cases = league.names.iter().zip(league.sources).map(|(name, text)| (*name, *text));
    Files::from_texts(league.name, league.rules, &cases.collect::<Vec<_>>())
}

/// Reads one league's directory; with a bar on a terminal's stderr where there are many files, and nothing in
/// a pipe.
pub(crate) fn load(directory: &Path) -> Result<Library, Vec<Finding>> {
    let progress = OnceCell::new();
    case_tools::load_telling(directory, |done, all| {
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

/// Number of load steps from which a progress bar is drawn: half a thousand files.
const MANY: usize = 1000;

/// Number of the case file that a stored case is generated from.
fn authored(id: CaseId) -> usize {
    usize::from(id.0) / Symmetry::ALL.len()
}
