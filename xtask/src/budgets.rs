//! `budgets`: all figures of the host side's cost as one page, docs/budgets.md.

use std::fmt::Write as _;
use std::fs;

use crate::context::{Context, Failure};
use crate::cost::{judge, table};
use crate::example_cost::{SIMULATOR, STRATEGY};
use crate::{game_cost, trial_cost};

/// Counts everything and writes docs/budgets.md.
pub(crate) fn write(context: &Context) -> Result<(), Failure> {
    let parts = [
        ("The simulator: a second of eleven against eleven", "simulator", SIMULATOR.rows(context)?),
        ("A trial of the first paper: a simulated second", "trial", trial_cost::rows(context)?),
        ("Strategy: one decision", "strategy", STRATEGY.rows(context)?),
        ("Matches: the host, and two whole teams", "game", game_cost::rows(context)?),
    ];
    let mut text = String::from(HEAD);
    for (title, bench, rows) in &parts {
        let _ = write!(text, "\n## {title}\n\n`cargo xtask bench {bench}`\n\n{}", table(rows));
    }
    text.push_str(TAIL);
    let file = context.root().join("docs/budgets.md");
    fs::write(&file, text).map_err(|error| Failure::at(&file, error))?;
    println!("xtask: written: docs/budgets.md");
    judge(&parts.into_iter().flat_map(|(_, _, rows)| rows).collect::<Vec<_>>())
}

const HEAD: &str = "\
# What it costs

What simulator, trials, strategy and host cost on a PC: instructions counted by valgrind's callgrind on x86-64 in a
release build. `cargo xtask budgets` writes this page again. What happens once, such as reading a case base, is taken out by counting a run and one twice as long. \"At most\" is the
budget of [architecture.md §9](architecture.md#9-budgets).
";

const TAIL: &str = "
## On the robot

Counted in guest instructions under QEMU, each table written by its own command: retrieval
([casebase](../casebase/README.md), `cargo xtask bench retrieval --write`), planned motion ([motion](../firmware/motion/README.md),
`cargo xtask bench motion --write`), radio frames ([protocol](../protocol/README.md), `cargo xtask bench radio --write`). A brain's
worst step, the median retrieval and the image's size are held by `cargo xtask test`.
";
