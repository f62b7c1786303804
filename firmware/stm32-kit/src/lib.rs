//! `stm32_kit`: drivers that boards with a chip of the STM32 families share. The board names the chip, by a
//! feature of embassy-stm32, so each board is built in an invocation of its own. Empty on the PC.
//!
//! | part | module |
//! |---|---|
//! | table of pins | `parts!` |
//! | drivers, flash, faults, emergency stop, programs of a board | `drivers!`, `flash!`, `fault_handlers!`, `emergency_stop!`, `robot_main!`, `bring_up_main!` |
//! | wheels' and dribbler's PWM | `pwm` |
//! | encoders | `encoders` |
//! | pulses that end by themselves, kicker | `pulse`, `kicker` |
//! | measured voltages | `analog` |
//! | radio's line, IMU's bus | `lines` |
//! | record of panics | `words` |
//! | watchdog | `watchdog` |
#![cfg(target_os = "none")]
#![no_std]
#![forbid(unsafe_code)]

pub mod analog;
mod board;
pub mod encoders;
pub mod kicker;
pub mod lines;
mod parts;
pub mod pulse;
pub mod pwm;
pub mod watchdog;
pub mod words;

#[doc(hidden)]
pub use embassy_stm32;
