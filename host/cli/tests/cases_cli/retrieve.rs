//! `retrieve`: tests of `onetwo cases retrieve`: output to the letter of docs/case-format.md §5.1, malformed
//! lines reported and skipped.

use std::io::{BufRead, BufReader, Read, Write};

use crate::common::{PASS_AROUND, PROBLEM, cases, command, library, onetwo, shot_at, worked_example};

/// The answer of docs/case-format.md §5.1, verbatim.
const ANSWER: &str = r#"{"case":"center/pass-around","id":0,"symmetry":"identity","similarity":0.9984,"cost":171.02,"conditions":1,"teammates":2,"match":{"1":1,"2":3},"adapted":{"1":[-720,10],"3":[300,910]},"candidates":1}"#;
const NOTHING: &str = r#"{"case":null,"candidates":0}"#;

#[test]
fn the_worked_example_is_answered_word_for_word() {
    let run = cases("retrieve", &worked_example("worked"), &[], format!("{PROBLEM}\n"));
    assert_eq!((run.stdout.as_str(), run.code), (format!("{ANSWER}\n").as_str(), 0));
    assert_eq!(run.stderr, "");
}

#[test]
fn an_opponent_inside_a_leg_leaves_no_case() {
    // At the middle of the pass from the ball (-600, 10) to tm2's place (300, 910).
    let blocked = PROBLEM.replace("[-150,40]", "[-150,460]");
    // Before the goal, on the path of the shot from (300, 910) to (2700, 0).
    let before_goal = PROBLEM.replace("[-150,40]", "[1500,455]");
    let run = cases("retrieve", &worked_example("blocked"), &[], format!("{blocked}\n{before_goal}\n"));
    assert_eq!(run.lines(), [NOTHING, NOTHING]);
}

#[test]
fn the_other_three_quarters_of_the_field_are_answered_by_the_symmetric_words() {
    let quarter = |sx: i32, sy: i32, goal: &str| {
        format!(
            r#"{{"ball":[{},{}],"defending":"{goal}","teammates":{{"1":[{},0],"3":[{},{}]}},"opponents":[[{},{}]]}}"#,
            -600 * sx,
            10 * sy,
            -700 * sx,
            200 * sx,
            800 * sy,
            -150 * sx,
            40 * sy
        )
    };
    let input = [quarter(1, -1, "yellow"), quarter(-1, 1, "cyan"), quarter(-1, -1, "cyan")].join("\n");
    let run = cases("retrieve", &worked_example("quarters"), &[], input);
    let expected = |id: u16, label: &str, sx: i32, sy: i32| {
        ANSWER
            .replace("\"id\":0", &format!("\"id\":{id}"))
            .replace("identity", label)
            .replace("[-720,10]", &format!("[{},{}]", -720 * sx, 10 * sy))
            .replace("[300,910]", &format!("[{},{}]", 300 * sx, 910 * sy))
    };
    assert_eq!(
        run.lines(),
        [expected(1, "across-x", 1, -1), expected(2, "across-y", -1, 1), expected(3, "both", -1, -1)]
    );
}

#[test]
fn whole_numbers_are_rounded_as_all_others() {
    let directory = library("whole", &[("front/shot.toml", &shot_at(1000, 0))]);
    let problem = r#"{"ball":[1000,0],"defending":"yellow","teammates":{"15":[880,0]},"opponents":[]}"#;
    let run = cases("retrieve", &directory, &[], problem);
    assert_eq!(
        run.lines(),
        // The case is symmetric to the axis: its mirrored copy across x equals it, and the lower id wins.
        [
            r#"{"case":"front/shot","id":0,"symmetry":"identity","similarity":1.0,"cost":0.0,"conditions":0,"teammates":1,"match":{"1":15},"adapted":{"15":[880,0]},"candidates":2}"#
        ]
    );
}

