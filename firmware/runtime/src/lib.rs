//! `runtime`: tasks around the brain on a robot's computer. Embassy tasks, generic over the board
//! (docs/architecture.md §3.1).
//!
//! ```text
//! air ──► radio_receive ─┐              ┌─► outbox ─► radio_send ──► air
//!                        ├─► inbox ─► brain
//! senses ─► sensors ─────┘              └─► orders ─► body ────────► wheels, legs, kicker
//! ```
//!
//! All input of the brain passes one inbox, so that it is handled in the order of its arrival. Where no
//! simulator moves the body, the tasks of [`hardware`] do: wheels, kicker, sensors, and a watchdog. A board
//! implements the traits of [`ports`], declares a task for each function of [`tasks`] (embassy's tasks cannot
//! be generic) and starts them with one [`Mailboxes`] between them:
//!
//! ```text
//! static BOXES: Mailboxes = Mailboxes::new();
//! #[embassy_executor::task]
//! async fn brain(config: BrainConfig, base: CaseBase<'static>) { tasks::brain(&config, base, &BOXES).await }
//! ```
//!
//! **Invariants.** Nothing here allocates, and nothing that arrives can panic: what does not fit is dropped
//! and counted.
#![cfg_attr(doctest, doc = include_str!("../README.md"))]
#![no_std]
// The functions of the processor's run-time ABI are assembly.
#![cfg_attr(not(target_arch = "arm"), forbid(unsafe_code))]

#[cfg(test)]
extern crate std;

pub mod bring_up;
mod controller;
#[cfg(all(target_arch = "arm", target_os = "none"))]
mod copy;
pub mod ending;
pub mod hardware;
pub mod kicker;
mod mailboxes;
pub mod parts;
pub mod persistent_counter;
pub mod ports;
pub mod progress;
mod recorded;
mod reporting;
pub mod sense;
pub mod setup;
pub mod tasks;
#[cfg(test)]
mod testing;
#[cfg(test)]
mod tests;
pub mod wheel;

pub use brain::BrainConfig;
pub use mailboxes::{Arrival, INBOX_LEN, Mailboxes, OUTBOX_LEN};
