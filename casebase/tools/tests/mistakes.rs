//! `mistakes`: tests: each kind of mistake is reported with code, file, line and a useful hint. One test a
//! kind (docs/case-format.md §1.2).
//!
//! A valid library of two files; each test makes exactly one mistake in one of them. Every code of the table
//! that a text alone can cause has a test here; those that need a directory or thousands of actions are in
//! `findings.rs`.

mod common;

use std::collections::BTreeSet;
use std::path::Path;

use case_tools::{CODES, Files, Finding, Severity, build, code, entry};
use common::{LEAGUE, PASS_AROUND, single};

/// The finding of the one mistake, which must be alone.
#[track_caller]
fn only(rules: &str, cases: &[(&str, &str)]) -> Finding {
    let result = build(&Files::from_texts("test", rules, cases));
    let refused = result.is_err();
    let findings = result.map_or_else(|findings| findings, |library| library.findings);
    let texts: Vec<_> = findings.iter().map(ToString::to_string).collect();
    assert_eq!(findings.len(), 1, "{}", texts.join("\n"));
    assert_eq!(refused, findings[0].severity == Severity::Error, "{}", findings[0]);
    assert_eq!(entry(findings[0].code).map(|entry| entry.severity), Some(findings[0].severity));
    findings[0].clone()
}

#[track_caller]
fn assert_finding(finding: &Finding, file: &str, line: u32, code: &str, hint: &str) {
    let place = (finding.code, finding.file.as_path(), finding.line);
    assert_eq!(place, (code, Path::new(file), line), "{finding}");
    assert!(finding.hint.contains(hint), "{finding}");
}

#[track_caller]
fn replaced(text: &str, old: &str, new: &str) -> String {
    assert!(text.contains(old), "{old} is not in the text");
    text.replacen(old, new, 1)
}

/// One test a kind: in the case or the league, `old => new`, the code, the line and a part of the hint.
macro_rules! mistakes {
    ($($name:ident $place:ident $old:literal => $new:literal, $code:ident $line:literal $hint:literal;)*) => {
        $(
            #[test]
            fn $name() {
                let finding = mistakes!(@$place $old, $new);
                let file = mistakes!(@file $place);
                assert_finding(&finding, file, $line, code::$code, $hint);
            }
        )*
        const IN_TEXTS: &[(&str, &str)] = &[$((stringify!($name), code::$code)),*];
    };
    (@case $old:literal, $new:literal) => {
        only(LEAGUE, &[("center/a", &replaced(PASS_AROUND, $old, $new))])
    };
    (@league $old:literal, $new:literal) => {
        only(&replaced(LEAGUE, $old, $new), &[("center/a", PASS_AROUND)])
    };
    (@file case) => { "test/center/a.toml" };
    (@file league) => { "test/league.toml" };
}

