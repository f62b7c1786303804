//! `strategy_cost`: instruction counts of strategy decisions: COUNT decisions of one PART, on scenes of six
//! against six or eleven against eleven.
//!
//! `cargo run --release -p onetwo-host --example strategy_cost -- PART COUNT` runs them and prints a summary
//! of the results; `cargo xtask bench strategy` counts its instructions, for every PART of its table.

mod defence;
mod passes;
mod scenes;

use std::process::ExitCode;

use rules::League;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [part, count] = &arguments[..] else { return usage() };
    let Ok(count) = count.parse::<u32>() else { return usage() };
    let (six, eleven) = (League::DivisionB, League::DivisionA);
    let sent = match part.as_str() {
        "pass-location" => passes::locations(eleven, 11, count),
        "pass-location-six" => passes::locations(six, 6, count),
        "pass-search" => passes::searches(eleven, 11, count),
        "pass-search-six" => passes::searches(six, 6, count),
        "defend" => defence::defences(eleven, 11, count),
        "defend-six" => defence::defences(six, 6, count),
        "cap-plan" => defence::plans(eleven, 11, count),
        "cap-plan-six" => defence::plans(six, 6, count),
        "cap-watch" => defence::watches(count, false),
        "cap-attack" => defence::watches(count, true),
        _ => return usage(),
    };
    println!("{count} {part}: {sent}");
    ExitCode::SUCCESS
}

fn usage() -> ExitCode {
    eprintln!(
        "usage: strategy_cost PART COUNT; PART: pass-location, pass-search, defend, cap-plan (each also -six), cap-watch, cap-attack"
    );
    ExitCode::from(2)
}
