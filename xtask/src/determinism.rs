//! `determinism`: determinism check: the same seed gives the same bits in debug and release, on the PC and on
//! the robot's processor.
//!
//! docs/architecture.md §2.5: a trial's trace hash covers every pose, actuator frame and radio packet, and is
//! computed by the same code for all back ends. So three equal hashes show that three builds played the same
//! trial.

use std::collections::BTreeSet;
use std::fmt;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::atomic::{AtomicUsize, Ordering};

use firmware_build::Install;

use crate::context::{self, Context, Failure, line_of};

pub(crate) const WHAT: &str = "the same trials have the same trace in debug, release and on QEMU";

pub(crate) fn run(context: &Context) -> Result<(), Failure> {
    firmware_build::ensure_qemu(Install::SystemWide).map_err(Failure::Qemu)?;
    // `onetwo` builds the firmware image by itself; that needs a compiler for the target.
    context.ensure_target()?;
    // Release as `cargo run` builds it, so that it is the program a person runs; debug as the tests do, which
    // have built it already.
    context::run(&mut context.cargo("test --workspace --features onetwo/png --no-run"))?;
    context::run(&mut context.cargo("build --release --bin onetwo"))?;
    let target = firmware_build::target_dir(context.root());
    let [debug, release] = ["debug", "release"]
        .map(|profile| target.join(profile).join(format!("onetwo{}", std::env::consts::EXE_SUFFIX)));
    let players = [
        Player { what: "debug", program: debug, backend: "native" },
        Player { what: "release", program: release.clone(), backend: "native" },
        Player { what: "QEMU", program: release, backend: "qemu" },
    ];
    let mut differing = Vec::new();
    let mut hashes = BTreeSet::new();
    for (trial, played) in play(context.root(), &players) {
        match same(&played) {
            Some(hash) => {
                hashes.insert(hash.to_string());
            }
            None => differing.push(format!("{trial}: {}", difference_text(&players, &played))),
        }
    }
    // A hash that never changes would always agree.
    if differing.is_empty() && hashes.len() < trials().count() {
        differing.push(format!("{} different trials have only {} hashes", trials().count(), hashes.len()));
    }
    if differing.is_empty() { Ok(()) } else { Err(Failure::Determinism(differing)) }
}

/// Each player's result of a trial.
type Played = [Result<String, String>; 3];

/// Plays every trial with every player, as many trials at once as there are cores: firmware images in
/// lockstep run one at a time.
fn play(root: &Path, players: &[Player; 3]) -> Vec<(Trial, Played)> {
    let trials: Vec<Trial> = trials().collect();
    let next = AtomicUsize::new(0);
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        let all: Vec<_> =
            (0..cores).map(|_| scope.spawn(|| play_waiting(root, players, &trials, &next))).collect();
        all.into_iter()
            .flat_map(|one| one.join().expect("a trial that cannot be played is an answer"))
            .collect()
    })
}

/// Plays the trials from number `next` on that no other thread has taken.
fn play_waiting(
    root: &Path,
    players: &[Player; 3],
    trials: &[Trial],
    next: &AtomicUsize,
) -> Vec<(Trial, Played)> {
    let mut results = Vec::new();
    while let Some(trial) = trials.get(next.fetch_add(1, Ordering::Relaxed)) {
        let played = players.each_ref().map(|player| player.trace_hash(root, *trial));
        println!("xtask: {trial}: {}", difference_text(players, &played));
        results.push((*trial, played));
    }
    results
}

/// A trial of the paper with full brains.
#[derive(Clone, Copy)]
struct Trial {
    scenario: u8,
    opponents: &'static str,
    seed: u64,
}

impl fmt::Display for Trial {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { scenario, opponents, seed } = self;
        write!(f, "trial --scenario {scenario} --opponents {opponents} --approach cbr --seed {seed}")
    }
}

/// Every scenario against both kinds of opponents.
fn trials() -> impl Iterator<Item = Trial> {
    (1..=SEEDS).flat_map(|seed| {
        ["dg", "2d"].into_iter().flat_map(move |opponents| {
            (1..=SCENARIOS).map(move |scenario| Trial { scenario, opponents, seed })
        })
    })
}

