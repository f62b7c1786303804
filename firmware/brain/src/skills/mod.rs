//! Which skills does the case language need, and how does each go? Pure functions of belief: intent and verdict out.
//!
//! A skill remembers nothing; what must be remembered between steps (a kick was commanded, the ball was held) is the
//! [execution's](crate::execution) or the reactive behaviour's.

mod get_ball;
mod kick;
mod receive;
mod shot;

pub use get_ball::{get_ball, meeting};
pub use kick::{aim, carry_to, pass, shoot};
pub use receive::{Reception, receive};
pub use shot::{attempt, push_on};

use crate::body::Intent;

/// How a skill stands after a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Step {
    /// Go on, wanting this.
    Running(Intent),
    /// It is done.
    Done,
}
