//! `evaluation`: the paper's evaluation of case-based against reactive attackers: thousands of trials, its
//! Tables 1 to 6 (§5).
//!
//! ```text
//! plan ─► play_shard ─► trials-1-of-3.csv … ─► merge ─► rows ─► tables ─► compare ─ Wilson, z, Welch, Holm
//!                                                        paper::rows ──────┘
//! ```
//! A [`EvaluationPlan`] numbers the trials; shards of it are played anywhere, and merged rows are the same
//! bytes for any number of threads, shards and interrupts. [`tables`] makes docs/case-format.md §5.2's
//! `tables.json` of them; [`compare`] and [`with_paper`] compute the differences.

mod ablation;
mod claims;
mod comparison;
mod identity;
mod judge;
mod labels;
mod paper;
mod plan;
mod results;
mod row;
mod runs;
mod summary;
mod tables;
mod uses;
mod verdicts;

pub use ablation::{ARMS, Arm, Effect, ablation_table, effects};
pub use claims::{Claim, ClaimPoint, ClaimVerdict, Judgement, Standing, claims};
pub use comparison::{Comparison, Flat, Measure, compare, with_paper};
pub use identity::Identity;
#[cfg(test)]
pub(crate) use identity::tests::identity as identity_for_tests;
pub use judge::{Held, JudgementLine, judge};
pub use paper::paper;
pub use plan::{EvaluationCell, EvaluationPlan, Planned};
pub use results::{Results, effect_files};
pub use row::TrialRow;
#[cfg(test)]
pub(crate) use row::tests::row as row_for_tests;
pub use runs::Evaluation;
pub use summary::summary;
pub use tables::{Extent, TableRow, tables};
pub use uses::{CaseUse, OUTCOMES, uses, uses_to_csv};
pub use verdicts::verdicts;
