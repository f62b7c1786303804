//! What do strategy's decisions cost? Its example `strategy_cost` under callgrind, which counts instructions (DESIGN §9).
//!
//! So many of a kind and twice as many: the difference is free of everything that happens once.

use crate::context::{Context, Failure};
use crate::cost::{Row, counted, judge, release};

/// Instructions of one decision of each kind, held to the budgets.
pub(crate) fn run_bench(context: &Context) -> Result<(), Failure> {
    judge(&rows(context)?)
}

/// The figures.
pub(crate) fn rows(context: &Context) -> Result<Vec<Row>, Failure> {
    let program = release(context, "-p host --example strategy_cost", "examples/strategy_cost")?;
    let row = |&(part, what, most): &(&str, &str, Option<f64>)| {
        let count = |times: u32| Ok(counted(&program, [part, &times.to_string()])?.0);
        Ok(Row::new(what, (count(2 * COUNT)? - count(COUNT)?) / f64::from(COUNT), most))
    };
    PARTS.iter().map(row).collect()
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
