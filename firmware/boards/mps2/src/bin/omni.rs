//! `omni`: firmware of the wheeled robot under QEMU. As the walking robot's (`src/main.rs`), with the other
//! body's brain and cases. Built with the feature `omni` alone.
#![allow(unsafe_code, reason = "registers, interrupts and flash are reached by address")]
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
#[path = "../lockstep/mod.rs"]
mod lockstep;

#[cfg(not(target_os = "none"))]
fn main() {}
