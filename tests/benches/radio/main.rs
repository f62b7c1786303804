//! `radio`: radio benchmark (docs/architecture.md §9). `cargo xtask bench radio` starts it.
//!
//! The bench's firmware image under QEMU, which counts instructions. Exit code 1 where a budget is exceeded.

mod counts;

use std::process::ExitCode;

use firmware_build::count::write_between;
use match_tests::bench;

fn main() -> ExitCode {
    bench::run("radio", USAGE, |arguments| {
        Some(match *arguments {
            [] => report(false),
            ["--write"] => report(true),
            _ => return None,
        })
    })
}

/// Counts, prints, and checks the budgets.
fn report(write: bool) -> Result<(), String> {
    let counts = counts::counted()?;
    let table = counts::table(&counts);
    println!("{table}");
    if write {
        write_between("protocol/README.md", "radio table", &table)?;
    }
    let broken = counts::broken(&counts);
    if broken.is_empty() { Ok(()) } else { Err(broken.join("\n")) }
}

const USAGE: &str =
    "usage: cargo xtask bench radio [--write]\n  --write   put the table into protocol/README.md";
