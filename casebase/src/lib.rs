//! `casebase`: case representation and retrieval: which gameplay fits a situation, which robot plays which
//! part, and whether the ball's path is free (Ros et al. 2009, §2–§3).
//!
//! A case is (P, A, K): a situation, what each robot does in it, and how far it generalises. A [`CaseBase`]
//! is a flat table in flash; [`retrieve()`] finds the case for a [`Problem`]; [`explain()`] gives the reason
//! for every case. The four symmetric copies of an authored case are stored in full, so that a robot never
//! mirrors anything.
//!
//! Whole millimetres, field frame (+x along the length, +y to the left of +x), as in the paper.
//!
//! **Invariants.** No I/O, no clock, no allocation; no bytes of a table, no problem and no setting can panic.
//! It does not depend on files (`case-tools` does) or on radio. Runs on robots and on the host alike.
#![cfg_attr(doctest, doc = include_str!("../README.md"))]
#![forbid(unsafe_code)]
#![no_std]

pub mod action;
mod best_search;
mod case;
mod cells;
mod correspondence;
mod explain;
mod index;
mod leg;
mod path;
pub mod plan_simulation;
mod point;
mod presence;
mod problem;
mod query;
mod rank;
mod retrieve;
pub mod settings;
mod stored;
mod symmetry;
pub mod table;
mod terms;
#[cfg(test)]
mod testing;
mod word_search;

pub use action::{
    Action, CaseKick, CaseRobot, FieldMm, KickAim, KickId, OPPONENTS_MAX, Pass, Primitive, TEAMMATES_MAX,
    TurnTarget,
};
pub use case::Case;
pub use cells::{cells_of, strips_of};
pub use explain::{CaseVerdict, explain};
pub use geometry::GoalEnd;
pub use index::Grid;
pub use leg::{Abreast, Leg, LegKind};
pub use path::{Blocked, blocked_leg};
pub use point::{PointMm, Scope};
pub use presence::{Demands, Presence};
pub use problem::{PROBLEM_OPPONENTS_MAX, PROBLEM_TEAMMATES_MAX, Problem};
pub use query::adapted_position;
pub use rank::{Correspondence, Match, rank_order};
pub use retrieve::{Retrieval, retrieve, retrieve_best};
pub use settings::{
    CorrespondenceRule, CostRule, Criterion, FreePathRule, OutOfField, RetrievalSettings, ScopeRule,
    SettingError,
};
pub use symmetry::Symmetry;
pub use table::{CaseBase, TableError};
pub use terms::{Terms, terms};
