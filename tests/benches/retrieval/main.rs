//! `retrieval`: retrieval benchmark (docs/architecture.md §9). `cargo xtask bench retrieval` starts it.
//!
//! Bases of 36 to 10,000 stored cases; random problems and those that robots retrieved for in 200 trials;
//! instructions on the robot's processor (QEMU) and on this machine (callgrind). Exit code 1 where a budget
//! is exceeded.

mod bases;
mod callgrind;
mod figures;
mod guest;
mod played;
mod table;
mod verify;

use std::path::Path;
use std::process::ExitCode;

use bases::Base;
use casebase::Problem;
use figures::{Figures, PLAYED};
use firmware_build::count::write_between;
use guest::Board;
use match_tests::bench;

fn main() -> ExitCode {
    bench::run("retrieval", USAGE, |arguments| {
        Some(match *arguments {
            ["--work", directory, method, rounds] => rounds
                .parse()
                .map_err(|_| "rounds".into())
                .and_then(|rounds| callgrind::work(Path::new(directory), method, rounds)),
            [] => report(false, true),
            ["--write"] => report(true, true),
            ["--guest"] => report(false, false),
            ["--verify"] => verify::run(VERIFIED),
            _ => return None,
        })
    })
}

/// Counts, prints, and checks the budgets.
fn report(write: bool, host: bool) -> Result<(), String> {
    let board = Board::new()?;
    let played = played::problems(TRIALS);
    eprintln!("{} problems played in {TRIALS} trials", played.len());
    let mut all = Vec::new();
    for base in Base::all() {
        let random: Vec<Problem> = base.random_problems(SEED).take(RANDOM).collect();
        for (set, problems) in [("random", &random), (PLAYED, &played)] {
            let table = base.library.base();
            let step = if table.len() < LARGE { 1 } else { problems.len().div_ceil(LARGE_PROBLEMS) };
            let problems: &Vec<Problem> = &problems.iter().step_by(step).cloned().collect();
            let answers = board.answers(table.bytes(), problems)?;
            guest::agrees(&table, problems, &answers)?;
            let host = if host {
                Some(callgrind::instructions(table.bytes(), &problems[..problems.len().min(HOST_PROBLEMS)])?)
            } else {
                None
            };
            let figures = Figures::of(&table, set, problems, &answers, host);
            eprintln!("{}", table::row(&figures));
            all.push(figures);
        }
    }
    let text = table::table(&all);
    println!("{text}");
    let broken: Vec<String> = all.iter().flat_map(Figures::broken).collect();
    if write {
        write_between("casebase/README.md", "retrieval table", &text)?;
    }
    if broken.is_empty() { Ok(()) } else { Err(broken.join("\n")) }
}

const USAGE: &str = "\
usage: cargo xtask bench retrieval [--write | --guest | --verify]
  --write   put the table into casebase/README.md
  --guest   the robot's processor alone, without callgrind
  --verify  answer 10^6 random problems as a plain scan does";

/// Number of trials whose problems are recorded (docs/architecture.md §9).
const TRIALS: usize = 200;
/// Number of random problems per base.
const RANDOM: usize = 1_000;
/// Number of cases from which on the scan is slow, and the approximate number of problems of a set that are
/// then used.
const LARGE: usize = 10_000;
const LARGE_PROBLEMS: usize = 1_500;
/// Number of problems of a set under callgrind, which is fifty times slower than the machine.
const HOST_PROBLEMS: usize = 200;
/// Number of random problems per base that are answered by both methods: 10^6 in all.
const VERIFIED: [usize; 4] = [300_000, 400_000, 250_000, 50_000];
/// Seed of the random problems.
const SEED: u64 = 34;
