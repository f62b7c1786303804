//! `nrf24`: radio frames of `protocol` over radio chips nRF24L01+: fragments, a robot's radio, a base
//! station. Times are the caller's, µs; no allocation.
//!
//! [`fragment`] cuts frames into payloads of at most 32 bytes and joins them; [`Robot`] is a robot's end,
//! [`Base`] the base station's, [`Station`] the base station with the line to its host, [`airtime`] what it
//! all costs of the air. Registers are `rf24-rs`'s; README.md says why, and what was measured.
//!
//! **Who sends when.** The base station alone starts packets. Robots answer in the acknowledgements that the
//! chip sends by itself (Enhanced ShockBurst), so no two radios of a team ever send at once, and no chip
//! changes between sending and receiving.
#![cfg_attr(doctest, doc = include_str!("../README.md"))]
#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

pub mod airtime;
mod base;
mod chip;
pub mod fragment;
mod robot;
mod scan;
mod settings;
mod station;

pub use base::{Base, BaseCounts};
pub use chip::{Channel, Fault, Rate};
pub use robot::{Robot, RobotCounts, SERVE_EVERY};
pub use station::Station;
