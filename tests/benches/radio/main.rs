//! `radio`: radio benchmark (docs/architecture.md §9). `cargo xtask bench radio` starts it.
//!
//! The bench's firmware image under QEMU, which counts instructions. Exit code 1 where a budget is exceeded.

mod counts;

use std::process::ExitCode;

use firmware_build::count::write_between;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let arguments: Vec<&str> =
        arguments.iter().map(String::as_str).filter(|label| *label != "--bench").collect();
    let done = match arguments[..] {
        [] => report(false),
        ["--write"] => report(true),
        _ => {
            eprintln!(
                "usage: cargo xtask bench radio [--write]\n  --write   put the table into protocol/README.md"
            );
            return ExitCode::from(2);
        }
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => {
            eprintln!("bench radio: {why}");
            ExitCode::FAILURE
        }
    }
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
