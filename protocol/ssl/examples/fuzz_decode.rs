//! `fuzz_decode`: fuzzing of the decoders. `cargo run -p onetwo-ssl --example fuzz_decode -- --count 1000000`
//!
//! Prints counts of read and refused packets; a panic is a finding, reported with the seed that repeats it.

#[path = "../tests/support/messages.rs"]
mod messages;
#[path = "../tests/support/mutate.rs"]
mod mutate;

use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

/// Packets a batch; a batch has a seed of its own, so that a finding is repeated in a second.
const BATCH: u64 = 10_000;

fn main() -> ExitCode {
    let Some((count, seed)) = arguments() else {
        eprintln!("usage: fuzz_decode [--count N] [--seed N]");
        return ExitCode::from(2);
    };
    let seeds = mutate::seeds(&Path::new(env!("CARGO_MANIFEST_DIR")).join("tests"));
    let begin = Instant::now();
    let mut total = mutate::Counters::default();
    for batch in 0..count.div_ceil(BATCH) {
        let size = BATCH.min(count - batch * BATCH);
        let own = seed.wrapping_add(batch);
        let ran = std::panic::catch_unwind(|| mutate::run(&seeds, size, own));
        let Ok(counters) = ran else {
            eprintln!("panic above: repeat it with --count {size} --seed {own}");
            return ExitCode::FAILURE;
        };
        total.packets += counters.packets;
        total.decoded += counters.decoded;
        total.refused += counters.refused;
        total.guessed += counters.guessed;
        total.logged += counters.logged;
        total.framed += counters.framed;
    }
    println!(
        "{} packets of {} seeds broken (seed {seed}), no panic: {} still decode, {} are refused; {} are \
         recognised as vision, referee or tracker; {} messages out of broken log files, {} out of broken streams; {:.1} s",
        total.packets,
        seeds.len(),
        total.decoded,
        total.refused,
        total.guessed,
        total.logged,
        total.framed,
        begin.elapsed().as_secs_f64()
    );
    ExitCode::SUCCESS
}

fn arguments() -> Option<(u64, u64)> {
    let (mut count, mut seed) = (1_000_000, 1);
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        let value = arguments.next()?.parse().ok()?;
        match argument.as_str() {
            "--count" => count = value,
            "--seed" => seed = value,
            _ => return None,
        }
    }
    Some((count, seed))
}
