//! `swarm`: plays many runs drawn from seeds and checks the promised properties. `cargo xtask swarm [--plan
//! faults|referee] --seeds 10000 [--first N] [--jobs J] [--record STEM]`
//!
//! `faults`: a team with faults of radio, clocks and sensors. `referee`: matches of 60 s with cards, keeper
//! changes, restarts and halts. Prints the results of the runs; a run with a violated property is reported
//! with the line that repeats it, and the exit code is 1. `--record` plays the match of `--first` alone and
//! records it, for `onetwo replay STEM.trace`.

use std::io::IsTerminal as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use arena::game::header;
use host::record::Recorder;
use match_tests::swarm::matches::{self, Plan, Sum};
use match_tests::swarm::{Runs, report, watch, watch_matches};

fn main() -> ExitCode {
    let Some(Arguments { plan, runs, record }) = arguments(std::env::args().skip(1)) else {
        eprintln!(
            "usage: cargo xtask swarm [--plan faults|referee] [--seeds N] [--first N] [--jobs J] [--record STEM]"
        );
        return ExitCode::from(2);
    };
    match (plan, record) {
        (Which::Referee, Some(stem)) => recorded(runs.first, &stem),
        (Which::Faults, Some(_)) => {
            eprintln!("swarm: only matches are recorded: --plan referee --first N --record STEM");
            ExitCode::from(2)
        }
        (Which::Faults, None) => faults(runs),
        (Which::Referee, None) => referee(runs),
    }
}

/// The command line's arguments.
struct Arguments {
    plan: Which,
    runs: Runs,
    record: Option<PathBuf>,
}

fn recorded(seed: u64, stem: &Path) -> ExitCode {
    let plan = Plan::drawn(seed, matches::LENGTH);
    let header = header(env!("CARGO_PKG_VERSION"), "", &matches::config(&plan));
    let mut recorder = match Recorder::begin(stem, &header) {
        Ok(recorder) => recorder,
        Err(error) => {
            eprintln!("swarm: {}: {error}", stem.display());
            return ExitCode::FAILURE;
        }
    };
    let outcome = matches::play(&plan, &mut recorder);
    println!("{}", matches::report(&plan, &outcome));
    match recorder.finish() {
        Ok(()) if outcome.found.is_empty() => ExitCode::SUCCESS,
        Ok(()) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("swarm: {}: {error}", stem.display());
            ExitCode::FAILURE
        }
    }
}

/// Which plan draws the runs.
#[derive(Clone, Copy)]
enum Which {
    Faults,
    Referee,
}

/// Matches of the referee's plan; each violation is reported at once.
fn referee(runs: Runs) -> ExitCode {
    let begin = Instant::now();
    let ended = watch_matches(runs, |done, (plan, outcome)| {
        if !outcome.found.is_empty() {
            println!("{}", matches::report(plan, outcome));
        }
        if done.is_multiple_of(10) {
            eprintln!("{done} of {} matches", runs.seeds);
        }
    });
    let mut sum = Sum::default();
    for (_, outcome) in &ended {
        sum.add(outcome);
    }
    let broken = ended.iter().filter(|(_, outcome)| !outcome.found.is_empty()).count();
    for (kind, matches) in &sum.kinds {
        println!("{matches:5} matches: {kind}");
    }
    let Runs { first, seeds, .. } = runs;
    let kept = ended.len() - broken;
    println!("seeds {first} to {}: {broken} broke a promise, {kept} kept all", first + seeds - 1);
    let matches::Outcome { running_s, blocked_s, acts, taken_off, begun, .. } = &sum.all;
    println!(
        "{running_s:.0} s in play, {blocked_s:.0} s blocked; {acts} acts of people; {} penalties, {} kick-offs, {} free kicks, {} \
         placements and {} that failed; {taken_off} robots taken off by hand; {:.0} s",
        begun[0],
        begun[1],
        begun[2],
        begun[3],
        begun[4],
        begin.elapsed().as_secs_f64()
    );
    if broken == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

fn faults(runs: Runs) -> ExitCode {
    let (begin, visible) = (Instant::now(), std::io::stderr().is_terminal());
    let (counters, broken) = watch(runs, |done| {
        if visible && done.is_multiple_of(50) {
            eprint!("\r{done} of {} runs", runs.seeds);
        }
    });
    if visible {
        eprintln!();
    }
    for (seed, found) in broken.iter().take(SHOWN) {
        println!("{}", report(*seed, found));
    }
    let Runs { first, seeds, .. } = runs;
    println!(
        "seeds {first} to {}: {} broke a promise, {} kept all",
        first + seeds - 1,
        broken.len(),
        counters.runs
    );
    println!(
        "{} cycles, {} gameplays, {} overlaps; {} packets handed to robots, {} of them not to be believed; {} steps of \
         braking; the slowest team played {} ms after healing; {:.0} s",
        counters.cycles,
        counters.gameplays,
        counters.overlaps,
        counters.packets,
        counters.unbelievable,
        counters.brakings,
        counters.slowest_ms,
        begin.elapsed().as_secs_f64()
    );
    if broken.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

fn arguments(mut flags: impl Iterator<Item = String>) -> Option<Arguments> {
    let jobs = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    let (mut plan, mut runs, mut record) = (Which::Faults, Runs { first: 0, seeds: 100, jobs }, None);
    while let Some(flag) = flags.next() {
        let value = flags.next()?;
        let number = || value.parse::<u64>().ok();
        match flag.as_str() {
            "--plan" if value == "faults" => plan = Which::Faults,
            "--plan" if value == "referee" => plan = Which::Referee,
            "--seeds" => runs.seeds = number().filter(|seeds| *seeds > 0)?,
            "--first" | "--from" => runs.first = number()?,
            "--jobs" => runs.jobs = number().filter(|jobs| *jobs > 0)? as usize,
            "--record" => record = Some(PathBuf::from(value)),
            _ => return None,
        }
    }
    Some(Arguments { plan, runs, record })
}

/// Maximum number of failed runs that are reported.
const SHOWN: usize = 20;
