//! `cost`: instruction counts of the host side. Programs under callgrind, which counts instructions: the same
//! on any machine of one kind, however busy it is.

use std::fmt::Write as _;
use std::io;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use crate::context::{Context, Failure, line_of, run};

pub(crate) struct Row {
    /// Description of the counted operation.
    pub(crate) what: String,
    pub(crate) millions: f64,
    /// Budget in millions, where docs/architecture.md §9 contains one.
    pub(crate) most: Option<f64>,
}

impl Row {
    pub(crate) fn new(what: impl Into<String>, instructions: f64, most: Option<f64>) -> Self {
        Self { what: what.into(), millions: instructions / 1e6, most: most.map(|most| most / 1e6) }
    }

    fn breaks(&self) -> bool {
        self.most.is_some_and(|most| self.millions > most)
    }
}

pub(crate) fn table(rows: &[Row]) -> String {
    let mut text = String::from("| what | million instructions | at most |\n|---|---|---|\n");
    for row in rows {
        let most = row.most.map_or_else(|| "–".into(), digits);
        let _ = writeln!(text, "| {} | {} | {most} |", row.what, digits(row.millions));
    }
    text
}

/// With all digits where it is small.
fn digits(millions: f64) -> String {
    if millions < 0.1 { format!("{millions:.6}") } else { format!("{millions:.2}") }
}

/// Prints the rows; fails where one exceeds its budget.
pub(crate) fn judge(rows: &[Row]) -> Result<(), Failure> {
    for row in rows {
        let most = row.most.map_or_else(String::new, |most| format!(", of at most {} M", digits(most)));
        println!("xtask: {}: {} M instructions{most}", row.what, digits(row.millions));
    }
    let broken: Vec<_> = rows.iter().filter(|row| row.breaks()).map(|row| row.what.as_str()).collect();
    if broken.is_empty() { Ok(()) } else { Err(Failure::Budget(broken.join(", "))) }
}

/// A program of the workspace, built for release.
pub(crate) fn release(context: &Context, build: &str, name: &str) -> Result<PathBuf, Failure> {
    run(&mut context.cargo(&format!("build --release {build}")))?;
    let directory = firmware_build::target_dir(context.root()).join("release");
    Ok(directory.join(format!("{name}{}", std::env::consts::EXE_SUFFIX)))
}

/// Instructions of a whole run, and its output.
pub(crate) fn counted<'a>(
    program: &Path,
    description: impl IntoIterator<Item = &'a str>,
) -> Result<(f64, String), Failure> {
    let mut command = Command::new("valgrind");
    command.args(["--tool=callgrind", "--callgrind-out-file=/dev/null"]).arg(program).args(description);
    let line = line_of(&command);
    let output = command
        .stdin(Stdio::null())
        .output()
        .map_err(|error| Failure::Start { line: format!("{line} (is valgrind installed?)"), error })?;
    let printed = String::from_utf8_lossy(&output.stderr);
    let instructions = printed.lines().find_map(|line| line.split_once("Collected :")?.1.trim().parse().ok());
    match instructions.filter(|_| output.status.success()) {
        Some(instructions) => Ok((instructions, String::from_utf8_lossy(&output.stdout).into_owned())),
        None => Err(Failure::Command { line, status: output.status }),
    }
}

/// Puts the text between the marks of that name in a file of the workspace.
pub(crate) fn write_between(file: &str, name: &str, table: &str) -> Result<(), Failure> {
    firmware_build::count::write_between(file, name, table)
        .map_err(|why| Failure::Start { line: file.to_owned(), error: io::Error::other(why) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_broken_budget_fails_and_names_what_broke_it() {
        let rows = [Row::new("all", 7.5e6, Some(10e6)), Row::new("some", 1.0e3, None)];
        assert_eq!(
            table(&rows).lines().skip(2).collect::<Vec<_>>(),
            ["| all | 7.50 | 10.00 |", "| some | 0.001000 | – |"]
        );
        assert!(judge(&rows).is_ok());
        let broken = judge(&[Row::new("this", 11e6, Some(10e6))]).unwrap_err();
        assert!(broken.to_string().contains("this"), "{broken}");
    }
}
