//! What do strategy's decisions cost? Its example `strategy_cost` under callgrind, which counts instructions (DESIGN §9).
//!
//! So many of a kind and twice as many: the difference is free of everything that happens once.

use crate::context::{Context, Failure, run};
use crate::simulator_cost::counted;

/// Instructions of one decision of each kind, held to the budgets.
pub(crate) fn run_bench(context: &Context) -> Result<(), Failure> {
    run(&mut context.cargo("build --release -p host --example strategy_cost"))?;
    let target = firmware_build::target_dir(context.root());
    let program =
        target.join("release/examples").join(format!("strategy_cost{}", std::env::consts::EXE_SUFFIX));
    let mut over = None;
    for (part, what, most) in PARTS {
        let cost = (counted(&program, part, 2 * COUNT)? - counted(&program, part, COUNT)?) / f64::from(COUNT);
        let budget = most.map_or_else(|| "no budget".into(), |most| format!("at most {most:.0}"));
        println!("xtask: {what}: {cost:.0} instructions ({budget})");
        if most.is_some_and(|most| cost > most) {
            over = Some(what);
        }
    }
    over.map_or(Ok(()), |what| Err(Failure::Budget(what.into())))
}

/// DESIGN §9: one pass location evaluated.
const PASS_LOCATION: f64 = 2_000.0;
/// So many and twice as many; a multiple of the 200 places of a search, on all 64 scenes.
const COUNT: u32 = 12_800;
/// The program's words, what they mean, and the budget.
const PARTS: [(&str, &str, Option<f64>); 4] = [
    ("pass-search-six", "a pass location in a search, six against six", Some(PASS_LOCATION)),
    ("pass-search", "a pass location in a search, eleven against eleven", Some(PASS_LOCATION)),
    ("pass-location-six", "a pass location rated in full, six against six", None),
    ("pass-location", "a pass location rated in full, eleven against eleven", None),
];
