//! `bring_up_f407`: all checks of a robot's first start, one after the other: battery, sensors at rest, each
//! wheel both ways, radio, break-beam sensor. It takes a minute at most.
//!
//! **The robot on a stand, wheels off the ground, no fingers near them; the kicker's board unplugged.**
//! Connect: everything else, and let a host run. See: a line for each check on the log, what it measured, or
//! what is wrong and what to look at. At the last check hold a ball before the dribbler, then take it away.
//!
//! A robot that has its page (`onetwo firmware flash --page`) reports the same by radio, until it is switched
//! off: `onetwo robot bring-up --team N --robots serial:DEVICE --key-file team.key` is its host and shows it.
//! With the kicker's board plugged in `onetwo robot bring-up --kick` charges and fires it (docs/boards.md).
#![allow(unsafe_code, reason = "registers, interrupts and flash are reached by address")]
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
stm32_kit::bring_up_main!(board_f407);

#[cfg(not(target_os = "none"))]
fn main() {}
