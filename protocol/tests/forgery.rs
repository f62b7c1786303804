//! `forgery`: tests: without the key, or with recordings only, no robot and no host can be deceived. 10^5
//! tries; `cargo run --release -p onetwo-protocol --example forge -- --count 1000000` makes more.

#[path = "support/forgery.rs"]
mod forgery;

const TRIES: u64 = 100_000;

#[test]
fn of_a_hundred_thousand_forged_replayed_and_foreign_frames_none_is_believed() {
    let counters = forgery::tries(TRIES, 11);
    // No kind is left out by chance.
    assert!(counters.kinds.iter().all(|tries| *tries > TRIES / 10), "{counters:?}");
    assert!(
        counters.boots == 5 && counters.after_boots > 1_000 && counters.to_fresh_hosts > 1_000,
        "{counters:?}"
    );
}
