//! `large_library`: tests of a library of 2,500 files.
//!
//! `explain` tests every case without index or short cut: it is the plain scan.

use case_library::LEAGUES;
use casebase::{
    CaseBase, CaseVerdict, Match, PointMm, Problem, RetrievalSettings, explain, rank_order, retrieve,
    retrieve_best,
};
use match_tests::random_library::{Dice, RandomLibrary};
use protocol::{CaseId, RobotId};

/// A problem near a random case, robots about their places.
fn problem(dice: &mut Dice, base: &CaseBase<'_>) -> Problem {
    let id = dice.between(0, base.len() as i64 - 1) as u16;
    let case = base.case(CaseId(id)).expect("an id of the base");
    let mut near = |at: PointMm, sigma: f64| {
        PointMm::new(at.x + dice.scatter(sigma) as i32, at.y + dice.scatter(sigma) as i32)
    };
    let ball = near(case.ball(), 150.0);
    let teammates =
        RobotId::all().zip(case.robots()).map(|(id, robot)| (id, near(case.adapted(robot, ball), 350.0)));
    let teammates = teammates.collect();
    let opponents = case.opponents().map(|(at, _)| near(at.plus(case.shift(ball)), 300.0)).collect();
    Problem { ball, defending: case.defending(), teammates, opponents }
}

/// Checks for the same winner and count; returns the number of problems with a winner.
fn agree(base: &CaseBase<'_>, seed: u64, problems: usize) -> usize {
    let settings = RetrievalSettings::default();
    let mut dice = Dice::new(seed);
    let mut won = 0;
    for number in 0..problems {
        let problem = problem(&mut dice, base);
        let mut candidates: Vec<Match> = Vec::new();
        explain(base, &problem, &settings, |_, verdict| {
            if let CaseVerdict::Candidate(found) = verdict {
                candidates.push(found);
            }
        });
        candidates.sort_by(|a, b| rank_order(a, b, &settings));
        let found = retrieve(base, &problem, &settings);
        assert_eq!(usize::from(found.candidates), candidates.len(), "problem {number}: {problem:?}");
        assert_eq!(found.best.as_ref(), candidates.first(), "problem {number}: {problem:?}");
        assert_eq!(retrieve_best(base, &problem, &settings), found.best, "problem {number}: {problem:?}");
        won += usize::from(found.best.is_some());
    }
    won
}

#[test]
fn explain_and_retrieve_agree_on_10_000_problems_of_the_built_in_libraries() {
    for league in LEAGUES.iter().filter(|league| !league.names.is_empty()) {
        let won = agree(&league.base(), 1, 10_000);
        assert!(won > 2_000, "{}: {won}", league.name);
    }
}

#[test]
fn a_library_of_2_500_files_loads_and_retrieves_as_the_plain_scan() {
    let directory = std::env::temp_dir().join(format!("large-library-{}", std::process::id()));
    RandomLibrary::new(11, 2_500).write(&directory).expect("written");
    let mut reported = Vec::new();
    let loaded = case_tools::load_with_progress(&directory, |done, all| reported.push((done, all)));
    std::fs::remove_dir_all(&directory).expect("removed");
    let library = loaded.expect("sound");
    assert!(
        reported.is_sorted()
            && reported.first() == Some(&(0, 5_000))
            && reported.last() == Some(&(5_000, 5_000))
    );
    let base = library.base();
    assert_eq!((library.names.len(), base.len()), (2_500, 10_000));
    let won = agree(&base, 2, 2_000);
    assert!(won > 400, "{won}");
}
