//! What does each league's field and robot look like, and where is what? Dimensions as data, SI, field frame.
//!
//! **Invariants.** No I/O, no clock, no allocation. One truth per fact: physics, brains, referee and pictures read the
//! dimensions here.
#![no_std]

mod field;
mod league;

pub use field::FieldSpec;
pub use league::{BallSpec, League, RobotSpec};
