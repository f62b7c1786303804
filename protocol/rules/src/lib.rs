//! What does each league's field and robot look like, where is what, and what may be done now? Dimensions and phases as
//! data, SI, field frame.
//!
//! **Invariants.** No I/O, no clock, no allocation. One truth per fact: physics, brains, referee and pictures read the
//! dimensions here.
#![no_std]

mod field;
mod game;
mod league;

pub use field::FieldSpec;
pub use game::{Colour, Phase, Side};
pub use league::{BallSpec, League, RobotSpec};
