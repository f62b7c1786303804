//! Does the built program answer problem lines as an independent reading of DESIGN §4.3 does? Files in, lines out: nothing
//! of ours in between but the program itself.

use std::collections::BTreeMap;

use match_tests::oracle::library::Library;
use match_tests::oracle::problem::Problem;
use match_tests::oracle::{Rules, answer_line, retrieve};
use match_tests::random_library::{Dice, RandomLibrary, random_problem};
use serde_json::Value;

use crate::common::{cases, library as scratch};

/// Problems put to the program, as the issue of the spine has it.
const PROBLEMS: usize = 1000;

#[test]
fn a_thousand_lines_are_answered_as_the_oracle_answers() {
    let folder = scratch("oracle", &[]);
    RandomLibrary::new(21, 60).write(&folder).expect("a library can be written");
    let library = Library::read(&folder).expect("the oracle reads it");
    let mut dice = Dice::new(22);
    let problems: Vec<Problem> = (0..PROBLEMS).map(|_| random_problem(&mut dice, &library)).collect();
    let lines: Vec<String> = problems.iter().map(Problem::to_line).collect();
    let out = cases("retrieve", &folder, &[], lines.join("\n") + "\n");
    assert_eq!(out.code, 0, "{}", out.stderr);
    let answers = out.lines();
    assert_eq!(answers.len(), PROBLEMS);
    let (mut excused, mut winners) = (0, 0);
    for (number, ((line, answer), problem)) in (1..).zip(lines.iter().zip(answers).zip(&problems)) {
        let ours: Value = serde_json::from_str(answer).expect("an answer is JSON");
        let theirs = answer_line(&library, number, line).expect("a line has an answer");
        winners += usize::from(!ours["case"].is_null());
        if retrieve(&library, problem, &Rules::default()).near_tie.is_some() {
            excused += 1;
        } else {
            assert_eq!(rounded(&ours), rounded(&theirs), "library seed 21, problem seed 22, line {number}: {line}");
        }
    }
    assert!(excused * 100 < PROBLEMS, "{excused} near-ties");
    assert!(winners * 4 > PROBLEMS, "only {winners} problems have an answer");
}

/// The answer with every number that is not whole at the two decimals both sides must share.
fn rounded(answer: &Value) -> BTreeMap<String, String> {
    let object = answer.as_object().expect("an answer is an object");
    object
        .iter()
        .map(|(key, value)| match value.as_f64() {
            // Both sides round or cut the last digit their own way.
            Some(number) if key == "cost" || key == "similarity" => (key.clone(), format!("{number:.1}")),
            _ => (key.clone(), value.to_string()),
        })
        .collect()
}
