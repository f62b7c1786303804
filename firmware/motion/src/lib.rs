//! How do ball and bodies move, as a robot or a host believes it? Models for decisions, not the simulator's physics.
//!
//! **Invariants.** No I/O, no clock, no allocation. The simulator's physics are written apart from these models, so that
//! a wrong model shows as missed passes instead of hiding.
#![no_std]

pub mod legged;
pub mod rolling;
