//! How are many runs played on many threads, with one answer whatever their number?

use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

use super::plan::Plan;
use super::{Found, Tally, run};

/// Which runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Runs {
    /// The first seed.
    pub first: u64,
    /// How many.
    pub seeds: u64,
    /// On so many threads.
    pub jobs: usize,
}

/// Plays them all; what came of those that kept every promise, and those that broke one, by seed. `look` is told how many
/// are done.
pub fn watch(runs: Runs, look: impl Fn(u64) + Sync) -> (Tally, Vec<(u64, Found)>) {
    let next = AtomicU64::new(0);
    let done = AtomicU64::new(0);
    let sums = Mutex::new((Tally::default(), Vec::new()));
    std::thread::scope(|scope| {
        for _ in 0..runs.jobs.max(1) {
            scope.spawn(|| {
                loop {
                    let number = next.fetch_add(1, Ordering::Relaxed);
                    if number >= runs.seeds {
                        return;
                    }
                    let seed = runs.first + number;
                    let ended = run(seed);
                    let Ok(mut sums) = sums.lock() else { return };
                    match ended {
                        Ok(tally) => sums.0 = sums.0.with(tally),
                        Err(found) => sums.1.push((seed, found)),
                    }
                    drop(sums);
                    look(done.fetch_add(1, Ordering::Relaxed) + 1);
                }
            });
        }
    });
    let (tally, mut broken) = sums.into_inner().unwrap_or_default();
    broken.sort_unstable_by_key(|(seed, _)| *seed);
    (tally, broken)
}

/// The lines that tell of a broken promise, the last of which repeats it.
pub fn words(seed: u64, found: &Found) -> String {
    let plan = Plan::drawn(seed);
    format!("seed {seed}: {found}\n  {plan}\n  repeat: cargo xtask swarm --first {seed} --seeds 1")
}
