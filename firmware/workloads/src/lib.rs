//! `workloads`: what the robot's costs are measured with, the same on a board and on the PC.
//!
//! [`retrieval`] exchanges problems and answers with the board and holds the reference scan, [`motion`] draws
//! tasks from a seed, [`radio`] builds frames. The bench images of the QEMU board and the benches in
//! `tests/benches` use them.
#![forbid(unsafe_code)]
#![no_std]

pub mod motion;
pub mod radio;
pub mod retrieval;