mistakes! {
    a_brace_too_many_is_no_toml case "ball = {" => "ball = {{", SYNTAX 3 "correct the syntax";
    a_key_given_twice_is_no_toml case "defending" => "defending = \"cyan\"\ndefending", SYNTAX 3 "correct the syntax";
    a_misspelt_key_is_told_with_the_known_ones case "at = [-720, 0]" => "at = [-720, 0]\nspeed = 3", UNKNOWN_KEY 7 "take one of: at, gameplay";
    a_misspelt_action_is_told_with_the_known_ones case "\"wait\"" => "\"sleep\"", UNKNOWN_KEY 11 "{ receive_ball = N }";
    an_action_with_an_unknown_key_is_told case "{ pass_ball = 2 }" => "{ pass = 2 }", UNKNOWN_KEY 7 "{ pass_ball = N }";
    a_turn_that_says_no_direction_is_told case "\"wait\"" => "{ turn = { left = 90 } }", UNKNOWN_KEY 11 "{ heading_deg = D } or { face = [x, y] }";
    a_missing_key_is_told case "defending = \"yellow\"\n" => "", MISSING_KEY 1 "add defending";
    a_robot_without_a_place_is_told case "at = [-720, 0]\n" => "", MISSING_KEY 5 "add at";
    an_opponent_without_a_scope_is_told case "scope = [300, 225]" => "", MISSING_KEY 13 "add scope";
    a_team_s_colour_is_no_goal case "\"yellow\"" => "\"blue\"", BAD_DEFENDING 2 "write \"yellow\"";
    a_number_for_a_label_is_told case "\"yellow\"" => "1", WRONG_TYPE 2 "a string in quotes";
    a_fraction_of_a_millimetre_is_told case "[-600, 0]" => "[-600.5, 0]", WRONG_TYPE 3 "a whole number";
    three_coordinates_are_told case "[-720, 0]" => "[-720, 0, 0]", WRONG_TYPE 6 "[x, y] in whole mm";
    two_actions_in_one_table_are_told case "{ pass_ball = 2 }" => "{ pass_ball = 2, kick = \"goal\" }", WRONG_TYPE 7 "{ kick = \"KIND\" }";
    a_huge_number_is_told case "[-720, 0]" => "[-720, 99999999999999999999]", BAD_VALUE 6 "a whole number from";
    a_ball_scope_of_radius_0_is_told case "[450, 250]" => "[450, 0]", BAD_SCOPE 3 "both radii in mm, above 0";
    an_opponent_scope_below_0_is_told case "[300, 225]" => "[300, -1]", BAD_SCOPE 15 "both radii in mm, above 0";
    a_presence_of_another_word_is_told case "scope = [300, 225]" => "scope = [300, 225]\npresence = \"maybe\"", BAD_VALUE 16 "take one of: \"preferred\", \"required\", \"excluded\"";
    a_pass_to_nobody_is_told case "pass_ball = 2" => "pass_ball = 3", ROBOT_NUMBER 7 "another robot of this case";
    a_pass_to_oneself_is_told case "pass_ball = 2" => "pass_ball = 1", ROBOT_NUMBER 7 "another robot of this case";
    nobody_gets_the_ball case "\"get_ball\"" => "\"wait\"", ONE_GETTER 5 "exactly one robot begin with \"get_ball\"";
    two_get_the_ball case "\"wait\"" => "\"get_ball\"", ONE_GETTER 9 "exactly one robot begin with \"get_ball\"";
    a_kick_without_the_ball_is_told case "\"wait\", {" => "{ kick = \"goal\" }, {", NOT_HOLDING 11 "give it the ball first";
    a_dribble_without_the_ball_is_told case "\"wait\", {" => "{ dribble_to = [0, 0] }, {", NOT_HOLDING 11 "give it the ball first";
    a_pass_after_the_ball_is_gone_is_told case "{ pass_ball = 2 }" => "{ kick = \"goal\" }, { pass_ball = 2 }", NOT_HOLDING 7 "give it the ball first";
    a_pass_nobody_receives_is_told case ", { receive_ball = 1 }, { kick = \"goal\" }" => "", PASS_UNANSWERED 7 "receive_ball of this pass";
    a_pass_that_waits_for_its_own_answer_is_a_deadlock case "{ pass_ball = 2 }" => "{ receive_ball = 2 }, { pass_ball = 2 }", RECEIVE_UNANSWERED 7 "let the other robot pass to it";
    a_receive_nobody_passes_is_told case ", { pass_ball = 2 }" => "", RECEIVE_UNANSWERED 11 "let the other robot pass to it";
    a_kind_of_kick_the_league_lacks_is_told case "kick = \"goal\"" => "kick = \"header\"", UNKNOWN_KICK 11 "add [kicks.header] or take one of: forward";
    a_ball_beyond_the_line_is_told case "at = [-600, 0]" => "at = [-2701, 0]", OUTSIDE_FIELD 3 "inside the field";
    a_robot_beyond_the_line_is_told case "at = [300, 900]" => "at = [300, 1801]", OUTSIDE_FIELD 10 "inside the field";
    an_opponent_beyond_the_line_is_told case "at = [-150, -35]" => "at = [-150, -1801]", OUTSIDE_FIELD 14 "inside the field";
    a_league_without_a_width_is_told league "width = 3600\n" => "", MISSING_KEY 2 "add width";
    a_field_of_no_length_is_told league "length = 5400" => "length = 0", BAD_VALUE 3 "from 1 to 30000";
    a_kick_at_a_corner_is_told league "aim = \"goal\"" => "aim = \"corner\"", BAD_VALUE 33 "goal";
    a_kick_without_its_mirror_image_is_told league "offset = 250\n" => "", NO_PARTNER 42 "a kind of opposite heading_deg or offset";
    a_scope_as_large_as_the_field_is_doubtful case "[450, 250]" => "[901, 250]", BIG_SCOPE 3 "within 900 × 700 mm";
    an_opponent_in_the_ball_s_way_is_doubtful case "at = [-150, -35]" => "at = [-150, 440]", SCOPE_IN_PATH 14 "move the scope";
    a_scope_half_in_the_ball_s_way_is_doubtful case "at = [-150, -35]" => "at = [-150, 160]", SELF_BLOCKING 14 "make the scope smaller";
    a_point_beyond_the_line_is_doubtful case "\"wait\", {" => "{ go_to_point = [0, 1801] }, {", POINT_OUTSIDE 11 "inside the field";
    a_robot_that_leaves_the_ball_is_doubtful case "\"get_ball\", " => "\"get_ball\", { go_to_point = [0, 0] }, ", LEAVES_BALL 7 "write dribble_to";
    a_primitive_no_body_knows_is_doubtful league "forward_soft" => "bicycle", UNKNOWN_PRIMITIVE 18 "take one of: ";
    a_case_for_nothing_is_doubtful case "Two attackers at the centre line, a defender ahead: pass around it and shoot." => " ", NO_INTENT 1 "what the case is for";
    an_opponent_on_a_robot_is_doubtful case "at = [-150, -35]\nscope = [300, 225]" => "at = [-750, 30]\nscope = [100, 100]", SAME_SPOT 14 "move one of the two";
    a_pass_over_a_hand_s_breadth_is_doubtful case "at = [300, 900]\ngameplay = [\"wait\", { receive_ball = 1 }, { kick = \"goal\" }]\n\n[[opponents]]\nat = [-150, -35]" => "at = [-600, 99]\ngameplay = [\"wait\", { receive_ball = 1 }, { kick = \"goal\" }]\n\n[[opponents]]\nat = [-150, -440]", SHORT_PASS 7 "dribble";
    a_robot_that_fetches_the_ball_for_nothing_is_doubtful case ", { kick = \"goal\" }" => ", { kick = \"forward\" }, \"get_ball\"", IDLE_BALL 11 "dribble_to, pass_ball or kick";
    a_kick_out_of_the_field_is_doubtful case "at = [300, 900]\ngameplay = [\"wait\", { receive_ball = 1 }, { kick = \"goal\" }]" => "at = [300, 950]\ngameplay = [\"wait\", { receive_ball = 1 }, { kick = \"left\" }]", KICK_LEAVES 11 "a shorter kind";
}

