//! What does a simulated second of eleven against eleven cost? The simulator under callgrind, which counts instructions
//! (DESIGN §9).
//!
//! So many seconds and twice as many: the difference is free of everything that happens once.

use std::fmt::Write;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

use crate::context::{Context, Failure, line_of, run};

/// Instructions a simulated second; with `write` the table goes into hil-sim/README.md.
pub(crate) fn run_bench(context: &Context, write: bool) -> Result<(), Failure> {
    run(&mut context.cargo("build --release -p hil-sim --example small_size_cost"))?;
    let target = firmware_build::target_dir(context.root());
    let program =
        target.join("release/examples").join(format!("small_size_cost{}", std::env::consts::EXE_SUFFIX));
    let mut rows = Vec::new();
    for (part, what) in PARTS {
        let cost =
            (counted(&program, part, 2 * SECONDS)? - counted(&program, part, SECONDS)?) / f64::from(SECONDS);
        println!("xtask: {what}: {:.2} M instructions a simulated second", cost / 1e6);
        rows.push((part, what, cost));
    }
    if write {
        let file = context.root().join("hil-sim/README.md");
        let start = |error| Failure::Start { line: file.display().to_string(), error };
        let text = fs::read_to_string(&file).map_err(start)?;
        fs::write(&file, with_table(&text, &table(&rows))).map_err(start)?;
    }
    match rows.iter().find(|(part, _, cost)| *part == BUDGETED && *cost > BUDGET) {
        Some((_, what, _)) => Err(Failure::Budget((*what).into())),
        None => Ok(()),
    }
}

/// Instructions of `program` with these two words.
pub(crate) fn counted(program: &Path, part: &str, seconds: u32) -> Result<f64, Failure> {
    let mut command = Command::new("valgrind");
    command.args(["--tool=callgrind", "--callgrind-out-file=/dev/null"]).arg(program);
    command.args([part, &seconds.to_string()]).stdin(Stdio::null());
    let line = line_of(&command);
    let output = command.output().map_err(|error| Failure::Start { line: line.clone(), error })?;
    let said = String::from_utf8_lossy(&output.stderr);
    let instructions = said.lines().find_map(|line| line.split_once("Collected :")?.1.trim().parse().ok());
    match instructions.filter(|_| output.status.success()) {
        Some(instructions) => Ok(instructions),
        None => Err(Failure::Command { line, status: output.status }),
    }
}

fn table(rows: &[(&str, &str, f64)]) -> String {
    let mut text =
        String::from("| what | million instructions a simulated second | at most |\n|---|---|---|\n");
    for (part, what, cost) in rows {
        let most = if *part == BUDGETED { format!("{:.1}", BUDGET / 1e6) } else { "–".into() };
        let _ = writeln!(text, "| {what} | {:.2} | {most} |", cost / 1e6);
    }
    text
}

/// The text with what stands between the marks replaced; unchanged where a mark is missing.
fn with_table(text: &str, table: &str) -> String {
    let parts = text.split_once(BEGIN).and_then(|(before, rest)| Some((before, rest.split_once(END)?.1)));
    match parts {
        Some((before, after)) => format!("{before}{BEGIN}\n{table}{END}{after}"),
        None => text.into(),
    }
}

/// DESIGN §9, instructions a simulated second.
const BUDGET: f64 = 10e6;
/// What the budget is for.
const BUDGETED: &str = "packets";
/// So many and twice as many.
const SECONDS: u32 = 16;
/// The program's words, and what they mean.
const PARTS: [(&str, &str); 4] = [
    ("physics", "physics of 11 + 11 scripted robots and the ball, with the trace hash"),
    ("cameras", "and four cameras at 75 Hz"),
    ("packets", "and their packets encoded"),
    (
        "restless",
        "the same with robots that all speed up and turn all the time and two that fight for the ball",
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
        let table = table(&[("packets", "all", 7.5e6), ("physics", "some", 1e6)]);
        let written = with_table(&text, &table);
        assert!(written.starts_with("a\n") && written.ends_with("\nb\n") && !written.contains("old"));
        assert!(written.contains("| all | 7.50 | 10.0 |") && written.contains("| some | 1.00 | – |"));
        assert_eq!(with_table(&written, &table), written);
        assert_eq!(with_table("no marks", &table), "no marks");
    }
}
