//! `free`: the free-running firmware image. The image for the emulated board without a simulator: radio over
//! the serial line, motors that are modelled, watchdog and panic as on a robot; all of it is in [`free`].
//!
//! `onetwo firmware run` starts it. Built with the feature `omni` alone.
#![allow(unsafe_code, reason = "registers, interrupts and flash are reached by address")]
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
#[path = "../free/mod.rs"]
mod free;

#[cfg(not(target_os = "none"))]
fn main() {}