/// Mistakes that take more than one replacement: name, code.
const OTHERS: &[(&str, &str)] = &[
    ("no robot", code::NO_TEAMMATE),
    ("five robots", code::TOO_MANY_TEAMMATES),
    ("five opponents", code::TOO_MANY_OPPONENTS),
    ("bystander", code::BYSTANDER),
    ("mate on the leg", code::TEAMMATE_IN_PATH),
    ("beyond every get_ball", code::NEVER_REACHED),
    ("twin", code::TWIN),
    ("no case", code::EMPTY),
    ("odd name", code::FILE_NAME),
    ("too many kicks", code::TOO_MANY_KICKS),
    ("beyond reach", code::BEYOND_REACH),
];

/// In `findings.rs`: a directory, a case or a second case is needed. The last one in `sampled.rs`.
const ELSEWHERE: &[&str] = &[
    code::UNREADABLE,
    code::MISPLACED,
    code::NO_LEAGUE,
    code::TOO_MANY_ACTIONS,
    code::BEATEN,
    code::NEVER_RETRIEVED,
];

/// 16,385 files would be needed for it; the limit is that of the ids.
const UNTRIED: &[&str] = &[code::TOO_MANY_CASES];

fn appended(more: &str) -> Finding {
    only(LEAGUE, &[("center/a", &format!("{PASS_AROUND}{more}"))])
}

#[test]
fn a_case_without_robots_is_an_error() {
    let text = "intent = \"x\"\ndefending = \"cyan\"\nball = { at = [0, 0], scope = [9, 9] }\n";
    assert_finding(
        &only(LEAGUE, &[("center/a", text)]),
        "test/center/a.toml",
        1,
        code::NO_TEAMMATE,
        "[[teammates]]",
    );
}

#[test]
fn a_fifth_robot_and_a_fifth_opponent_are_errors() {
    let robots = "\n[[teammates]]\nat = [0, 0]\ngameplay = [\"wait\"]\n".repeat(3);
    assert_finding(&appended(&robots), "test/center/a.toml", 25, code::TOO_MANY_TEAMMATES, "leave out");
    let opponents = "\n[[opponents]]\nat = [0, 1500]\nscope = [9, 9]\n".repeat(4);
    assert_finding(&appended(&opponents), "test/center/a.toml", 29, code::TOO_MANY_OPPONENTS, "justify");
}

