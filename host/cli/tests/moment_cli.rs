//! `moment_cli`: tests of `onetwo play --from FILE --at SECONDS`, on a recording of the league's programs.

use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;

const LOG: &str = "protocol/ssl/tests/data/grsim_divB_22s.log.gz";

fn play(arguments: &[&str]) -> Output {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let mut command = Command::new(env!("CARGO_BIN_EXE_onetwo"));
    command.current_dir(root).args(["play", "--from", LOG]).args(arguments);
    command.output().expect("the program starts")
}

fn lines(arguments: &[&str]) -> Vec<Value> {
    let out = play(&[arguments, &["--json"]].concat());
    assert_eq!(out.status.code(), Some(0), "{}", String::from_utf8_lossy(&out.stderr));
    let text = String::from_utf8(out.stdout).expect("UTF-8");
    text.lines().map(|line| serde_json::from_str(line).expect("JSON")).collect()
}

fn refused(arguments: &[&str]) -> String {
    let out = play(&[arguments, &["--headless"]].concat());
    assert_eq!(out.status.code(), Some(1), "{arguments:?}");
    String::from_utf8(out.stderr).expect("UTF-8")
}

#[test]
fn tries_are_equal_by_seed_and_differ_between_seeds() {
    let arguments = ["--at", "15", "--opponents-from-log", "yellow", "--duration", "3"];
    let tries = lines(&[&arguments[..], &["--tries", "2", "--seed", "4"]].concat());
    let seeds: Vec<_> = tries.iter().map(|row| row["seed"].as_u64()).collect();
    assert_eq!(seeds, [Some(4), Some(5)]);
    assert_ne!(tries[0]["trace_hash"], tries[1]["trace_hash"]);
    let once = lines(&[&arguments[..], &["--seed", "4"]].concat());
    assert_eq!(once[0]["trace_hash"], tries[0]["trace_hash"]);
    // The ball is in play from the first tick on.
    assert!(once[0]["ball_in_play"].as_f64() > Some(0.2), "{}", once[0]);
}

#[test]
fn what_cannot_be_started_from_is_refused_with_a_reason() {
    let ended = refused(&["--at", "500"]);
    assert!(ended.contains("grsim_divB_22s.log.gz: it ends after 23.2"), "{ended}");
    let early = refused(&["--at", "0"]);
    assert!(early.contains("no geometry of the field until 0 s"), "{early}");
    let field = refused(&["--at", "15", "--league", "division-a"]);
    assert!(field.contains("9.0 × 6.0 m, not that of division-a: add --league division-b"), "{field}");
}
