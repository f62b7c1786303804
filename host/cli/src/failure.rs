//! `failure`: errors of the program, and how to fix them. Exit code 1 (docs/case-format.md §5); wrong usage
//! is clap's.

use std::fmt;
use std::io;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use arena::cases::{LibraryError, SettingFailure};
use arena::game::GameError;
use case_tools::Finding;
use casebase::SettingError;
use foreign::printable;
use hil_sim::SimulationError;
use study::store::EvaluationError;

mod bring_up;
mod description;
mod firmware;
mod network;
mod recorded;
mod survey;

pub(crate) use bring_up::BringUpError;
pub(crate) use description::DescriptionError;
pub(crate) use firmware::FirmwareError;
pub(crate) use network::NetworkError;
pub(crate) use recorded::{Asked, Missing, RecordedError};
pub(crate) use survey::{FromError, LineFault, ProblemError, SurveyError};

use crate::cases::new::DraftError;
use crate::output::{print_error, printable_path};
use crate::picture::SnapshotError;
use crate::virtual_robot::RobotError;

/// One variant for each failure that the operator can fix.
#[derive(Debug)]
pub(crate) enum Failure {
    /// There is no library.
    Library(LibraryError),
    /// A case requested by a name or id that the library lacks.
    UnknownCase {
        /// The name or id as given.
        asked: String,
        /// The league of the library.
        league: String,
        /// Number of stored cases.
        stored: usize,
        /// A similar name.
        near: Option<String>,
    },
    /// A problem to draw cannot be read.
    Problem(ProblemError),
    /// A figure of the retrieved case was requested, and no case fits.
    NoCaseFits,
    /// A case to be drawn under a problem that defends the other goal.
    OtherGoal(String),
    /// `--set` with a name or value that retrieval does not know.
    Setting(SettingFailure),
    /// A library without a case has nothing to count.
    EmptyLibrary(String),
    /// Problems could not be drawn, read or counted.
    Survey(SurveyError),
    /// A trial could not be played.
    Trial(SimulationError),
    /// A match could not be played.
    Game(GameError),
    /// A recording could not be written.
    Recording {
        /// `stem` of what could not be begun; none where what was begun is not whole.
        stem: Option<PathBuf>,
        /// Why.
        error: io::Error,
    },
    /// The robots' image or its emulator cannot be had.
    Firmware(FirmwareError),
    /// A figure could not be written.
    Picture {
        /// The output file.
        file: PathBuf,
        /// Why.
        error: SnapshotError,
    },
    /// A Markdown file has no place for figures.
    Markdown {
        /// The file.
        file: PathBuf,
        /// What is missing in it.
        error: report::MarkerError,
    },
    /// No authored case of that name.
    UnknownName {
        /// The name as given.
        asked: String,
        /// The league of the library.
        league: String,
    },
    /// No case can be drafted from the problem.
    Draft(DraftError),
    /// A robot's description is wrong, or another than this program's.
    Description(DescriptionError),
    /// The checks of a robot's first start cannot be shown.
    BringUp(BringUpError),
    /// A virtual robot cannot run.
    Robot(RobotError),
    /// Threads cannot be started.
    Threads(rayon::ThreadPoolBuildError),
    /// An evaluation could not be played, kept or put together.
    Evaluation(EvaluationError),
    /// Learning failed.
    Learning(study::learning::LearnError),
    /// The list of refused changes beside a library cannot be read.
    Refusals(String),
    /// The filters of an evaluation leave nothing.
    NoTrials,
    /// A recording could not be read, or lacks what was requested.
    Recorded {
        /// The file.
        file: PathBuf,
        /// What is wrong, and how to fix it.
        error: RecordedError,
    },
    /// A verb on the league's networks cannot continue.
    Network(NetworkError),
    /// Stdin could not be read.
    Input(io::Error),
    /// Stdout could not be written.
    Output(io::Error),
}

impl Failure {
    pub(crate) fn setting(name: &str, value: &str, error: SettingError) -> Self {
        Self::Setting(SettingFailure::new(name, value, error))
    }

    pub(crate) fn missing_directory(directory: &Path) -> Self {
        Self::Library(LibraryError::NoDirectory(directory.to_owned()))
    }

    pub(crate) fn faulty_library(directory: impl Into<PathBuf>, findings: Vec<Finding>) -> Self {
        Self::Library(LibraryError::Faulty { directory: directory.into(), findings })
    }

