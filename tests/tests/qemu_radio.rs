//! `qemu_radio`: tests: radio frames stay within their budget on the robot's processor (docs/architecture.md
//! §9).
//!
//! `cargo xtask bench radio` prints the same counts. Needs QEMU and a compiler for the target (feature
//! `qemu`).

#[path = "../benches/radio/counts.rs"]
mod counts;

use workloads::radio::Work;

#[test]
fn every_frame_is_sealed_and_opened_within_its_budget() {
    let counts = counts::counted().unwrap_or_else(|why| panic!("{why}"));
    assert_eq!(counts.len(), Work::ALL.len());
    let broken = counts::broken(&counts);
    assert!(broken.is_empty(), "{}\n{}", broken.join("\n"), counts::table(&counts));
    let of = |work| counts.iter().find(|count| count.work == work).map_or(0, |count| count.worst);
    assert!(of(Work::RefuseReplay) < 200, "a replay is refused before its tag is computed");
}
