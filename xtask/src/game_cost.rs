//! `game_cost`: instruction counts of a host with eleven robots and of a match of two teams. Both under
//! callgrind (docs/architecture.md §9).
//!
//! The host's input is a recorded match of division A; each packet of vision, with all inputs until the next
//! one, is counted separately by a callgrind dump. A match is counted over [`SECONDS`] and over twice as many
//! seconds.

use std::path::Path;
use std::process::{Command, Stdio};
use std::{fs, io};

use crate::context::{Context, Failure, line_of, run};
use crate::cost::{Row, counted, release};

pub(crate) fn rows(context: &Context) -> Result<Vec<Row>, Failure> {
    let onetwo = release(context, "--bin onetwo", "onetwo")?;
    let feeder = release(context, "-p onetwo-host --example host_cost", "examples/host_cost")?;
    let directory = firmware_build::target_dir(context.root()).join("bench-game");
    let _ = fs::remove_dir_all(&directory);
    fs::create_dir_all(&directory).map_err(|error| Failure::at(&directory, error))?;
    let mut match_of_eleven = Command::new(&onetwo);
    match_of_eleven.args("play --headless --league division-a --seed 1 --json --duration".split(' '));
    match_of_eleven.args([&SECONDS.to_string(), "--record"]).arg(directory.join("match"));
    run(match_of_eleven.stdout(Stdio::null()))?;
    let rounds = each_round(&feeder, &directory)?;
    let mean = rounds.iter().sum::<f64>() / rounds.len() as f64;
    let late = rounds[rounds.len() - 1 - rounds.len() / 1000];
    let _ = fs::remove_dir_all(&directory);
    let second = (played(&onetwo, 2 * SECONDS)? - played(&onetwo, SECONDS)?) / f64::from(SECONDS);
    let host = "host, 11 v 11, from a packet of vision to the commands";
    Ok(vec![
        Row::new(format!("{host}: mean of {} packets", rounds.len()), mean, Some(PACKET_MEAN_MAX)),
        Row::new(format!("{host}: 999 of 1,000 at most"), late, Some(PACKET_LATE_MAX)),
        Row::new(format!("{host}: worst"), rounds[rounds.len() - 1], None),
        Row::new("a second of 6 v 6 with two whole teams, simulator and all", second, Some(GAME_SECOND_MAX)),
    ])
}

/// Instructions of a match of so many seconds.
fn played(onetwo: &Path, seconds: u32) -> Result<f64, Failure> {
    let line = format!("play --headless --seed 1 --json --duration {seconds}");
    Ok(counted(onetwo, line.split(' '))?.0)
}

/// Instructions of each packet, rising.
fn each_round(feeder: &Path, directory: &Path) -> Result<Vec<f64>, Failure> {
    let mut command = Command::new("valgrind");
    command
        .arg("--tool=callgrind")
        .arg(format!("--callgrind-out-file={}", directory.join("round").display()));
    command.args([format!("--toggle-collect={ROUND}"), format!("--dump-after={ROUND}")]);
    command.arg(feeder).arg(directory.join("match.trace"));
    let line = line_of(&command);
    let start = |error| Failure::Start { line: format!("{line} (is valgrind installed?)"), error };
    let status = command.stdin(Stdio::null()).stderr(Stdio::null()).status().map_err(start)?;
    if !status.success() {
        return Err(Failure::Command { line, status });
    }
    let mut rounds = Vec::new();
    for entry in fs::read_dir(directory).map_err(start)? {
        let path = entry.map_err(start)?.path();
        if path.file_name().is_some_and(|name| name.to_string_lossy().starts_with("round.")) {
            let text = fs::read_to_string(&path).map_err(start)?;
            rounds.extend(total(&text));
        }
    }
    rounds.sort_by(f64::total_cmp);
    // The first call is before any packet, and a handful of numbers would be no distribution.
    if rounds.len() < 1000 {
        return Err(start(io::Error::other(format!("only {} packets counted", rounds.len()))));
    }
    Ok(rounds)
}

/// The total of one of callgrind's dumps.
fn total(dump: &str) -> Option<f64> {
    dump.lines().find_map(|line| line.strip_prefix("totals:")?.trim().parse().ok())
}

/// Budgets of docs/architecture.md §9, instructions: a packet of vision, 11 v 11, on average and for 999 of
/// 1,000; a second of 6 v 6.
const PACKET_MEAN_MAX: f64 = 10e6;
const PACKET_LATE_MAX: f64 = 25e6;
const GAME_SECOND_MAX: f64 = 300e6;
/// Simulated seconds of either match.
const SECONDS: u32 = 20;
/// The function that is counted call by call.
const ROUND: &str = "host_cost::count_this_round";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_dump_s_total_is_read_from_its_last_line() {
        assert_eq!(total("part: 100\nevents: Ir\nsummary: 56492\ntotals: 56492\n"), Some(56_492.0));
        assert_eq!(total("part: 1\n"), None);
    }
}
