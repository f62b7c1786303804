//! `skeleton`: tests: a drafted case passes every check and is retrieved in the situation it was drafted
//! from.

mod common;

use case_tools::{Files, Lineup, Sampler, SkeletonError, build, skeleton};
use casebase::{Problem, RetrievalSettings, retrieve_best};
use common::{LEAGUE, library, problem};

fn draft(of: &Problem) -> case_tools::Skeleton {
    skeleton(&Files::from_texts("test", LEAGUE, &[]).rules, of).expect("drafted")
}

#[test]
fn drafts_of_two_to_four_robots_are_sound_without_a_doubt_and_retrieve_themselves() {
    let field = library(&[]).base().field();
    for robots in 2..=4 {
        let sampler = Sampler::new(Lineup::guess(field, robots), field, 5);
        for number in 0..300 {
            let situation = sampler.problem(number);
            let made = draft(&situation);
            let files = Files::from_texts("test", LEAGUE, &[("center/new", &made.text)]);
            let library = build(&files).unwrap_or_else(|findings| panic!("{findings:?}\n{}", made.text));
            assert_eq!(library.findings, [], "{number}\n{}", made.text);
            let best =
                retrieve_best(&library.base(), &situation, &RetrievalSettings::default()).expect(&made.text);
            assert_eq!((best.cost, best.similarity), (0.0, 1.0), "{}", made.text);
            let counts = (usize::from(best.teammates), usize::from(best.conditions));
            assert_eq!(counts, (robots, situation.opponents.len()), "{}", made.text);
            assert_eq!((made.retrieved, made.notes, made.findings), (true, vec![], vec![]));
        }
    }
}

#[test]
fn the_robot_nearest_to_the_ball_gets_it_and_keeps_its_place() {
    let made = draft(&problem((0, 0), &[(4, (300, 0)), (9, (-200, 10))], &[(900, 900)]));
    let first = "# tm1: robot 9 of the situation, the nearest to the ball.\n[[teammates]]\nat = [-200, 10]\ngameplay = [\"get_ball\", ";
    assert!(made.text.contains(first), "{}", made.text);
    assert!(made.text.contains("ball = { at = [0, 0], scope = [450, 300] }"), "{}", made.text);
    assert!(made.text.contains("at = [900, 900]\nscope = [300, 300]\n"), "{}", made.text);
}

#[test]
fn more_than_four_a_side_leave_out_the_farthest_and_say_so() {
    let robots: Vec<_> = (0..7).map(|id| (id, (-300 - 200 * i32::from(id), 0))).collect();
    let opponents: Vec<_> = (0..6).map(|i| (2600 - 300 * i, 1500)).collect();
    let made = draft(&problem((0, 0), &robots, &opponents));
    assert_eq!(made.notes.len(), 2, "{:?}", made.notes);
    assert!(
        made.notes[0].contains("4 at most") && made.notes[0].ends_with("robot 4, 5, 6"),
        "{:?}",
        made.notes
    );
    assert!(made.notes[1].ends_with("opponent 2, 1"), "{:?}", made.notes);
    assert!(made.notes.iter().all(|note| made.text.contains(note)));
    assert_eq!((made.retrieved, made.findings), (true, vec![]));
    assert_eq!(made.text.matches("[[teammates]]").count(), 4);
}

#[test]
fn objects_beyond_the_lines_are_moved_inside_with_a_note() {
    let made = draft(&problem((2750, 0), &[(1, (2600, i32::MAX))], &[(i32::MIN, 0)]));
    assert_eq!(made.notes.len(), 3, "{:?}", made.notes);
    assert_eq!(made.findings, []);
    // A robot that far off is another situation.
    assert!(!made.retrieved);
    // A ball just over the line is not.
    assert!(draft(&problem((2750, 0), &[(1, (2600, 0))], &[])).retrieved);
}

#[test]
fn with_every_kick_blocked_the_robot_dribbles() {
    let wall: Vec<_> = [(300, 0), (200, 300), (200, -300), (0, 330), (0, -330)].into();
    let made = draft(&problem((0, 0), &[(1, (-150, 0))], &wall));
    assert!(made.text.contains("\"get_ball\", { dribble_to = [540, 0] }"), "{}", made.text);
    assert!(made.retrieved);
}

#[test]
fn without_a_robot_or_a_league_there_is_no_draft() {
    let rules = |text: &str| Files::from_texts("test", text, &[]).rules;
    assert_eq!(skeleton(&rules(LEAGUE), &problem((0, 0), &[], &[])), Err(SkeletonError::NoTeammate));
    let refused = skeleton(&rules("field = 1"), &problem((0, 0), &[(1, (0, 0))], &[]));
    assert!(matches!(refused, Err(SkeletonError::League(findings)) if !findings.is_empty()));
}
