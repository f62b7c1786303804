//! `description`: why a robot's description cannot be used, fitted or written.

use std::fmt;
use std::io;
use std::path::PathBuf;

use robots::{Finding, Unreadable, VARIABLE};

use crate::output::printable_path;
use foreign::excerpt;

/// Why a description cannot be used.
#[derive(Debug)]
pub(crate) enum DescriptionError {
    /// There is no such file.
    Unreadable(Unreadable),
    /// Findings, one a line.
    Faulty(Vec<Finding>),
    /// This many files or more were refused; their findings are printed already.
    Refused(usize),
    /// It is another robot than the one that this program is built for.
    OtherRobot {
        /// The description that was given.
        asked: String,
        /// Name of the robot that this program is built for.
        built_for: &'static str,
        /// Keys whose values differ.
        keys: Vec<&'static str>,
    },
    /// A built-in description cannot be changed.
    BuiltIn(String),
    /// A file of measurements cannot be read.
    Measurements {
        /// The file.
        file: PathBuf,
        /// What is wrong, with the line and the remedy.
        what: String,
    },
    /// The measurements give no value.
    NoFit {
        /// The key that was to be fitted.
        key: &'static str,
        /// What is missing, and the remedy.
        what: String,
    },
    /// The file cannot be written.
    Write(PathBuf, io::Error),
}

impl fmt::Display for DescriptionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unreadable(error) => error.fmt(f),
            Self::Faulty(findings) => {
                let lines: Vec<_> = findings.iter().map(Finding::to_string).collect();
                f.write_str(&lines.join("\n"))
            }
            Self::Refused(1) => f.write_str("a description is refused; see its findings"),
            Self::Refused(count) => write!(f, "{count} descriptions are refused; see their findings"),
            Self::OtherRobot { asked, built_for, keys } => {
                let asked = excerpt(asked, 300);
                let shown: Vec<_> = keys.iter().take(KEYS_SHOWN).copied().collect();
                let more = if keys.len() > KEYS_SHOWN { ", …" } else { "" };
                write!(
                    f,
                    "this program is built for the robot {built_for}; {asked} differs in {} keys ({}{more}). Build it \
                     for that robot, in a clone of the project: {VARIABLE}={asked} cargo run --release -- …",
                    keys.len(),
                    shown.join(", ")
                )
            }
            Self::BuiltIn(name) => write!(
                f,
                "{} comes with the program; keep a copy of it and change that: onetwo robot show {name} --text > FILE",
                excerpt(name, 300)
            ),
            Self::Measurements { file, what } => write!(f, "{}: {what}", printable_path(file)),
            Self::NoFit { key, what } => write!(f, "{key} cannot be fitted: {what}"),
            Self::Write(file, error) => write!(f, "cannot write {}: {error}", printable_path(file)),
        }
    }
}

/// Keys of a difference that are named.
const KEYS_SHOWN: usize = 4;
