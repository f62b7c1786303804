//! `free`: the free-running firmware for the emulated board without a simulator: radio over the serial line,
//! simulated motors, watchdog and panic as on a robot; what it shares with `udp` is in [`standalone`].
//!
//! `onetwo firmware run` starts it. Built with the feature `omni` alone.
#![allow(unsafe_code, reason = "registers, interrupts and flash are reached by address")]
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
#[path = "../serial/mod.rs"]
mod parts;
#[cfg(target_os = "none")]
#[path = "../standalone/mod.rs"]
mod standalone;

#[cfg(not(target_os = "none"))]
fn main() {}
