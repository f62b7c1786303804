//! `inspect`: tests of `onetwo cases check`, `list` and `show` (docs/case-format.md §1.2, §5.2).

use crate::common::{PASS_AROUND, cases, command, library, onetwo, shot_at, worked_example};

#[test]
fn the_list_is_one_json_list_of_every_stored_case() {
    let directory = library(
        "list",
        &[("front/shot.toml", &shot_at(1000, 300)), ("center/pass-around.toml", PASS_AROUND)],
    );
    let run = cases("list", &directory, &["--json"], "");
    // Ordered by the bytes of region/name, four stored for each authored one.
    let row = |id: u16, case: &str, symmetry: &str, defending: &str, teammates: u8, opponents: u8| {
        let region = case.split('/').next().unwrap();
        format!(
            r#"{{"league":"list","id":{id},"case":"{case}","symmetry":"{symmetry}","region":"{region}","defending":"{defending}","teammates":{teammates},"opponents":{opponents}}}"#
        )
    };
    let expected = [
        row(0, "center/pass-around", "identity", "yellow", 2, 1),
        row(1, "center/pass-around", "across-x", "yellow", 2, 1),
        row(2, "center/pass-around", "across-y", "cyan", 2, 1),
        row(3, "center/pass-around", "both", "cyan", 2, 1),
        row(4, "front/shot", "identity", "yellow", 1, 0),
        row(5, "front/shot", "across-x", "yellow", 1, 0),
        row(6, "front/shot", "across-y", "cyan", 1, 0),
        row(7, "front/shot", "both", "cyan", 1, 0),
    ];
    assert_eq!(run.stdout, format!("[\n{}\n]\n", expected.join(",\n")));
    assert_eq!((run.code, run.stderr.as_str()), (0, ""));
    let read: serde_json::Value = serde_json::from_str(&run.stdout).unwrap();
    assert_eq!(read.as_array().unwrap().len(), 8);
}

#[test]
fn the_table_has_a_line_for_every_authored_case_and_with_all_for_every_stored_one() {
    let authored = cases("list", &worked_example("table"), &[], "");
    let rows: Vec<String> = authored.lines().into_iter().map(str::to_owned).collect();
    let of_case = rows.iter().filter(|row| row.contains("center/pass-around")).count();
    assert!(of_case == 1 && rows.iter().any(|row| row.contains("--all")), "{rows:?}");
    let run = cases("list", &worked_example("table"), &["--all"], "");
    let arguments: Vec<Vec<&str>> =
        run.lines().into_iter().map(|line| line.split_whitespace().collect()).collect();
    assert_eq!(arguments[0], ["league", "id", "case", "symmetry", "defending", "teammates", "opponents"]);
    assert_eq!(arguments[3], ["table", "2", "center/pass-around", "across-y", "cyan", "2", "1"]);
    assert_eq!(arguments.len(), 5);
}

#[test]
fn without_a_directory_every_built_in_league_is_listed() {
    let run = onetwo(&["cases", "list", "--json"]);
    let rows: Vec<serde_json::Value> = serde_json::from_str(&run.stdout).unwrap();
    let stored: usize = case_library::LEAGUES.iter().map(|league| league.base().len()).sum();
    assert_eq!((rows.len(), run.code), (stored, 0));
    for (index, row) in rows.iter().filter(|row| row["league"] == "four-legged").enumerate() {
        assert_eq!(row["id"], index);
    }
}

#[test]
fn a_case_is_displayed_with_its_intent_its_gameplays_and_the_balls_path() {
    let directory = worked_example("show");
    let run = cases("show", &directory, &["center/pass-around"], "");
    assert_eq!(
        run.stdout,
        "center/pass-around  id 0, identity, show\n\
         Two attackers at the centre line, a defender ahead: pass around it and shoot.\n\
         defending yellow: attacks towards +x; mm and degrees, field frame\n\
         \n\
         ball       (-600, 0)  scope 450 x 250\n\
         tm1        (-720, 0)  get_ball; pass_ball to tm2\n\
         tm2       (300, 900)  wait; receive_ball from tm1; kick goal (at the goal)\n\
         opp1     (-150, -35)  scope 300 x 225\n\
         \n\
         path of the ball\n\
         leg 1 tm1 passes to tm2: (-600, 0) to (300, 900), 1273 mm, radius 100 to 300\n\
         leg 2 tm2 kicks goal (at the goal): (300, 900) to (2700, 0), 2563 mm, radius 100 to 300\n"
    );
    let both = cases("show", &directory, &["3"], "");
    for part in [
        "id 3, both",
        "defending cyan: attacks towards -x",
        "tm1         (720, 0)",
        "(-300, -900) to (-2700, 0), 2563 mm",
    ] {
        assert!(both.stdout.contains(part), "{part} is not in\n{}", both.stdout);
    }
}

