//! `competence`: tests: survey counts agree with cases actually deleted and problems actually retrieved.

use case_tools::coverage::{Cells, Counters, Survey};
use case_tools::{Files, Library, build};
use casebase::{GoalEnd, PointMm, Problem, RetrievalSettings, retrieve};
use protocol::RobotId;

const RULES: &str = "[field]\nlength = 5400\nwidth = 3600\ngoal_width = 800\npenalty_area = { depth = 650, width = 1300 }\n\
    [pass]\nr_min = 100\nr_max = 300\n[kicks.ahead]\nheading_deg = 0\nlength = 800\nr_min = 100\nr_max = 300\n";

fn case(ball: [i32; 2], scope: [i32; 2], opponents: &str) -> String {
    let [x, y] = ball;
    format!(
        "intent = \"test\"\ndefending = \"yellow\"\nball = {{ at = {ball:?}, scope = {scope:?} }}\n[[teammates]]\n\
         at = [{}, {y}]\ngameplay = [\"get_ball\", {{ kick = \"ahead\" }}]\n{opponents}",
        x - 150
    )
}

/// A wide case, one inside it, one beside it, and one with an opponent scope ahead.
fn texts() -> Vec<(&'static str, String)> {
    vec![
        ("back/wide", case([-1500, 0], [800, 700], "")),
        ("back/within", case([-1500, 0], [300, 300], "")),
        ("center/beside", case([-400, 300], [700, 600], "")),
        ("center/pressed", case([0, 0], [700, 600], "[[opponents]]\nat = [0, 400]\nscope = [300, 300]\n")),
    ]
}

fn library(texts: &[(&str, String)]) -> Library {
    let cases: Vec<(&str, &str)> = texts.iter().map(|(name, text)| (*name, text.as_str())).collect();
    build(&Files::from_texts("test", RULES, &cases)).expect("a sound library")
}

/// A problem from its number alone: balls over the whole field, one to three robots, up to two opponents.
fn problem(number: u64) -> Problem {
    let mut state = number.wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ 0xD1B5_4A32_D192_ED03;
    let mut next = |end: i32| {
        state = (state ^ (state >> 29)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        state ^= state >> 32;
        (state % u64::from(end.unsigned_abs())) as i32
    };
    let mut place = || PointMm::new(next(5401) - 2700, next(3601) - 1800);
    let ball = place();
    let teammates = RobotId::all().skip(1).take(1 + number as usize % 3).map(|id| (id, place())).collect();
    let opponents = (0..number % 3).map(|_| place()).collect();
    let defending = if number.is_multiple_of(2) { GoalEnd::Negative } else { GoalEnd::Positive };
    Problem { ball, defending, teammates, opponents }
}

fn survey(library: &Library) -> Counters {
    let base = library.base();
    let cells = Cells::new(base.field(), 300).expect("a grid");
    Survey::new(base, &RetrievalSettings::default(), cells)
        .expect("settings")
        .over((0..PROBLEMS).map(|n| (n, problem(n))))
}

#[test]
fn the_loss_of_a_deletion_is_what_really_deleting_the_file_loses() {
    let texts = texts();
    let whole = survey(&library(&texts));
    assert!(whole.none > 0 && whole.cases.iter().any(|case| case.sole > 0));
    for deleted in 0..texts.len() {
        let mut rest = texts.clone();
        rest.remove(deleted);
        let without = survey(&library(&rest));
        assert_eq!(without.none - whole.none, whole.cases[deleted].sole, "{}", texts[deleted].0);
        let lost = without.areas.iter().zip(&whole.areas).map(|(without, whole)| without.none - whole.none);
        assert!(lost.eq(whole.cases[deleted].sole_in), "{}", texts[deleted].0);
    }
}

#[test]
fn winners_and_candidates_are_those_of_retrieval() {
    let library = library(&texts());
    let counters = survey(&library);
    let (mut wins, mut candidates, mut none) = (vec![0; 4], 0, 0);
    for number in 0..PROBLEMS {
        let found = retrieve(&library.base(), &problem(number), &RetrievalSettings::default());
        candidates += u64::from(found.candidates);
        match found.best {
            Some(best) => wins[usize::from(best.case.0 / 4)] += 1,
            None => none += 1,
        }
    }
    assert_eq!(counters.cases.iter().map(|case| case.wins).collect::<Vec<u64>>(), wins);
    assert_eq!((counters.candidates, counters.none, counters.problems), (candidates, none, PROBLEMS));
    for case in &counters.cases {
        assert_eq!(case.verdicts.iter().sum::<u64>(), PROBLEMS);
        assert_eq!(case.wins + case.beaten_by.values().sum::<u64>(), case.candidate());
    }
    assert_eq!(counters.cells.iter().map(|cell| cell.none).sum::<u64>(), none);
    assert_eq!(counters.rings.iter().sum::<u64>(), counters.costs.iter().sum::<u64>());
}

#[test]
fn parts_merge_to_the_whole_in_any_order() {
    let library = library(&texts());
    let base = library.base();
    let cells = Cells::new(base.field(), 300).expect("a grid");
    let survey = Survey::new(base, &RetrievalSettings::default(), cells).expect("settings");
    let part = |from: u64, to: u64| survey.over((from..to).map(|number| (number, problem(number))));
    let whole = part(0, 900);
    assert_eq!(part(0, 1).merge(part(1, 500)).merge(part(500, 900)), whole);
    assert_eq!(part(500, 900).merge(survey.empty()).merge(part(1, 500).merge(part(0, 1))), whole);
}

#[test]
fn a_problem_just_outside_a_scope_is_counted_as_one_for_wider_scopes() {
    let library = library(&[("center/only", case([0, 0], [500, 400], ""))]);
    let base = library.base();
    let cells = Cells::new(base.field(), 300).expect("a grid");
    let survey = Survey::new(base, &RetrievalSettings::default(), cells).expect("settings");
    // The scope ends at 500.6 mm, one a fifth larger at 600.7 mm.
    for (x, would_fill) in [(500, None), (501, Some(1)), (600, Some(1)), (601, Some(0))] {
        let mut problem = problem(0);
        problem.ball = PointMm::new(x, 0);
        problem.teammates =
            [(RobotId::new(1).expect("an id"), PointMm::new(x - 150, 0))].into_iter().collect();
        let counters = survey.over([(0, problem)]);
        assert_eq!((counters.none == 1).then_some(counters.cases[0].would_fill), would_fill, "{x} mm");
    }
}

/// Enough for every kind of answer to occur often.
const PROBLEMS: u64 = 4000;
