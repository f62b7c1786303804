//! `board_f407`: board support for the STM32F407: pins, clocks and drivers only; the logic is `runtime`'s
//! and `brain`'s (docs/architecture.md §1). README.md has the wiring.
//!
//! The robot is the program `onetwo-f407` (`src/main.rs`).
//! Empty on the PC.
//!
//! | part | module |
//! |---|---|
//! | assignment of pins | [`pins`] |
//! | clocks | [`clocks`] |
//! | parts as drivers | [`drivers`] |
//! | key page and counter of starts | [`flash`] |
//! | panics, everything off | [`fault`], [`off`](fn@off::everything) |
#![allow(unsafe_code, reason = "registers, interrupts and flash are reached by address")]
#![cfg(target_os = "none")]
#![no_std]

pub mod clocks;
pub mod drivers;
pub mod fault;
pub mod flash;
pub mod off;
pub mod pins;

// Transport of the log to the probe.
use defmt_rtt as _;

use pins::Parts;

/// Starts clocks and pins; everything that moves is off. Call once, first of all.
pub fn start() -> Parts {
    Parts::of(embassy_stm32::init(clocks::config()))
}
