//! `forgery`: tests: without the key, or with recordings only, no robot and no host can be deceived. 10^5
//! tries; `cargo run --release -p protocol --example forge -- --count 1000000` makes more.

#[path = "support/forgery.rs"]
mod forgery;

const TRIES: u64 = 100_000;

#[test]
fn of_a_hundred_thousand_forged_replayed_and_foreign_frames_none_is_believed() {
    let tally = forgery::tries(TRIES, 11);
    // No kind is left out by chance.
    assert!(tally.kinds.iter().all(|tries| *tries > TRIES / 10), "{tally:?}");
    assert!(tally.boots == 5 && tally.after_boots > 1_000 && tally.to_fresh_hosts > 1_000, "{tally:?}");
}
