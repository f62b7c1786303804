//! `retrieval`: the baselines that retrieval is measured against, and the exchange of problems and
//! answers with the measured board.
//!
//! [`scan`] is the plain linear scan of docs/case-format.md §3: every case in turn, no index, no short cut.
//! [`encode`] and [`problems`] carry problems to a board, [`Answer`] brings back its results and their
//! instruction counts. Runs on the PC and in the bench's firmware image (`retrieval-bench` of the QEMU
//! board); `cargo xtask bench retrieval` drives both.

mod exchange;
mod scan;

pub use exchange::{
    Answer, Found, HEADER_LEN, LEN_MAX, PROBLEMS_ADDRESS, TABLE_ADDRESS, behind_header, encode, header,
    problems,
};
pub use scan::scan;
