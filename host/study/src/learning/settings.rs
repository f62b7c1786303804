//! `settings`: settings of a run of learning.

use std::collections::BTreeSet;

use crate::learning::edit::Edit;
use crate::learning::proposals::Kind;
use crate::learning::starts::Worlds;

/// Settings of a run; equal ones on equal files learn the same.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct LearnSettings {
    /// Seed of all starts and choices.
    pub seed: u64,
    /// Trials after which no further round starts.
    pub budget: u64,
    /// Kinds of changes that are tried.
    pub kinds: BTreeSet<Kind>,
    /// The worlds that are learned in.
    pub worlds: Worlds,
    /// Expected share of wrong changes among the accepted ones.
    pub error_rate: f64,
    /// Tests that the error rate is shared among; after as many no change is accepted.
    pub tries: u32,
    /// Changes that are not proposed, because an author has refused them.
    pub refused: BTreeSet<Edit>,
    /// The null control: in every pair chance decides which outcome counts as the change's.
    pub shuffle: bool,
    /// Proposes and screens once, changes nothing.
    pub dry_run: bool,
}
