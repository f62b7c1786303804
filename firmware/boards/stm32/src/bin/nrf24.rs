//! `nrf24`: the robot of `src/main.rs` with a radio chip nRF24L01+ instead of a modem on a serial line. Its
//! base station is the program of `src/bin/base.rs`.
#![allow(unsafe_code, reason = "registers, interrupts and flash are reached by address")]
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
#[path = "../robot/nrf24.rs"]
mod radio;
#[cfg(target_os = "none")]
#[path = "../robot/mod.rs"]
mod robot;

#[cfg(not(target_os = "none"))]
fn main() {}
