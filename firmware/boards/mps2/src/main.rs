//! `board-mps2`: firmware of the walking robot under QEMU, for the board MPS2 with AN386, a Cortex-M4F, in
//! lockstep with the simulator (docs/architecture.md §7.2); all of it is in [`lockstep`]. Built with the
//! feature `legged` alone.
#![allow(unsafe_code, reason = "registers, interrupts and flash are reached by address")]
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
mod lockstep;

#[cfg(not(target_os = "none"))]
fn main() {}
