//! `survey`: problems that a library is tested with. What `cases coverage` and `cases stats` have in common:
//! drawn or recorded problems, counted in blocks on all cores. The numbers do not depend on the number of
//! cores.

use std::io::sink;
use std::path::{Path, PathBuf};

use arena::cases::{Chosen, LibraryHandle};
use case_tools::coverage::{Cells, Counters, Survey};
use case_tools::{Files, Sampler, build};
use casebase::{GoalEnd, Problem, Symmetry};
use clap::{Args, value_parser};
use rayon::prelude::*;

use super::failure::{FromError, LineFault, SurveyError};
use super::lines::for_each_problem;
use super::playable::Playable;
use crate::Failure;
use crate::args::{LibraryArgs, SettingsArgs, parsers, threads};
use crate::progress::Progress;

/// Arguments of both verbs.
#[derive(Debug, Args)]
pub(crate) struct SurveyArgs {
    #[command(flatten)]
    library: LibraryArgs,
    #[command(flatten)]
    settings: SettingsArgs,
    /// Number of problems that are drawn.
    #[arg(long, value_name = "N", default_value_t = 100_000, value_parser = value_parser!(u64).range(1..=100_000_000))]
    problems: u64,
    /// Random seed: the same seed draws the same problems.
    #[arg(short, long, default_value_t = 1)]
    seed: u64,
    /// Recorded problems instead of drawn ones: a file of lines as `cases retrieve` takes them and `onetwo
    /// replay --problems` prints them.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["problems", "seed"])]
    from: Option<PathBuf>,
    /// Only problems of the team that defends this goal.
    #[arg(long, value_name = "GOAL", value_parser = parsers::goal)]
    defending: Option<GoalEnd>,
    /// Only the first N robots of each problem are present.
    #[arg(long, value_name = "N", value_parser = value_parser!(u8).range(1..=11))]
    teammates: Option<u8>,
    /// Number of threads; the number of cores by default. The answer is the same.
    #[arg(short, long, value_name = "J", value_parser = value_parser!(u16).range(1..=1024))]
    jobs: Option<u16>,
    /// Edge of a cell, mm; a cell holds the balls that are counted together.
    #[arg(long, value_name = "MM", value_parser = value_parser!(i32).range(1..=30_000))]
    cell: Option<i32>,
}

impl SurveyArgs {
    /// The files and directories that are read.
    pub(crate) fn inputs(&self) -> Vec<&Path> {
        self.from.iter().chain(&self.library.directory.library).map(PathBuf::as_path).collect()
    }
}

/// An opened library and the problems it is tested with.
#[derive(Debug)]
pub(crate) struct Trial<'a> {
    args: &'a SurveyArgs,
    pub(crate) library_handle: LibraryHandle,
    pub(crate) chosen: Chosen,
    source: Source,
    /// Places that the ball of a problem may have; anywhere by default.
    places: Option<Playable>,
}

#[derive(Debug)]
enum Source {
    Drawn(Sampler),
    Recorded(Vec<Problem>),
}

impl<'a> Trial<'a> {
    pub(crate) fn open(args: &'a SurveyArgs) -> Result<Self, Failure> {
        let chosen = args.settings.choose()?;
        let library_handle = crate::library::open(&args.library)?;
        let source = match &args.from {
            Some(file) => Source::Recorded(recorded(file)?),
            None => Source::Drawn(sampler(&library_handle, args.seed)?),
        };
        Ok(Self { args, library_handle, chosen, source, places: None })
    }

    /// Number of problems before those of the other team are left out.
    pub(crate) fn len(&self) -> u64 {
        match &self.source {
            Source::Drawn(_) => self.args.problems,
            Source::Recorded(problems) => problems.len() as u64,
        }
    }

    /// Leaves out problems whose ball lies where no field player of the team may play it.
    pub(crate) fn only_playable(&mut self) {
        self.places = Some(Playable::new(self.library_handle.league(), self.library_handle.base().field()));
    }

    /// True if the problems were recorded: played, not drawn.
    pub(crate) fn is_recorded(&self) -> bool {
        matches!(self.source, Source::Recorded(_))
    }

    /// The seed, if problems were drawn.
    pub(crate) fn seed(&self) -> Option<u64> {
        matches!(self.source, Source::Drawn(_)).then_some(self.args.seed)
    }

