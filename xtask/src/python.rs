//! `python`: the Python package in a virtual environment of its own below the target directory. Formatting,
//! the linter, an installation as a user's, and its tests against the built program.
//!
//! Crates of others are in the shared target directory already; ours are built again, because cargo tells
//! crates of two workspaces apart.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::{env, fs};

use crate::context::{Context, Failure, output_of, run};

/// The property checked by the step.
pub(crate) const WHAT: &str = "the Python package installs, answers as the program does and passes Gymnasium's and PettingZoo's checkers";

pub(crate) fn check(context: &Context) -> Result<(), Failure> {
    context.ensure_component("fmt", "rustfmt")?;
    run(&mut context.cargo(&format!("fmt --check {MANIFEST}")))?;
    let environment = Environment::ensure(context)?;
    context.ensure_component("clippy", "clippy")?;
    let clippy = format!("clippy --locked {MANIFEST} --all-targets -- -D warnings");
    run(environment.in_it(&mut context.cargo(&clippy)))?;
    run(&mut context.cargo("build --release --bin onetwo"))?;
    let mut install = environment.python(context);
    install.args([
        "-m",
        "pip",
        "install",
        "--quiet",
        "--no-build-isolation",
        "--no-deps",
        "--force-reinstall",
    ]);
    run(install.arg(PACKAGE))?;
    let mut tests = environment.python(context);
    tests.args(["-m", "unittest", "discover", "--start-directory"]).arg(format!("{PACKAGE}/tests"));
    let program = format!("onetwo{}", env::consts::EXE_SUFFIX);
    run(tests.env("ONETWO", environment.target.join("release").join(program)))?;
    start_page(context, &environment)
}

/// The Python of the researcher's start page, which prints a case, the ranks of those that fit, and an
/// outcome.
fn start_page(context: &Context, environment: &Environment) -> Result<(), Failure> {
    let file = context.root().join(START_PAGE);
    let text = fs::read_to_string(&file).map_err(|error| Failure::at(&file, error))?;
    let code = code_of(&text).ok_or_else(|| Failure::Documentation(format!("{START_PAGE} has no Python")))?;
    let printed = output_of(environment.python(context).args(["-c", code]))?;
    println!("{printed}");
    let lines: Vec<_> = printed.lines().collect();
    match lines[..] {
        [case, first, .., others, _]
            if case.contains('/')
                && first.starts_with("1 ")
                && others.contains("another place of the ball") =>
        {
            Ok(())
        }
        _ => Err(Failure::Documentation(format!("the Python of {START_PAGE} prints otherwise: {printed}"))),
    }
}

/// The first block of Python of a page.
fn code_of(page: &str) -> Option<&str> {
    page.split_once("```python\n")?.1.split("```").next()
}

/// The virtual environment with what building and testing need.
pub(crate) struct Environment {
    target: PathBuf,
    programs: PathBuf,
}

impl Environment {
    /// Makes it where it is missing.
    pub(crate) fn ensure(context: &Context) -> Result<Self, Failure> {
        let target = firmware_build::target_dir(context.root());
        let directory = target.join("python-venv");
        let programs = directory.join(if cfg!(windows) { "Scripts" } else { "bin" });
        let environment = Self { target, programs };
        if !environment
            .python(context)
            .args(["-c", "import pip"])
            .output()
            .is_ok_and(|out| out.status.success())
        {
            let python = ensure_python()?;
            run(Command::new(python).args(["-m", "venv", "--clear"]).arg(&directory))?;
        }
        run(environment.python(context).args(["-m", "pip", "install", "--quiet"]).args(NEEDED))?;
        Ok(environment)
    }

    /// Its Python, at the workspace's root.
    pub(crate) fn python(&self, context: &Context) -> Command {
        let mut command = Command::new(self.programs.join("python"));
        command.current_dir(context.root());
        self.in_it(&mut command);
        command
    }

    /// The command with the environment's programs first, and the shared target directory.
    fn in_it<'a>(&self, command: &'a mut Command) -> &'a mut Command {
        let path = env::var_os("PATH").unwrap_or_default();
        let all = std::iter::once(self.programs.clone()).chain(env::split_paths(&path));
        let joined = env::join_paths(all).unwrap_or_else(|_| OsString::from(&self.programs));
        command
            .env("PATH", joined)
            .env("CARGO_TARGET_DIR", &self.target)
            .env("PYO3_PYTHON", self.programs.join("python"))
    }
}

/// A Python that can make environments, installed first where that is possible.
fn ensure_python() -> Result<&'static str, Failure> {
    if let Some(name) = fit_python() {
        return Ok(name);
    }
    // The next check shows whether it helped.
    let _ = run(Command::new("apt-get").args(["install", "-y", "python3", "python3-venv"]));
    fit_python().ok_or(Failure::Python)
}

fn fit_python() -> Option<&'static str> {
    NAMES.into_iter().find(|name| is_fit(Path::new(name), TESTED_FROM))
}

/// Whether it is Python 3.`minor` or later, and makes environments.
pub(crate) fn is_fit(python: &Path, minor: u32) -> bool {
    let mut question = Command::new(python);
    let code = format!("import ensurepip, sys, venv; sys.exit(sys.version_info < (3, {minor}))");
    question.args(["-c", &code]);
    question.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    question.status().is_ok_and(|status| status.success())
}

/// The oldest Python 3.x that all of what is needed for the tests runs on.
const TESTED_FROM: u32 = 11;
/// The start page whose Python is run.
const START_PAGE: &str = "docs/start/cbr-researcher.md";
/// The package, from the workspace's root.
const PACKAGE: &str = "./host/python";
/// The same for cargo: a workspace of its own.
const MANIFEST: &str = "--manifest-path host/python/Cargo.toml";
/// Names of Python on various systems.
const NAMES: [&str; 2] = ["python3", "python"];
/// What builds and tests the package: the build tool and the checkers by version, so that a run can be
/// repeated.
const NEEDED: [&str; 11] = [
    "maturin==1.16.0",
    "gymnasium==1.4.0",
    "pettingzoo==1.27.0",
    "numpy>=1.26",
    // A window, and the videos of Gymnasium's wrapper.
    "pygame==2.6.1",
    "moviepy==2.2.1",
    // Tables, types, and the notebook in docs.
    "pandas==3.1.1",
    "mypy==2.4.1",
    "nbclient==0.11.0",
    "nbformat==5.11.1",
    "ipykernel==7.4.0",
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_python_is_not_taken() {
        assert!(!is_fit(Path::new("onetwo-has-no-such-program"), TESTED_FROM));
        assert!(!is_fit(Path::new("false"), TESTED_FROM));
    }

    #[test]
    fn a_pages_first_block_of_python_is_its_code() {
        assert_eq!(code_of("a\n```sh\nb\n```\n```python\nimport c\nd\n```\n"), Some("import c\nd\n"));
        assert_eq!(code_of("a"), None);
    }

    #[test]
    fn the_environments_programs_come_first() {
        let environment = Environment { target: "there".into(), programs: "there/bin".into() };
        let mut command = Command::new("true");
        let set = environment.in_it(&mut command).get_envs().find(|(name, _)| *name == "PATH");
        let path = set.and_then(|(_, value)| value).unwrap_or_default();
        assert_eq!(env::split_paths(path).next(), Some(PathBuf::from("there/bin")));
    }
}
