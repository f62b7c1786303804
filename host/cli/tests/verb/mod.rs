//! `verb`: a verb of the built program that runs to its end, for the tests of the command line.
#![allow(dead_code, reason = "each test program takes what it needs of it")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;

pub(crate) fn onetwo(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_onetwo")).args(arguments).output().expect("the program starts")
}

/// The output of a run that succeeds.
pub(crate) fn done(arguments: &[&str]) -> String {
    let out = onetwo(arguments);
    assert_eq!(out.status.code(), Some(0), "{arguments:?}: {}", String::from_utf8_lossy(&out.stderr));
    String::from_utf8(out.stdout).expect("words in UTF-8")
}

/// The error of a run that ends with `code`, which is one and no panic.
pub(crate) fn failed(arguments: &[&str], code: i32) -> String {
    let out = onetwo(arguments);
    let error = String::from_utf8(out.stderr).expect("words in UTF-8");
    assert_eq!(out.status.code(), Some(code), "{arguments:?}: {error}");
    assert!(error.contains("error:") && !error.contains("panicked"), "{error}");
    error
}

/// The value that a run which ends with `code` prints with `--json`.
pub(crate) fn json(arguments: &[&str], code: i32) -> Value {
    let out = onetwo(&[arguments, &["--json"]].concat());
    assert_eq!(out.status.code(), Some(code), "{}", String::from_utf8_lossy(&out.stderr));
    serde_json::from_slice(&out.stdout).expect("one JSON value on stdout and nothing else")
}

/// A recording of the league's programs.
pub(crate) fn recording(name: &str) -> String {
    let directory = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../protocol/ssl/tests/data");
    directory.join(name).display().to_string()
}

/// A name in a directory of this test program's own.
pub(crate) fn scratch(name: &str) -> PathBuf {
    let directory = Path::new(env!("CARGO_TARGET_TMPDIR")).join(env!("CARGO_CRATE_NAME"));
    fs::create_dir_all(&directory).expect("a scratch directory");
    directory.join(name)
}

/// An empty directory of a test's own.
pub(crate) fn directory(test: &str) -> PathBuf {
    let directory = scratch(test);
    let _ = fs::remove_dir_all(&directory);
    fs::create_dir_all(&directory).expect("a scratch directory");
    directory
}

/// Names in an empty directory of a test's own.
pub(crate) fn names_in(test: &str) -> impl Fn(&str) -> String {
    let directory = directory(test);
    move |name| directory.join(name).display().to_string()
}

pub(crate) fn text(path: &Path) -> &str {
    path.to_str().expect("a name in UTF-8")
}
