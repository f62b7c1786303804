//! `explain`: tests: `onetwo cases explain` names for every case under the goal the first check it fails,
//! with its margin, and for candidates the rank (docs/case-format.md §3.3, §5.2).

use std::path::PathBuf;

use crate::common::{PASS_AROUND, PROBLEM, cases, library, shot_at};

/// The worked example (ids 0–3) and a shot from (0, 10) (ids 4–7).
fn directory(test: &str) -> PathBuf {
    library(test, &[("center/pass-around.toml", PASS_AROUND), ("front/shot.toml", &shot_at(0, 10))])
}

#[test]
fn every_case_under_the_goal_has_its_verdict_and_its_evidence() {
    let run = cases("explain", &directory("explain-json"), &["--json"], PROBLEM);
    let rows = [
        r#"{"id":0,"case":"center/pass-around","symmetry":"identity","verdict":"candidate","rank":1,"similarity":0.9984,"cost":171.02,"conditions":1,"teammates":2,"match":{"1":1,"2":3}}"#,
        // Robot 3 at (200, 800), tm2's mirrored place at (300, -890).
        r#"{"id":1,"case":"center/pass-around","symmetry":"across-x","verdict":"thr_c","case_robot":2,"robot":3,"distance_mm":1692.96,"over_mm":192.96}"#,
        // 600 mm beside a scope whose edge is at 450 mm · √1.002393 = 450.54 mm; exp(-(600/450)²) = 0.1690.
        r#"{"id":4,"case":"front/shot","symmetry":"identity","verdict":"ball","similarity":0.169,"threshold":0.367,"outside_mm":149.46}"#,
    ];
    let start = format!("{{\"winner\":0,\"candidates\":1,\"cases\":[{},", rows.join(","));
    assert!(run.stdout.starts_with(&start), "{}", run.stdout);
    let read: serde_json::Value = serde_json::from_str(&run.stdout).unwrap();
    let ids: Vec<_> =
        read["cases"].as_array().unwrap().iter().map(|row| row["id"].as_u64().unwrap()).collect();
    assert_eq!(ids, [0, 1, 4, 5], "those that defend yellow, and no others");
    assert_eq!((run.code, run.stderr.as_str()), (0, ""));
}

#[test]
fn a_missing_robot_and_a_blocked_leg_are_distinguished() {
    let alone = PROBLEM.replace(",\"3\":[200,800]", "");
    // On the line from (-600, 10) to (300, 910), at its middle: ρ = 200 mm, its edge at 200 mm · √1.002393.
    let blocked = PROBLEM.replace("[-150,40]", "[2000,1700],[-150,460]");
    let run = cases("explain", &directory("explain-verdicts"), &["--json"], format!("{alone}\n{blocked}\n"));
    let lines = run.lines();
    let first = r#"{"winner":null,"candidates":0,"cases":[{"id":0,"case":"center/pass-around","symmetry":"identity","verdict":"#;
    let robots = format!("{first}\"robots\",\"needed\":2,\"present\":1}},");
    let path = format!("{first}\"path\",\"leg\":1,\"opponent\":2,\"inside_mm\":200.24}},");
    assert!(lines[0].starts_with(&robots), "{}", lines[0]);
    assert!(lines[1].starts_with(&path), "{}", lines[1]);
}

#[test]
fn candidates_are_ranked_as_retrieval_ranks_them() {
    // Two shots whose ball scopes overlap; robot 2 stands at the second's place, so that the second costs
    // nothing.
    let directory = library(
        "explain-ranks",
        &[("front/near.toml", &shot_at(1000, 300)), ("front/nearer.toml", &shot_at(1040, 300))],
    );
    let problem = r#"{"ball":[1020,300],"defending":"yellow","teammates":{"2":[900,300]},"opponents":[]}"#;
    let explained = cases("explain", &directory, &["--json"], problem).stdout;
    let read: serde_json::Value = serde_json::from_str(&explained).unwrap();
    let ranks: Vec<_> = read["cases"].as_array().unwrap().iter().map(|row| row["rank"].as_u64()).collect();
    // Both are 20 mm away and cost the same: the lower id ranks first; the mirrored copies are out of scope.
    assert_eq!(ranks, [Some(1), None, Some(2), None]);
    let retrieved: serde_json::Value =
        serde_json::from_str(&cases("retrieve", &directory, &[], problem).stdout).unwrap();
    assert_eq!((&read["winner"], &read["candidates"]), (&retrieved["id"], &retrieved["candidates"]));
}

#[test]
fn settings_are_recorded_and_may_reject_what_lies_outside_the_field() {
    let directory = directory("explain-settings");
    let problem = PROBLEM.replace("[-600,10]", "[-600,150]").replace("[200,800]", "[300,1700]");
    let high = PASS_AROUND.replace("[300, 900]", "[300, 1700]");
    std::fs::write(directory.join("center/pass-around.toml"), high).unwrap();
    let run = cases("explain", &directory, &["--json", "--set", "out_of_field=reject"], &problem);
    let row = r#"{"id":0,"case":"center/pass-around","symmetry":"identity","verdict":"out_of_field","case_robot":2}"#;
    assert!(run.stdout.contains(row), "{}", run.stdout);
    assert!(run.stdout.ends_with(",\"settings\":{\"out_of_field\":\"reject\"}}\n"), "{}", run.stdout);
}

