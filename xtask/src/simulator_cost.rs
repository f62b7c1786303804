//! `simulator_cost`: instruction count of a simulated second of eleven against eleven. The simulator under
//! callgrind (docs/architecture.md §9).
//!
//! Counted over [`SECONDS`] and over twice as many seconds: the difference excludes everything that happens
//! once.

use std::fs;

use crate::context::{Context, Failure};
use crate::cost::{Row, between, counted, judge, release, table};

/// Instructions per simulated second; with `write` the table is written into hil-sim/README.md.
pub(crate) fn run_bench(context: &Context, write: bool) -> Result<(), Failure> {
    let rows = rows(context)?;
    if write {
        let file = context.root().join("hil-sim/README.md");
        let start = |error| Failure::Start { line: file.display().to_string(), error };
        let text = fs::read_to_string(&file).map_err(start)?;
        fs::write(&file, with_table(&text, &table(&rows))).map_err(start)?;
    }
    judge(&rows)
}

/// The figures.
pub(crate) fn rows(context: &Context) -> Result<Vec<Row>, Failure> {
    let program = release(context, "-p hil-sim --example small_size_cost", "examples/small_size_cost")?;
    let row = |&(part, what, most): &(&str, &str, Option<f64>)| {
        let count = |seconds: u32| Ok(counted(&program, [part, &seconds.to_string()])?.0);
        let cost = (count(2 * SECONDS)? - count(SECONDS)?) / f64::from(SECONDS);
        Ok(Row::new(what, cost, most))
    };
    PARTS.iter().map(row).collect()
}

/// The text with its table replaced.
fn with_table(text: &str, table: &str) -> String {
    between(text, (BEGIN, END), table)
}

/// Simulated seconds of the shorter run; the longer one has twice as many.
const SECONDS: u32 = 16;
/// The program's argument, its meaning, and the budget of docs/architecture.md §9, instructions per simulated
/// second.
const PARTS: [(&str, &str, Option<f64>); 4] = [
    ("physics", "physics of 11 + 11 scripted robots and the ball, with the trace hash", None),
    ("cameras", "and four cameras at 75 Hz", None),
    ("packets", "and their packets encoded", Some(10e6)),
    (
        "restless",
        "the same with robots that all speed up and turn all the time and two that fight for the ball",
        None,
    ),
];
const BEGIN: &str = "<!-- simulator table -->";
const END: &str = "<!-- end of simulator table -->";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_takes_the_place_of_the_old_one_alone() {
        let text = format!("a\n{BEGIN}\nold\n{END}\nb\n");
        let table = table(&[Row::new("all", 7.5e6, Some(10e6))]);
        let written = with_table(&text, &table);
        assert!(written.starts_with("a\n") && written.ends_with("\nb\n") && !written.contains("old"));
        assert!(written.contains("| all | 7.50 | 10.00 |"));
        assert_eq!(with_table(&written, &table), written);
        assert_eq!(with_table("no marks", &table), "no marks");
    }
}
