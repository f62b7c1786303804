//! `qemu_match`: tests: six firmware images play the same match as six native brains. Host, radio, cameras
//! and referee around them are the same; the match's hash is compared after every tick (docs/architecture.md
//! §2.5, §7.2).
//!
//! `ONETWO_MATCH_SECONDS=600 cargo test --release -p match-tests --test qemu_match` plays
//! longer. Needs QEMU and a compiler for the target.

use firmware_build::inspect::{STACK_BUDGET, STEP_BUDGET};
use match_tests::hil::Pair;

/// Default length in simulated seconds: the worst steps come in stops and restarts, the first after half a
/// minute.
const SECONDS: f64 = 60.0;

#[test]
fn six_images_in_lockstep_play_the_match_that_six_native_brains_play() {
    let seconds = std::env::var("ONETWO_MATCH_SECONDS").ok().and_then(|text| text.parse().ok());
    let root = firmware_build::workspace_root();
    let image = firmware_build::build_image(&root, firmware_build::ImageBody::Omni)
        .unwrap_or_else(|error| panic!("{error}"));
    let mut pair = Pair::new(5, seconds.unwrap_or(SECONDS), &image).unwrap_or_else(|error| panic!("{error}"));
    let played = pair.play(|tick, hashes| assert_eq!(hashes[0], hashes[1], "tick {tick}"));
    let reported = played.unwrap_or_else(|error| panic!("{error}"));
    println!("{reported}");
    assert!(reported.ticks as f64 >= 100.0 * seconds.unwrap_or(SECONDS) - 1.0, "{reported}");
    let worst = reported.worst_instructions;
    assert!((1..=STEP_BUDGET).contains(&worst), "the worst step took {worst} instructions");
    let stack = reported.worst_stack;
    assert!((1..=STACK_BUDGET).contains(&stack), "{stack} B of stack");
}