#[test]
fn a_shot_and_a_pass_beyond_their_reach_are_errors() {
    let kick = |reach: &str| replaced(LEAGUE, "aim = \"goal\"", &format!("aim = \"goal\"\nreach = {reach}"));
    let cases = [("center/a", PASS_AROUND)];
    // From [300, 900] to the middle of the goal at 2700.
    assert_finding(&only(&kick("2563"), &cases), "test/center/a.toml", 11, code::BEYOND_REACH, "nearer");
    assert!(build(&Files::from_texts("test", &kick("2564"), &cases)).is_ok());
    // From [-600, 0] to the receiver at [300, 900].
    let pass = |reach: &str| replaced(LEAGUE, "[pass]", &format!("[pass]\nreach = {reach}"));
    assert_finding(&only(&pass("1272"), &cases), "test/center/a.toml", 7, code::BEYOND_REACH, "nearer");
    assert!(build(&Files::from_texts("test", &pass("1273"), &cases)).is_ok());
}

#[test]
fn a_bystander_is_doubtful_and_more_so_on_the_ball_s_way() {
    let far = "[[teammates]]\nat = [0, -900]\ngameplay = [\"wait\"]\n";
    assert_finding(&appended(far), "test/center/a.toml", 16, code::BYSTANDER, "leave it out");
    let turns = "[[teammates]]\nat = [-150, 450]\ngameplay = [{ turn = { heading_deg = 0 } }]\n";
    assert_finding(&appended(turns), "test/center/a.toml", 17, code::TEAMMATE_IN_PATH, "move it aside");
}

#[test]
fn a_get_ball_no_kick_leads_to_is_doubtful() {
    let text = single("[0, 0]", "[400, 400]", ", { dribble_to = [90, 0] }")
        + "[[teammates]]\nat = [0, 500]\ngameplay = [\"wait\", \"get_ball\"]\n";
    let library = build(&Files::from_texts("test", LEAGUE, &[("center/a", &text)])).expect("sound");
    let [idle, never] = library.findings.as_slice() else { panic!("{:?}", library.findings) };
    assert_finding(idle, "test/center/a.toml", 9, code::IDLE_BALL, "dribble_to");
    assert_finding(never, "test/center/a.toml", 9, code::NEVER_REACHED, "let a kick come before it");
}

#[test]
fn the_same_case_twice_is_doubtful() {
    let finding = only(LEAGUE, &[("center/a", PASS_AROUND), ("center/b", PASS_AROUND)]);
    assert_finding(&finding, "test/center/b.toml", 1, code::TWIN, "take one of the two out");
}

#[test]
fn a_library_without_a_case_is_doubtful() {
    assert_finding(&only(LEAGUE, &[]), "test/league.toml", 1, code::EMPTY, "<region>/<name>.toml");
}

#[test]
fn a_name_with_a_blank_is_doubtful() {
    let finding = only(LEAGUE, &[("center/pass around", PASS_AROUND)]);
    assert_finding(&finding, "test/center/pass around.toml", 1, code::FILE_NAME, "rename it");
}

#[test]
fn more_kick_kinds_than_fit_are_an_error() {
    let kind = |i| format!("[kicks.k{i}]\nheading_deg = 0\nlength = 9\nr_min = 1\nr_max = 1\n");
    let kinds = (0..256).map(kind).collect::<Vec<_>>().concat();
    let result = build(&Files::from_texts("test", &format!("{LEAGUE}{kinds}"), &[]));
    let findings = result.expect_err("refused");
    assert!(findings.iter().any(|finding| finding.code == code::TOO_MANY_KICKS), "{findings:?}");
}

#[test]
fn there_are_30_kinds_at_least_and_every_code_is_tried() {
    assert!(IN_TEXTS.len() + OTHERS.len() >= 30, "{}", IN_TEXTS.len());
    let tried: BTreeSet<_> = IN_TEXTS.iter().chain(OTHERS).map(|(_, code)| *code).collect();
    let tried: BTreeSet<_> = tried.iter().chain(ELSEWHERE).chain(UNTRIED).copied().collect();
    let known: BTreeSet<_> = CODES.iter().map(|entry| entry.code).collect();
    assert_eq!(tried, known);
}

#[test]
fn what_editors_of_other_systems_leave_behind_is_no_mistake() {
    for text in [PASS_AROUND.replace('\n', "\r\n"), format!("\u{feff}{PASS_AROUND}")] {
        let library = build(&Files::from_texts("test", LEAGUE, &[("center/a", &text)]));
        assert_eq!(library.map(|library| library.findings), Ok(vec![]));
    }
    // Lines are counted equally with either line ending.
    let windows = replaced(PASS_AROUND, "[300, 225]", "[300, 0]").replace('\n', "\r\n");
    let finding = only(LEAGUE, &[("center/a", &windows)]);
    assert_finding(&finding, "test/center/a.toml", 15, code::BAD_SCOPE, "above 0");
}
