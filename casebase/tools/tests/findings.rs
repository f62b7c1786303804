//! `findings`: tests: faults of a library are reported with code and line (docs/case-format.md §1.2), those
//! that `mistakes.rs` does not make.

mod common;

use case_tools::{Files, Finding, Severity, build, code, load};
use common::{LEAGUE, PASS_AROUND, single};

/// Code and line of every finding, and whether the library is refused.
fn findings(league: &str, cases: &[(&str, &str)]) -> (Vec<(&'static str, u32)>, bool) {
    let result = build(&Files::from_texts("test", league, cases));
    let refused = result.is_err();
    let list = result.map_or_else(|findings| findings, |library| library.findings);
    let short = |finding: &Finding| {
        assert!(!finding.message.is_empty() && !finding.hint.is_empty(), "{finding}");
        (finding.code, finding.line)
    };
    (list.iter().map(short).collect(), refused)
}

/// The one error of a case: PASS_AROUND with `old` replaced by `new`.
#[track_caller]
fn expect_error(old: &str, new: &str, code: &'static str, line: u32) {
    assert!(PASS_AROUND.contains(old), "{old} is not in the case");
    let text = PASS_AROUND.replacen(old, new, 1);
    assert_eq!(findings(LEAGUE, &[("center/a", &text)]), (vec![(code, line)], true), "{new}");
}

/// The one error of the league: LEAGUE with `old` replaced by `new`.
#[track_caller]
fn expect_league_error(old: &str, new: &str, code: &'static str, line: u32) {
    assert!(LEAGUE.contains(old), "{old} is not in the league");
    let text = LEAGUE.replacen(old, new, 1);
    assert_eq!(findings(&text, &[]), (vec![(code, line)], true), "{new}");
}

#[test]
fn the_example_is_sound() {
    assert_eq!(findings(LEAGUE, &[("center/pass-around", PASS_AROUND)]), (vec![], false));
}

#[test]
fn misspelled_case_files_are_errors() {
    expect_error("intent", "purpose = 1\nintent", code::UNKNOWN_KEY, 1);
    expect_error("[450, 250] }", "[450, 250], color = 1 }", code::UNKNOWN_KEY, 3);
    expect_error("at = [-600, 0], ", "", code::MISSING_KEY, 3);
    expect_error("[-600, 0]", "[-600.0, 0]", code::WRONG_TYPE, 3);
    expect_error("[-720, 0]", "[-720, 99999999999]", code::BAD_VALUE, 6);
    expect_error("{ pass_ball = 2 }", "{ pass_ball = \"2\" }", code::WRONG_TYPE, 7);
    expect_error("\"wait\"", "{ turn = { heading_deg = 90.5 } }", code::WRONG_TYPE, 11);
}

#[test]
fn robots_that_do_not_exist_or_exceed_the_limits_are_errors() {
    expect_error("pass_ball = 2", "pass_ball = 0", code::ROBOT_NUMBER, 7);
    expect_error("receive_ball = 1", "receive_ball = 2", code::ROBOT_NUMBER, 11);
    let many = single("[0, 0]", "[9, 9]", &", \"wait\"".repeat(255));
    assert_eq!(findings(LEAGUE, &[("a/a", &many)]), (vec![(code::TOO_MANY_ACTIONS, 4)], true));
}

#[test]
fn places_outside_the_field_and_empty_scopes_are_errors() {
    expect_error("scope = [450, 250]", "scope = [0, 250]", code::BAD_SCOPE, 3);
    // A point on the line is inside; far outside is only doubtful for a point of an action.
    let on_line = PASS_AROUND.replace("at = [300, 900]", "at = [300, 1800]");
    assert_eq!(findings(LEAGUE, &[("a/a", &on_line)]), (vec![], false));
}

#[test]
fn league_files_with_wrong_keys_or_values_are_errors() {
    expect_league_error("[field]", "[field", code::SYNTAX, 2);
    expect_league_error("[field]", "name = 1\n[field]", code::UNKNOWN_KEY, 2);
    expect_league_error("length = 5400", "length = \"5400\"", code::WRONG_TYPE, 3);
    expect_league_error("depth = 650, ", "", code::MISSING_KEY, 7);
    expect_league_error("r_min = 100", "r_min = 0", code::BAD_VALUE, 10);
    expect_league_error("[pass]\nr_min = 100\nr_max = 300\n", "", code::MISSING_KEY, 1);
    expect_league_error("length = 1000\n", "", code::MISSING_KEY, 13);
    expect_league_error("primitive = \"forward_soft\"", "primitive = 3", code::WRONG_TYPE, 18);
    // A partner has equal length and radii: both sides lose it.
    let text = LEAGUE.replacen("length = 900", "length = 901", 1);
    assert_eq!(findings(&text, &[]), (vec![(code::NO_PARTNER, 20), (code::NO_PARTNER, 26)], true));
    // Margin and offset may be left out.
    let text = LEAGUE.replace("margin = 300\n", "");
    assert_eq!(findings(&text, &[("center/a", PASS_AROUND)]), (vec![], false));
}

#[test]
fn one_run_finds_every_fault() {
    let text = PASS_AROUND
        .replace("\"yellow\"", "\"blue\"")
        .replace("[300, 225]", "[0, 0]")
        .replace("[-720, 0]", "1");
    let (list, refused) = findings(LEAGUE, &[("center/a", &text), ("center/b", "x")]);
    let codes = [(code::BAD_DEFENDING, 2), (code::WRONG_TYPE, 6), (code::BAD_SCOPE, 15), (code::SYNTAX, 1)];
    assert!(refused);
    assert_eq!(list, codes);
}

#[test]
fn twins_and_beaten_cases_are_doubtful() {
    // A mirrored copy is a twin.
    let mirrored = "intent = \"the same below\"\ndefending = \"yellow\"\nball = { at = [-600, 0], scope = [450, 250] }\n\
        [[teammates]]\nat = [-720, 0]\ngameplay = [\"get_ball\", { pass_ball = 2 }]\n\
        [[teammates]]\nat = [300, -900]\ngameplay = [{ receive_ball = 1 }, { kick = \"goal\" }]\n\
        [[opponents]]\nat = [-150, 35]\nscope = [300, 225]\n";
    assert_eq!(findings(LEAGUE, &[("center/a", PASS_AROUND), ("center/b", mirrored)]).0, [(code::TWIN, 1)]);
    // Two cases with one robot each. A case is beaten in its own situation by one with the same robots and a
    // higher rank there; here neither is.
    let near = single("[0, 0]", "[400, 400]", ", { kick = \"forward\" }");
    let wide = single("[100, 0]", "[800, 600]", ", { kick = \"goal\" }")
        .replace("[[teammates]]\nat = [100, 0]", "[[teammates]]\nat = [90, 0]");
    // In the situation of `wide` (ball at [100, 0], robot at [90, 0]) `near` costs 10 mm; `wide` costs
    // nothing.
    assert_eq!(findings(LEAGUE, &[("a/near", &near), ("a/wide", &wide)]), (vec![], false));
    let scoped = wide.clone() + "[[opponents]]\nat = [100, 900]\nscope = [300, 225]\n";
    let third = near.clone()
        + "[[opponents]]\nat = [0, 900]\nscope = [300, 225]\n[[opponents]]\nat = [0, 1060]\nscope = [300, 225]\n";
    // With its one opponent at [100, 900], both scopes of `third` are occupied: two conditions beat one.
    assert_eq!(findings(LEAGUE, &[("a/scoped", &scoped), ("a/third", &third)]).0, [(code::BEATEN, 1)]);
}

#[test]
fn misplaced_and_missing_files_are_errors() {
    let root = std::env::temp_dir().join(format!("case-tools-{}", std::process::id()));
    let write = |name: &str, text: &[u8]| {
        let path = root.join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    };
    let codes = || {
        let findings = load(&root).expect_err("refused");
        findings.into_iter().map(|finding| (finding.code, finding.file)).collect::<Vec<_>>()
    };
    let at = |name: &str| root.join(name);

    assert_eq!(codes(), [(code::UNREADABLE, root.clone()), (code::NO_LEAGUE, at("league.toml"))]);
    write("center/pass-around.toml", PASS_AROUND.as_bytes());
    assert_eq!(codes(), [(code::NO_LEAGUE, at("league.toml"))]);
    write("league.toml", LEAGUE.as_bytes());
    write("center/notes.txt", b"not a case");
    let library = load(&root).expect("sound");
    assert_eq!(library.names, ["center/pass-around"]);
    assert_eq!(Some(library.league.as_str()), root.file_name().and_then(|name| name.to_str()));
    assert_eq!(library.findings, []);
    assert_eq!(library.sources, [PASS_AROUND]);

    write("stray.toml", PASS_AROUND.as_bytes());
    write("center/deep/case.toml", PASS_AROUND.as_bytes());
    write("center/latin.toml", b"intent = \"\xe9\"");
    let mut found = codes();
    found.sort();
    let expected = [
        (code::MISPLACED, at("center/deep/case.toml")),
        (code::MISPLACED, at("stray.toml")),
        (code::UNREADABLE, at("center/latin.toml")),
    ];
    assert_eq!(found, expected);
    std::fs::remove_dir_all(&root).unwrap();
}

#[test]
fn ids_follow_the_bytes_of_region_and_name() {
    let texts = [("front/a", 100), ("front-side/a", 200), ("back/z", 300), ("back/Z", 400)]
        .map(|(name, x)| (name, single(&format!("[{x}, 0]"), "[100, 100]", "")));
    let borrowed: Vec<_> = texts.iter().map(|(name, text)| (*name, text.as_str())).collect();
    let library = common::library(&borrowed);
    assert_eq!(library.names, ["back/Z", "back/z", "front-side/a", "front/a"]);
    let balls: Vec<_> = library.base().cases().step_by(4).map(|case| case.ball().x).collect();
    assert_eq!(balls, [400, 300, 200, 100]);
    assert!(library.findings.iter().all(|finding| finding.severity == Severity::Warning));
}
