//! `target`: compiler detection for the robot's processor: rustup's target where it is, or can be fetched.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

use crate::TARGET;
use crate::process::{in_path, output_of, run_within};

/// Makes sure the workspace's toolchain can build for the robots' [`TARGET`]; lets rustup fetch it where it
/// is missing.
pub fn ensure_target(root: &Path) -> Result<ThumbToolchain, TargetError> {
    ensure_target_of(root, TARGET)
}

/// Ensures what [`ensure_target`] does, for any target: a board may have one of its own.
pub fn ensure_target_of(root: &Path, target: &str) -> Result<ThumbToolchain, TargetError> {
    output_of(rustc().current_dir(root).arg("-vV")).map_err(TargetError::NoCompiler)?;
    let missing = |why| TargetError::NoTarget { target: target.to_owned(), why };
    if prebuilt(root, target).is_err() {
        let rustup = in_path("rustup").ok_or_else(|| missing("rustup is not installed".to_owned()))?;
        run_within(RUSTUP_TIMEOUT, Command::new(rustup).current_dir(root).args(["target", "add", target]))
            .map_err(missing)?;
        prebuilt(root, target).map_err(missing)?;
    }
    Ok(ThumbToolchain(target.to_owned()))
}

/// A toolchain with `core` for a target of robots.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ThumbToolchain(String);

impl ThumbToolchain {
    /// `cargo`, in the workspace; add a verb, packages and a profile, then run it. Every build for the target
    /// starts here: other flags would compile all of it again.
    pub fn cargo(&self, root: &Path, verb: &str) -> Command {
        let mut command = Command::new(cargo_program());
        command.current_dir(root).arg(verb).args(["--target", &self.0]);
        command
    }
}

/// Reason why this machine cannot build for the robot's processor.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum TargetError {
    /// No Rust compiler was found: the output of the attempt.
    #[error("no Rust compiler ({0}); install rustup, then `rustup target add {TARGET}`")]
    NoCompiler(String),
    /// The compiler has no `core` for the target, and rustup did not fetch it.
    #[error("nothing here compiles for {target} ({why}); install it with `rustup target add {target}`")]
    NoTarget {
        /// Target triple that was asked for.
        target: String,
        /// Obstacle to its installation.
        why: String,
    },
}

/// `cargo` as it was called, so that the same toolchain is used.
pub(crate) fn cargo_program() -> PathBuf {
    env::var_os("CARGO").map(PathBuf::from).filter(|path| path.is_file()).unwrap_or_else(|| "cargo".into())
}

fn rustc() -> Command {
    Command::new(env::var_os("RUSTC").unwrap_or_else(|| "rustc".into()))
}

/// Tells whether the toolchain that the workspace's file, or the caller, has chosen holds `core` for the
/// target.
fn prebuilt(root: &Path, target: &str) -> Result<(), String> {
    let mut question = rustc();
    question.current_dir(root).args(["--print", "target-libdir", "--target", target]);
    let directory = PathBuf::from(output_of(&mut question)?.trim());
    let entries = fs::read_dir(&directory).map_err(|_| "not installed".to_string())?;
    let has_core = entries.flatten().any(|entry| entry.file_name().to_string_lossy().starts_with("libcore-"));
    if has_core { Ok(()) } else { Err("without `core`".into()) }
}

/// The target is 10 MB; a server that is silent for this long will stay silent.
const RUSTUP_TIMEOUT: Duration = Duration::from_mins(2);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_error_has_the_reason_and_what_to_install() {
        let text =
            TargetError::NoTarget { target: TARGET.into(), why: "no answer within 120 s".into() }.to_string();
        let expected = "nothing here compiles for thumbv7em-none-eabihf (no answer within 120 s); \
            install it with `rustup target add thumbv7em-none-eabihf`";
        assert_eq!(text, expected);
    }

    #[test]
    fn a_workspace_that_is_not_there_has_no_compiler() {
        let error = ensure_target(Path::new("/no/such/workspace")).unwrap_err();
        assert!(matches!(error, TargetError::NoCompiler(_)), "{error}");
    }
}
