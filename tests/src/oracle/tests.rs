//! Tests of the oracle by hand calculations.

use std::collections::BTreeMap;

use serde_json::{Value, json};

use super::library::{Library, Point};
use super::{answer_line, walk};

const LEAGUE: &str = r#"
[field]
length = 5400
width = 3600
goal_width = 800
penalty_area = { depth = 650, width = 1300 }
[pass]
r_min = 100
r_max = 300
[kicks.goal]
aim = "goal"
r_min = 100
r_max = 500
[kicks.left]
heading_deg = 90
length = 1000
r_min = 100
r_max = 300
[kicks.right]
heading_deg = -90
length = 1000
r_min = 100
r_max = 300
[kicks.goal_left]
aim = "goal"
offset = 250
r_min = 100
r_max = 300
[kicks.goal_right]
aim = "goal"
offset = -250
r_min = 100
r_max = 300
"#;

/// The example of docs/case-format.md §1, as it is in the built-in library.
const PASS_AROUND: &str = include_str!("../../../casebase/library/cases/four-legged/center/pass-around.toml");

fn library(cases: &[(&str, &str)]) -> Library {
    let files: BTreeMap<String, String> =
        cases.iter().map(|(name, text)| ((*name).to_owned(), (*text).to_owned())).collect();
    Library::from_texts(LEAGUE, &files).expect("readable")
}

fn ask(library: &Library, line: &str) -> Value {
    answer_line(library, 7, line).expect("an answer")
}

fn number(answer: &Value, key: &str) -> f64 {
    answer[key].as_f64().expect(key)
}

#[test]
fn the_documented_example_has_the_documented_answer() {
    // With a shot after the reception.
    let case = PASS_AROUND.replace("{ receive_ball = 1 }", "{ receive_ball = 1 }, { kick = \"goal\" }");
    let library = library(&[("center/pass-around", &case)]);
    let line = r#"{"ball":[-600,10],"defending":"yellow","teammates":{"1":[-700,0],"3":[200,800]},"opponents":[[-150,40]]}"#;
    let answer = ask(&library, line);
    assert_eq!(answer["case"], "center/pass-around");
    assert_eq!(answer["id"], 0);
    assert_eq!(answer["symmetry"], "identity");
    assert!((number(&answer, "similarity") - 0.9984).abs() < 5e-5);
    assert!((number(&answer, "cost") - 171.02).abs() < 5e-3);
    assert_eq!(answer["conditions"], 1);
    assert_eq!(answer["teammates"], 2);
    assert_eq!(answer["match"], json!({"1": 1, "2": 3}));
    assert_eq!(answer["adapted"], json!({"1": [-720, 10], "3": [300, 910]}));
    assert_eq!(answer["candidates"], 1);

    let blocked = line.replace("[[-150,40]]", "[[0,600]]");
    assert_eq!(ask(&library, &blocked), json!({"case": null, "candidates": 0}));
    let malformed = line.replace("[200,800]", "[200]");
    assert_eq!(ask(&library, &malformed), json!({"error": "line 7: teammates.3: expected [x, y] in mm"}));
    assert_eq!(answer_line(&library, 8, "  "), None);
}

#[test]
fn the_four_symmetries_mirror_goal_points_and_kicks() {
    let kick = |kind: &str| {
        format!(
            r#"
intent = "One robot."
defending = "yellow"
ball = {{ at = [1000, 500], scope = [100, 100] }}
[[teammates]]
at = [900, 500]
gameplay = ["get_ball", {{ dribble_to = [1200, 600] }}, {{ kick = "{kind}" }}]
"#
        )
    };
    let library = library(&[("side/heading", &kick("left")), ("side/post", &kick("goal_right"))]);
    let end = |id: usize| {
        let case = &library.cases[id];
        walk::legs(&library, case, case.ball).expect("playable")[0].to
    };
    let close = |a: (f64, f64), b: (f64, f64)| (a.0 - b.0).hypot(a.1 - b.1) < 1e-9;
    // A kick to the left from (1200, 600): +y when attacking +x; its end is mirrored in the copies.
    for (id, at) in
        [(0, (1200.0, 1600.0)), (1, (1200.0, -1600.0)), (2, (-1200.0, 1600.0)), (3, (-1200.0, -1600.0))]
    {
        assert!(close(end(id), at), "{id}: {:?}", end(id));
    }
    // 250 mm to the right of the goal's middle, seen in attack.
    for (id, at) in
        [(4, (2700.0, -250.0)), (5, (2700.0, 250.0)), (6, (-2700.0, -250.0)), (7, (-2700.0, 250.0))]
    {
        assert!(close(end(id), at), "{id}: {:?}", end(id));
    }
}

