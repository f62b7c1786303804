//! `start_pages`: the three start pages as a reader follows them: every command of their shell blocks to its
//! end, every block of terminals beside each other, each held to what `promises.txt` says of it.
//!
//! That builds and runs the release program in the clone, and takes ports 8080, 8082 and those of the league:
//! `cargo xtask test --only readme` does it, plain `cargo test` does without.

mod promises;
mod terminals;

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Command;

use match_tests::workspace::root;
use promises::{PAGES, Promise, blocks, command_of, promised};

fn texts() -> Vec<String> {
    PAGES.iter().map(|page| fs::read_to_string(root().join(page)).expect("a page")).collect()
}

#[test]
fn every_command_of_the_start_pages_does_what_they_say() {
    let texts = texts();
    let mut printed = BTreeMap::new();
    for line in texts.iter().flat_map(|text| blocks(text, "sh")).flatten() {
        let output = run(line);
        for promise in promised(line) {
            held(line, promise, &output, &printed);
        }
        printed.insert(command_of(line).to_owned(), output);
    }
    // Blocks use files of those before them.
    let written = terminals::Written::new();
    for lines in texts.iter().flat_map(|text| blocks(text, "terminals")) {
        terminals::block(&lines);
    }
    drop(written);
}

/// What a command prints on its standard output.
fn run(line: &str) -> String {
    println!("$ {line}");
    let output = Command::new("sh").args(["-c", line]).current_dir(root()).output().expect("sh");
    assert!(output.status.success(), "`{line}`: {}", String::from_utf8_lossy(&output.stderr));
    let output = String::from_utf8_lossy(&output.stdout).into_owned();
    println!("{output}");
    output
}

fn held(line: &str, promise: Promise, output: &str, printed: &BTreeMap<String, String>) {
    match promise {
        Promise::Prints(text) => assert!(output.contains(text), "`{line}` did not print `{text}`"),
        Promise::Writes(file) => assert!(is_there(file), "`{line}` did not write {file}"),
        Promise::TraceOf(other) => {
            assert_eq!(
                trace_in(output).expect("a trace"),
                trace_in(&printed[other]).expect("a trace"),
                "`{line}`"
            );
        }
        Promise::RunsUntil(_) | Promise::Page => {
            panic!("`{line}` does not end: it belongs into a block of terminals")
        }
    }
}

fn is_there(file: impl AsRef<Path>) -> bool {
    fs::metadata(root().join(file)).is_ok_and(|found| found.len() > 0)
}

/// The hash behind `trace ` in what a trial prints.
fn trace_in(output: &str) -> Option<&str> {
    output.lines().find_map(|line| line.strip_prefix("trace ")?.split(',').next())
}