    /// The problem of a number below [`Trial::len`]; `None` if it is filtered out.
    pub(crate) fn problem(&self, number: u64) -> Option<Problem> {
        let mut problem = match &self.source {
            Source::Drawn(sampler) => sampler.problem(number),
            Source::Recorded(problems) => problems.get(usize::try_from(number).ok()?)?.clone(),
        };
        if let Some(teammates) = self.args.teammates {
            problem.teammates.truncate(usize::from(teammates));
        }
        let allowed = |places: &Playable| places.allows(problem.ball, problem.defending);
        let wanted = self.args.defending.is_none_or(|goal| goal == problem.defending)
            && self.places.as_ref().is_none_or(allowed);
        wanted.then_some(problem)
    }

    /// All counts, and the grid they are counted over.
    pub(crate) fn count(&self) -> Result<(Counters, Cells), Failure> {
        let base = self.library_handle.base();
        let edge = self.args.cell.unwrap_or_else(|| Cells::suitable_edge_mm(base.field()));
        let cells = Cells::new(base.field(), edge).map_err(|error| SurveyError::Cell(edge, error))?;
        let survey = Survey::new(base, &self.chosen.settings, cells).map_err(SurveyError::Wider)?;
        let counters =
            threads(self.args.jobs)?.install(|| counters(&survey, self.len(), |number| self.problem(number)));
        if counters.problems == 0 {
            return Err(SurveyError::NothingLeft.into());
        }
        Ok((counters, cells))
    }
}

/// All counts over the problems numbered below `len`, on the threads of the caller's pool.
pub(crate) fn counters(
    survey: &Survey<'_>,
    len: u64,
    problem: impl Fn(u64) -> Option<Problem> + Sync,
) -> Counters {
    let progress = Progress::of(len, "problems");
    let block = |number: u64| {
        let numbers = number * BLOCK_PROBLEMS..len.min((number + 1) * BLOCK_PROBLEMS);
        let count = numbers.end - numbers.start;
        let counters = survey.over(numbers.filter_map(|number| Some((number, problem(number)?))));
        progress.add(count);
        counters
    };
    let blocks = (0..len.div_ceil(BLOCK_PROBLEMS)).into_par_iter();
    blocks.map(block).reduce(|| survey.empty(), Counters::merge)
}

/// A share in percent, to one decimal place: `12.3`.
pub(crate) fn percent(part: u64, whole: u64) -> f64 {
    (1000.0 * part as f64 / whole.max(1) as f64).round() / 10.0
}

/// Region of a case's name: its directory.
pub(crate) fn region(name: &str) -> &str {
    name.split_once('/').map_or(name, |(region, _)| region)
}

/// Class of the authored case in the paper: robots, and opponents in its situation.
pub(crate) fn class(library_handle: &LibraryHandle, authored: usize) -> (&'static str, usize) {
    let id = protocol::CaseId((authored * Symmetry::ALL.len()) as u16);
    library_handle.base().case(id).map_or(("individual", 0), |case| {
        (if case.teammates() > 1 { "cooperative" } else { "individual" }, case.opponents().count())
    })
}

fn recorded(file: &Path) -> Result<Vec<Problem>, Failure> {
    let fail = |error| SurveyError::From(file.to_owned(), error);
    let input = foreign::open(file).map_err(|error| fail(FromError::Unreadable(error)))?;
    let mut problems = Vec::new();
    let (mut first_fault, mut faults) = (None, 0_u64);
    for_each_problem(input, &mut sink(), |_, _, problem| {
        match problem {
            Ok(problem) if problems.len() < RECORDED_MAX => problems.push(problem),
            Ok(_) => {
                faults += 1;
                first_fault.get_or_insert(LineFault::TooMany(RECORDED_MAX));
            }
            Err(error) => {
                faults += 1;
                first_fault.get_or_insert(LineFault::Malformed(error));
            }
        }
        Ok(())
    })?;
    match first_fault {
        Some(first) => Err(fail(FromError::Faulty { first, more: faults - 1 }).into()),
        None if problems.is_empty() => Err(fail(FromError::Empty).into()),
        None => Ok(problems),
    }
}

fn sampler(library_handle: &LibraryHandle, seed: u64) -> Result<Sampler, Failure> {
    match library_handle {
        LibraryHandle::Directory(library, ..) => Ok(library.sampler(seed)),
        LibraryHandle::BuiltIn(league, _) => {
            let cases: Vec<_> = league.names.iter().copied().zip(league.sources.iter().copied()).collect();
            let library = build(&Files::from_texts(league.name, league.rules, &cases))
                .map_err(|findings| Failure::faulty_library(league.name, findings))?;
            Ok(library.sampler(seed))
        }
    }
}

/// Problems that are read from one file: 2 GB of memory.
const RECORDED_MAX: usize = 5_000_000;
/// Problems that are counted in one go: some tens of milliseconds.
const BLOCK_PROBLEMS: u64 = 2048;
