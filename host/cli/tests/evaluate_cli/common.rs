//! `common`: test helpers for `onetwo evaluate`.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;

/// The program, not yet started.
pub(crate) fn onetwo(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_onetwo"));
    command.args(arguments);
    command
}

/// The output of a run that must not fail.
pub(crate) fn stdout_of(arguments: &[&str]) -> String {
    let out = onetwo(arguments).output().expect("the program starts");
    assert_eq!(out.status.code(), Some(0), "{arguments:?}: {}", String::from_utf8_lossy(&out.stderr));
    assert!(out.stderr.is_empty(), "no progress in a pipe");
    String::from_utf8(out.stdout).expect("words in UTF-8")
}

/// The error of a run that must be refused, with exit code `code`.
pub(crate) fn refused(arguments: &[&str], code: i32) -> String {
    let Output { status, stdout, stderr } = onetwo(arguments).output().expect("the program starts");
    assert_eq!(status.code(), Some(code), "{arguments:?}");
    assert!(stdout.is_empty(), "{arguments:?}");
    String::from_utf8(stderr).expect("words in UTF-8")
}

/// An empty directory of a test's own.
pub(crate) fn scratch(name: &str) -> PathBuf {
    let directory = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("evaluate-cli").join(name);
    let _ = std::fs::remove_dir_all(&directory);
    std::fs::create_dir_all(&directory).expect("a scratch folder");
    directory
}

pub(crate) fn text(path: &Path) -> &str {
    path.to_str().expect("UTF-8")
}

pub(crate) fn json(file: &Path) -> Value {
    let bytes = std::fs::read(file).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
    serde_json::from_slice(&bytes).expect("JSON")
}

/// The lines of a CSV file without quotes, by the names of their columns.
pub(crate) fn table(file: &Path) -> Vec<std::collections::BTreeMap<String, String>> {
    let text = std::fs::read_to_string(file).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
    let mut lines = text.lines().map(|line| line.split(',').map(str::to_owned).collect::<Vec<_>>());
    let names = lines.next().expect("the columns' names");
    lines.map(|line| names.iter().cloned().zip(line).collect()).collect()
}
