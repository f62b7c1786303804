//! `virtual_robot`: a virtual robot for other simulators. It runs as a process of its own on the PC, takes
//! radio frames from a host and speaks the league's simulation protocol with any simulator.
//!
//! [`VirtualRobot`] is the whole robot without sockets: the same [`brain::Station`] as on a board, in a
//! [`SimulatedBody`] that the simulation protocol moves. [`run`] gives it a socket and a clock. `onetwo
//! control --robots sim://HOST` starts one for each robot.
//!
//! Robots whose brains are firmware images have here what is around them: [`AccessPoint`] carries their
//! frames over UDP, [`Bodies`] moves their bodies in a simulator, and [`replay`] gives a native brain what an
//! image was given, and compares.
//!
//! **Invariants.** Times come from the caller everywhere but in [`run`], [`AccessPoint`] and [`Bodies`].
//! Invalid input from outside is counted and dropped.
#![forbid(unsafe_code)]

mod access_point;
mod bodies;
mod body;
mod replayed;
mod robot;
mod run;

pub use access_point::{AccessPoint, PassedCounts};
pub use bodies::Bodies;
pub use body::{SimulatedBody, TICK};
pub use replayed::{ReplayError, Replayed, replay};
pub use robot::VirtualRobot;
pub use run::{Options, ProcessEnd, RunError, parent_gone, run};
