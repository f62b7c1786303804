//! `handle`: a case library: built in, or one league's directory read at run time (docs/case-format.md §5).

use std::path::{Path, PathBuf};

use case_library::{LEAGUES, League};
use case_tools::{Files, Finding, Library, Reduction, Severity};
use casebase::{CaseBase, FieldMm, KickId, Symmetry};
use foreign::printable;
use protocol::CaseId;

/// One opened library.
#[derive(Clone, Copy, Debug)]
pub enum LibraryHandle {
    /// Built into this program; with the case base over its table, which is checked once.
    BuiltIn(&'static League, CaseBase<'static>),
    /// Read from a directory, or made from files of one. It is kept until the program ends, because the case
    /// base borrows from it. The last is the directory of a library that is whole.
    Directory(&'static Library, CaseBase<'static>, Option<&'static Path>),
}

impl LibraryHandle {
    /// The built-in league of that name.
    pub fn named(league: &str) -> Result<Self, LibraryError> {
        let found = case_library::league(league).map(Self::built_in);
        found.ok_or_else(|| LibraryError::UnknownLeague(league.to_owned()))
    }

    /// One league's directory; `on_progress` gets the number of finished steps and of all.
    pub fn read(directory: &Path, on_progress: impl FnMut(usize, usize)) -> Result<Self, LibraryError> {
        if !directory.is_dir() {
            return Err(LibraryError::NoDirectory(directory.to_owned()));
        }
        let library = case_tools::load_with_progress(directory, on_progress)
            .map_err(|findings| LibraryError::Faulty { directory: directory.to_owned(), findings })?;
        let library: &'static Library = Box::leak(Box::new(library));
        let directory: &'static Path = Box::leak(directory.to_owned().into_boxed_path());
        Ok(Self::Directory(library, library.base(), Some(directory)))
    }

    /// The same with at most those of its cases that `reduction` keeps.
    pub fn reduced(self, reduction: Reduction) -> Result<Self, LibraryError> {
        if reduction == Reduction::NONE || matches!(self, Self::Directory(_, _, None)) {
            return Ok(self);
        }
        let built = self.files().and_then(|files| case_tools::build_reduced(&files, reduction));
        let library = built.map_err(|findings| LibraryError::Faulty {
            directory: self.directory().map_or_else(|| self.league().into(), Path::to_owned),
            findings,
        })?;
        let library: &'static Library = Box::leak(Box::new(library));
        Ok(Self::Directory(library, library.base(), None))
    }

    /// The directory that it was read from.
    pub const fn directory(&self) -> Option<&'static Path> {
        match self {
            Self::BuiltIn(..) => None,
            Self::Directory(_, _, directory) => *directory,
        }
    }

    /// Files: those of its directory as they are now, or those of a built-in league.
    pub fn files(&self) -> Result<Files, Vec<Finding>> {
        match self {
            Self::BuiltIn(league, _) => Ok(built_in_files(league)),
            Self::Directory(library, _, None) => Ok(case_library::league(&library.league)
                .map_or_else(|| Files::from_texts(&library.league, "", &[]), built_in_files)),
            Self::Directory(_, _, Some(directory)) => Files::read(directory),
        }
    }

    /// A built-in league's.
    pub fn built_in(league: &'static League) -> Self {
        Self::BuiltIn(league, league.base())
    }

    /// Every built-in league's.
    pub fn all_built_in() -> impl Iterator<Item = Self> {
        LEAGUES.iter().map(Self::built_in)
    }

    /// The league whose simulator has the library's field.
    pub fn simulated_league(&self) -> Result<rules::League, LibraryError> {
        let league = league_of(self.base().field(), self.league());
        league.ok_or_else(|| LibraryError::NoSimulator(self.league().to_owned()))
    }

    /// Refuses cases of a field on which no trial is played: the trials' simulator has one.
    pub fn check_field_of_trials(&self) -> Result<(), LibraryError> {
        match self.simulated_league() {
            Ok(rules::League::FourLegged) => Ok(()),
            _ => Err(LibraryError::NoSimulator(self.league().to_owned())),
        }
    }

