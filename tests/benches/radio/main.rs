//! `radio`: radio benchmark (docs/architecture.md §9). `cargo xtask bench radio` starts it.
//!
//! The bench's firmware image under QEMU, which counts instructions. Exit code 1 where a budget is exceeded.

mod counts;

use std::fs;
use std::process::ExitCode;

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).filter(|word| *word != "--bench").collect();
    let done = match words[..] {
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
        put(&table)?;
    }
    let broken = counts::broken(&counts);
    if broken.is_empty() { Ok(()) } else { Err(broken.join("\n")) }
}

/// Writes the table between its marks.
fn put(table: &str) -> Result<(), String> {
    let file = firmware_build::workspace_root().join("protocol/README.md");
    let text = fs::read_to_string(&file).map_err(|error| format!("{}: {error}", file.display()))?;
    let missing = || format!("{} has no marks for the table: `{BEGIN}` and `{END}`", file.display());
    let (before, rest) = text.split_once(BEGIN).ok_or_else(missing)?;
    let (_, after) = rest.split_once(END).ok_or_else(missing)?;
    fs::write(&file, format!("{before}{BEGIN}\n{table}{END}{after}"))
        .map_err(|error| format!("{}: {error}", file.display()))
}

const BEGIN: &str = "<!-- radio table -->";
const END: &str = "<!-- end of radio table -->";
