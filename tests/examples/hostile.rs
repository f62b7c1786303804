//! `hostile`: fuzzing of readers and brains. `cargo run --release -p match-tests --example hostile -- --count
//! 10000000 [--seed N] [--jobs J]`: a panic is reported with the command that repeats it.

use std::process::ExitCode;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

use match_tests::hostile::{corpus, run};

/// Number of byte strings per seed.
const BATCH: u64 = 50_000;

fn main() -> ExitCode {
    let jobs = std::thread::available_parallelism().map_or(1, std::num::NonZero::get) as u64;
    let (mut count, mut seed, mut threads) = (1_000_000_u64, 0_u64, jobs);
    let mut arguments = std::env::args().skip(1);
    while let Some(label) = arguments.next() {
        let value = arguments.next().and_then(|value| value.parse().ok());
        match (label.as_str(), value) {
            ("--count", Some(value)) => count = value,
            ("--seed", Some(value)) => seed = value,
            ("--jobs", Some(value)) => threads = value,
            _ => {
                eprintln!("usage: hostile [--count N] [--seed N] [--jobs J]");
                return ExitCode::from(2);
            }
        }
    }
    let corpus = match corpus() {
        Ok(corpus) => corpus,
        Err(error) => {
            eprintln!("protocol/fuzz/corpus: {error}");
            return ExitCode::FAILURE;
        }
    };
    let (begin, next, fallen) = (Instant::now(), AtomicU64::new(0), AtomicU64::new(0));
    let batches = count.div_ceil(BATCH);
    std::thread::scope(|scope| {
        for _ in 0..threads.max(1) {
            scope.spawn(|| {
                loop {
                    let batch = next.fetch_add(1, Ordering::Relaxed);
                    if batch >= batches {
                        return;
                    }
                    let own = seed + batch;
                    if let Err(panicked) = run(&corpus, own, BATCH.min(count - batch * BATCH)) {
                        fallen.fetch_add(1, Ordering::Relaxed);
                        eprintln!("panic above: {} with {:02x?}", panicked.target, panicked.bytes);
                        eprintln!("repeat: --count {BATCH} --seed {own} --jobs 1");
                    }
                }
            });
        }
    });
    let fallen = fallen.into_inner();
    println!(
        "{count} byte strings for {} targets and a brain (seeds {seed} to {}), {fallen} panics; {:.0} s",
        corpus.len(),
        seed + batches - 1,
        begin.elapsed().as_secs_f64()
    );
    if fallen == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
