//! `qemu_motion`: tests: motion planning on the robot's processor equals the PC's, within its budget
//! (docs/architecture.md §9).
//!
//! `cargo xtask bench motion` prints the same counts, and those of this machine.
//! Needs QEMU and a compiler for the target.

#[path = "../benches/motion/figures.rs"]
#[allow(dead_code, reason = "the bench prints what is not judged")]
mod figures;
#[path = "../benches/motion/guest.rs"]
mod guest;

use workloads::motion::Work;

#[test]
fn motion_on_the_board_is_that_of_the_pc_and_within_its_budget() {
    let counted = guest::counted().unwrap_or_else(|why| panic!("{why}"));
    let figures = figures::Figures::of(&counted, [None; Work::ALL.len()]);
    let broken = figures.broken();
    assert!(broken.is_empty(), "{}\n{}", broken.join("\n"), figures.table());
}
