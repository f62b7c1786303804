//! `strategy_pictures`: the figures of the second paper, by our own code (Biswas et al. 2014).
//!
//! `cargo run --release -p onetwo-host --example strategy_pictures -- FOLDER` writes them to that directory;
//! `cargo xtask pictures` keeps those in `docs/strategy`.

mod angles;
mod coercing;
mod field;
mod page;
mod pass_probability;
mod risk;
mod scenes;
mod tactics;

use std::path::Path;
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [directory] = &arguments[..] else {
        eprintln!("usage: strategy_pictures FOLDER");
        return ExitCode::from(2);
    };
    for (name, draw) in PICTURES {
        let file = Path::new(directory).join(name);
        let written = std::fs::create_dir_all(directory).and_then(|()| std::fs::write(&file, draw()));
        if let Err(error) = written {
            eprintln!("{}: {error}; name a writable directory", file.display());
            return ExitCode::FAILURE;
        }
        println!("{}", file.display());
    }
    ExitCode::SUCCESS
}

/// A figure's file and the function that draws it.
type NamedDrawing = (&'static str, fn() -> String);

const PICTURES: [NamedDrawing; 5] = [
    ("pass-probability.svg", pass_probability::draw),
    ("tactics.svg", tactics::draw),
    ("risk-of-receiving.svg", risk::draw),
    ("open-angles.svg", angles::draw),
    ("coerce-plan.svg", coercing::draw),
];
