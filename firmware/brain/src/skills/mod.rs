//! `skills`: skills of the case language. A directory per body; belief in, intent and verdict out.
//!
//! A walking robot's skills keep no state; what must be kept between steps (a kick was commanded, the ball
//! was held) is the [execution's](crate::execution) or the reactive behaviour's.

pub mod legged;
pub mod wheels;

use crate::body::Intent;

/// How a skill stands after a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Step {
    /// Go on, wanting this.
    Running(Intent),
    /// It is done.
    Done,
}

/// How a reception stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reception {
    /// Moving to the ball, or to its stop position.
    Going(Step),
    /// The ball has passed by, or stopped too far away.
    Missed,
}
