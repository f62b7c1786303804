//! `learn`: tests of `onetwo cases learn`: its report, its library, its journal, and what it refuses.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::common::{Run, onetwo};

/// An output directory that is not there yet.
fn out(test: &str) -> PathBuf {
    let directory = Path::new(env!("CARGO_TARGET_TMPDIR")).join("cases-cli").join(format!("learn-{test}"));
    if directory.exists() {
        fs::remove_dir_all(&directory).unwrap();
    }
    directory
}

/// A run on the least budget.
fn learn(out: &Path, more: &[&str]) -> Run {
    let out = out.to_str().unwrap();
    onetwo(
        &[&["cases", "learn", "--budget", "1", "--seed", "7", "--only", "scopes", "--out", out], more]
            .concat(),
    )
}

fn report(out: &Path) -> Value {
    serde_json::from_str(&fs::read_to_string(out.join("report.json")).unwrap()).unwrap()
}

/// The case files of a league's directory, by their names, with their texts.
fn texts(directory: &Path) -> Vec<(String, String)> {
    let mut texts = Vec::new();
    for region in
        fs::read_dir(directory).unwrap().map(|entry| entry.unwrap().path()).filter(|path| path.is_dir())
    {
        for file in fs::read_dir(&region).unwrap().map(|entry| entry.unwrap().path()) {
            if file.extension().is_some_and(|extension| extension == "toml") {
                let name = file.strip_prefix(directory).unwrap().display().to_string();
                texts.push((name, fs::read_to_string(&file).unwrap()));
            }
        }
    }
    texts.sort();
    texts
}

fn authored() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../casebase/library/cases/four-legged")
}

#[test]
fn a_run_writes_its_report_and_a_library_and_goes_on_from_its_journal() {
    let out = out("run");
    let run = learn(&out, &["--json"]);
    assert_eq!((run.code, run.stderr.as_str()), (0, ""));
    let printed: Value = serde_json::from_str(&run.stdout).unwrap();
    assert_eq!(printed, report(&out));
    let changes = printed["changes"].as_array().unwrap();
    assert!(!changes.is_empty());
    assert!(changes.iter().all(|change| change["kind"] == "scopes"), "{changes:?}");
    assert!(fs::read_to_string(out.join("report.html")).unwrap().starts_with("<!DOCTYPE html>"));
    // As many files differ as the diff names, and none where nothing was accepted.
    let learned = texts(&out.join("four-legged"));
    let before = texts(&authored());
    let differing = learned.iter().zip(&before).filter(|(new, old)| new != old).count();
    let named = printed["diff"].as_str().unwrap().lines().filter(|line| line.starts_with("--- a/")).count();
    assert_eq!((learned.len(), differing), (before.len(), named));
    assert_eq!(onetwo(&["cases", "check", "--library", out.join("four-legged").to_str().unwrap()]).code, 0);
    // The same command again plays no trial, and says the same.
    let journal = fs::read(out.join("journal-1-of-1.jsonl")).unwrap();
    assert_eq!(learn(&out, &["--json"]).stdout, run.stdout);
    assert_eq!(fs::read(out.join("journal-1-of-1.jsonl")).unwrap(), journal);
}

#[test]
fn a_dry_run_proposes_and_leaves_the_library_as_it_is() {
    let out = out("dry");
    let run = learn(&out, &["--dry-run"]);
    assert_eq!((run.code, run.stderr.as_str()), (0, ""));
    assert!(run.stdout.contains("proposed") && run.stdout.contains("0 of "), "{}", run.stdout);
    let report = report(&out);
    assert_eq!((&report["accepted"], &report["tests"], &report["diff"]), (&0.into(), &0.into(), &"".into()));
    assert!(report["changes"].as_array().unwrap().iter().any(|change| change["verdict"] == "proposed"));
    assert_eq!(texts(&out.join("four-legged")), texts(&authored()));
}

#[test]
fn an_unknown_kind_of_change_is_refused_with_the_known_ones() {
    let out = out("unknown");
    let run = onetwo(&["cases", "learn", "--only", "scope", "--out", out.to_str().unwrap()]);
    assert_eq!(run.code, 2);
    for word in ["scopes", "actions", "new", "forget"] {
        assert!(run.stderr.contains(word), "{}", run.stderr);
    }
    assert!(!out.exists());
}

#[test]
fn what_the_author_has_refused_is_not_proposed() {
    let first = out("refuse");
    assert_eq!(learn(&first, &["--dry-run"]).code, 0);
    // The library that was learned lies beside the report, and so does the author's list.
    let (edit, words) = {
        let changes = &report(&first)["changes"];
        (changes[0]["edit"].clone(), changes[0]["text"].clone())
    };
    fs::write(first.join("refused.jsonl"), format!("{edit}\n")).unwrap();
    let (library, second) = (first.join("four-legged"), out("refuse-again"));
    let library = library.to_str().unwrap();
    let run = learn(&second, &["--dry-run", "--library", library]);
    assert_eq!((run.code, run.stderr.as_str()), (0, ""));
    assert!(run.stdout.contains("changes refused by hand, not proposed: 1"), "{}", run.stdout);
    let again = report(&second)["changes"].as_array().unwrap().clone();
    assert!(!again.is_empty() && again.iter().all(|change| change["text"] != words), "{words}");

    fs::write(first.join("refused.jsonl"), "{}\n").unwrap();
    let run = learn(&out("refuse-fault"), &["--library", library]);
    assert_eq!(run.code, 1);
    assert!(run.stderr.contains("refused.jsonl: line 1: "), "{}", run.stderr);
}
