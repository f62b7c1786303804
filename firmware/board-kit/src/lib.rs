//! `board_kit`: what real robots' boards share, whatever their chip. A board brings pins, clocks, buses and
//! timers as [`embedded_hal`]'s traits; here they become what `runtime`'s tasks ask for.
//!
//! | part | module |
//! |---|---|
//! | the list of what is on a board, its start and its tasks | `robot` (robots only) |
//! | motors, three schemes behind one trait | [`motors`] |
//! | counters of encoders; motors with their encoders | [`encoders`], [`wheels`] |
//! | gyroscope and accelerometer | [`imu`] |
//! | readings taken a thousand times a second | [`sampling`] |
//! | radio on a serial line; radio chip on a bus | `radio`, `nrf24` (robots only) |
//! | base station with such a chip | `base_station` (robots only) |
//! | record of panics, counter of starts | [`crash`], [`ledger`] |
//! | the checks of a robot's first start, on a board | `bring_up` (robots only) |
//! | parts that are not wired yet | [`not_wired`] |
//!
//! How to make a board: docs/boards.md. **Invariants.** Nothing here allocates or panics,
//! and what is not known (no reading, no answer) leaves motors and coils without current.
#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

#[cfg(target_os = "none")]
pub mod base_station;
#[cfg(target_os = "none")]
pub mod bring_up;
pub mod crash;
pub mod encoders;
pub mod imu;
pub mod ledger;
pub mod motors;
pub mod not_wired;
#[cfg(target_os = "none")]
pub mod nrf24;
#[cfg(target_os = "none")]
pub mod radio;
#[cfg(target_os = "none")]
pub mod robot;
pub mod sampling;
pub mod wheels;

// What the macro `robot_tasks` names.
#[cfg(target_os = "none")]
pub use {embassy_executor, runtime};
