//! `steps`: the steps of a run, in their order.
//!
//! Fast steps first. Steps share their builds: the linter and the documentation check metadata, the tests are
//! a debug build, QEMU and the trials a release build, the robot's crates and the firmware image a build for
//! the target.

use firmware_build::{Board, Install, boards};

use crate::context::{Context, Failure, run, run_tests};
use crate::{deny, determinism, emulate, first_build, images, page, python, readme, robots};

#[derive(Debug)]
pub(crate) struct Step {
    /// Its name for `--only`.
    pub(crate) name: &'static str,
    /// The property that holds when it passes.
    pub(crate) what: &'static str,
    pub(crate) run: fn(&Context) -> Result<(), Failure>,
}

pub(crate) const STEPS: [Step; 17] = [
    Step { name: "fmt", what: "sources are formatted as rustfmt.toml says", run: fmt },
    Step { name: "clippy", what: "the linter has no warning, on the PC", run: clippy },
    Step { name: "deny", what: deny::WHAT, run: deny::check },
    Step {
        name: "test",
        what: "unit, integration and doc tests pass on the PC, tidy and README among them",
        run: test,
    },
    Step { name: "doc", what: "the documentation builds without a warning or a broken link", run: doc },
    Step { name: "thumb", what: "programs for trying a board's parts link for its processor", run: thumb },
    Step { name: "clippy-thumb", what: "the linter has no warning, on the robot's side", run: clippy_thumb },
    Step { name: "doc-thumb", what: "the boards' documentation builds likewise", run: doc_thumb },
    Step { name: "image", what: images::WHAT, run: image },
    Step { name: "qemu", what: "the tests that run the image on QEMU pass", run: qemu },
    Step { name: "determinism", what: determinism::WHAT, run: determinism::run },
    Step { name: "first-build", what: first_build::WHAT, run: first_build::check },
    Step {
        name: "publish",
        what: "the libraries can be packed as they would be published, each with its README",
        run: publish,
    },
    Step { name: "page", what: page::WHAT, run: page::check },
    Step { name: "python", what: python::WHAT, run: python::check },
    Step { name: "readme", what: readme::WHAT, run: readme::check },
    Step { name: "robots", what: robots::WHAT, run: robots::check },
];

fn fmt(context: &Context) -> Result<(), Failure> {
    context.ensure_component("fmt", "rustfmt")?;
    run(&mut context.cargo("fmt --all --check"))
}

fn clippy(context: &Context) -> Result<(), Failure> {
    context.ensure_component("clippy", "clippy")?;
    // `--test *`: those too that run in steps of their own.
    run(&mut context.cargo("clippy --workspace --all-targets --test * --features onetwo/png -- -D warnings"))
}

fn test(context: &Context) -> Result<(), Failure> {
    // All failures, not only those of the first crate that has one.
    run_tests(&mut context.cargo("test --workspace --features onetwo/png --no-fail-fast"))
}

fn doc(context: &Context) -> Result<(), Failure> {
    // A board is empty on the PC, and its links would be broken: `doc-thumb` documents it.
    let boards: String = boards().iter().flat_map(|board| [" --exclude ", &board.package]).collect();
    let line = format!("doc --workspace --no-deps{boards}");
    run(context.cargo(&line).env("RUSTDOCFLAGS", "-D warnings"))
}

fn doc_thumb(context: &Context) -> Result<(), Failure> {
    boards().iter().try_for_each(|board| {
        run(context.cargo_board("doc", board, "--no-deps")?.env("RUSTDOCFLAGS", "-D warnings"))
    })
}

fn thumb(context: &Context) -> Result<(), Failure> {
    // The robot's crates alone are checked by `clippy-thumb`, and their code is generated for each image.
    with_examples(context)
        .try_for_each(|board| run(&mut context.cargo_board("build", board, "--examples")?))
}

