//! What does a simulated second cost? Trials of the paper with full brains under callgrind, which counts instructions (DESIGN §9).
//!
//! The same trials once and twice as many: the difference is free of everything that happens once.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use crate::context::{Context, Failure, line_of, run};

/// Instructions a simulated second, of every approach against both kinds of opponents.
pub(crate) fn run_bench(context: &Context) -> Result<(), Failure> {
    run(&mut context.cargo("build --release --bin onetwo"))?;
    let target = firmware_build::target_dir(context.root());
    let program = target.join("release").join(format!("onetwo{}", std::env::consts::EXE_SUFFIX));
    let folder = target.join("bench-trial");
    let mut broken = Vec::new();
    for opponents in ["dg", "2d"] {
        for approach in ["cbr", "reactive"] {
            let count = |trials| counted(&program, &folder, opponents, approach, trials);
            let (once, twice) = (count(TRIALS)?, count(2 * TRIALS)?);
            let cost = (twice.instructions - once.instructions) / (twice.seconds - once.seconds);
            println!(
                "xtask: {approach} against {opponents}: {:.2} M instructions a simulated second, of at most {:.1} M",
                cost / 1e6,
                BUDGET / 1e6
            );
            if cost > BUDGET {
                broken.push(format!("{approach} against {opponents}"));
            }
        }
    }
    if broken.is_empty() { Ok(()) } else { Err(Failure::Budget(broken.join(", "))) }
}

/// What trials came to.
struct Counted {
    instructions: f64,
    seconds: f64,
}

fn counted(
    program: &Path,
    folder: &PathBuf,
    opponents: &str,
    approach: &str,
    trials: u32,
) -> Result<Counted, Failure> {
    // What an earlier run kept would not be played again.
    let _ = fs::remove_dir_all(folder);
    let mut command = Command::new("valgrind");
    command.args(["--tool=callgrind", "--callgrind-out-file=/dev/null"]).arg(program);
    command.args(["evaluate", "--jobs", "1", "--maps", "0", "--profile", "simulated", "--scenario", "3"]);
    command.args([
        "--opponents",
        opponents,
        "--approach",
        approach,
        "--trials",
        &trials.to_string(),
        "--out",
    ]);
    command.arg(folder).stdin(Stdio::null());
    let line = line_of(&command);
    let output = command.output().map_err(|error| Failure::Start { line: line.clone(), error })?;
    let said = String::from_utf8_lossy(&output.stderr);
    let instructions = said.lines().find_map(|line| line.split_once("Collected :")?.1.trim().parse().ok());
    let rows = fs::read_to_string(folder.join("trials.csv")).ok();
    match (instructions.filter(|_| output.status.success()), rows.and_then(|rows| seconds(&rows))) {
        (Some(instructions), Some(seconds)) => Ok(Counted { instructions, seconds }),
        _ => Err(Failure::Command { line, status: output.status }),
    }
}

/// The sum of a table's seconds.
fn seconds(rows: &str) -> Option<f64> {
    let mut lines = rows.lines();
    let column = lines.next()?.split(',').position(|name| name == "time_s")?;
    lines.map(|line| line.split(',').nth(column)?.parse::<f64>().ok()).sum()
}

/// DESIGN §9, instructions a simulated second.
const BUDGET: f64 = 3e6;
/// So many and twice as many: minutes of simulated time.
const TRIALS: u32 = 10;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn seconds_are_summed_by_the_columns_name() {
        assert_eq!(seconds("trial,time_s,x\n0,1.5,a\n1,2.0,b\n"), Some(3.5));
        assert_eq!(seconds("trial,x\n0,a\n"), None);
        assert_eq!(seconds("time_s\nlong\n"), None);
    }
}
