//! `virtual_robot`: a virtual robot for other simulators. As a process of its own, which takes radio frames
//! from whoever commands and speaks the league's simulation protocol with any simulator. Runs on the PC.
//!
//! [`VirtualRobot`] is the whole robot without sockets: the very [`brain::Station`] of a board, in a [`SimulatedBody`] that the
//! simulation protocol moves. [`run`] gives it a socket and a clock. `onetwo control --robots sim://HOST` starts one for
//! each robot.
//!
//! **Invariants.** Times come from the caller everywhere but in [`run`]. Whatever comes from outside is counted and survived.
#![forbid(unsafe_code)]

mod body;
mod robot;
mod run;

pub use body::{SimulatedBody, TICK};
pub use robot::VirtualRobot;
pub use run::{End, Options, RunError, parent_gone, run};