#[test]
fn malformed_lines_are_reported_with_their_place_and_the_rest_go_on() {
    let table: &[(&str, &str)] = &[
        (&PROBLEM.replace("[200,800]", "[200]"), "teammates.3: expected [x, y] in mm"),
        (&PROBLEM.replace("[200,800]", "[200,800.0]"), "teammates.3: expected [x, y] in mm"),
        (&PROBLEM.replace("[200,800]", "[2e2,800]"), "teammates.3: expected [x, y] in mm"),
        (&PROBLEM.replace("[-600,10]", "{\"x\":1}"), "ball: expected [x, y] in mm"),
        (&PROBLEM.replace("[-150,40]", "[-150,40],[0,0,0]"), "opponents.2: expected [x, y] in mm"),
        (&PROBLEM.replace("yellow", "blue"), "defending: expected \"yellow\" or \"cyan\""),
        (&PROBLEM.replace("\"3\"", "\"16\""), "teammates.16: expected a robot id, 0 to 15"),
        (&PROBLEM.replace("\"3\"", "\"01\""), "teammates.01: robot 1 given twice"),
        (&PROBLEM.replace("\"3\"", "\"1\""), "teammates.1: robot 1 given twice"),
        (
            &PROBLEM.replace("\"ball\"", "\"bal\""),
            "bal: unknown key; the keys are ball, defending, teammates and opponents",
        ),
        (&PROBLEM.replacen('{', "{\"ball\":[0,0],", 1), "ball: given twice"),
        (
            &PROBLEM.replace(",\"opponents\":[[-150,40]]", ""),
            "opponents: missing; the keys are ball, defending, teammates and opponents",
        ),
        ("[]", "expected an object with ball, defending, teammates and opponents"),
        ("{}", "ball: missing; the keys are ball, defending, teammates and opponents"),
        ("{", "column 1: not JSON: EOF while parsing an object"),
        (
            &PROBLEM[..PROBLEM.len() - 1],
            &format!("column {}: not JSON: EOF while parsing an object", PROBLEM.len() - 1),
        ),
    ];
    let mut input = String::new();
    let mut expected = Vec::new();
    for (number, (line, error)) in (1..).step_by(2).zip(table) {
        input.extend([line, "\n", PROBLEM, "\n"]);
        let error = format!("line {number}: {error}").replace('"', "\\\"");
        expected.extend([format!("{{\"error\":\"{error}\"}}"), ANSWER.to_owned()]);
    }
    let run = cases("retrieve", &worked_example("malformed"), &[], input);
    assert_eq!(run.lines(), expected);
    assert_eq!(run.code, 0);
}

