//! Where do the figures of `docs/evaluation.md` come from? From here: `cargo xtask evaluation` plays every trial and writes them.

use std::fs;
use std::io::ErrorKind;

use crate::context::{Context, Failure, run};

/// Plays the paper's evaluation and puts its tables and plots into the documentation.
pub(crate) fn write(context: &Context) -> Result<(), Failure> {
    // Trials of a program that was changed since, but not committed, would be taken for its own.
    let folder = context.root().join(FOLDER);
    match fs::remove_dir_all(&folder) {
        Err(error) if error.kind() != ErrorKind::NotFound => {
            return Err(Failure::Start { line: format!("remove {}", folder.display()), error });
        }
        _ => {}
    }
    run(&mut context.cargo(&format!("run --release -- evaluate --maps 0 --out {FOLDER}")))?;
    let line = format!("run --release -- evaluate report {FOLDER} --markdown docs/evaluation.md");
    run(&mut context.cargo(&line))
}

/// Not committed; the report with everything in it stays there.
const FOLDER: &str = "out/evaluation";
