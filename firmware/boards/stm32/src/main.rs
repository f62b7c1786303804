//! `board-stm32`: start-up of the robot. Clocks, record of the last life, provisioned page, ledger, tasks,
//! and what it says of all that.
//!
//! Without a page, an epoch or a radio it drives nothing and says nothing on the air; its red lamp is lit.
#![allow(unsafe_code, reason = "registers, interrupts and flash are reached by address")]
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
mod robot;

#[cfg(not(target_os = "none"))]
fn main() {}
