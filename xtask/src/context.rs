//! `context`: shared context of the steps. The workspace, the tools found so far, and functions that run a
//! command and check its result.

use std::cell::OnceCell;
use std::env;
use std::ffi::OsStr;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus, Stdio};

use firmware_build::{Board, BuildError, QemuError, TargetError, ThumbToolchain};
use thiserror::Error;

/// The workspace and its tools. A tool is searched for once, when the first step needs it.
pub(crate) struct Context {
    root: PathBuf,
    target: OnceCell<Result<ThumbToolchain, TargetError>>,
}

impl Context {
    pub(crate) fn new() -> Self {
        Self { root: firmware_build::workspace_root(), target: OnceCell::new() }
    }

    pub(crate) fn root(&self) -> &Path {
        &self.root
    }

    /// `cargo` for this machine, in the workspace.
    pub(crate) fn cargo(&self, line: &str) -> Command {
        let mut command = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
        command.current_dir(&self.root).args(line.split_whitespace());
        command
    }

    /// `cargo` for the robot's processor; the first argument of the line is the verb.
    pub(crate) fn cargo_thumb(&self, line: &str) -> Result<Command, Failure> {
        let (verb, rest) = line.split_once(' ').unwrap_or((line, ""));
        let mut command = self.ensure_target()?.cargo(&self.root, verb);
        command.args(rest.split_whitespace());
        Ok(command)
    }

    /// `cargo` for the processor of that board, and its package alone: two boards of one family may ask its
    /// drivers for different chips.
    pub(crate) fn cargo_board(&self, verb: &str, board: &Board, more: &str) -> Result<Command, Failure> {
        let toolchain =
            firmware_build::ensure_target_of(&self.root, &board.target).map_err(Failure::Target)?;
        let mut command = toolchain.cargo(&self.root, verb);
        command.args(["--profile", "firmware", "--package", &board.package]);
        command.args(board.profile().into_iter().flatten()).args(more.split_whitespace());
        Ok(command)
    }

    /// The compiler for the robot's processor, installed first where it is missing.
    pub(crate) fn ensure_target(&self) -> Result<&ThumbToolchain, Failure> {
        let target = self.target.get_or_init(|| firmware_build::ensure_target(&self.root));
        target.as_ref().map_err(|error| Failure::Target(error.clone()))
    }

    /// A component of the toolchain (`fmt`, `clippy`), fetched by rustup where it is missing.
    pub(crate) fn ensure_component(&self, verb: &str, component: &'static str) -> Result<(), Failure> {
        if answers(&mut self.cargo(verb)) {
            return Ok(());
        }
        let mut add = Command::new("rustup");
        add.current_dir(&self.root).args(["component", "add", component]);
        // The next check shows whether it helped.
        let _ = run(&mut add);
        if answers(&mut self.cargo(verb)) { Ok(()) } else { Err(Failure::Component(component)) }
    }
}

/// Whether a program is there: it prints its version.
pub(crate) fn answers(program: &mut Command) -> bool {
    program.arg("--version").stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    program.status().is_ok_and(|status| status.success())
}

/// Runs a command to its end, with this program's standard output and error.
pub(crate) fn run(command: &mut Command) -> Result<(), Failure> {
    let line = line_of(command);
    println!("xtask: {line}");
    match command.stdin(Stdio::null()).status() {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(Failure::Command { line, status }),
        Err(error) => Err(Failure::Start { line, error }),
    }
}

/// Runs tests to their end, with this program's standard output and error; the failure repeats what failed
/// tests printed, since hundreds of lines may follow it.
pub(crate) fn run_tests(command: &mut Command) -> Result<(), Failure> {
    let line = line_of(command);
    println!("xtask: {line}");
    let mut tests = match command.stdin(Stdio::null()).stdout(Stdio::piped()).spawn() {
        Ok(tests) => tests,
        Err(error) => return Err(Failure::Start { line, error }),
    };
    let mut failed = FailedTests::default();
    if let Some(output) = tests.stdout.take() {
        for text in BufReader::new(output).split(b'\n').map_while(Result::ok) {
            let text = String::from_utf8_lossy(&text);
            println!("{text}");
            failed.note(&text);
        }
    }
    match tests.wait() {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(Failure::Tests { line, status, failed: failed.lines }),
        Err(error) => Err(Failure::Start { line, error }),
    }
}

/// What test programs print of their failed tests: every name, and from `failures:` to the result.
#[derive(Debug, Default)]
struct FailedTests {
    lines: Vec<String>,
    are_listed: bool,
}

impl FailedTests {
    fn note(&mut self, line: &str) {
        self.are_listed = (self.are_listed || line == "failures:") && !line.starts_with("test result:");
        let is_listed = self.are_listed && self.lines.len() < FAILED_LINES_MAX;
        if is_listed || line.ends_with("... FAILED") {
            self.lines.push(line.to_owned());
        }
    }
}

