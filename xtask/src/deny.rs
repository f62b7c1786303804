//! `deny`: licences, sources and known faults of every dependency, by cargo-deny and the rules in
//! `deny.toml`.
//!
//! cargo-deny is installed from crates.io where it is missing, once, into the target directory, which CI
//! keeps; without optimizations, since it runs for seconds. Known faults (RustSec's advisories) need a
//! database from the network. Where it is unavailable the step reports that they were not checked, and
//! passes: licences and sources do not depend on it.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::context::{Context, Failure, answers, run};

/// The property checked by the step.
pub(crate) const WHAT: &str =
    "every dependency's licence and source is allowed, and no fault of it is known where that can be asked";

/// The version that `deny.toml` is written for.
const VERSION: &str = "0.20.2";

pub(crate) fn check(context: &Context) -> Result<(), Failure> {
    let tool = ensure(context)?;
    deny(context, &tool, "check licenses bans sources")?;
    // Fetched by a separate command, so that an unavailable database is distinguished from a found fault.
    if deny(context, &tool, "fetch db").is_err() {
        println!("{NOT_CHECKED}");
        return Ok(());
    }
    deny(context, &tool, "check advisories")
}

fn deny(context: &Context, tool: &Path, line: &str) -> Result<(), Failure> {
    let mut command = Command::new(tool);
    command.current_dir(context.root()).args(["--locked", "--all-features"]);
    run(command.args(line.split(' ')))
}

const NOT_CHECKED: &str = "\
xtask: ADVISORIES WERE NOT CHECKED: RustSec's database cannot be fetched (see above), so known faults of the dependencies are not
xtask: ruled out by this run; repeat `cargo xtask test --only deny` where the network leads to it";

/// cargo-deny: the user's installation, else ours, installed where it is missing.
fn ensure(context: &Context) -> Result<PathBuf, Failure> {
    let name = format!("cargo-deny{}", std::env::consts::EXE_SUFFIX);
    let ours = tools(context);
    let own = ours.join("bin").join(&name);
    if let Some(there) =
        [PathBuf::from(name), own.clone()].into_iter().find(|tool| answers(&mut Command::new(tool)))
    {
        return Ok(there);
    }
    let mut install = context.cargo("install cargo-deny --debug --locked --version");
    install.arg(VERSION).arg("--root").arg(&ours);
    run(&mut install)?;
    Ok(own)
}

/// Where tools are installed: below the target directory, so that `cargo clean` removes them.
fn tools(context: &Context) -> PathBuf {
    let target =
        std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| context.root().join("target"), PathBuf::from);
    context.root().join(target).join("tools")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tools_lie_within_the_target_directory() {
        let tools = tools(&Context::new());
        assert!(tools.is_absolute() && tools.ends_with("tools"), "{}", tools.display());
    }

    #[test]
    fn a_tool_that_is_not_there_does_not_answer() {
        assert!(!answers(&mut Command::new("onetwo-has-no-such-program")));
        assert!(answers(&mut Command::new("cargo")));
    }

    #[test]
    fn what_was_not_checked_is_said_plainly() {
        assert!(NOT_CHECKED.contains("ADVISORIES WERE NOT CHECKED"));
    }
}
