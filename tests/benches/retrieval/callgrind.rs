//! `callgrind`: retrieval benchmark on this machine. This program itself under callgrind, which counts
//! instructions.
//!
//! It runs over all problems once and then twice; the difference excludes everything that happens once.

use std::fs;
use std::path::Path;

use casebase::{CaseBase, Problem, RetrievalSettings, retrieve, retrieve_best};
use firmware_build::count::callgrind;
use workloads::retrieval::{problems, scan};

use crate::guest::{Directory, in_memory, write};

/// Labels of the measured methods.
pub(crate) const METHODS: [&str; 3] = ["best", "counted", "scan"];

/// Mean instructions per problem, of each of [`METHODS`].
pub(crate) fn instructions(table: &[u8], problems: &[Problem]) -> Result<[u64; 3], String> {
    let directory = Directory::new()?;
    write(&directory.0.join("table"), table)?;
    write(&directory.0.join("problems"), &in_memory(problems))?;
    let mut means = [0; 3];
    for (method, mean) in METHODS.iter().zip(&mut means) {
        let (once, twice) = (counted(&directory.0, method, 1)?, counted(&directory.0, method, 2)?);
        *mean = twice.saturating_sub(once) / problems.len().max(1) as u64;
    }
    Ok(means)
}

fn counted(directory: &Path, method: &str, rounds: u32) -> Result<u64, String> {
    callgrind(&["--work", &directory.display().to_string(), method, &rounds.to_string()])
}

/// The workload under callgrind: all problems in `directory`, `rounds` times.
pub(crate) fn work(directory: &Path, method: &str, rounds: u32) -> Result<(), String> {
    let read = |name: &str| {
        let file = directory.join(name);
        fs::read(&file).map_err(|error| format!("cannot read {}: {error}", file.display()))
    };
    let table = case_tools::Table::aligned(&read("table")?);
    let base = CaseBase::from_bytes(table.bytes()).map_err(|error| error.to_string())?;
    let problems: Vec<Problem> = problems(&read("problems")?).collect();
    let settings = RetrievalSettings::default();
    let mut found = 0_u64;
    for _ in 0..rounds {
        for problem in &problems {
            let best = match method {
                "best" => retrieve_best(&base, problem, &settings),
                "counted" => retrieve(&base, problem, &settings).best,
                _ => scan(&base, problem).best,
            };
            found += u64::from(best.is_some());
        }
    }
    println!("{found}");
    Ok(())
}
