//! `retrieval_oracle`: tests: retrieval agrees with the oracle.
//!
//! Random libraries and the built-in one, 1,000 problems and more each, `case-tools` + `casebase` on one side
//! and `match_tests::oracle` on the other, both from the same TOML files. Where a decision depends on a
//! relative difference below 1e-4, two correct answers may differ; such problems are counted and must be few.
//! Lengths in mm, field frame.

use std::path::{Path, PathBuf};

use casebase::{GoalEnd, PointMm, Retrieval, RetrievalSettings};
use match_tests::oracle::library::{Goal, Library, Point};
use match_tests::oracle::problem::Problem;
use match_tests::oracle::{Answer, Criterion, NEAR, Rules, retrieve};
use match_tests::random_library::{Dice, RandomLibrary, random_problem};
use protocol::ids::RobotId;

/// Number of problems per library.
const PROBLEMS: usize = 1500;

/// Maximum share of the problems whose answers may differ by a near-tie.
const EXCUSED_MAX: f64 = 0.01;

#[test]
fn random_libraries_are_answered_as_the_oracle_answers() {
    for (seed, size) in [(1, 1), (2, 5), (3, 20), (4, 20), (5, 60), (6, 60), (7, 120), (8, 250), (9, 500)] {
        let trial = Trial::of_random_library(seed, size);
        trial.compare(&RetrievalSettings::default(), &Rules::default());
    }
}

#[test]
fn the_built_in_library_is_answered_as_the_oracle_answers() {
    let trial = Trial::of_directory(1, &four_legged_directory());
    trial.compare(&RetrievalSettings::default(), &Rules::default());
    assert_eq!(
        trial.table.base().hash(),
        case_library::four_legged().hash(),
        "the baked table is another one"
    );
}

#[test]
fn the_built_in_library_has_no_warnings() {
    let trial = Trial::of_directory(1, &four_legged_directory());
    let findings: Vec<String> = trial.table.findings.iter().map(ToString::to_string).collect();
    assert!(findings.is_empty(), "{}", findings.join("\n"));
}

#[test]
fn settings_change_the_answers_as_documented() {
    let trial = Trial::of_random_library(11, 80);
    let default = Rules::default;
    let (conditions, teammates, cost) =
        (Criterion::Conditions, Criterion::Teammates, Criterion::IntervalCost);
    let settings = [
        ("correspondence", "constrained", Rules { constrained: true, ..default() }),
        ("cost", "max", Rules { longest: true, ..default() }),
        ("scopes", "absolute", Rules { scopes_absolute: true, ..default() }),
        ("thr_c", "700", Rules { furthest: 700.0, ..default() }),
        ("thr", "0.6", Rules { membership: 0.6, ..default() }),
        ("thr", "0.1", Rules { membership: 0.1, ..default() }),
        (
            "ranking",
            "interval-cost,teammates,conditions",
            Rules { ranking: [cost, teammates, conditions], ..default() },
        ),
        (
            "ranking",
            "teammates,conditions,interval-cost",
            Rules { ranking: [teammates, conditions, cost], ..default() },
        ),
    ];
    for (name, value, rules) in settings {
        let mut settings = RetrievalSettings::default();
        settings.set(name, value).unwrap_or_else(|error| panic!("--set {name}={value}: {error}"));
        let changed = trial.compare(&settings, &rules);
        assert!(changed > 0, "--set {name}={value} changes no answer");
    }
}

#[test]
fn every_case_in_all_symmetries_retrieves_itself_in_its_own_situation() {
    let trial = Trial::of_directory(1, &four_legged_directory());
    for (id, case) in trial.oracle.cases.iter().enumerate() {
        let problem = Problem::own_situation(case);
        let answer =
            casebase::retrieve(&trial.table.base(), &translated(&problem), &RetrievalSettings::default());
        let best = answer.best.unwrap_or_else(|| panic!("{} {} blocks itself", case.name, case.symmetry));
        let winner = &trial.oracle.cases[usize::from(best.case.0)];
        assert_eq!(winner.name, case.name, "{id} {} is beaten by {}", case.symmetry, best.case);
        assert_eq!((best.similarity, best.cost), (1.0, 0.0), "{id}");
        assert_eq!(usize::from(best.conditions), case.opponents.len(), "{id}");
    }
}

/// One library, read by both sides.
struct Trial {
    seed: u64,
    oracle: Library,
    table: case_tools::Library,
}

