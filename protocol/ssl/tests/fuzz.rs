//! `fuzz`: fuzz test of the decoders. A short run of `examples/fuzz_decode.rs`.

#[path = "support/messages.rs"]
mod messages;
#[path = "support/mutate.rs"]
mod mutate;

use std::path::Path;

#[test]
fn twenty_thousand_broken_packets_are_read_or_refused() {
    let seeds = mutate::seeds(&Path::new(env!("CARGO_MANIFEST_DIR")).join("tests"));
    let counters = mutate::run(&seeds, 20_000, 7);
    assert_eq!(counters.packets, 20_000);
    // Enough mutations that both happen often, or the run proves nothing.
    assert!(counters.decoded > 5_000 && counters.refused > 5_000, "{counters:?}");
    assert!(counters.guessed > 2000 && counters.logged > 10_000 && counters.framed > 10_000, "{counters:?}");
}

#[test]
fn the_same_seed_breaks_the_same_packets() {
    let seeds = mutate::seeds(&Path::new(env!("CARGO_MANIFEST_DIR")).join("tests"));
    assert_eq!(mutate::run(&seeds, 300, 3), mutate::run(&seeds, 300, 3));
    assert_ne!(mutate::run(&seeds, 300, 3), mutate::run(&seeds, 300, 4));
}
