//! `board_stm32`: board support for the STM32H743: pins, clocks and drivers only; the logic is `runtime`'s
//! and `brain`'s (docs/architecture.md §1). README.md has the wiring.
//!
//! The robot is the program `onetwo-stm32` (`src/main.rs`), its parts are tried one by one by `examples/`.
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
    if let Some(mut core) = cortex_m::Peripherals::take() {
        // Data is not cached, so that the DMA and the core see the same.
        core.SCB.enable_icache();
    }
    Parts::of(embassy_stm32::init(clocks::config()))
}