    pub(crate) fn unknown_league(name: &str) -> Self {
        Self::Library(LibraryError::UnknownLeague(name.to_owned()))
    }

    /// Prints it on stderr. A closed stdout is not an error: the reader has read enough.
    pub(crate) fn report(&self) -> ExitCode {
        if matches!(self, Self::Output(error) if error.kind() == io::ErrorKind::BrokenPipe) {
            return ExitCode::SUCCESS;
        }
        print_error(self);
        ExitCode::FAILURE
    }
}

impl From<NetworkError> for Failure {
    fn from(error: NetworkError) -> Self {
        Self::Network(error)
    }
}

impl From<FirmwareError> for Failure {
    fn from(error: FirmwareError) -> Self {
        Self::Firmware(error)
    }
}

impl From<BringUpError> for Failure {
    fn from(error: BringUpError) -> Self {
        Self::BringUp(error)
    }
}

impl From<DescriptionError> for Failure {
    fn from(error: DescriptionError) -> Self {
        Self::Description(error)
    }
}

impl From<EvaluationError> for Failure {
    fn from(error: EvaluationError) -> Self {
        Self::Evaluation(error)
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Library(error) => error.fmt(f),
            Self::UnknownCase { asked, league, stored, near } => {
                write!(f, "no case {asked:?} in {league}; ")?;
                if let Some(near) = near {
                    write!(f, "did you mean {near}? Else ")?;
                }
                match stored.checked_sub(1) {
                    Some(last) => {
                        write!(f, "take an id, 0 to {last}, or a region/name that `onetwo cases list` prints")
                    }
                    None => f.write_str("the library holds no case"),
                }
            }
            Self::Problem(error) => write!(f, "{error}"),
            Self::NoCaseFits => {
                f.write_str("no case fits the problem; name a case to see why, or ask `onetwo cases explain`")
            }
            Self::OtherGoal(name) => write!(
                f,
                "{name} defends the other goal than the problem; take the id of its copy from `onetwo cases list`"
            ),
            Self::Setting(error) => write!(f, "--set {error}"),
            Self::EmptyLibrary(league) => {
                write!(f, "the library {league} holds no case; add one at <region>/<name>.toml")
            }
            Self::Draft(error) => write!(f, "{error}"),
            Self::Survey(error) => write!(f, "{error}"),
            Self::Network(error) => write!(f, "{error}"),
            Self::Robot(error) => write!(f, "{error}"),
            Self::Description(error) => write!(f, "{error}"),
            Self::BringUp(error) => write!(f, "{error}"),
            Self::Trial(error) => write!(f, "{error}"),
            Self::Firmware(error) => write!(f, "{error}"),
            Self::Game(error) => write!(f, "{error}"),
            Self::Recording { stem: Some(stem), error } => {
                write!(f, "cannot keep the recording: {}: {error}", printable_path(stem))
            }
            Self::Recording { stem: None, error } => {
                write!(f, "cannot keep the recording: it is not whole: {error}")
            }
            Self::Markdown { file, error } => write!(f, "{}: {error}", printable_path(file)),
            Self::Picture { file, error } => {
                write!(f, "cannot write the picture {}: {error}", printable_path(file))
            }
            Self::UnknownName { asked, league } => write!(
                f,
                "no case {asked:?} in {league}; take a region/name that `onetwo cases list` prints, or a region"
            ),
            Self::Evaluation(error) => write!(f, "{error}"),
            Self::Learning(error) => error.fmt(f),
            Self::Refusals(what) => f.write_str(what),
            Self::NoTrials => f.write_str(
                "no trial is left: robots' trials (--profile robots) are against dg, of scenarios 3 and 4 and, asked for, random; \
                 leave out a filter",
            ),
            Self::Threads(error) => write!(f, "cannot start threads: {error}; try --jobs 1"),
            Self::Recorded { file, error } => {
                let file = printable_path(file);
                // The reason may quote the file's own text.
                let description = error.to_string();
                let description = printable(&description);
                // Some reasons name the file already.
                if description.starts_with(&file) {
                    f.write_str(&description)
                } else {
                    write!(f, "{file}: {description}")
                }
            }
            Self::Input(error) => write!(f, "cannot read stdin: {error}"),
            Self::Output(error) => write!(f, "cannot write stdout: {error}"),
        }
    }
}

impl std::error::Error for Failure {}
