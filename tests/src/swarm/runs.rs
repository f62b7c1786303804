//! `runs`: parallel runs with deterministic results.

use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

use arena::game::NoWatcher;

use super::matches::{self, LENGTH, Outcome, Plan};
use super::{Counters, Found, plan, run};

/// Selection of runs, by their seeds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Runs {
    /// Seed of the first run.
    pub first: u64,
    /// Number of runs, one a seed.
    pub seeds: u64,
    /// Number of threads that play them.
    pub jobs: usize,
}

/// Plays them all; returns the results of those without violations, and the violations of the others, by
/// seed. `look` is called with the number done.
pub fn watch(runs: Runs, look: impl Fn(u64) + Sync) -> (Counters, Vec<(u64, Found)>) {
    let mut counters = Counters::default();
    let mut broken = Vec::new();
    for (seed, ended) in each(runs, run, |done, _| look(done)) {
        match ended {
            Ok(one) => counters = counters.with(one),
            Err(found) => broken.push((seed, found)),
        }
    }
    (counters, broken)
}

/// Plays all matches, ordered by seed; `look` is called with the number done and the results of the last one.
pub fn watch_matches(runs: Runs, look: impl Fn(u64, &(Plan, Outcome)) + Sync) -> Vec<(Plan, Outcome)> {
    let play = |seed| {
        let plan = Plan::drawn(seed, LENGTH);
        let outcome = matches::play(&plan, &mut NoWatcher);
        (plan, outcome)
    };
    each(runs, play, look).into_iter().map(|(_, ended)| ended).collect()
}

fn each<T: Send>(runs: Runs, play: impl Fn(u64) -> T + Sync, look: impl Fn(u64, &T) + Sync) -> Vec<(u64, T)> {
    let next = AtomicU64::new(0);
    let done = AtomicU64::new(0);
    let all = Mutex::new(Vec::new());
    std::thread::scope(|scope| {
        for _ in 0..runs.jobs.max(1) {
            scope.spawn(|| {
                loop {
                    let number = next.fetch_add(1, Ordering::Relaxed);
                    if number >= runs.seeds {
                        return;
                    }
                    let seed = runs.first + number;
                    let ended = play(seed);
                    look(done.fetch_add(1, Ordering::Relaxed) + 1, &ended);
                    let Ok(mut all) = all.lock() else { return };
                    all.push((seed, ended));
                }
            });
        }
    });
    let mut all = all.into_inner().unwrap_or_default();
    all.sort_unstable_by_key(|(seed, _)| *seed);
    all
}

/// The lines that report a violation; the last one repeats it.
pub fn report(seed: u64, found: &Found) -> String {
    let plan = plan::Plan::drawn(seed);
    format!("seed {seed}: {found}\n  {plan}\n  repeat: cargo xtask swarm --first {seed} --seeds 1")
}