#[test]
fn people_get_a_table() {
    let input = format!("\n{PROBLEM}\n{{}}\n{}\n", PROBLEM.replace("yellow", "cyan"));
    let run = cases("explain", &directory("explain-table"), &["--set", "thr_c=1400"], input);
    let lines: Vec<String> =
        run.lines().iter().map(|line| line.split_whitespace().collect::<Vec<_>>().join(" ")).collect();
    // Candidates, then misses, the nearest first; each loser with what would make it win.
    assert_eq!(
        lines[..5],
        [
            "line 2: center/pass-around (identity), id 0, of 1 candidate",
            "with thr_c=1400",
            "id case symmetry verdict why",
            "0 center/pass-around identity candidate rank 1: 1 condition, 2 teammates, similarity 0.9984, cost 171.02 mm; \
         tm1 = robot 1, tm2 = robot 3",
            "4 front/shot identity ball similarity 0.169, threshold 0.367: the ball lies 149.46 mm outside the scope",
        ]
    );
    let missed = "1 center/pass-around across-x thr_c tm2 = robot 3: 1692.96 mm to go, 292.96 mm too far";
    assert!(lines.iter().any(|line| line == missed), "{lines:#?}");
    let after =
        |line: &str| lines[lines.iter().position(|other| other.starts_with(line)).unwrap() + 1].clone();
    assert!(after("4 front/shot").starts_with("would win if "), "{lines:#?}");
    let reported = |line: &str| lines.iter().any(|other| other == line);
    assert!(reported("line 3: ball: missing; the keys are ball, defending, teammates and opponents"));
    assert!(reported("line 4: no case fits"));
    assert_eq!(run.code, 0);
}

#[test]
fn malformed_lines_are_reported_as_retrieval_reports_them() {
    let run = cases("explain", &directory("explain-malformed"), &["--json"], "x\n");
    assert_eq!(run.stdout, "{\"error\":\"line 1: column 1: not JSON: expected value\"}\n");
    assert_eq!(run.code, 0);
}

#[test]
fn what_is_said_to_make_a_case_win_does_when_asked_again() {
    let directory = directory("explain-what-if");
    let explained = cases("explain", &directory, &["--json", "--all", "--what-if"], PROBLEM).stdout;
    assert!(!cases("explain", &directory, &["--json", "--all"], PROBLEM).stdout.contains("counterfactuals"));
    let read: serde_json::Value = serde_json::from_str(&explained).unwrap();
    let list = read["counterfactuals"].as_array().unwrap();
    assert_eq!(list.iter().map(|row| row["id"].as_u64().unwrap()).collect::<Vec<_>>().len(), 3, "{list:#?}");
    let mut asked = 0;
    for row in list.iter().filter(|row| row["moved"] == "ball") {
        let mut problem: serde_json::Value = serde_json::from_str(PROBLEM).unwrap();
        problem["ball"] = row["to"].clone();
        let again = cases("retrieve", &directory, &[], problem.to_string()).stdout;
        assert!(again.contains(&format!("\"id\":{},", row["id"])), "{row} {again}");
        asked += 1;
    }
    assert!(asked > 0, "{list:#?}");
}

#[test]
fn two_cases_are_set_side_by_side() {
    let directory = library(
        "explain-diff",
        &[("front/near.toml", &shot_at(1000, 300)), ("front/nearer.toml", &shot_at(1040, 300))],
    );
    let problem = r#"{"ball":[1030,300],"defending":"yellow","teammates":{"2":[900,300]},"opponents":[]}"#;
    let diff = |a: &str, b: &str, more: &[&str]| {
        cases("explain", &directory, &[&["--diff", a, b], more].concat(), problem)
    };
    // Both in interval H; from (900, 300) it is 10 mm to (910, 300) for both: the nearer ball is the more
    // similar one.
    let run = diff("front/near", "4", &["--json"]);
    let read: serde_json::Value = serde_json::from_str(&run.stdout).unwrap();
    assert_eq!((&read["first"], &read["by"]), (&4.into(), &"similarity".into()), "{}", run.stdout);
    let mirrored = diff("front/near/across-x", "front/nearer", &[]).stdout;
    assert!(mirrored.contains("front/near (across-x), id 1: ball: "), "{mirrored}");
    assert!(mirrored.contains("id 4 ranks first, by verdict"), "{mirrored}");
    let other_goal = diff("2", "0", &[]).stdout;
    assert!(other_goal.contains("other_goal: it defends the other goal"), "{other_goal}");
    assert_eq!(diff("front/none", "0", &[]).code, 1);
}
