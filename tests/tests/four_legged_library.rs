//! `four_legged_library`: tests of the built-in four-legged library with the oracle.
//!
//! Each case must be the answer to its own situation (docs/case-format.md §1.2 warns of a case beaten there),
//! nearly every problem must have a candidate (paper §5: "most of the time, at least one case will be
//! retrieved"), every case must be retrieved for some problem, none may win everywhere, and every region and
//! class of the paper (§5.1.1) must occur. Problems are drawn as the paper's scenarios place robots
//! (`case_tools::Sampler`, with the line-ups of `league.toml`).

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use match_tests::oracle::library::{Goal, Library, Point};
use match_tests::oracle::problem::Problem;
use match_tests::oracle::{Rules, retrieve};

/// Number of authored cases, as in the paper.
const AUTHORED: usize = 34;
/// Regions of the paper.
const REGIONS: [&str; 6] = ["back", "center", "corner", "front", "front-side", "side"];
/// Number of problems drawn.
const PROBLEMS: u64 = 6000;

fn directory() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../casebase/library/cases/four-legged")
}

fn four_legged() -> Library {
    Library::read(&directory()).expect("the built-in library is readable")
}

/// Problems as the paper's scenarios place robots, the ball over the whole field.
fn drawn() -> impl Iterator<Item = Problem> {
    let built = case_tools::load(&directory()).expect("the built-in library is sound");
    let sampler = case_tools::Sampler::new(built.lineup.clone(), built.base().field(), 2009);
    (0..PROBLEMS).map(move |number| {
        let problem = sampler.problem(number);
        let point = |at: casebase::PointMm| Point { x: at.x.into(), y: at.y.into() };
        Problem {
            ball: point(problem.ball),
            defending: Goal::from_label(problem.defending.label()).expect("one of two words"),
            teammates: problem.teammates.iter().map(|(id, at)| (id.number(), point(*at))).collect(),
            opponents: problem.opponents.iter().map(|at| point(*at)).collect(),
        }
    })
}

#[test]
fn every_region_has_cases_for_one_and_two_robots_and_all_opponent_classes() {
    let library = four_legged();
    assert_eq!(library.cases.len(), 4 * AUTHORED);
    let mut classes = BTreeSet::new();
    for case in library.cases.iter().step_by(4) {
        let region = case.name.split('/').next().unwrap_or_default();
        assert!(REGIONS.contains(&region), "{}", case.name);
        assert!((1..=2).contains(&case.robots.len()) && case.opponents.len() <= 2, "{}", case.name);
        classes.insert((region, case.robots.len(), case.opponents.len()));
    }
    for region in REGIONS {
        for robots in [1, 2] {
            let there = classes.iter().any(|class| (class.0, class.1) == (region, robots));
            assert!(there, "{region} has no case for {robots} robots");
        }
    }
    for class in [(1, 0), (1, 1), (1, 2), (2, 0), (2, 1), (2, 2)] {
        assert!(classes.iter().any(|(_, robots, opponents)| (*robots, *opponents) == class), "{class:?}");
    }
}

#[test]
fn no_scope_of_the_ball_is_larger_than_900_by_700() {
    for case in four_legged().cases {
        assert!(case.scope.x <= 900 && case.scope.y <= 700, "{}: {:?}", case.name, case.scope);
    }
}

#[test]
fn every_case_in_every_symmetry_retrieves_itself_or_its_twin_from_its_own_situation() {
    let library = four_legged();
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
fn a_robot_behind_a_ball_that_no_one_blocks_has_a_case_on_95_percent_of_the_field() {
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
        assert!(covered * 100 >= places * 95, "defending {}: {covered} of {places}", defending.label());
    }
}

#[test]
fn nearly_every_random_problem_has_a_case_and_no_case_wins_a_tenth() {
    let library = four_legged();
    let mut wins: BTreeMap<&str, u64> = library.cases.iter().map(|case| (case.name.as_str(), 0)).collect();
    for problem in drawn() {
        if let Some(winner) = retrieve(&library, &problem, &Rules::default()).winner {
            *wins.entry(library.cases[winner.id].name.as_str()).or_default() += 1;
        }
    }
    let covered: u64 = wins.values().sum();
    assert!(covered * 100 >= PROBLEMS * 97, "{covered} of {PROBLEMS}");
    let odd: Vec<_> = wins.iter().filter(|(_, wins)| **wins == 0 || **wins * 10 > PROBLEMS).collect();
    assert!(odd.is_empty(), "never or too often: {odd:?} of {wins:?}");
}
