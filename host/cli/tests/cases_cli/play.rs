//! `play`: tests of `onetwo cases play`.

use serde_json::Value;

use crate::common::{cases, library, onetwo, shot_at};

fn play(arguments: &[&str]) -> Vec<Value> {
    let run = onetwo(&[&["cases", "play", "--json"], arguments].concat());
    assert_eq!((run.code, run.stderr.as_str()), (0, ""));
    serde_json::from_str(&run.stdout).unwrap()
}

#[test]
fn every_score_counts_its_attempts_and_any_number_of_jobs_gives_the_same() {
    let arguments = ["front-side", "side/draw-out", "--trials", "6", "--seed", "3"];
    let scores = play(&[&arguments[..], &["--jobs", "1"]].concat());
    assert_eq!(scores, play(&[&arguments[..], &["--jobs", "3"]].concat()));
    assert!(scores.len() >= 4);
    for score in &scores {
        let sum =
            |key: &str| score[key].as_object().unwrap().values().map(|n| n.as_u64().unwrap()).sum::<u64>();
        let count = |key: &str| score[key].as_u64().unwrap();
        assert_eq!(count("retrieved") + sum("instead"), 6, "{score}");
        assert_eq!(count("completed") + sum("aborted"), count("retrieved"), "{score}");
        assert_eq!(sum("outcomes"), count("completed"), "{score}");
    }
}

#[test]
fn one_kind_of_opponents_gives_one_row_a_case_and_the_file_names_its_command() {
    let run =
        onetwo(&["cases", "play", "side/draw-out", "--trials", "2", "--opponents", "standing", "--markdown"]);
    assert_eq!(run.code, 0);
    assert!(
        run.stdout.contains(
            "`onetwo cases play side/draw-out --trials 2 --seed 1 --opponents standing --markdown`"
        )
    );
    assert_eq!(run.lines().iter().filter(|line| line.starts_with("| side/draw-out | standing |")).count(), 1);
}

#[test]
fn a_story_reports_each_attempt() {
    let run = onetwo(&["cases", "play", "front/shot", "--trials", "2", "--opponents", "playing", "--story"]);
    assert_eq!(run.code, 0);
    assert!(run.stdout.contains("front/shot, opponents playing, attempt 1"));
    assert!(
        run.stdout.contains("a given situation against nobody")
            && run.stdout.contains("retrieves front/shot")
    );
}

#[test]
fn an_unknown_case_and_a_field_without_a_simulator_are_refused_with_a_hint() {
    let run = onetwo(&["cases", "play", "front/shoot"]);
    assert_eq!(run.code, 1);
    assert!(
        run.stderr.contains("no case \"front/shoot\"") && run.stderr.contains("onetwo cases list"),
        "{}",
        run.stderr
    );
    let directory = library("small", &[("front/shot.toml", &shot_at(1000, 300))]);
    let rules = directory.join("league.toml");
    let text = std::fs::read_to_string(&rules).unwrap();
    let length = text.lines().find(|line| line.starts_with("length")).unwrap().to_owned();
    std::fs::write(&rules, text.replace(&length, "length = 5000")).unwrap();
    let run = cases("play", &directory, &["--trials", "1"], "");
    assert_eq!(run.code, 1);
    assert!(run.stderr.contains("cannot be played") && run.stderr.contains("5400"), "{}", run.stderr);
}
