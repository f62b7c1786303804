//! `example_cost`: instruction counts of the examples that do one thing many times: decisions of strategy,
//! and simulated seconds of eleven against eleven. Under callgrind (docs/architecture.md §9).
//!
//! So many times and twice as many: the difference is free of everything that happens once.

use std::path::Path;

use crate::context::{Context, Failure};
use crate::cost::{Row, counted, judge, release, table, write_between};

/// An example that takes the name of a part and how often to do it.
pub(crate) struct Example {
    package: &'static str,
    name: &'static str,
    parts: &'static [Part],
}

impl Example {
    pub(crate) fn rows(&self, context: &Context) -> Result<Vec<Row>, Failure> {
        let Self { package, name, parts } = self;
        let build = format!("-p {package} --example {name}");
        let program = release(context, &build, &format!("examples/{name}"))?;
        parts.iter().map(|part| part.row(&program)).collect()
    }
}

impl Part {
    /// Instructions of one: the difference of a run of twice as many and one of so many.
    fn row(&self, program: &Path) -> Result<Row, Failure> {
        let [once, twice] = [self.count, 2 * self.count]
            .map(|times| counted(program, [self.label, &times.to_string()]).map(|(count, _)| count));
        Ok(Row::new(self.what, (twice? - once?) / f64::from(self.count), self.most))
    }
}

/// Counts the simulator's parts and writes their table into hil-sim/README.md.
pub(crate) fn write_simulator(context: &Context) -> Result<(), Failure> {
    let rows = SIMULATOR.rows(context)?;
    write_between("hil-sim/README.md", "simulator table", &table(&rows))?;
    judge(&rows)
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

/// Budget of docs/architecture.md §9 for one pass location, instructions.
const PASS_LOCATION_MAX: f64 = 2_000.0;
/// Budget of docs/architecture.md §9 for a simulated second of eleven against eleven with packets,
/// instructions.
const SIMULATOR_SECOND_MAX: f64 = 10e6;
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
    package: "onetwo-host",
    name: "strategy_cost",
    parts: &[
        part(
            "pass-search-six",
            "a pass location in a search, six against six",
            PLACES,
            Some(PASS_LOCATION_MAX),
        ),
        part(
            "pass-search",
            "a pass location in a search, eleven against eleven",
            PLACES,
            Some(PASS_LOCATION_MAX),
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
    package: "onetwo-hil-sim",
    name: "small_size_cost",
    parts: &[
        part(
            "physics",
            "physics of 11 + 11 scripted robots and the ball, with the trace hash",
            SECONDS,
            None,
        ),
        part("cameras", "and four cameras at 75 Hz", SECONDS, None),
        part("packets", "and their packets encoded", SECONDS, Some(SIMULATOR_SECOND_MAX)),
        part(
            "restless",
            "the same with robots that all speed up and turn all the time and two that fight for the ball",
            SECONDS,
            None,
        ),
    ],
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_packages_that_are_counted_are_in_the_workspace() {
        for Example { package, .. } in [&STRATEGY, &SIMULATOR] {
            let found = std::process::Command::new(env!("CARGO")).args(["pkgid", package]).output().unwrap();
            assert!(found.status.success(), "{package}: {}", String::from_utf8_lossy(&found.stderr));
        }
    }
}
