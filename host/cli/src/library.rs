//! Whose cases, by name and by id? One library: built in, or one league's folder read at run time (DESIGN §8).

use std::path::Path;

use case_library::{LEAGUES, League};
use case_tools::Library;
use casebase::{CaseBase, KickId, Symmetry};
use protocol::CaseId;

use crate::Failure;
use crate::args::LibraryArgs;

/// One opened library.
#[derive(Debug)]
pub(crate) enum Shelf {
    /// Baked into this program.
    BuiltIn(&'static League),
    /// Read from a folder.
    Folder(Box<Library>),
}

impl Shelf {
    /// The library the command line means.
    pub(crate) fn open(args: &LibraryArgs) -> Result<Self, Failure> {
        match &args.folder.library {
            Some(folder) => Self::read(folder),
            None => LEAGUES
                .iter()
                .find(|league| league.name == args.league)
                .map(Self::BuiltIn)
                .ok_or_else(|| Failure::UnknownLeague(args.league.clone())),
        }
    }

    /// One league's folder.
    pub(crate) fn read(folder: &Path) -> Result<Self, Failure> {
        if !folder.is_dir() {
            return Err(Failure::missing_folder(folder));
        }
        let library = case_tools::load(folder)
            .map_err(|findings| Failure::FaultyLibrary { folder: folder.to_owned(), findings })?;
        Ok(Self::Folder(Box::new(library)))
    }

    /// The libraries meant where no single one needs to be named: the folder, or every built-in league.
    pub(crate) fn all(folder: Option<&Path>) -> Result<Vec<Self>, Failure> {
        match folder {
            Some(folder) => Ok(vec![Self::read(folder)?]),
            None => Ok(LEAGUES.iter().map(Self::BuiltIn).collect()),
        }
    }

    /// The case base over the table, checked anew by every call: once is enough.
    pub(crate) fn base(&self) -> CaseBase<'_> {
        match self {
            Self::BuiltIn(league) => league.base(),
            Self::Folder(library) => library.base(),
        }
    }

    /// The league's name.
    pub(crate) fn league(&self) -> &str {
        match self {
            Self::BuiltIn(league) => league.name,
            Self::Folder(library) => &library.league,
        }
    }

    /// `region/name` of every authored case, in order.
    pub(crate) fn names(&self) -> Vec<String> {
        match self {
            Self::BuiltIn(league) => league.names.iter().map(ToString::to_string).collect(),
            Self::Folder(library) => library.names.clone(),
        }
    }

    /// `region/name` of the authored case that a stored one descends from.
    pub(crate) fn name(&self, id: CaseId) -> &str {
        let authored = authored(id);
        match self {
            Self::BuiltIn(league) => league.names[authored],
            Self::Folder(library) => &library.names[authored],
        }
    }

    /// What the league calls a kind of kick.
    pub(crate) fn kick(&self, kind: KickId) -> &str {
        let kind = usize::from(kind.0);
        match self {
            Self::BuiltIn(league) => league.kicks[kind],
            Self::Folder(library) => &library.kicks[kind],
        }
    }

    /// What the author of a stored case meant by it.
    pub(crate) fn intent(&self, id: CaseId) -> Option<String> {
        let authored = authored(id);
        let source = match self {
            Self::BuiltIn(league) => league.sources[authored],
            Self::Folder(library) => &library.sources[authored],
        };
        let table: toml::Table = source.parse().ok()?;
        Some(table.get("intent")?.as_str()?.to_owned())
    }
}

/// Number of the case file that a stored case descends from.
fn authored(id: CaseId) -> usize {
    usize::from(id.0) / Symmetry::ALL.len()
}