/// One build of the program, with one kind of robots.
struct Player {
    what: &'static str,
    program: PathBuf,
    backend: &'static str,
}

impl Player {
    fn trace_hash(&self, root: &Path, trial: Trial) -> Result<String, String> {
        let mut command = Command::new(&self.program);
        command.current_dir(root).args(trial.to_string().split(' ')).args([
            "--backend",
            self.backend,
            "--json",
        ]);
        let line = line_of(&command);
        let output = command.output().map_err(|error| format!("`{line}` does not start: {error}"))?;
        if !output.status.success() {
            let printed = String::from_utf8_lossy(&output.stderr);
            return Err(format!(
                "`{line}` failed ({}): {}",
                output.status,
                printed.lines().last().unwrap_or("")
            ));
        }
        let report = String::from_utf8_lossy(&output.stdout);
        trace_hash_in(&report).map(str::to_string).ok_or(format!("`{line}` printed no trace_hash"))
    }
}

/// The hash, where all players have the same one.
fn same(played: &[Result<String, String>]) -> Option<&str> {
    let first = played.first()?.as_ref().ok()?;
    played.iter().all(|hash| hash.as_ref() == Ok(first)).then_some(first)
}

fn difference_text(players: &[Player], played: &[Result<String, String>]) -> String {
    if let Some(hash) = same(played) {
        return hash.to_string();
    }
    let each = players.iter().zip(played).map(|(player, hash)| match hash {
        Ok(hash) => format!("{} {hash}", player.what),
        Err(why) => format!("{} {why}", player.what),
    });
    each.collect::<Vec<_>>().join(", ")
}

/// The value of `"trace_hash"` in a trial's report: 16 hexadecimal digits.
fn trace_hash_in(report: &str) -> Option<&str> {
    let (_, rest) = report.split_once("\"trace_hash\"")?;
    let (hash, _) = rest.trim_start().strip_prefix(':')?.trim_start().strip_prefix('"')?.split_once('"')?;
    (hash.len() == 16 && hash.bytes().all(|digit| digit.is_ascii_hexdigit())).then_some(hash)
}

/// Seeds per scenario and kind of opponents: 3 × 4 × 2 = 24 trials, above the 20 that are required.
const SEEDS: u64 = 3;
/// The paper's scenarios (Ros et al. 2009, §5.1.1).
const SCENARIOS: u8 = 4;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hash_is_found_however_the_report_is_spaced() {
        let tight = r#"{"time_s":3.2,"trace_hash":"00ff00ff00ff00ff"}"#;
        let airy = "{\n  \"trace_hash\" : \"00ff00ff00ff00ff\"\n}";
        assert_eq!(trace_hash_in(tight), Some("00ff00ff00ff00ff"));
        assert_eq!(trace_hash_in(airy), Some("00ff00ff00ff00ff"));
        assert_eq!(trace_hash_in(r#"{"trace_hash":"00ff"}"#), None);
        assert_eq!(trace_hash_in(r#"{"trace_hash":null,"x":"00ff00ff00ff00ff"}"#), None);
        assert_eq!(trace_hash_in("{}"), None);
    }

    #[test]
    fn one_player_who_differs_or_fails_is_enough() {
        let (a, b) = (Ok("a".to_string()), Ok("b".to_string()));
        let failed = Err("no QEMU".to_string());
        assert_eq!(same(&[a.clone(), a.clone(), a.clone()]), Some("a"));
        assert_eq!(same(&[a.clone(), a.clone(), b]), None);
        assert_eq!(same(&[a.clone(), a, failed.clone()]), None);
        assert_eq!(same(&[failed.clone(), failed]), None);
    }

    #[test]
    fn at_least_twenty_trials_cover_every_scenario() {
        let all: Vec<_> = trials().collect();
        assert!(all.len() >= 20);
        for scenario in 1..=4 {
            assert!(all.iter().any(|trial| trial.scenario == scenario && trial.opponents == "2d"));
        }
        assert_eq!(all[0].to_string(), "trial --scenario 1 --opponents dg --approach cbr --seed 1");
    }
}
