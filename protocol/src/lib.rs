//! `protocol`: messages between robots, host and simulator (docs/architecture.md §5–§7).
//!
//! Bottom up: [`ids`] and [`time`] name things; [`quantized`] is the one place where SI becomes integers of
//! the wire; [`key`] derives the keys, [`frame`] is the radio's envelope (sender, epoch, counter, tags),
//! [`link`] and [`host_link`] are its two ends ([`peer`]: which teammates are trusted;
//! [`host_clock`]: the age of a frame of the host), [`serial`] puts it on a line; [`team`] has the messages
//! between robots, [`mod@host`] those between host and robots, [`decision`] what a coordinator decided on;
//! [`robot_io`] is what a body gives its brain and takes from it; [`lockstep`] carries the latter between
//! simulator and computer, [`provision`] is a robot's identity in its flash and [`network_page`] its place in
//! an IP network, [`slot`] is where a computer finds a case table that was not built into it, [`journal`]
//! keeps what a brain took in and gave out, [`bring_up`] is what a robot reports of its first start,
//! [`pulses`] how its kicker is measured then, [`robot_log`] its log, [`version`] what it runs. The bytes are
//! written down in `protocol/SPEC.md`, and tests hold the code to them.
//!
//! **Invariants.** No I/O, no clock, no allocation; no input from outside can panic.
#![cfg_attr(doctest, doc = include_str!("../README.md"))]
#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

pub mod bring_up;
pub mod decision;
pub mod frame;
pub mod host;
pub mod host_clock;
pub mod host_link;
pub mod ids;
pub mod journal;
pub mod key;
pub mod link;
pub mod lockstep;
pub mod network_page;
pub mod parts;
pub mod peer;
pub mod provision;
pub mod pulses;
pub mod quantized;
pub mod robot_io;
pub mod robot_log;
pub mod serial;
pub mod slot;
pub mod station;
pub mod team;
pub mod time;
pub mod version;

pub use ids::{CaseId, CycleId, RobotId, TeamId, Who};
pub use time::{Duration, Instant};
