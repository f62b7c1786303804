//! `strategy_cost`: instruction counts of strategy decisions. Its example `strategy_cost` under callgrind,
//! which counts instructions (docs/architecture.md §9).
//!
//! Each kind is counted for a number of decisions and for twice as many: the difference excludes everything
//! that happens once.

use crate::context::{Context, Failure};
use crate::cost::{Row, counted, judge, release};

/// Instructions of one decision of each kind, checked against the budgets.
pub(crate) fn run_bench(context: &Context) -> Result<(), Failure> {
    judge(&rows(context)?)
}

/// The figures.
pub(crate) fn rows(context: &Context) -> Result<Vec<Row>, Failure> {
    let program = release(context, "-p host --example strategy_cost", "examples/strategy_cost")?;
    let row = |part: &Part| {
        let count = |times: u32| Ok(counted(&program, [part.word, &times.to_string()])?.0);
        let each = (count(2 * part.count)? - count(part.count)?) / f64::from(part.count);
        Ok(Row::new(part.what, each, part.most))
    };
    PARTS.iter().map(row).collect()
}

/// docs/architecture.md §9: one pass location evaluated.
const PASS_LOCATION: f64 = 2_000.0;
/// Number of places in the shorter run, twice as many in the longer; a multiple of the 200 places of a
/// search, on all 64 scenes.
const PLACES: u32 = 12_800;
/// Number of ticks of the defence: eight of each of the 64 scenes.
const TICKS: u32 = 512;
/// Number of plans: each of the 64 scenes once.
const PLANS: u32 = 64;

struct Part {
    /// The program's argument.
    word: &'static str,
    what: &'static str,
    count: u32,
    most: Option<f64>,
}

const fn part(word: &'static str, what: &'static str, count: u32, most: Option<f64>) -> Part {
    Part { word, what, count, most }
}

const PARTS: [Part; 10] = [
    part("pass-search-six", "a pass location in a search, six against six", PLACES, Some(PASS_LOCATION)),
    part("pass-search", "a pass location in a search, eleven against eleven", PLACES, Some(PASS_LOCATION)),
    part("pass-location-six", "a pass location rated in full, six against six", PLACES, None),
    part("pass-location", "a pass location rated in full, eleven against eleven", PLACES, None),
    part("defend-six", "a tick of the defence by threats, six against six", TICKS, None),
    part("defend", "a tick of the defence by threats, eleven against eleven", TICKS, None),
    part("cap-plan-six", "a free kick planned (Coerce and Attack), six against six", PLANS, None),
    part("cap-plan", "a free kick planned (Coerce and Attack), eleven against eleven", PLANS, None),
    part("cap-watch", "a tick of coercing, six against six", TICKS, None),
    part("cap-attack", "a free kick planned and its attack planned anew, six against six", PLANS, None),
];
