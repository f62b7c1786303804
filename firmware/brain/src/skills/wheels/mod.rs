//! `wheels`: skills of the wheeled robot, one file each; belief in, intent and verdict out.
//!
//! They keep no state but that of their types (`Placing`, [`Reception`](crate::skills::Reception)). Their
//! intents pass the governor; the drivetrain keeps them out of forbidden regions. Field frame, SI.

mod block;
mod contest;
mod dribble;
mod get_ball;
mod go_to;
mod kick;
mod place_ball;
mod receive;
mod release;
mod shoot;
#[cfg(test)]
pub(crate) mod testing;
mod wall;

pub use block::block;
pub use dribble::{carry_to, dribble, let_go_in_time, shield};
pub use get_ball::{Approach, approach, barrier, get_ball};
pub use go_to::{go_to, keep_off};
pub use kick::{kick, kick_held, pass, pass_speed};
pub use place_ball::{Placement, place_ball};
pub use receive::{receive, take_pass};
pub use release::release;
pub use shoot::{clear_or_shoot, shoot, target};
