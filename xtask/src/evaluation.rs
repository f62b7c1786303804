//! Where do the figures of `docs/evaluation.md` come from? From here: `cargo xtask evaluation` plays every trial and writes them.

use crate::context::{Context, Failure, run};

/// Plays the round robin of all teams and writes `docs/matches.md`.
pub(crate) fn write_matches(context: &Context) -> Result<(), Failure> {
    let line = "evaluate matches --fresh --round-robin --out out/matches --markdown docs/matches.md";
    run(&mut context.cargo(&format!("run --release -- {line}")))
}

/// Plays the paper's evaluation and the ablations, and puts tables and plots into the documentation; what is not committed, the
/// reports with everything in them, stays under `out`.
pub(crate) fn write(context: &Context) -> Result<(), Failure> {
    // Afresh: trials of a program that was changed since, but not committed, would be taken for its own.
    for line in [
        "evaluate --fresh --maps 0 --out out/evaluation",
        "evaluate report out/evaluation --markdown docs/evaluation.md",
        "evaluate ablations --fresh --out out/ablations --markdown docs/evaluation.md",
    ] {
        run(&mut context.cargo(&format!("run --release -- {line}")))?;
    }
    Ok(())
}