fn clippy_thumb(context: &Context) -> Result<(), Failure> {
    context.ensure_component("clippy", "clippy")?;
    let packages = packages(&ON_ROBOT);
    run(&mut context.cargo_thumb(&format!("clippy{FIRMWARE}{packages} -- -D warnings"))?)?;
    boards().iter().try_for_each(|board| run(&mut context.cargo_board("clippy", board, STRICT)?))?;
    let examples = format!("--examples {STRICT}");
    with_examples(context)
        .try_for_each(|board| run(&mut context.cargo_board("clippy", board, &examples)?))?;
    run(&mut context.cargo_thumb(&format!("clippy{FIRMWARE} --package on-target --tests -- -D warnings"))?)
}

fn image(context: &Context) -> Result<(), Failure> {
    images::check(context)?;
    // A new board's skeleton, in a copy of the workspace.
    run(&mut context.cargo("test --workspace --features onetwo/png --test skeleton"))
}

fn qemu(context: &Context) -> Result<(), Failure> {
    images::check(context)?;
    firmware_build::ensure_qemu(Install::SystemWide).map_err(Failure::Qemu)?;
    emulate::on_target(context, &[])?;
    run_tests(&mut context.cargo("test --release --no-fail-fast -p onetwo -p match-tests --test qemu_*"))
}

/// Everything but the upload and the build of what was packed, which takes a debug build of each package;
/// before a release run it without `--no-verify`. Where the registry cannot be asked, the libraries are
/// packed from the crates that are on this machine.
fn publish(context: &Context) -> Result<(), Failure> {
    let asked = run(&mut context.cargo("publish --dry-run --workspace --allow-dirty --no-verify"));
    asked.or_else(|_| {
        println!("xtask: the dry run failed (see above); packing the libraries without the registry");
        let libraries = packages(&PUBLISHED);
        run(&mut context.cargo(&format!("package --offline --allow-dirty --no-verify{libraries}")))
    })
}

/// Libraries that may be published: packages without `publish = false`.
const PUBLISHED: [&str; 16] = [
    "onetwo-foreign",
    "onetwo-robots",
    "onetwo-geometry",
    "onetwo-rules",
    "onetwo-protocol",
    "onetwo-ssl",
    "onetwo-motion",
    "onetwo-casebase",
    "onetwo-case-tools",
    "onetwo-case-library",
    "onetwo-nrf24",
    "onetwo-brain",
    "onetwo-runtime",
    "onetwo-figures",
    "onetwo-hil-sim",
    "onetwo-host",
];

fn packages(names: &[&str]) -> String {
    names.iter().flat_map(|name| [" --package ", name]).collect()
}

/// Boards with programs that try one part each.
fn with_examples(context: &Context) -> impl Iterator<Item = &'static Board> {
    let directory = context.root().join("firmware/boards");
    boards().iter().filter(move |board| directory.join(&board.name).join("examples").is_dir())
}

/// What clippy passes to the compiler.
const STRICT: &str = "-- -D warnings";
/// The firmware image's profile for all builds for the target, so that macros and build scripts are built
/// once.
const FIRMWARE: &str = " --profile firmware";
/// Crates on a robot, lowest first; tests/tests/tidy.rs holds the same crates to `no_std`.
const ON_ROBOT: [&str; 10] = [
    "onetwo-geometry",
    "onetwo-protocol",
    "onetwo-rules",
    "onetwo-motion",
    "onetwo-casebase",
    "onetwo-case-library",
    "onetwo-nrf24",
    "onetwo-brain",
    "onetwo-runtime",
    "board-kit",
];

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_step_has_a_name_of_its_own() {
        let names: BTreeSet<_> = STEPS.iter().map(|step| step.name).collect();
        assert_eq!(names.len(), STEPS.len());
        assert!(names.iter().all(|name| !name.contains(char::is_whitespace)));
    }

    #[test]
    fn a_package_list_is_ready_for_cargo() {
        assert_eq!(packages(&["geometry", "rules"]), " --package geometry --package rules");
    }
}
