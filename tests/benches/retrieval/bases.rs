//! `bases`: case bases of the retrieval benchmark. A part of the built-in library, all of it, and random ones
//! of 1,000 and 10,000 cases.

use std::path::Path;

use case_tools::{Files, Library};
use casebase::{GoalEnd, PointMm, Problem};
use match_tests::oracle::library::{Goal, Library as Oracle, Point};
use match_tests::oracle::problem::Problem as Drawn;
use match_tests::random_library::{Dice, RandomLibrary, random_problem};
use protocol::RobotId;

/// A case base, and the library from which its problems are drawn.
pub(crate) struct Base {
    pub(crate) library: Library,
    oracle: Oracle,
}

impl Base {
    /// All four, smallest first.
    pub(crate) fn all() -> Vec<Self> {
        let built_in = built_in();
        let step = built_in.cases.len().div_ceil(PART);
        let part = RandomLibrary {
            league: built_in.league.clone(),
            cases: built_in.cases.clone().into_iter().step_by(step).collect(),
        };
        let random = |cases| RandomLibrary::new(SEED, cases);
        [part, built_in, random(250), random(2500)].iter().map(Self::of).collect()
    }

    fn of(texts: &RandomLibrary) -> Self {
        let paths: Vec<_> = texts.cases.iter().map(|(name, text)| (name.as_str(), text.as_str())).collect();
        let library = case_tools::build(&Files::from_texts("bench", &texts.league, &paths));
        let library = library.unwrap_or_else(|findings| panic!("a valid library is refused: {findings:?}"));
        let oracle = Oracle::from_texts(&texts.league, &texts.cases).expect("readable by the oracle");
        Self { library, oracle }
    }

    /// Problems near its cases.
    pub(crate) fn random_problems(&self, seed: u64) -> impl Iterator<Item = Problem> + '_ {
        let mut dice = Dice::new(seed);
        std::iter::repeat_with(move || translated(&random_problem(&mut dice, &self.oracle)))
    }
}

/// The four-legged library's texts.
fn built_in() -> RandomLibrary {
    let directory = Path::new(env!("CARGO_MANIFEST_DIR")).join("../casebase/library/cases/four-legged");
    let read = |path: &Path| std::fs::read_to_string(path).expect("a file of the project");
    let entries = |directory: &Path| {
        let entries = directory.read_dir().expect("a folder of the project");
        entries.map(|entry| entry.expect("readable").path()).collect::<Vec<_>>()
    };
    let regions = entries(&directory).into_iter().filter(|path| path.is_dir());
    let cases = regions.flat_map(|region| {
        let name = move |file: &Path| {
            let region = region.file_name().expect("a name").to_string_lossy().into_owned();
            format!("{region}/{}", file.file_stem().expect("a name").to_string_lossy())
        };
        let files = entries(&directory.join(name(Path::new("x")).trim_end_matches("/x")));
        files.into_iter().map(move |file| (name(&file), read(&file))).collect::<Vec<_>>()
    });
    RandomLibrary { league: read(&directory.join("league.toml")), cases: cases.collect() }
}

fn translated(problem: &Drawn) -> Problem {
    let point = |p: Point| PointMm { x: p.x as i32, y: p.y as i32 };
    let id = |id: u8| RobotId::new(id).expect("an id of 0–15");
    Problem {
        ball: point(problem.ball),
        defending: match problem.defending {
            Goal::Yellow => GoalEnd::Negative,
            Goal::Cyan => GoalEnd::Positive,
        },
        teammates: problem.teammates.iter().map(|&(robot, at)| (id(robot), point(at))).collect(),
        opponents: problem.opponents.iter().map(|&at| point(at)).collect(),
    }
}

/// Authored cases of the smallest base: stored in four copies they come nearest to the 34 a team would have
/// without symmetry.
const PART: usize = 9;
/// Of the random libraries.
const SEED: u64 = 8;