#[test]
fn kicks_and_turns_are_reported_by_side_and_mirrored() {
    let text = PASS_AROUND
        .replace(
            "\"get_ball\", ",
            "\"get_ball\", { turn = { heading_deg = 30 } }, { dribble_to = [-500, 100] }, ",
        )
        .replace("{ kick = \"goal\" }", "{ turn = { face = [2700, 0] } }, { kick = \"left\" }");
    let directory = library("sides", &[("center/pass-around.toml", &text)]);
    let authored = cases("show", &directory, &["0"], "").stdout;
    assert!(
        authored.contains("get_ball; turn to 30 deg left; dribble_to (-500, 100); pass_ball to tm2\n"),
        "{authored}"
    );
    assert!(authored.contains("turn to face (2700, 0); kick left (1200 mm 45 deg left)\n"), "{authored}");
    let mirrored = cases("show", &directory, &["1"], "").stdout;
    assert!(mirrored.contains("turn to 30 deg right; dribble_to (-500, -100)"), "{mirrored}");
    assert!(mirrored.contains("turn to face (2700, 0); kick right (1200 mm 45 deg right)\n"), "{mirrored}");
}

#[test]
fn a_case_that_is_not_there_is_reported_with_those_that_are() {
    let directory = worked_example("no-case");
    for asked in ["center/pass", "4", "99999999"] {
        let run = cases("show", &directory, &[asked], "");
        assert_eq!((run.code, run.stdout.as_str()), (1, ""), "{asked}");
        assert!(run.stderr.contains(asked) && run.stderr.contains("0 to 3"), "{}", run.stderr);
    }
}

#[test]
fn a_sound_library_passes_the_check() {
    let run = cases("check", &worked_example("sound"), &[], "");
    assert_eq!(run.code, 0, "{}", run.stdout);
    assert_eq!(run.lines().last(), Some(&"sound: 1 case file, 4 stored cases; 0 errors, 0 warnings"));
    let strict = cases("check", &worked_example("sound-strict"), &["--strict"], "");
    assert_eq!(strict.code, 0, "{}", strict.stdout);
}

#[test]
fn an_error_fails_the_check_with_file_line_code_and_hint() {
    let directory = library(
        "faulty",
        &[
            ("center/pass-around.toml", &PASS_AROUND.replace("pass_ball = 2", "pass_ball = 3")),
            ("front/shot.toml", "intent = \n"),
        ],
    );
    let run = cases("check", &directory, &[], "");
    assert_eq!(run.code, 1);
    let lines = run.lines();
    assert_eq!(lines.last(), Some(&"faulty: refused; 2 errors, 0 warnings"));
    let at = |place: &str| {
        let line = lines.iter().find(|line| line.contains(place));
        line.unwrap_or_else(|| panic!("{place} is not in\n{}", run.stdout))
    };
    for place in ["center/pass-around.toml:7: error[", "front/shot.toml:1: error["] {
        let (_, arguments) = at(place).split_once("]: ").unwrap();
        assert!(arguments.contains("; "), "no mend: {arguments}");
    }
}

#[test]
fn a_refused_library_is_named_by_its_directory_even_where_that_is_reported_as_a_dot() {
    let directory = library("dotted", &[("front/shot.toml", "")]);
    let output = command(&["cases", "check", "--library", "."]).current_dir(directory).output().unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(text.contains("front/shot.toml:1: error[") && text.contains("\ndotted: refused; "), "{text}");
}

#[test]
fn a_warning_fails_the_check_only_where_it_is_strict() {
    let wide = PASS_AROUND.replace("scope = [450, 250]", "scope = [950, 250]");
    let directory = library("wide", &[("center/pass-around.toml", &wide)]);
    let run = cases("check", &directory, &[], "");
    assert!(run.stdout.contains("center/pass-around.toml:3: warning["), "{}", run.stdout);
    assert_eq!((run.code, cases("check", &directory, &["--strict"], "").code), (0, 1));
}

