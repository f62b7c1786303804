//! `counterfactual`: tests: the move that `counterfactual` names makes the case win, and no shorter one of
//! its kind does.

mod common;

use case_tools::{Counterfactual, CounterfactualObstacle, Entity, counterfactual};
use casebase::{CaseVerdict, PointMm, RetrievalSettings, explain, retrieve, retrieve_best};
use common::{Dice, PASS_AROUND, library, problem, single};
use protocol::{CaseId, RobotId};

#[test]
fn every_move_found_makes_the_case_win_in_thousands_of_problems() {
    let settings = RetrievalSettings::default();
    let (mut moves, mut kinds, mut asked) = (0, [0; 3], 0);
    for seed in 0..8 {
        let mut dice = Dice::new(seed);
        let library = dice.library(30);
        let base = library.base();
        for _ in 0..350 {
            let problem = dice.problem(&base);
            let winner = retrieve_best(&base, &problem, &settings).map(|found| found.case);
            // One case at random, and all that pass the test of the ball.
            let mut ids = vec![CaseId(dice.below(base.len() as u64) as u16)];
            explain(&base, &problem, &settings, |id, verdict| {
                ids.extend((!matches!(verdict, CaseVerdict::Ball { .. })).then_some(id));
            });
            for id in ids {
                match counterfactual(&base, &problem, &settings, id) {
                    None => assert_ne!(base.case(id).unwrap().defending(), problem.defending),
                    Some(Counterfactual::Winner) => assert_eq!(winner, Some(id)),
                    Some(Counterfactual::NoSingleMove(_)) => {
                        assert_ne!(winner, Some(id));
                        asked += 1;
                    }
                    Some(Counterfactual::Move(found)) => {
                        assert_ne!(winner, Some(id));
                        let again = retrieve(&base, &found.applied(&problem), &settings);
                        assert_eq!(again.best.map(|found| found.case), Some(id), "{found:?}");
                        let [dx, dy] = found.to.minus(found.from).to_f32();
                        assert!((dx.hypot(dy) - found.distance_mm).abs() < 0.01 && found.distance_mm > 0.0);
                        moves += 1;
                        asked += 1;
                        kinds[match found.entity {
                            Entity::Ball => 0,
                            Entity::Teammate(_) => 1,
                            Entity::Opponent(_) => 2,
                        }] += 1;
                    }
                }
            }
        }
    }
    assert!(moves > 2000 && kinds.iter().all(|count| *count > 300), "{asked} {moves} {kinds:?}");
}

/// Both cases cost the distance robot 1 has to walk; `b` is 300 mm farther. By hand: b's place is (300, 0),
/// a's (0, 0).
#[test]
fn the_robots_move_equals_the_one_found_by_hand() {
    let a = single("[0, 0]", "[900, 700]", ", { kick = \"forward\" }");
    let b = a.replace("[[teammates]]\nat = [0, 0]", "[[teammates]]\nat = [300, 0]");
    let library = library(&[("x/a", &a), ("x/b", &b)]);
    let base = library.base();
    let problem = problem((0, 0), &[(3, (-100, 0))], &[]);
    let found = counterfactual(&base, &problem, &RetrievalSettings::default(), CaseId(4));
    let Some(Counterfactual::Move(found)) = found else { panic!("{found:?}") };
    // Past the middle, x = 150, b is nearer: 251 mm; at 150 both cost the same and the lower id wins.
    assert_eq!(found.entity, Entity::Teammate(RobotId::new(3).unwrap()));
    assert_eq!(found.to, PointMm::new(151, 0));
    assert_eq!(found.distance_mm, 251.0);
}

#[test]
fn an_opponent_in_the_leg_is_to_move_by_what_it_stands_inside() {
    let shot = single("[0, 0]", "[900, 700]", ", { kick = \"forward\" }");
    let library = library(&[("x/a", &shot)]);
    let base = library.base();
    // Half way along 1,000 mm the leg is 200 mm wide at each side, times √1.002393: it ends at 200.24 mm.
    let problem = problem((0, 0), &[(1, (0, 0))], &[(500, 150)]);
    let found = counterfactual(&base, &problem, &RetrievalSettings::default(), CaseId(0));
    let Some(Counterfactual::Move(found)) = found else { panic!("{found:?}") };
    assert_eq!((found.entity, found.to), (Entity::Opponent(0), PointMm::new(500, 201)));
    assert_eq!(found.distance_mm, 51.0);
}

#[test]
fn a_case_that_no_single_move_fixes_gets_a_reason() {
    let library = library(&[("x/pass", PASS_AROUND)]);
    let base = library.base();
    let alone = problem((-600, 0), &[(1, (-700, 0))], &[]);
    let settings = RetrievalSettings::default();
    let found = counterfactual(&base, &alone, &settings, CaseId(0));
    let reason = CounterfactualObstacle::Robots { needed: 2, present: 1 };
    assert_eq!(found, Some(Counterfactual::NoSingleMove(reason)));
    // Two robots too far away each: one move brings only one of them within the limit.
    let far = problem((-600, 0), &[(1, (2600, -1700)), (2, (2600, -1800))], &[]);
    let found = counterfactual(&base, &far, &settings, CaseId(0));
    assert!(
        matches!(found, Some(Counterfactual::NoSingleMove(CounterfactualObstacle::Several { .. }))),
        "{found:?}"
    );
    // Under the other goal it is not tested.
    assert_eq!(counterfactual(&base, &far, &settings, CaseId(2)), None);
}
