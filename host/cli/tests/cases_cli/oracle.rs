//! `oracle`: tests: the program answers as an independent reading of docs/case-format.md §3 does. Files in,
//! lines out: nothing of ours in between but the program itself.

use std::path::Path;

use match_tests::oracle::library::Library;
use match_tests::oracle::problem::Problem;
use match_tests::oracle::{Rules, answer_line, retrieve};
use match_tests::random_library::{Dice, RandomLibrary, random_problem};
use serde::Deserialize;
use serde_json::Value;

use crate::common::{cases, library as scratch};

/// Problems put to the program, as many as the project requires.
const PROBLEMS: usize = 1000;

#[test]
fn a_thousand_lines_are_answered_as_the_oracle_answers() {
    let directory = scratch("oracle", &[]);
    RandomLibrary::new(21, 60).write(&directory).expect("a library can be written");
    let library = Library::read(&directory).expect("the oracle reads it");
    let mut dice = Dice::new(22);
    let problems: Vec<Problem> = (0..PROBLEMS).map(|_| random_problem(&mut dice, &library)).collect();
    let lines: Vec<String> = problems.iter().map(Problem::to_line).collect();
    let out = cases("retrieve", &directory, &[], lines.join("\n") + "\n");
    assert_eq!(out.code, 0, "{}", out.stderr);
    let answers = out.lines();
    assert_eq!(answers.len(), PROBLEMS);
    let (mut excused, mut winners) = (0, 0);
    for (number, ((line, answer), problem)) in (1..).zip(lines.iter().zip(answers).zip(&problems)) {
        let ours: Value = serde_json::from_str(answer).expect("an answer is JSON");
        let theirs = answer_line(&library, number, line).expect("a line has an answer");
        winners += usize::from(!ours["case"].is_null());
        if agree(&ours, &theirs) {
            continue;
        }
        // Where a decision depends on less than a ten-thousandth, two correct answers may differ.
        let near = retrieve(&library, problem, &Rules::default()).near_tie;
        assert!(
            near.is_some(),
            "library seed 21, problem seed 22, line {number}: {line}\nours {ours}\ntheirs {theirs}"
        );
        excused += 1;
    }
    assert!(excused * 100 < PROBLEMS, "{excused} near-ties");
    assert!(winners * 4 > PROBLEMS, "only {winners} problems have an answer");
}

/// The answers of both verbs to a problem.
#[derive(Deserialize)]
struct Reported {
    #[serde(alias = "winner")]
    id: Option<u16>,
    candidates: usize,
    #[serde(default)]
    cases: Vec<Row>,
}

#[derive(Deserialize)]
struct Row {
    id: u16,
    verdict: String,
    rank: Option<usize>,
}

#[test]
fn explain_agrees_with_retrieve_on_10_000_problems_of_two_libraries() {
    let random = scratch("explain-agrees", &[]);
    RandomLibrary::new(23, 30).write(&random).expect("a library can be written");
    let built_in = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../casebase/library/cases/four-legged");
    for (directory, seed) in [(built_in, 24), (random, 25)] {
        let library = Library::read(&directory).expect("the oracle reads it");
        let mut dice = Dice::new(seed);
        let mut winners = 0;
        // In parts, so that at most a few MB are held at a time.
        for part in 0..10 {
            let lines: Vec<_> = (0..1_000).map(|_| random_problem(&mut dice, &library).to_line()).collect();
            let ask =
                |verb, description: &[&str]| cases(verb, &directory, description, lines.join("\n") + "\n");
            let (explained, retrieved) = (ask("explain", &["--json"]), ask("retrieve", &[]));
            assert_eq!((explained.lines().len(), retrieved.lines().len()), (1_000, 1_000));
            for ((explained, retrieved), line) in explained.lines().iter().zip(retrieved.lines()).zip(&lines)
            {
                let [why, what] = [*explained, retrieved].map(|text| {
                    serde_json::from_str::<Reported>(text).unwrap_or_else(|error| panic!("{error}: {text}"))
                });
                assert_eq!((why.id, why.candidates), (what.id, what.candidates), "{part}: {line}");
                let candidates: Vec<_> = why.cases.iter().filter(|row| row.verdict == "candidate").collect();
                assert_eq!(candidates.len(), what.candidates, "{line}");
                let first = candidates.iter().find(|row| row.rank == Some(1)).map(|row| row.id);
                assert_eq!(first, what.id, "{line}");
                winners += usize::from(what.id.is_some());
            }
        }
        assert!(winners > 2_500, "only {winners} problems have an answer");
    }
}

/// Equal but for the last digit that is printed of the two numbers that are not whole.
fn agree(ours: &Value, theirs: &Value) -> bool {
    let (Some(ours), Some(theirs)) = (ours.as_object(), theirs.as_object()) else { return false };
    ours.keys().eq(theirs.keys())
        && ours.iter().all(|(key, value)| match (key.as_str(), value.as_f64(), theirs[key].as_f64()) {
            ("cost", Some(a), Some(b)) => (a - b).abs() <= 0.02,
            ("similarity", Some(a), Some(b)) => (a - b).abs() <= 0.0002,
            _ => *value == theirs[key],
        })
}
