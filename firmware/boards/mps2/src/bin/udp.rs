//! `udp`: the free-running firmware with UDP over the board's Ethernet for a radio, and a body in a
//! simulator: orders and sensor frames are datagrams too.
//!
//! `onetwo firmware run --udp` starts it. Built with the features `omni` and `ethernet`.
#![allow(unsafe_code, reason = "registers, interrupts and flash are reached by address")]
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
#[path = "../ethernet/mod.rs"]
mod parts;
#[cfg(target_os = "none")]
#[path = "../standalone/mod.rs"]
mod standalone;

#[cfg(not(target_os = "none"))]
fn main() {}