impl Trial {
    fn of_random_library(seed: u64, size: usize) -> Self {
        let dir = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("random-library-{seed}-{size}"));
        RandomLibrary::new(seed, size).write(&dir).expect("a folder for the library");
        Self::of_directory(seed, &dir)
    }

    fn of_directory(seed: u64, dir: &Path) -> Self {
        let oracle = Library::read(dir).expect("readable by the oracle");
        let table = case_tools::load(dir).unwrap_or_else(|findings| {
            let findings: Vec<String> = findings.iter().map(ToString::to_string).collect();
            panic!("seed {seed}: a valid library is refused:\n{}", findings.join("\n"))
        });
        assert_eq!(table.base().len(), oracle.cases.len(), "seed {seed}");
        Self { seed, oracle, table }
    }

    /// Compares both sides; returns the number of answers that differ from those under default rules.
    fn compare(&self, settings: &RetrievalSettings, rules: &Rules) -> usize {
        let base = self.table.base();
        let mut dice = Dice::new(self.seed ^ 0x5eed);
        let (mut excused, mut answered, mut several, mut changed) = (0, 0, 0, 0);
        for number in 1..=PROBLEMS {
            let problem = random_problem(&mut dice, &self.oracle);
            let expected = retrieve(&self.oracle, &problem, rules);
            let got = casebase::retrieve(&base, &translated(&problem), settings);
            answered += usize::from(expected.winner.is_some());
            several += usize::from(expected.candidates > 1);
            if *rules != Rules::default() {
                changed += usize::from(retrieve(&self.oracle, &problem, &Rules::default()) != expected);
            }
            if let Err(difference) = agree(&expected, &got) {
                assert!(
                    expected.near_tie.is_some(),
                    "seed {}, {} cases, problem {number}: {difference}\n{}\nexpected {}\ngot {got:?}\n{rules:?}",
                    self.seed,
                    self.oracle.cases.len(),
                    problem.to_line(),
                    expected.to_json(&self.oracle),
                );
                excused += 1;
                println!("excused: {difference}; {:?} {}", expected.near_tie, problem.to_line());
            }
        }
        println!(
            "seed {}, {} stored cases: of {PROBLEMS} problems {answered} have an answer, {several} several candidates, \
             {excused} excused as near-ties",
            self.seed,
            self.oracle.cases.len(),
        );
        assert!(f64::from(excused) < EXCUSED_MAX * PROBLEMS as f64, "{excused} near-ties");
        assert!(answered * 5 > PROBLEMS, "only {answered} problems with an answer: too easy");
        changed
    }
}

/// The difference between the two answers.
fn agree(expected: &Answer, got: &Retrieval) -> Result<(), String> {
    let same = |what: &str, expected: usize, got: usize| {
        if expected == got { Ok(()) } else { Err(format!("{what}: {expected} expected, got {got}")) }
    };
    let near = |what: &str, expected: f64, got: f32| {
        let within = (expected - f64::from(got)).abs() <= NEAR * expected.max(1.0);
        if within { Ok(()) } else { Err(format!("{what}: {expected} expected, got {got}")) }
    };
    same("candidates", expected.candidates, usize::from(got.candidates))?;
    match (&expected.winner, &got.best) {
        (None, None) => Ok(()),
        (Some(winner), Some(best)) => {
            same("case", winner.id, usize::from(best.case.0))?;
            near("similarity", winner.similarity, best.similarity)?;
            near("cost", winner.cost, best.cost)?;
            same("conditions", winner.conditions, usize::from(best.conditions))?;
            same("teammates", winner.correspondence.len(), usize::from(best.teammates))?;
            let ids: Vec<u8> = best.correspondence.iter().map(|id| id.number()).collect();
            if ids == winner.correspondence { Ok(()) } else { Err(format!("match: got {ids:?}")) }
        }
        (Some(_), None) => Err("no answer".to_owned()),
        (None, Some(best)) => Err(format!("an answer, {}, where there is none", best.case)),
    }
}

fn translated(problem: &Problem) -> casebase::Problem {
    let point = |p: Point| PointMm { x: p.x as i32, y: p.y as i32 };
    let id = |id: u8| RobotId::new(id).expect("an id of 0–15");
    casebase::Problem {
        ball: point(problem.ball),
        defending: match problem.defending {
            Goal::Yellow => GoalEnd::Negative,
            Goal::Cyan => GoalEnd::Positive,
        },
        teammates: problem.teammates.iter().map(|&(robot, at)| (id(robot), point(at))).collect(),
        opponents: problem.opponents.iter().map(|&at| point(at)).collect(),
    }
}

fn four_legged_directory() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../casebase/library/cases/four-legged")
}