    /// The case base over the table.
    pub const fn base(&self) -> CaseBase<'_> {
        match self {
            Self::BuiltIn(_, base) | Self::Directory(_, base, _) => *base,
        }
    }

    /// The same for the lifetime of the program: built in, or kept until its end.
    pub const fn lasting_base(&self) -> CaseBase<'static> {
        match self {
            Self::BuiltIn(_, base) | Self::Directory(_, base, _) => *base,
        }
    }

    /// The league's name.
    pub fn league(&self) -> &str {
        match self {
            Self::BuiltIn(league, _) => league.name,
            Self::Directory(library, ..) => &library.league,
        }
    }

    /// `region/name` of every authored case, in order.
    pub fn names(&self) -> Vec<String> {
        match self {
            Self::BuiltIn(league, _) => league.names.iter().map(ToString::to_string).collect(),
            Self::Directory(library, ..) => library.names.clone(),
        }
    }

    /// `region/name` of the authored case that a stored one descends from.
    pub fn name(&self, id: CaseId) -> &str {
        let authored = authored(id);
        match self {
            Self::BuiltIn(league, _) => league.names[authored],
            Self::Directory(library, ..) => &library.names[authored],
        }
    }

    /// The league's name for a kind of kick.
    pub fn kick(&self, kind: KickId) -> &str {
        let kind = usize::from(kind.0);
        match self {
            Self::BuiltIn(league, _) => league.kicks[kind],
            Self::Directory(library, ..) => &library.kicks[kind],
        }
    }

    /// Intent of a stored case, as its author wrote it.
    pub fn intent(&self, id: CaseId) -> Option<String> {
        let authored = authored(id);
        let source = match self {
            Self::BuiltIn(league, _) => league.sources[authored],
            Self::Directory(library, ..) => &library.sources[authored],
        };
        let table: toml::Table = source.parse().ok()?;
        Some(table.get("intent")?.as_str()?.to_owned())
    }
}

fn built_in_files(league: &League) -> Files {
    let cases = league.names.iter().zip(league.sources).map(|(name, text)| (*name, *text));
    Files::from_texts(league.name, league.rules, &cases.collect::<Vec<_>>())
}

/// The league with that field: the one of that name, if it has it.
pub fn league_of(field: FieldMm, name: &str) -> Option<rules::League> {
    let in_mm = |metres: f32| (metres * 1000.0).round() as i32;
    let same = |league: &rules::League| {
        let played = league.field();
        [in_mm(played.length), in_mm(played.width)] == [field.length, field.width]
    };
    let leagues = [
        rules::League::FourLegged,
        rules::League::DivisionB,
        rules::League::DivisionA,
        rules::League::Ssl2013,
    ];
    let named = |league: &rules::League| league.name() == name && same(league);
    leagues.into_iter().find(named).or_else(|| leagues.into_iter().find(same))
}

/// Number of the case file that a stored case is generated from.
fn authored(id: CaseId) -> usize {
    usize::from(id.0) / Symmetry::ALL.len()
}

/// Error that keeps a library from being opened.
#[derive(Debug, thiserror::Error)]
pub enum LibraryError {
    /// The named directory does not exist.
    #[error(
        "no library at {}: no such directory; take one league's directory, the one that holds league.toml",
        printable(&.0.to_string_lossy())
    )]
    NoDirectory(PathBuf),
    /// The case files in a directory are faulty.
    #[error(
        "the library at {} is refused:\n{}correct the files; `onetwo cases check --library DIR` lists the errors again, \
         with warnings",
        printable(&.directory.to_string_lossy()), errors(.findings)
    )]
    Faulty {
        /// The league's directory.
        directory: PathBuf,
        /// The findings, errors among them.
        findings: Vec<Finding>,
    },
    /// No built-in league has that name.
    #[error("no built-in league {:?}; take one of: {}", .0, leagues())]
    UnknownLeague(String),
    /// Cases of a league on whose field no simulator plays.
    #[error(
        "the cases of {0} cannot be played: the simulator plays on the four-legged league's field of 5400 x 3600 mm, \
         and theirs is another; take league four-legged or a library for that field"
    )]
    NoSimulator(String),
}

fn errors(findings: &[Finding]) -> String {
    let errors = findings.iter().filter(|finding| finding.severity == Severity::Error);
    errors.fold(String::new(), |text, finding| text + "  " + &finding.to_string() + "\n")
}

fn leagues() -> String {
    LEAGUES.iter().map(|league| league.name).collect::<Vec<_>>().join(", ")
}
