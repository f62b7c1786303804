//! `tests`: a file is changed as by hand, and what is shown of it is what the checks and retrieval say.

use super::*;
use crate::{Severity, code};

const RULES: &str = include_str!("../../../library/cases/division-b/league.toml");
const CASE: &str = "\
# Why: it was missing.
intent = \"Play it around.\" # one sentence
defending = \"yellow\"
ball = { at = [-600, 0],  scope = [450, 250] }

# tm1: the passer.
[[teammates]]
at = [-720, 0]   # behind the ball
gameplay = [\"get_ball\", { pass_ball = 2 }]

[[teammates]]
gameplay = [
    \"wait\", # until it comes
    { receive_ball = 1 },
    { kick = \"goal\" },
]
at = [300, 900]

[[opponents]]
at = [-150, -600]
scope = [300, 225]
";

fn workbench() -> Workbench {
    Workbench::new(Files::from_texts("division-b", RULES, &[])).unwrap()
}

fn edited(text: &str, edit: Edit) -> String {
    workbench().edited("center/a", text, edit, Symmetry::Identity).unwrap()
}

fn part(name: &str) -> Part {
    name.parse().unwrap()
}

/// Lines of `after` that are not in `before`, and the other way round.
fn difference<'t>(before: &'t str, after: &'t str) -> [Vec<&'t str>; 2] {
    let only =
        |a: &'t str, b: &'t str| a.lines().filter(|line| !b.lines().any(|other| other == *line)).collect();
    [only(before, after), only(after, before)]
}

#[test]
fn a_drag_changes_two_numbers_and_no_comment_or_order() {
    let text = edited(CASE, Edit::Move { part: part("tm1"), to: [-800, 50] });
    assert_eq!(
        difference(CASE, &text),
        [vec!["at = [-720, 0]   # behind the ball"], vec!["at = [-800, 50]   # behind the ball"]]
    );
    let text = edited(CASE, Edit::Move { part: part("ball"), to: [-590, 10] });
    assert!(text.contains("ball = { at = [-590, 10],  scope = [450, 250] }\n"), "{text}");
    let text = edited(CASE, Edit::Scope { part: part("opp1"), radii: [310, 225] });
    assert_eq!(difference(CASE, &text), [vec!["scope = [300, 225]"], vec!["scope = [310, 225]"]]);
    let text = edited(CASE, Edit::Intent { intent: "Around \"him\".".into() });
    assert!(text.contains("intent = 'Around \"him\".' # one sentence\n"), "{text}");
}

#[test]
fn the_same_place_again_is_the_same_text() {
    for (name, to) in [("ball", [-600, 0]), ("tm2", [300, 900]), ("opp1", [-150, -600])] {
        assert_eq!(edited(CASE, Edit::Move { part: part(name), to }), CASE, "{name}");
    }
}

#[test]
fn a_drag_in_a_mirror_image_moves_the_case_so_that_its_image_lies_there() {
    let workbench = workbench();
    for symmetry in Symmetry::ALL {
        let edit = Edit::Move { part: part("tm2"), to: [400, -700] };
        let text = workbench.edited("center/a", CASE, edit, symmetry).unwrap();
        let sheet = workbench.sheet("center/a", &text);
        let copy = sheet.copies.iter().find(|copy| copy.symmetry == symmetry.label()).unwrap();
        assert_eq!(copy.robots[1].at, [400, -700], "{symmetry:?}");
    }
}

#[test]
fn actions_are_added_and_taken_out_in_their_list() {
    let dribble = ActionText::DribbleTo([-500, 200]);
    let text = edited(CASE, Edit::AddAction { robot: 1, number: 2, action: dribble });
    assert!(
        text.contains(r#"gameplay = ["get_ball", { dribble_to = [-500, 200] }, { pass_ball = 2 }]"#),
        "{text}"
    );
    let back = edited(&text, Edit::RemoveAction { robot: 1, number: 2 });
    assert_eq!(back, CASE);
    // A list on several lines keeps its layout.
    let text = edited(CASE, Edit::SetAction { robot: 2, number: 3, action: ActionText::Kick("push".into()) });
    assert_eq!(difference(CASE, &text), [vec!["    { kick = \"goal\" },"], vec!["    { kick = \"push\" },"]]);
}

#[test]
fn a_pass_brings_its_receive_with_it_and_a_robot_that_goes_takes_its_passes_along() {
    let three = edited(CASE, Edit::AddRobot { at: [1500, -900] });
    let text = edited(&three, Edit::SetAction { robot: 2, number: 3, action: ActionText::PassBall(3) });
    assert_eq!(codes(&text), [code::PASS_UNANSWERED]);
    let shorter = edited(&three, Edit::RemoveAction { robot: 2, number: 3 });
    let text = edited(&shorter, Edit::AddAction { robot: 2, number: 3, action: ActionText::PassBall(3) });
    assert!(codes(&text).is_empty(), "{:?}", codes(&text));
    let without = edited(&text, Edit::RemoveRobot { robot: 1 });
    let sheet = workbench().sheet("center/a", &without);
    assert_eq!(sheet.robots.len(), 2);
    assert_eq!(sheet.robots[0].actions, [ActionText::Wait, ActionText::PassBall(2)]);
    assert_eq!(sheet.robots[1].actions, [ActionText::Wait, ActionText::ReceiveBall(1)]);
}

fn codes(text: &str) -> Vec<&'static str> {
    let errors = workbench().sheet("center/a", text).findings;
    errors.iter().filter(|finding| finding.severity == Severity::Error.to_string()).map(|f| f.code).collect()
}

#[test]
fn a_kick_goes_to_the_kind_whose_end_is_nearest_and_a_pass_to_the_nearest_robot() {
    let text = edited(CASE, Edit::Move { part: part("tm2.3"), to: [4500, 400] });
    assert!(text.contains("{ kick = \"goal_left\" }"), "{text}");
    let text = edited(CASE, Edit::Move { part: part("tm2.3"), to: [1600, 900] });
    assert!(text.contains("{ kick = \"push\" }"), "{text}");
    let text = edited(CASE, Edit::AddRobot { at: [0, -2000] });
    let text = edited(&text, Edit::Move { part: part("tm1.2"), to: [100, -1900] });
    assert!(text.contains("{ pass_ball = 3 }"), "{text}");
}

#[test]
fn actions_that_may_follow_are_those_that_the_checks_accept() {
    let workbench = workbench();
    let sheet = workbench.sheet("center/a", CASE);
    // tm1 holds the ball after get_ball: it may dribble, pass and kick, and receives nothing.
    let second = &sheet.robots[0].may_be[1];
    assert!(second.contains(&ActionText::PassBall(2)) && second.contains(&ActionText::Kick("goal".into())));
    assert!(!second.contains(&ActionText::ReceiveBall(2)));
    // tm2 waits for the pass: it does not hold the ball before, nor does a second robot begin with it.
    let first = &sheet.robots[1].may_be[0];
    assert!(first.contains(&ActionText::ReceiveBall(1)) && !first.contains(&ActionText::Kick("goal".into())));
    assert!(!first.contains(&ActionText::GetBall));
    // Each of them as the last action of its list gives no error but the other's missing part.
    for (robot, sheet) in (1..).zip(&sheet.robots) {
        for (index, choices) in sheet.may_be.iter().enumerate() {
            for action in choices {
                let mut text = CASE.to_owned();
                for number in (index + 1..=sheet.actions.len()).rev() {
                    text = edited(&text, Edit::RemoveAction { robot, number });
                }
                text = edited(&text, Edit::AddAction { robot, number: index + 1, action: action.clone() });
                let found = codes(&text);
                if (robot, index) == (1, 0) {
                    assert_eq!(
                        found.contains(&code::ONE_GETTER),
                        *action != ActionText::GetBall,
                        "{action:?}"
                    );
                    continue;
                }
                // tm1 gives its pass up where it plays the ball otherwise: then tm2 has none.
                let own = if robot == 1 { code::RECEIVE_UNANSWERED } else { code::PASS_UNANSWERED };
                assert!(found.iter().all(|found| *found == own), "{robot}.{index} {action:?}: {found:?}");
            }
        }
    }
}

#[test]
fn a_text_that_cannot_be_read_has_findings_and_no_drawing() {
    let sheet = workbench().sheet("center/a", "intent = \n");
    assert_eq!(sheet.findings[0].code, code::SYNTAX);
    assert!(sheet.copies.is_empty());
    let refused = Edit::Move { part: part("tm1"), to: [0, 0] }.apply("intent = \n");
    assert!(matches!(refused, Err(EditError::Syntax(_))));
    let refused = Edit::Move { part: part("tm4"), to: [0, 0] }.apply(CASE);
    assert_eq!(refused, Err(EditError::NoPart("at of tm4".into())));
    let refused = Edit::Scope { part: part("ball"), radii: [0, 10] }.apply(CASE);
    assert!(matches!(refused, Err(EditError::Range(_))));
}

#[test]
fn only_plain_names_in_a_region_name_a_case() {
    for name in ["center/a", "front-side/cut_back2"] {
        assert!(is_case_name(name), "{name}");
    }
    for name in
        ["a", "../a", "center/../a", "/a", "a/b/c", "center/a.toml", "center/", "c\u{e9}/a", "a\\b/c", "./a"]
    {
        assert!(!is_case_name(name), "{name}");
    }
}

#[test]
fn parts_are_read_alike_from_tables_and_from_lists_of_inline_tables() {
    let inline = "\
        intent = \"x\"\ndefending = \"yellow\"\nball = { at = [-600, 0], scope = [450, 250] }\n\
        teammates = [{ at = [-720, 0], gameplay = [\"get_ball\", { pass_ball = 2 }] }, \
        { at = [300, 900], gameplay = [\"wait\", { receive_ball = 1 }, { kick = \"goal\" }] }]\n\
        opponents = [{ at = [-150, -600], scope = [300, 225] }]\n";
    for text in [CASE, inline] {
        let case = CaseText::read(text).unwrap();
        assert_eq!(case.robots(), 2);
        assert_eq!(case.scope_of(&part("ball")), Some([450, 250]));
        assert_eq!(case.scope_of(&part("opp1")), Some([300, 225]));
        assert_eq!([case.scope_of(&part("opp2")), case.scope_of(&part("tm1"))], [None, None]);
        assert_eq!(case.point_of(&part("tm2")), Some([300, 900]));
        // The comment behind `wait` belongs to no action.
        let actions: Vec<String> = case.actions(2).iter().map(ToString::to_string).collect();
        assert_eq!(actions, ["\"wait\"", "{ receive_ball = 1 }", "{ kick = \"goal\" }"]);
    }
    assert!(matches!(CaseText::read("ball = {"), Err(EditError::Syntax(_))));
}

#[test]
fn actions_are_written_as_read_and_other_texts_are_refused() {
    for text in [
        "\"wait\"",
        "\"get_ball\"",
        "{ go_to_point = [1, -2] }",
        "{ dribble_to = [400, -150] }",
        "{ turn = { heading_deg = 45 } }",
        "{ turn = { face = [1, 2] } }",
        "{ pass_ball = 2 }",
        "{ receive_ball = 1 }",
        "{ kick = \"left\" }",
    ] {
        assert_eq!(text.parse::<ActionText>().unwrap().to_string(), text);
    }
    for text in ["", "{", "\"fly\"", "{ kick = 1 }", "\"wait\"\nother = 1"] {
        assert!(matches!(text.parse::<ActionText>(), Err(EditError::Syntax(_))), "{text}");
    }
}

#[test]
fn files_without_a_case_keep_the_others_in_order() {
    let files = Files::from_texts("l", "", &[("a/a", "1"), ("a/b", "2"), ("a/c", "3")]).without("a/b");
    let names: Vec<&str> = files.cases.iter().map(|file| file.name.as_str()).collect();
    assert_eq!(names, ["a/a", "a/c"]);
}
