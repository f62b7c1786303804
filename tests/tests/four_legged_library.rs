//! Is the built-in four-legged library fit to play with, judged by the oracle and by nothing of the program?
//!
//! Each case must be the answer to its own situation (DESIGN §4.1 warns of a case beaten there), the ball must nearly
//! everywhere lie in some case's scope (paper §5: "most of the time, at least one case will be retrieved"), and no case
//! may be there for nothing.

use std::collections::BTreeMap;
use std::path::Path;

use match_tests::oracle::library::{Goal, Library, Point};
use match_tests::oracle::problem::Problem;
use match_tests::oracle::{Rules, retrieve};
use match_tests::random_library::{Dice, random_problem};

/// Cases the issue asks for to start with.
const AUTHORED_MIN: usize = 16;

fn four_legged() -> Library {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../casebase/library/cases/four-legged");
    Library::read(&folder).expect("the built-in library is readable")
}

#[test]
fn every_case_in_every_symmetry_retrieves_itself_or_its_twin_from_its_own_situation() {
    let library = four_legged();
    assert!(library.cases.len() >= 4 * AUTHORED_MIN);
    for (id, case) in library.cases.iter().enumerate() {
        let problem = Problem::own_situation(case);
        let answer = retrieve(&library, &problem, &Rules::default());
        let winner = answer.winner.unwrap_or_else(|| panic!("{} blocks itself", case.name));
        let won = &library.cases[winner.id];
        assert_eq!(
            won.name,
            case.name,
            "{id} {} is beaten by {}: {}",
            case.symmetry,
            won.symmetry,
            problem.to_line()
        );
        assert_eq!((winner.similarity, winner.cost), (1.0, 0.0), "{} {}", case.name, case.symmetry);
        assert_eq!(winner.conditions, case.opponents.len(), "{} {}", case.name, case.symmetry);
    }
}

#[test]
fn a_robot_behind_a_ball_that_nobody_blocks_has_a_case_on_95_percent_of_the_field() {
    let library = four_legged();
    for defending in [Goal::Yellow, Goal::Cyan] {
        let (mut places, mut covered) = (0, 0);
        for x in (-2650..=2650).step_by(100) {
            for y in (-1750..=1750).step_by(100) {
                let teammates = vec![(1, Point { x: x - 150 * defending.attack(), y })];
                let problem = Problem { ball: Point { x, y }, defending, teammates, opponents: Vec::new() };
                places += 1;
                covered += usize::from(retrieve(&library, &problem, &Rules::default()).winner.is_some());
            }
        }
        assert!(covered * 100 >= places * 95, "defending {}: {covered} of {places}", defending.word());
    }
}

#[test]
fn every_case_wins_some_sampled_problem() {
    let library = four_legged();
    let mut dice = Dice::new(4);
    let mut wins: BTreeMap<&str, u32> = library.cases.iter().map(|case| (case.name.as_str(), 0)).collect();
    for _ in 0..4000 {
        if let Some(winner) =
            retrieve(&library, &random_problem(&mut dice, &library), &Rules::default()).winner
        {
            *wins.entry(library.cases[winner.id].name.as_str()).or_default() += 1;
        }
    }
    let rare: Vec<_> = wins.iter().filter(|(_, wins)| **wins < 10).collect();
    assert!(rare.is_empty(), "hardly ever retrieved: {rare:?} of {wins:?}");
}
