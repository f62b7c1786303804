//! `study`: experiments with simulator and teams, and their results: the papers' tables, matches, scenes,
//! skills, ablations, and the learning of case libraries. Runs on the PC.
//!
//! [`evaluation`] plays paper 1's thousands of trials and computes its tables.
//!
//! [`mod@matches`] plays many matches and reports the results, in the form of the second paper's Table 2.
//!
//! [`scenes`] plays short scenes with several variants of a team and measures what a part of its play is
//! worth.
//!
//! [`drills`] plays our team against scripted opponents, from recorded situations.
//!
//! [`skills`] plays tries of single skills through the whole loop, in worlds of any physics.
//!
//! [`penalty`] counts the penalties that our keeper saves.
//!
//! [`learning`] makes a case library better by play.
//!
//! Each is an [`Experiment`](store::Experiment): a plan, its jobs and their rows. [`store`] plays and keeps
//! them; [`statistics`] has the tests and intervals that all of them use.
#![forbid(unsafe_code)]

pub mod drills;
pub mod evaluation;
pub mod learning;
pub mod matches;
pub mod penalty;
pub mod scenes;
pub mod skills;
pub mod statistics;
pub mod store;
#[cfg(test)]
mod testing;
