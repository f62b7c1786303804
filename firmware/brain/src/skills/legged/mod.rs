//! `legged`: skills of the walking robot. Pure functions of belief.

mod case_shot;
mod get_ball;
mod kick;
mod receive;
mod shot;

pub use case_shot::{case_shot, pressed_shot};
pub use get_ball::{get_ball, interception_point};
pub use kick::{aim, carry_to, pass, shoot};
pub use receive::receive;
pub use shot::{attempt, push_on};