#[test]
fn a_case_that_no_drawn_problem_retrieves_is_doubtful_for_any_number_of_threads() {
    // The first is a candidate for every problem of the second, with one condition more.
    let candidate = shot_at(0, 0) + "[[opponents]]\nat = [0, 1500]\nscope = [9000, 9000]\n";
    let directory =
        library("shadowed", &[("front/rival.toml", &candidate), ("front/shot.toml", &shot_at(0, 0))]);
    let check = |jobs: &str, arguments: &[&str]| {
        let mut command = command(&["cases", "check"]);
        let command = command.arg("--library").arg(&directory).args(arguments).env("RAYON_NUM_THREADS", jobs);
        let output = command.output().unwrap();
        (String::from_utf8(output.stdout).unwrap(), output.status.code())
    };
    let (reported, code) = check("1", &[]);
    let line = reported.lines().find(|line| line.contains("warning[never-retrieved]")).expect(&reported);
    assert!(line.contains("front/shot.toml:3: ") && line.contains("in 20000 drawn problems"), "{line}");
    assert!(
        line.contains("beaten most often by front/rival (") && line.contains("; tell them apart"),
        "{line}"
    );
    assert_eq!((reported.matches("never-retrieved").count(), code), (1, Some(0)), "{reported}");
    assert_eq!(check("3", &[]).0, reported);
    assert_ne!(check("3", &["--seed", "2"]).0, reported);
    assert!(!check("1", &["--problems", "0"]).0.contains("never-retrieved"));
}

#[test]
fn the_built_in_leagues_pass_the_check() {
    let run = onetwo(&["cases", "check"]);
    assert_eq!(run.code, 0, "{}{}", run.stdout, run.stderr);
    assert!(!run.stdout.contains("never-retrieved"), "{}", run.stdout);
    for league in case_library::LEAGUES {
        assert!(run.stdout.contains(&format!("{}: ", league.name)), "{}", run.stdout);
    }
}

#[test]
fn a_directory_that_is_not_there_fails_the_check_in_words() {
    let run = onetwo(&["cases", "check", "--library", "no/such/folder"]);
    assert_eq!((run.code, run.stdout.as_str()), (1, ""));
    assert!(run.stderr.contains("no/such/folder"), "{}", run.stderr);
}

#[test]
fn the_version_names_the_commit_and_wrong_usage_is_distinguished_from_failure() {
    let version = onetwo(&["--version"]);
    let rest = version.stdout.trim().strip_prefix(&format!("onetwo {} (", env!("CARGO_PKG_VERSION")));
    let rest = rest.and_then(|rest| rest.strip_suffix(')')).unwrap_or_else(|| panic!("{}", version.stdout));
    let (commit, date) = rest.split_once(", ").unwrap_or_else(|| panic!("{rest}"));
    assert!(commit == "unknown" || commit.len() == 12, "{commit}");
    assert!(date == "unknown" || date.len() == "2026-11-24".len(), "{date}");
    assert_eq!(onetwo(&["--help"]).code, 0);
    for usage in [&[][..], &["dance"], &["cases"], &["cases", "list", "--jsonn"], &["cases", "show"]] {
        let run = onetwo(usage);
        assert_eq!((run.code, run.stdout.as_str()), (2, ""), "{usage:?}");
        assert!(run.stderr.contains("Usage"), "{}", run.stderr);
    }
}

#[test]
fn findings_are_reported_as_data_and_their_codes_are_explained() {
    let faulty = PASS_AROUND.replacen("[300, 225]", "[0, 225]", 1);
    let directory = library("findings-as-data", &[("center/a.toml", &faulty)]);
    let run = cases("check", &directory, &["--json"], "");
    assert_eq!(run.code, 1);
    let findings: serde_json::Value = serde_json::from_str(&run.stdout).unwrap();
    assert_eq!(findings.as_array().map(Vec::len), Some(1));
    assert_eq!((&findings[0]["code"], &findings[0]["line"]), (&"bad-scope".into(), &15.into()));
    assert_eq!(
        (&findings[0]["severity"], &findings[0]["league"]),
        (&"error".into(), &"findings-as-data".into())
    );
    assert!(findings[0]["file"].as_str().unwrap().ends_with("center/a.toml"));
    assert_eq!(cases("check", &worked_example("no-findings"), &["--json"], "").stdout, "[]\n");

    let reported = onetwo(&["cases", "check", "--explain", "bad-scope"]);
    assert!(reported.code == 0 && reported.stdout.starts_with("error[bad-scope]: "), "{}", reported.stdout);
    assert_eq!(onetwo(&["cases", "check", "--explain", "all"]).lines().len(), case_tools::CODES.len());
    assert_eq!(onetwo(&["cases", "check", "--explain", "nonsense"]).code, 2);
}
