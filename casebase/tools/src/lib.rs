//! `case_tools`: tools that turn case files into tables and check them. Runs on the host, at build and run
//! time.
//!
//! [`load`] reads one league's directory: files → [`CaseLeague`] and authored cases → checks → the four
//! symmetric copies → table and index ([`Table`]) → warnings. Every [`Finding`] has a code, file, line and
//! hint (docs/case-format.md §1.2).
//!
//! **Invariant.** All stored values were computed by the crate that will read them, `casebase`.
#![cfg_attr(doctest, doc = include_str!("../README.md"))]
#![forbid(unsafe_code)]

mod authored;
mod check;
mod codes;
pub mod competence;
mod counterfactual;
pub mod coverage;
mod document;
mod encode;
mod files;
mod grid;
pub mod keys;
mod league;
mod library;
mod lineup;
mod notes;
mod plans;
mod sample;
mod sampled;
pub mod self_blocking;
mod skeleton;
mod warnings;
mod words;
pub mod workbench;

pub use codes::{CODES, CodeEntry, code, entry};
pub use counterfactual::{Counterfactual, CounterfactualObstacle, Entity, Move, counterfactual};
pub use encode::Table;
pub use files::{CASE_FILE_LEN_MAX, Files, SourceFile, SourcePlace};
pub use foreign::{Finding, Severity};
pub use league::CaseLeague;
pub use library::{
    Library, Reduction, build, build_reduced, build_without_warnings, load, load_with_progress,
};
pub use lineup::{Lineup, Rectangle};
pub use sample::Sampler;
pub use sampled::never_retrieved;
pub use skeleton::{Skeleton, SkeletonError, skeleton};
