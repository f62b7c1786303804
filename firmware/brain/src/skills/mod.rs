//! `skills`: skills of the case language. A directory per body; belief in, intent and verdict out.
//!
//! A walking robot's skills keep no state; what must be kept between steps (a kick was commanded, the ball
//! was held) is the [execution's](crate::execution) or the reactive behaviour's.

pub mod legged;
pub mod wheels;

use crate::body::Intent;

/// Result of a step of a skill.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Step {
    /// The skill continues with this intent.
    Running(Intent),
    /// The skill is done.
    Done,
}

/// Result of a step of a reception.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reception {
    /// Moving to the ball, or to its stop position.
    Going(Step),
    /// The ball has passed by, or stopped too far away.
    Missed,
}
