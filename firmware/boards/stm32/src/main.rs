//! `board-stm32`: start-up of the robot: clocks, record of the last boot epoch, provisioned page, counter of
//! starts, tasks, and their log.
//!
//! Without a page, an epoch or a radio it drives nothing and sends nothing; its red lamp is lit.
#![allow(unsafe_code, reason = "registers, interrupts and flash are reached by address")]
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
#[path = "robot/serial.rs"]
mod radio;
#[cfg(target_os = "none")]
mod robot;

#[cfg(not(target_os = "none"))]
fn main() {}
