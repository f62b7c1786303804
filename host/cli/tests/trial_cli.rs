//! `trial_cli`: tests of `onetwo trial` and `play`.

mod verb;

use std::process::Command;

use serde_json::Value;

use verb::{done, json, onetwo, scratch, text};

fn report(arguments: &[&str]) -> Value {
    json(&[&["trial"], arguments].concat(), 0)
}

fn refused(arguments: &[&str], code: i32) -> String {
    let out = onetwo(arguments);
    assert_eq!(out.status.code(), Some(code), "{arguments:?}");
    assert!(out.stdout.is_empty(), "{arguments:?}");
    String::from_utf8(out.stderr).expect("words in UTF-8")
}

#[test]
fn every_scenario_runs_against_both_kinds_of_opponents() {
    for scenario in ["1", "2", "3", "4", "random"] {
        for opponents in ["dg", "2d"] {
            let report = report(&["--scenario", scenario, "--opponents", opponents, "--seed", "5"]);
            let outcome = report["outcome"].as_str().expect("a word");
            assert!(["goal", "close", "block", "out", "timeout"].contains(&outcome), "{outcome}");
            assert_eq!(report["opponents"], opponents);
            assert_eq!(report["scenario"].to_string().trim_matches('"'), scenario);
            assert_eq!(report["out_by"].is_string(), outcome == "out", "{report}");
            assert_eq!(report["trace_hash"].as_str().map(str::len), Some(16));
            let cycles = report["cycles"].as_array().expect("a list");
            assert!(!cycles.is_empty());
            let cases = &report["cases"];
            let counted: u64 =
                ["individual", "cooperative", "none"].iter().filter_map(|k| cases[k].as_u64()).sum();
            assert!(counted <= cycles.len() as u64 && counted > 0, "{report}");
        }
    }
}

#[test]
fn the_same_seed_is_the_same_trial_and_another_is_not() {
    let hash = |seed: &str, approach: &str| {
        report(&["--seed", seed, "--approach", approach])["trace_hash"].as_str().map(String::from)
    };
    assert_eq!(hash("7", "cbr"), hash("7", "cbr"));
    assert_ne!(hash("7", "cbr"), hash("8", "cbr"));
    assert_ne!(hash("7", "cbr"), hash("7", "reactive"));
}

#[test]
fn a_setting_reaches_the_robots() {
    // With no distance to go, no case can be adapted: all robots play reactively.
    let report = report(&["--set", "thr_c=1", "--seed", "5"]);
    assert_eq!(report["cases"]["individual"], 0);
    assert_eq!(report["cases"]["cooperative"], 0);
    assert_eq!(report["settings"]["thr_c"], "1");
}

#[test]
fn a_trial_is_reported_as_a_story_and_drawn() {
    let picture = scratch("play.svg");
    let story = done(&["trial", "--seed", "3", "--svg", text(&picture)]);
    for label in ["coordinates and retrieves", "plays:", "trace ", "onetwo trial --scenario 3", "picture: "] {
        assert!(story.contains(label), "{label} is missing in\n{story}");
    }
    let svg = std::fs::read_to_string(picture).expect("the picture is there");
    assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"));
}

#[test]
fn wrong_usage_is_reported_and_ends_with_two() {
    assert!(refused(&["trial", "--scenario", "5"], 2).contains("1, 2, 3, 4 or random"));
    assert!(refused(&["trial", "--opponents", "3d"], 2).contains("dg or 2d"));
    assert!(refused(&["trial", "--loss", "2"], 2).contains("0 to 1"));
    assert!(refused(&["trial", "--backend", "hardware"], 2).contains("native"));
}

#[test]
fn what_cannot_be_done_is_reported_with_its_hint_and_ends_with_one() {
    assert!(refused(&["trial", "--library", "no/such/folder"], 1).contains("league.toml"));
    assert!(refused(&["trial", "--set", "thr_c=far"], 1).contains("thr_c"));
    let nowhere = scratch("no-folder").join("x.svg");
    assert!(refused(&["trial", "--svg", text(&nowhere)], 1).contains("x.svg"));
}

#[test]
fn a_missing_emulator_is_reported_with_what_to_install() {
    let out = Command::new(env!("CARGO_BIN_EXE_onetwo"))
        .args(["trial", "--backend", "qemu"])
        .env("PATH", scratch("empty-path"))
        .output()
        .expect("the program starts");
    assert_eq!(out.status.code(), Some(1));
    let stderr = String::from_utf8(out.stderr).expect("words in UTF-8");
    assert!(stderr.contains("qemu-system-arm") && stderr.contains("install"), "{stderr}");
}
