//! `division_b_library`: tests of division B's built-in library with the oracle. Its plans are read, not
//! played.
//!
//! Rules it must keep (ssl-rules, 2026): no robot of ours touches the ball in their defence area (1 m deep, 2
//! m wide), and a ball is dribbled for less than a metre.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use match_tests::oracle::library::{Action, Library, Point};
use match_tests::oracle::problem::Problem;
use match_tests::oracle::{Rules, retrieve};

/// Minimum number of cases of the league's library.
const AUTHORED_MIN: usize = 16;
/// Regions of the paper.
const REGIONS: [&str; 6] = ["back", "center", "corner", "front", "front-side", "side"];
/// Maximum length of a dribble, mm.
const DRIBBLE_MAX: f64 = 1000.0;

fn directory() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../casebase/library/cases/division-b")
}

fn division_b() -> Library {
    Library::read(&directory()).expect("the built-in library is readable")
}

#[test]
fn every_region_has_gameplays_for_two_and_three_robots_without_warnings() {
    let library = division_b();
    let authored = library.cases.len() / 4;
    assert!(authored >= AUTHORED_MIN, "{authored} cases");
    assert!(library.cases.iter().all(|case| (2..=3).contains(&case.robots.len())));
    assert!(library.cases.iter().any(|case| case.robots.len() == 3));
    let regions: BTreeSet<_> = library.cases.iter().filter_map(|case| case.name.split('/').next()).collect();
    assert_eq!(regions, BTreeSet::from(REGIONS));
    let built = case_tools::load(&directory()).expect("no errors");
    assert!(built.findings.is_empty(), "{:?}", built.findings);
    assert!(case_library::LEAGUES.iter().any(|league| league.name == "division-b"));
}

#[test]
fn every_case_in_every_symmetry_is_retrieved_from_its_own_situation() {
    let library = division_b();
    for case in &library.cases {
        let winner = retrieve(&library, &Problem::own_situation(case), &Rules::default()).winner;
        let winner = winner.unwrap_or_else(|| panic!("{} blocks itself", case.name));
        assert_eq!(library.cases[winner.id].name, case.name, "{} is beaten", case.symmetry);
        assert_eq!(winner.conditions, case.opponents.len(), "{} {}", case.name, case.symmetry);
    }
}

#[test]
fn cases_do_not_play_in_the_opponents_area_or_dribble_a_metre() {
    for case in division_b().cases {
        let attack = case.defending.attack();
        let in_their_area = |at: Point| at.x * attack > 3500 && at.y.abs() < 1000;
        assert!(!in_their_area(case.ball), "{}: the ball", case.name);
        for robot in &case.robots {
            assert!(!in_their_area(robot.at), "{}: a robot", case.name);
            for action in &robot.gameplay {
                match *action {
                    Action::DribbleTo(to) => {
                        let distance = ((to.x - case.ball.x) as f64).hypot((to.y - case.ball.y) as f64);
                        assert!(distance < DRIBBLE_MAX, "{}: {distance} mm", case.name);
                        assert!(!in_their_area(to), "{}: a dribble", case.name);
                    }
                    Action::GoTo(to) => assert!(!in_their_area(to), "{}: a run", case.name),
                    _ => {}
                }
            }
        }
    }
}