/// Most lines that are repeated of failed tests, besides their names: a screen or two.
const FAILED_LINES_MAX: usize = 120;

/// Runs a command to its end; its standard output.
pub(crate) fn output_of(command: &mut Command) -> Result<String, Failure> {
    let line = line_of(command);
    println!("xtask: {line}");
    match command.stdin(Stdio::null()).stderr(Stdio::inherit()).output() {
        Ok(output) if output.status.success() => Ok(String::from_utf8_lossy(&output.stdout).into_owned()),
        Ok(output) => Err(Failure::Command { line, status: output.status }),
        Err(error) => Err(Failure::Start { line, error }),
    }
}

/// Why a step failed.
#[derive(Debug, Error)]
pub(crate) enum Failure {
    /// A command failed; its own output is printed above.
    #[error("`{line}` failed ({status})")]
    Command { line: String, status: ExitStatus },
    /// Tests failed; `failed` is what they printed of it.
    #[error("`{line}` failed ({status})\n{}", failed.join("\n"))]
    Tests { line: String, status: ExitStatus, failed: Vec<String> },
    #[error("`{line}` does not start: {error}")]
    Start { line: String, error: std::io::Error },
    /// A part of the toolchain is missing.
    #[error("{0} is missing; install it with `rustup component add {0}`")]
    Component(&'static str),
    /// No compiler for the robot's processor.
    #[error("{0}")]
    Target(TargetError),
    /// No emulator.
    #[error("{0}")]
    Qemu(QemuError),
    #[error(
        "no Chromium is found: install it (Debian: apt-get install chromium), or name one in ONETWO_BROWSER"
    )]
    Browser,
    #[error(
        "no Python of 3.11 or later that makes virtual environments is found: install it (Debian: apt-get install \
         python3 python3-venv)"
    )]
    Python,
    /// The firmware image cannot be built.
    #[error("{0}")]
    Image(BuildError),
    /// A firmware image is too large, or contains a panic that is not permitted.
    #[error("the firmware\n  {}", .0.join("\n  "))]
    Firmware(Vec<String>),
    /// A budget of docs/architecture.md §9 is exceeded.
    #[error("over the budget: {0}")]
    Budget(String),
    /// The same trial gave different traces, or none.
    #[error("{} trials differ or fail\n  {}", .0.len(), .0.join("\n  "))]
    Determinism(Vec<String>),
    /// Figures of the documentation cannot be made as asked.
    #[error("{0}")]
    Documentation(String),
}

impl Failure {
    /// A file or directory that cannot be read or written.
    pub(crate) fn at(path: &Path, error: std::io::Error) -> Self {
        Self::Start { line: path.display().to_string(), error }
    }

    /// A firmware image that cannot be read.
    pub(crate) fn unreadable(image: &Path, why: &dyn std::fmt::Display) -> Self {
        Self::Firmware(vec![format!("{}: {why}", image.display())])
    }
}

/// The command as typed on a command line: cargo by its name, not by its path.
pub(crate) fn line_of(command: &Command) -> String {
    let program = Path::new(command.get_program());
    let program = program.file_stem().unwrap_or(program.as_os_str());
    let parts = std::iter::once(program).chain(command.get_args());
    parts.map(OsStr::to_string_lossy).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_command_is_reported_as_it_is_typed() {
        let context = Context::new();
        assert_eq!(line_of(&context.cargo("fmt --all --check")), "cargo fmt --all --check");
    }

    #[test]
    fn a_command_that_fails_or_is_not_there_says_so() {
        let failed = run(&mut Command::new("false")).unwrap_err().to_string();
        assert!(failed.starts_with("`false` failed"), "{failed}");
        let missing = run(&mut Command::new("onetwo-has-no-such-program")).unwrap_err().to_string();
        assert!(missing.contains("does not start"), "{missing}");
    }

    #[test]
    fn a_failure_repeats_what_failed_tests_printed() {
        let printed = "test a ... ok\ntest b ... FAILED\n\nfailures:\n\n---- b stdout ----\nleft: 1\n\ntest result: FAILED.\nmore";
        let mut command = Command::new("sh");
        command.args(["-c", &format!("printf '{printed}'; exit 101")]);
        let failure = run_tests(&mut command).unwrap_err().to_string();
        assert!(failure.contains("101"), "{failure}");
        assert!(
            failure.ends_with("\ntest b ... FAILED\nfailures:\n\n---- b stdout ----\nleft: 1\n"),
            "{failure}"
        );
        run_tests(&mut Command::new("true")).unwrap();
    }
}
