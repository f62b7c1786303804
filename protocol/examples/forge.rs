//! `forge`: counts forged, replayed and foreign frames that are accepted: none, or it panics with the first.
//!
//! Run it with `cargo run --release -p onetwo-protocol --example forge -- --count 1000000 [--seed N]`.

#[path = "../tests/support/forgery.rs"]
mod forgery;

use std::process::ExitCode;

fn main() -> ExitCode {
    let (mut count, mut seed) = (1_000_000, 1);
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        match (argument.as_str(), arguments.next().and_then(|value| value.parse().ok())) {
            ("--count", Some(value)) => count = value,
            ("--seed", Some(value)) => seed = value,
            _ => {
                eprintln!("usage: forge [--count N] [--seed N]");
                return ExitCode::from(2);
            }
        }
    }
    let counters = forgery::tries(count, seed);
    let [sent, flipped, counter, epoch, length, name, made] = counters.kinds;
    println!(
        "{count} frames (seed {seed}), none believed: {sent} as they were said, {flipped} with flipped bits, {counter} with a newer \
         counter, {epoch} with a newer epoch, {length} cut or stretched, {name} in another's name, {made} made with guessed keys; \
         and {} recordings right after {} boots, {} to hosts that had just started",
        counters.after_boots, counters.boots, counters.to_fresh_hosts
    );
    ExitCode::SUCCESS
}
