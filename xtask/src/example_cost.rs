//! `example_cost`: instruction counts of the examples that do one thing many times: decisions of strategy,
//! and simulated seconds of eleven against eleven. Under callgrind (docs/architecture.md §9).
//!
//! So many times and twice as many: the difference is free of everything that happens once.

use crate::context::{Context, Failure};
use crate::cost::{Row, counted, release};

/// An example that takes the name of a part and how often to do it.
pub(crate) struct Example {
    package: &'static str,
    name: &'static str,
    parts: &'static [Part],
}

impl Example {
    /// Instructions of one of each part.
    pub(crate) fn rows(&self, context: &Context) -> Result<Vec<Row>, Failure> {
        let Self { package, name, parts } = self;
        let build = format!("-p {package} --example {name}");
        let program = release(context, &build, &format!("examples/{name}"))?;
        let row = |part: &Part| {
            let count = |times: u32| Ok(counted(&program, [part.label, &times.to_string()])?.0);
            let each = (count(2 * part.count)? - count(part.count)?) / f64::from(part.count);
            Ok(Row::new(part.what, each, part.most))
        };
        parts.iter().map(row).collect()
    }
}

struct Part {
    /// The program's argument.
    label: &'static str,
    what: &'static str,
    /// So many and twice as many.
    count: u32,
    /// Instructions of one at most, where docs/architecture.md §9 names a budget.
    most: Option<f64>,
}

const fn part(label: &'static str, what: &'static str, count: u32, most: Option<f64>) -> Part {
    Part { label, what, count, most }
}

/// docs/architecture.md §9: one pass location evaluated.
const PASS_LOCATION: f64 = 2_000.0;
/// Places: a multiple of the 200 of a search, on all 64 scenes.
const PLACES: u32 = 12_800;
/// Ticks of the defence: eight of each of the 64 scenes.
const TICKS: u32 = 512;
/// Plans: each of the 64 scenes once.
const PLANS: u32 = 64;
/// Simulated seconds.
const SECONDS: u32 = 16;

/// Decisions of each kind.
pub(crate) const STRATEGY: Example = Example {
    package: "host",
    name: "strategy_cost",
    parts: &[
        part("pass-search-six", "a pass location in a search, six against six", PLACES, Some(PASS_LOCATION)),
        part(
            "pass-search",
            "a pass location in a search, eleven against eleven",
            PLACES,
            Some(PASS_LOCATION),
        ),
        part("pass-location-six", "a pass location rated in full, six against six", PLACES, None),
        part("pass-location", "a pass location rated in full, eleven against eleven", PLACES, None),
        part("defend-six", "a tick of the defence by threats, six against six", TICKS, None),
        part("defend", "a tick of the defence by threats, eleven against eleven", TICKS, None),
        part("cap-plan-six", "a free kick planned (Coerce and Attack), six against six", PLANS, None),
        part("cap-plan", "a free kick planned (Coerce and Attack), eleven against eleven", PLANS, None),
        part("cap-watch", "a tick of coercing, six against six", TICKS, None),
        part("cap-attack", "a free kick planned and its attack planned again, six against six", PLANS, None),
    ],
};

/// A simulated second of eleven against eleven.
pub(crate) const SIMULATOR: Example = Example {
    package: "hil-sim",
    name: "small_size_cost",
    parts: &[
        part(
            "physics",
            "physics of 11 + 11 scripted robots and the ball, with the trace hash",
            SECONDS,
            None,
        ),
        part("cameras", "and four cameras at 75 Hz", SECONDS, None),
        part("packets", "and their packets encoded", SECONDS, Some(10e6)),
        part(
            "restless",
            "the same with robots that all speed up and turn all the time and two that fight for the ball",
            SECONDS,
            None,
        ),
    ],
};
