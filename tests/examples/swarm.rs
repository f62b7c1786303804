//! Does a team stay safe whatever goes wrong? `cargo xtask swarm --seeds 10000 [--first N] [--jobs J]`
//!
//! Prints what the runs came to; a run that breaks a promise is told with the line that repeats it, and the exit code is 1.

use std::io::IsTerminal as _;
use std::process::ExitCode;
use std::time::Instant;

use match_tests::swarm::{Runs, watch, words};

fn main() -> ExitCode {
    let Some(runs) = arguments(std::env::args().skip(1)) else {
        eprintln!("usage: cargo xtask swarm [--seeds N] [--first N] [--jobs J]");
        return ExitCode::from(2);
    };
    let (begin, shown) = (Instant::now(), std::io::stderr().is_terminal());
    let (tally, broken) = watch(runs, |done| {
        if shown && done.is_multiple_of(50) {
            eprint!("\r{done} of {} runs", runs.seeds);
        }
    });
    if shown {
        eprintln!();
    }
    for (seed, found) in broken.iter().take(SHOWN) {
        println!("{}", words(*seed, found));
    }
    let Runs { first, seeds, .. } = runs;
    println!(
        "seeds {first} to {}: {} broke a promise, {} kept all",
        first + seeds - 1,
        broken.len(),
        tally.runs
    );
    println!(
        "{} cycles, {} gameplays, {} overlaps; {} packets handed to robots, {} of them not to be believed; {} steps of \
         braking; the slowest team played {} ms after healing; {:.0} s",
        tally.cycles,
        tally.gameplays,
        tally.overlaps,
        tally.packets,
        tally.unbelievable,
        tally.brakings,
        tally.slowest_ms,
        begin.elapsed().as_secs_f64()
    );
    if broken.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

fn arguments(mut words: impl Iterator<Item = String>) -> Option<Runs> {
    let jobs = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    let mut runs = Runs { first: 0, seeds: 100, jobs };
    while let Some(word) = words.next() {
        let value: u64 = words.next()?.parse().ok()?;
        match word.as_str() {
            "--seeds" if value > 0 => runs.seeds = value,
            "--first" => runs.first = value,
            "--jobs" if value > 0 => runs.jobs = value as usize,
            _ => return None,
        }
    }
    Some(runs)
}

/// Of many that fail the first are told.
const SHOWN: usize = 20;
