//! `survey`: tests of `onetwo cases coverage` and `stats` (docs/case-format.md §5).

use std::fs;

use serde_json::Value;

use crate::common::{PASS_AROUND, PROBLEM, cases, library, onetwo, shot_at, worked_example};

const SMALL: [&str; 2] = ["--problems", "3000"];

fn json(run: &str) -> Value {
    serde_json::from_str(run).unwrap()
}

#[test]
fn every_gap_is_a_problem_that_retrieval_finds_no_case_for() {
    let directory = library("gaps", &[("center/pass-around.toml", PASS_AROUND)]);
    let gaps = cases("coverage", &directory, &[&SMALL[..], &["--gaps", "10"]].concat(), "");
    assert_eq!((gaps.code, gaps.lines().len(), gaps.stderr.as_str()), (0, 10, ""));
    let answers = cases("retrieve", &directory, &[], &gaps.stdout);
    assert_eq!(answers.lines(), [r#"{"case":null,"candidates":0}"#; 10]);
}

#[test]
fn any_number_of_jobs_prints_the_same_bytes() {
    for verb in ["coverage", "stats"] {
        let with = |jobs| onetwo(&["cases", verb, "--problems", "5000", "--json", "--jobs", jobs]).stdout;
        let one = with("1");
        assert_eq!(json(&one)["problems"], 5000, "{verb}");
        assert_eq!(one, with("7"), "{verb}");
    }
}

#[test]
fn the_counts_of_recorded_problems_are_those_of_their_answers() {
    let directory = library(
        "recorded",
        &[("center/pass-around.toml", PASS_AROUND), ("front/shot.toml", &shot_at(1000, 300))],
    );
    // One that pass-around answers, two that nothing answers, one that the shot answers.
    let far = PROBLEM.replace("[-600,10]", "[-2000,1500]");
    let shot = PROBLEM.replace("[-600,10]", "[1000,300]").replace("[-700,0]", "[880,300]");
    let file = directory.join("problems.jsonl");
    fs::write(&file, [PROBLEM, &far, &far, &shot].join("\n")).unwrap();
    let from = ["--from", file.to_str().unwrap(), "--json"];
    let coverage = json(&cases("coverage", &directory, &from, "").stdout);
    assert_eq!((&coverage["problems"], &coverage["none"]), (&4.into(), &2.into()));
    let stats = json(&cases("stats", &directory, &from, "").stdout);
    for case in stats["cases"].as_array().unwrap() {
        assert_eq!((&case["wins"], &case["lost_if_deleted"]), (&1.into(), &1.into()), "{case}");
        assert_eq!(case["role"], "pivotal");
    }
}

#[test]
fn cells_add_up_to_the_whole_in_snapshot_and_table() {
    let directory = worked_example("cells");
    let [svg, csv] = ["map.svg", "map.csv"].map(|name| directory.join(name));
    let out = |file: &std::path::Path| {
        let file = file.to_str().unwrap();
        assert_eq!(cases("coverage", &directory, &[&SMALL[..], &["--out", file]].concat(), "").code, 0);
        fs::read_to_string(file).unwrap()
    };
    assert!(out(&svg).starts_with("<svg"));
    let problems: u64 =
        out(&csv).lines().skip(1).map(|line| line.split(',').nth(2).unwrap().parse::<u64>().unwrap()).sum();
    assert_eq!(problems, 3000);
}

#[test]
fn what_cannot_be_counted_is_refused_in_words() {
    let directory = worked_example("refused");
    let recorded = directory.join("broken.jsonl");
    fs::write(&recorded, format!("{PROBLEM}\n{{\n")).unwrap();
    let recorded = recorded.to_str().unwrap();
    let table: [(&str, &std::path::Path, &[&str], i32, &str); 8] = [
        ("coverage", &directory, &["--problems", "0"], 2, "0 is not in 1..="),
        ("coverage", &directory, &["--cell=-5"], 2, "-5 is not in 1..="),
        ("coverage", &directory, &["--cell", "1"], 1, "take a larger edge"),
        ("coverage", &directory, &["--jobs", "0"], 2, "0 is not in 1..="),
        (
            "coverage",
            &directory,
            &["--out", "map.gif"],
            2,
            "expected a name that ends in .svg or .png or .csv",
        ),
        ("coverage", &directory, &["--defending", "blue"], 2, "expected yellow"),
        ("stats", &directory, &["--case", "front/none"], 1, "no case \"front/none\""),
        ("stats", &directory, &["--from", recorded], 1, "line 2: "),
    ];
    for (verb, directory, more, code, description) in table {
        let run = cases(verb, directory, more, "");
        assert_eq!((run.code, run.stdout.as_str()), (code, ""), "{more:?}");
        assert!(run.stderr.contains(description), "{more:?}: {}", run.stderr);
    }
}

#[test]
fn gaps_of_played_problems_are_places_where_the_ball_was_often_and_could_be_played() {
    let directory = library("played", &[("center/pass-around.toml", PASS_AROUND)]);
    let alone = PROBLEM.replace(r#"{"1":[-700,0],"3":[200,800]}"#, r#"{"1":[-700,0]}"#);
    let far = PROBLEM.replace("[-600,10]", "[-2000,1500]");
    let out = PROBLEM.replace("[-600,10]", "[-3000,1500]");
    assert!([&alone, &far, &out].into_iter().all(|other| other != PROBLEM));
    // Out of the field nine times; in one cell three of five times without a case, in another once of once.
    let mut lines = vec![out.as_str(); 9];
    lines.extend([&far, PROBLEM, &alone, &alone, &alone, PROBLEM]);
    let file = directory.join("played.jsonl");
    fs::write(&file, lines.join("\n")).unwrap();
    let gaps = cases("coverage", &directory, &["--from", file.to_str().unwrap(), "--gaps", "10"], "");
    assert_eq!((gaps.code, gaps.lines()), (0, vec![alone.trim(), far.trim()]), "{}", gaps.stderr);
    // Drawn problems: all of them can be played, by the rules of a league that has such.
    let drawn =
        onetwo(&["cases", "coverage", "--league", "division-b", "--problems", "20000", "--gaps", "400"]);
    let balls = drawn.stdout.lines().map(|line| json(line)["ball"].clone());
    let balls: Vec<[i64; 2]> = balls.map(|ball| serde_json::from_value(ball).unwrap()).collect();
    assert!(balls.len() > 50, "{}", balls.len());
    let inside =
        balls.iter().filter(|[x, y]| x.abs() > 3800 && y.abs() < 700 || x.abs() > 4522 || y.abs() > 3022);
    assert_eq!(inside.count(), 0);
}