#[test]
fn a_later_get_ball_goes_to_the_lowest_waiting_robot() {
    let library = library(&[(
        "front/rebound",
        r#"
intent = "Kick ahead, the partner runs on and shoots."
defending = "yellow"
ball = { at = [0, 0], scope = [100, 100] }
[[teammates]]
at = [-100, 0]
gameplay = ["get_ball", { kick = "left" }, { go_to_point = [0, -300] }, { receive_ball = 2 }]
[[teammates]]
at = [-300, 900]
gameplay = ["wait", "get_ball", { dribble_to = [500, 1000] }, { pass_ball = 1 }]
[[teammates]]
at = [0, -900]
gameplay = [{ turn = { heading_deg = 90 } }]
"#,
    )]);
    let legs = walk::legs(&library, &library.cases[0], Point { x: 10, y: 20 }).expect("playable");
    let ends: Vec<_> = legs.iter().map(|leg| (leg.from, leg.to)).collect();
    let round = |(x, y): (f64, f64)| ((x * 1e6_f64).round() / 1e6, (y * 1e6_f64).round() / 1e6);
    let ends: Vec<_> = ends.into_iter().map(|(a, b)| (round(a), round(b))).collect();
    assert_eq!(ends, [((10.0, 20.0), (10.0, 1020.0)), ((510.0, 1020.0), (10.0, -280.0))]);
}

#[test]
fn the_distance_sum_is_minimised_before_a_distant_robot_rejects() {
    // On one line: tm1 at 0, tm2 at 100 (adapted). Robots at 1450 (id 2) and 1700 (id 5): both maps cost
    // 3050; the smaller list [2, 5] wins and sends robot 5 over 1600 mm, though [5, 2] would send it over
    // 1700.
    let library = library(&[(
        "center/pair",
        r#"
intent = "Two robots."
defending = "yellow"
ball = { at = [0, 0], scope = [100, 100] }
[[teammates]]
at = [0, 0]
gameplay = ["get_ball"]
[[teammates]]
at = [100, 0]
gameplay = ["wait"]
"#,
    )]);
    let line = |x: i64| {
        format!(
            r#"{{"ball":[0,0],"defending":"yellow","teammates":{{"05":[{x},0],"2":[1450,0]}},"opponents":[]}}"#
        )
    };
    assert_eq!(ask(&library, &line(1700)), json!({"case": null, "candidates": 0}));
    let answer = ask(&library, &line(1600));
    assert_eq!(answer["match"], json!({"1": 2, "2": 5}), "1500 mm is not too far: {answer}");
    // The mirrored copy across x equals the case: the lower id wins.
    assert_eq!((answer["id"].as_u64(), answer["candidates"].as_u64()), (Some(0), Some(2)));
}

#[test]
fn more_conditions_beat_more_teammates_beat_similarity() {
    let case = |x: i64, tau: i64, robots: usize, opponent: bool| {
        let mut text = format!(
            "intent = \"x\"\ndefending = \"yellow\"\nball = {{ at = [{x}, 0], scope = [{tau}, {tau}] }}\n[[teammates]]\nat = [-100, 0]\ngameplay = [\"get_ball\"]\n"
        );
        for _ in 1..robots {
            text += "[[teammates]]\nat = [-100, 200]\ngameplay = [\"wait\"]\n";
        }
        if opponent {
            text += "[[opponents]]\nat = [400, 0]\nscope = [500, 500]\n";
        }
        text
    };
    let line =
        r#"{"ball":[0,0],"defending":"yellow","teammates":{"1":[0,0],"2":[0,0]},"opponents":[[400,0]]}"#;
    let winner = |cases: &[(&str, String)]| {
        let cases: Vec<(&str, &str)> = cases.iter().map(|(name, text)| (*name, text.as_str())).collect();
        ask(&library(&cases), line)["case"].as_str().expect("a case").to_owned()
    };
    let near = ("a/near", case(0, 500, 1, false));
    let pair = ("b/pair", case(300, 500, 2, false));
    let condition = ("c/condition", case(450, 500, 1, true));
    assert_eq!(winner(&[near.clone(), pair.clone()]), "b/pair");
    assert_eq!(winner(&[near.clone(), pair, condition]), "c/condition");
    // exp(−0.36) = 0.70 < 0.8: the nearer interval wins though its distance is as long.
    assert_eq!(winner(&[("a/far", case(300, 500, 1, false)), ("b/near", near.1)]), "b/near");
}
