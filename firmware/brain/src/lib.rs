//! What does a robot do next? The robot's logic as a value (DESIGN §3–§5; Ros et al. 2009 §4–§5). Runs on the MCU, in the
//! simulator and in tests, unchanged.
//!
//! Four kinds of methods, as on [`Brain`]: getters; `handle_*(now, …)` for what happens; `poll_*` for what it wants, to be
//! drained after every `handle_*`; no commands besides. Bottom up: [`timer`] (every deadline), [`belief`] and [`mates`]
//! (what it holds true), [`body`] and [`skills`] (what it can do), [`reactive`] (what it does by itself), [`execution`]
//! (its part of a case), [`team`] (the cycle), [`Brain`] (the order of thought), [`Station`] (brain with radio).
//!
//! Not here yet: `handle_host_frame` and its directives, the skills and the body of wheeled robots, and the safety governor;
//! they come with the host of the Small Size League.
//!
//! **Invariants.** No I/O, no clock, no allocation, no randomness; nothing from outside can panic; it knows the world only
//! by [`SensorFrame`](protocol::robot_io::SensorFrame) and its teammates' beacons; it takes a
//! [`CaseBase`](casebase::CaseBase) and never links a library.
#![no_std]

pub mod belief;
pub mod body;
mod brain;
mod config;
mod estimate;
pub mod execution;
pub mod mates;
pub mod reactive;
pub mod skills;
mod station;
pub mod team;
pub mod timer;

pub use brain::Brain;
pub use config::{Approach, BrainConfig, Positioning};
pub use station::Station;
