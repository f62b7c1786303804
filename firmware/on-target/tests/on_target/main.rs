//! `on_target`: tests of the robot's logic on its own processor.
//!
//! `cargo xtask on-target` builds this as a program of its own and gives every test an emulator of its own;
//! the same program runs on hardware with `probe-rs run`. It does not repeat the PC's tests, but covers a
//! little of each part: retrieval, a robot's cycle, frames, timers, what the governor does when something
//! breaks. On the PC this is empty.
#![allow(unsafe_code, reason = "the board's clock reaches registers by address")]
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
#[path = "../../../boards/mps2/src/standalone/clock.rs"]
mod clock;
#[cfg(target_os = "none")]
mod cycle;
#[cfg(target_os = "none")]
mod failsafe;
#[cfg(target_os = "none")]
mod frames;
#[cfg(target_os = "none")]
mod retrieval;
#[cfg(target_os = "none")]
mod timers;

// A panic prints its place and ends the emulator with exit code 1.
#[cfg(target_os = "none")]
use panic_semihosting as _;
// Links its functions of the run-time ABI.
#[cfg(target_os = "none")]
use runtime as _;

#[cfg(not(target_os = "none"))]
fn main() {}
