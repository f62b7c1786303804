//! `trial_cost`: instruction count of a simulated second of a trial. Trials of the paper with full brains
//! under callgrind, which counts instructions (docs/architecture.md §9).
//!
//! The same trials once and twice as many: the difference excludes everything that happens once.

use std::path::Path;
use std::{fs, io};

use crate::context::{Context, Failure};
use crate::cost::{Row, counted, release};

/// Instructions a simulated second, of every approach against both kinds of opponents.
pub(crate) fn rows(context: &Context) -> Result<Vec<Row>, Failure> {
    let program = release(context, "--bin onetwo", "onetwo")?;
    let directory = firmware_build::target_dir(context.root()).join("bench-trial");
    let mut rows = Vec::new();
    for opponents in ["dg", "2d"] {
        for approach in ["cbr", "reactive"] {
            let [once, twice] =
                [TRIALS, 2 * TRIALS].map(|trials| played(&program, &directory, opponents, approach, trials));
            let (once, twice) = (once?, twice?);
            let cost = (twice.instructions - once.instructions) / (twice.seconds - once.seconds);
            rows.push(Row::new(format!("{approach} against {opponents}"), cost, Some(TRIAL_SECOND_MAX)));
        }
    }
    Ok(rows)
}

struct Played {
    instructions: f64,
    seconds: f64,
}

fn played(
    program: &Path,
    directory: &Path,
    opponents: &str,
    approach: &str,
    trials: u32,
) -> Result<Played, Failure> {
    // Results kept by an earlier run would not be played again.
    let _ = fs::remove_dir_all(directory);
    let line = format!(
        "evaluate --jobs 1 --maps 0 --profile simulated --scenario 3 --opponents {opponents} --approach {approach} \
         --trials {trials} --out"
    );
    let out = directory.display().to_string();
    let (instructions, _) = counted(program, line.split_whitespace().chain([out.as_str()]))?;
    let file = directory.join("trials.csv");
    let rows = fs::read_to_string(&file).map_err(|error| Failure::at(&file, error))?;
    let no_column = io::Error::new(io::ErrorKind::InvalidData, "no column of seconds");
    let seconds = seconds(&rows).ok_or_else(|| Failure::at(&file, no_column))?;
    Ok(Played { instructions, seconds })
}

/// The sum of a table's seconds.
fn seconds(rows: &str) -> Option<f64> {
    let mut lines = rows.lines();
    let column = lines.next()?.split(',').position(|name| name == "time_s")?;
    lines.map(|line| line.split(',').nth(column)?.parse::<f64>().ok()).sum()
}

/// Budget of docs/architecture.md §9, instructions a simulated second.
const TRIAL_SECOND_MAX: f64 = 3e6;
/// Number of trials in the shorter run, twice as many in the longer: minutes of simulated time.
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
