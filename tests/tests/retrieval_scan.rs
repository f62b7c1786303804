//! `retrieval_scan`: tests: retrieval agrees with a scan of the same table, bit for bit.
//!
//! A part of the problems of `cargo xtask bench retrieval --verify`, over the same bases: 36 to 10,000 stored
//! cases.

#[path = "../benches/retrieval/bases.rs"]
mod bases;
#[path = "../benches/retrieval/verify.rs"]
mod verify;

#[test]
fn retrieval_answers_1000_problems_as_a_plain_scan_does() {
    verify::run([2_000, 2_000, 1_000, 200]).unwrap();
}
