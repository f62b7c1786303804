//! `motion`: motion benchmark (docs/architecture.md §9). `cargo xtask bench motion` starts it.
//!
//! Instructions on the robot's processor (QEMU) and on this machine (callgrind), on tasks of a seed; with
//! `--verify` 10^6 tasks are compared with the best of all shares. Exit code 1 where a budget is exceeded.

mod figures;
mod guest;
mod host;
mod verify;

use std::process::ExitCode;

use figures::Figures;
use firmware_build::count::write_between;
use match_tests::bench;
use workloads::motion::Work;

fn main() -> ExitCode {
    bench::run("motion", USAGE, |arguments| {
        Some(match *arguments {
            ["--work", work, rounds] => host::work(work, rounds),
            [] => report(false, true),
            ["--write"] => report(true, true),
            ["--guest"] => report(false, false),
            ["--verify"] => verify::run(VERIFIED),
            _ => return None,
        })
    })
}

/// Counts, prints, and checks the budgets.
fn report(write: bool, here: bool) -> Result<(), String> {
    let counted = guest::counted()?;
    let mut means = [None; Work::ALL.len()];
    if here {
        for (mean, work) in means.iter_mut().zip(Work::ALL) {
            *mean = Some(host::instructions(work)?);
        }
    }
    let figures = Figures::of(&counted, means);
    let text = figures.table();
    println!("{text}");
    if write {
        write_between("firmware/motion/README.md", "motion table", &text)?;
    }
    let broken = figures.broken();
    if broken.is_empty() { Ok(()) } else { Err(broken.join("\n")) }
}

const USAGE: &str = "\
usage: cargo xtask bench motion [--write | --guest | --verify]
  --write   put the table into firmware/motion/README.md
  --guest   the robot's processor alone, without callgrind
  --verify  hold 10^6 times to the best of all shares between the axes";

/// Number of tasks, without drag and with.
const VERIFIED: usize = 1_000_000;
