//! `qemu_retrieval`: tests: retrieval on the robot's processor equals the PC's, within its budget
//! (docs/architecture.md §9).
//!
//! The built-in library on problems that robots retrieved for; `cargo xtask bench retrieval` has all bases
//! and problems, and checks their budgets. Needs QEMU and a compiler for the target.

#[path = "../benches/retrieval/figures.rs"]
#[allow(dead_code, reason = "the bench prints what is not judged")]
mod figures;
#[path = "../benches/retrieval/guest.rs"]
mod guest;
#[path = "../benches/retrieval/played.rs"]
mod played;

use figures::{Figures, PLAYED};
use guest::Board;

#[test]
fn a_retrieval_from_the_built_in_library_is_within_its_budget() {
    let base = case_library::four_legged();
    let problems = played::problems(TRIALS);
    let board = Board::new().unwrap_or_else(|why| panic!("{why}"));
    let answers = board.answers(base.bytes(), &problems).unwrap_or_else(|why| panic!("{why}"));
    guest::agrees(&base, &problems, &answers).unwrap_or_else(|why| panic!("{why}"));
    let figures = Figures::of(&base, PLAYED, &problems, &answers, None);
    let [best, ..] = figures.guest;
    assert!(best.median <= MEDIAN_MAX && best.worst <= WORST_MAX, "{best:?}");
    assert!(figures.bytes_per_case <= 96.0, "{} bytes a case", figures.bytes_per_case);
}

/// Guest instructions (docs/architecture.md §9).
const MEDIAN_MAX: u32 = 1_500;
const WORST_MAX: u32 = 12_000;
/// As many as docs/architecture.md §9 names: every scenario and configuration 25 times.
const TRIALS: usize = 200;