#[test]
fn blank_lines_line_ends_and_odd_bytes_are_taken_as_they_come() {
    let input = [b"\n \t\r\n", PROBLEM.as_bytes(), b"\r\n\xc3\x28{}\n\r\n", PROBLEM.as_bytes()].concat();
    let run = cases("retrieve", &worked_example("bytes"), &[], input);
    assert_eq!(run.lines(), [ANSWER, r#"{"error":"line 4: column 1: not UTF-8"}"#, ANSWER]);
    let nothing = cases("retrieve", &worked_example("empty"), &[], "");
    assert_eq!((nothing.stdout.as_str(), nothing.code), ("", 0));
}

#[test]
fn coordinates_beyond_all_fields_are_answered() {
    let far = "99999999999999999999";
    let ball = PROBLEM.replace("-600", far);
    let robot = PROBLEM.replace("-700", &format!("-{far}"));
    let opponents =
        PROBLEM.replace("[[-150,40]]", &format!("[[-150,40],[{far},-{far}],[-2147483648,2147483647]]"));
    let run = cases("retrieve", &worked_example("far"), &[], [ball, robot, opponents].join("\n"));
    assert_eq!(run.lines(), [NOTHING, NOTHING, ANSWER]);
}

#[test]
fn settings_change_the_answer_and_are_recorded_with_it() {
    let directory = worked_example("settings");
    // Robot 3 is 148.66 mm away from tm2's adapted place.
    let near = cases("retrieve", &directory, &["--set", "thr_c=148"], PROBLEM);
    assert_eq!(near.lines(), [r#"{"case":null,"candidates":0,"settings":{"thr_c":"148"}}"#]);
    let max = cases("retrieve", &directory, &["--set", "cost=sum", "--set=cost=max"], PROBLEM);
    // By the largest distance the mirrored copy is a candidate too: with the robots swapped no robot has more
    // than 1339 mm to go, where the least sum requires 1693 mm of one of them.
    let expected = ANSWER
        .replace("171.02", "148.66")
        .replace("\"candidates\":1", "\"candidates\":2,\"settings\":{\"cost\":\"max\"}");
    assert_eq!(max.lines(), [expected]);
    let default = cases("retrieve", &directory, &["--set", "thr_c=1500"], PROBLEM);
    assert_eq!(default.lines(), [ANSWER]);
}

#[test]
fn where_positions_are_clamped_the_answer_says_so() {
    let directory =
        library("clamped", &[("center/pass-around.toml", &PASS_AROUND.replace("[300, 900]", "[300, 1790]"))]);
    // The ball 100 mm to the left: tm2's place would be (300, 1890), beyond the touch line at 1800.
    let problem = PROBLEM.replace("[-600,10]", "[-600,100]").replace("[200,800]", "[300,1700]");
    let run = cases("retrieve", &directory, &["--set", "out_of_field=clamp"], &problem);
    assert!(run.stdout.contains(r#""adapted":{"1":[-720,100],"3":[300,1800]}"#), "{}", run.stdout);
    let kept = cases("retrieve", &directory, &[], &problem);
    assert!(kept.stdout.contains(r#""adapted":{"1":[-720,100],"3":[300,1890]}"#), "{}", kept.stdout);
}

#[test]
fn a_bad_setting_says_what_is_allowed() {
    let directory = worked_example("bad-setting");
    let unknown = cases("retrieve", &directory, &["--set", "thr_x=1"], PROBLEM);
    assert_eq!((unknown.code, unknown.stdout.as_str()), (1, ""));
    assert!(unknown.stderr.contains("--set thr_x=1: no such setting"), "{}", unknown.stderr);
    assert!(
        unknown.stderr.contains("out_of_field") && unknown.stderr.contains("thr_c"),
        "{}",
        unknown.stderr
    );
    let value = cases("retrieve", &directory, &["--set", "cost=average"], PROBLEM);
    assert_eq!(value.code, 1);
    assert!(value.stderr.contains("sum or max"), "{}", value.stderr);
    let usage = cases("retrieve", &directory, &["--set", "cost"], PROBLEM);
    assert_eq!(usage.code, 2);
    assert!(usage.stderr.contains("NAME=VALUE"), "{}", usage.stderr);
}

#[test]
fn a_library_that_cannot_be_had_is_named_with_what_to_do() {
    let missing = onetwo(&["cases", "retrieve", "--library", "no/such/folder"]);
    assert_eq!((missing.code, missing.stdout.as_str()), (1, ""));
    assert!(
        missing.stderr.contains("no/such/folder") && missing.stderr.contains("league.toml"),
        "{}",
        missing.stderr
    );
    let league = onetwo(&["cases", "retrieve", "--league", "cricket"]);
    assert_eq!(league.code, 1);
    assert!(league.stderr.contains("cricket") && league.stderr.contains("four-legged"), "{}", league.stderr);
    let both = onetwo(&["cases", "retrieve", "--library", ".", "--league", "four-legged"]);
    assert_eq!(both.code, 2);
    let broken =
        library("broken", &[("center/pass-around.toml", &PASS_AROUND.replace("\"wait\", ", "\"wiat\", "))]);
    let run = cases("retrieve", &broken, &[], PROBLEM);
    assert_eq!((run.code, run.stdout.as_str()), (1, ""));
    assert!(run.stderr.contains("pass-around.toml:11: error["), "{}", run.stderr);
}

#[test]
fn the_built_in_league_answers_without_any_directory() {
    let run = onetwo(&["cases", "retrieve"]);
    assert_eq!((run.code, run.stdout.as_str(), run.stderr.as_str()), (0, "", ""));
}

#[test]
fn a_question_is_answered_before_the_next_is_asked() {
    let directory = worked_example("dialogue");
    let mut child =
        command(&["cases", "retrieve", "--library", directory.to_str().unwrap()]).spawn().unwrap();
    let mut stdin = child.stdin.take().unwrap();
    let mut stdout = BufReader::new(child.stdout.take().unwrap());
    for question in [PROBLEM, "{}", PROBLEM] {
        writeln!(stdin, "{question}").unwrap();
        let mut answer = String::new();
        stdout.read_line(&mut answer).unwrap();
        assert!(answer.ends_with("}\n"), "{answer}");
    }
    drop(stdin);
    assert_eq!(child.wait().unwrap().code(), Some(0));
}

#[test]
fn whoever_has_read_enough_may_close_the_pipe() {
    let directory = worked_example("closed");
    let mut child =
        command(&["cases", "retrieve", "--library", directory.to_str().unwrap()]).spawn().unwrap();
    let mut stdin = child.stdin.take().unwrap();
    drop(child.stdout.take());
    let questions = format!("{PROBLEM}\n").repeat(10_000);
    // The program stops reading when its reader is gone; then our pipe breaks too.
    let _ = stdin.write_all(questions.as_bytes());
    drop(stdin);
    let mut text = String::new();
    child.stderr.take().unwrap().read_to_string(&mut text).unwrap();
    assert_eq!((child.wait().unwrap().code(), text.as_str()), (Some(0), ""));
}
