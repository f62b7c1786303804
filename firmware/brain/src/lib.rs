//! `brain`: the robot's logic as a sans-IO value (docs/architecture.md §3–§5; Ros et al. 2009 §4–§5). Runs on
//! the MCU, in the simulator and in tests, unchanged.
//!
//! Four kinds of methods, as on [`Brain`]: getters; `handle_*(now, …)` for inputs; `poll_*` for outputs, to
//! be drained after every `handle_*`; no commands besides. Bottom up: [`timer`] (every deadline), [`belief`]
//! and [`teammates`] (what it knows), [`body`], [`skills`] and [`abilities`] (what it can do), [`actuation`]
//! (how it moves), [`reactive`] (what it does by itself), [`execution`] (its part of a case), [`team`] (the
//! cycle), [`Brain`] (the order of these within a step), [`Station`] (brain with radio).
//!
//! Where a host leads (wheels): [`snapshot`] and [`hosted`] (what it sends), [`directive`] (the skill that
//! carries it out), [`governor`] (what of it reaches the motors).
//!
//! **Invariants.** No I/O, no clock, no allocation, no randomness; nothing from outside can panic; it
//! perceives the world only by [`SensorFrame`](protocol::robot_io::SensorFrame), its teammates' beacons and
//! its host; it takes a [`CaseBase`](casebase::CaseBase) and never links a library.
#![cfg_attr(doctest, doc = include_str!("../README.md"))]
#![no_std]
#![forbid(unsafe_code)]

pub mod abilities;
mod action_scene;
pub mod actuation;
pub mod belief;
pub mod body;
mod brain;
mod config;
pub mod directive;
mod estimate;
pub mod execution;
pub mod governor;
pub mod hosted;
pub mod reactive;
pub mod skills;
pub mod snapshot;
mod station;
pub mod team;
pub mod teammates;
pub mod timer;

pub use brain::Brain;
pub use config::{Approach, BrainConfig, Positioning};
pub use station::Station;
