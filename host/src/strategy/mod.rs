//! `strategy`: an order for every robot, within the rules: keeper, two defenders, the others by cases
//! (docs/architecture.md §3.3).
//!
//! [`view`] is the strategy's view of the field, turned so that we attack towards +x (the only module that
//! flips); [`roles`] assigns the roles without flicker; [`defence`], [`restart`] and [`support`] give the
//! places; [`Coach`] chooses among them by the phase of the game. Every [`Order`] carries its reason. SI
//! units, attack frame.
//!
//! [`pass`] is the second paper's choice and timing of passes, [`threat`] is its defence and [`coerce`] its
//! planner of free kicks; [`Tactics`] selects which of them the coach plays. [`opponents`] are other teams'
//! open play, as a reference for ours.

mod bench;
pub mod case_candidate;
pub mod clear;
mod coach;
pub mod coerce;
pub mod counters;
pub mod defence;
mod off_ball;
pub mod opponents;
mod order;
pub mod pass;
pub mod possession;
pub(crate) mod proposal;
pub mod rated;
pub mod restart;
pub mod roles;
pub mod stakes;
pub mod support;
mod tactics;
pub mod threat;
pub mod value;
pub mod view;

pub use coach::{Coach, Orders};
pub use opponents::Team;
pub use order::{Order, OrderReason, Role, Task};
pub use proposal::cases_of;
pub use tactics::{ROUND_1, Tactics};
pub use view::{Flip, View};
