//! `faults`: cost of packet loss for a team. `cargo xtask faults [--seeds N] [--write]` prints the table;
//! with `--write` it becomes `docs/faults.md` and its figure.

use std::path::Path;
use std::process::ExitCode;

use match_tests::swarm::report;
use match_tests::sweep::{loss_chart, page, sweep};

fn main() -> ExitCode {
    let (mut seeds, mut write) = (40_u64, false);
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--write" => write = true,
            "--seeds" => match arguments.next().and_then(|number| number.parse().ok()).filter(|n| *n > 0) {
                Some(n) => seeds = n,
                None => return usage(),
            },
            _ => return usage(),
        }
    }
    let rows = match sweep(seeds) {
        Ok(rows) => rows,
        Err((seed, found)) => {
            eprintln!("{}", report(seed, &found));
            return ExitCode::FAILURE;
        }
    };
    let text = page(&rows, seeds);
    println!("{text}");
    if !write {
        return ExitCode::SUCCESS;
    }
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs");
    let written = std::fs::create_dir_all(docs.join("faults"))
        .and_then(|()| std::fs::write(docs.join("faults.md"), text))
        .and_then(|()| std::fs::write(docs.join("faults/loss.svg"), loss_chart(&rows)));
    match written {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{}: {error}", docs.display());
            ExitCode::FAILURE
        }
    }
}

fn usage() -> ExitCode {
    eprintln!("usage: cargo xtask faults [--seeds N] [--write]");
    ExitCode::from(2)
}
