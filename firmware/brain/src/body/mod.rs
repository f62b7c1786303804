//! What can a brain want of its body, whatever the body is? Intents; a module per body turns them into actuators.

pub mod legged;

use geometry::{Angle, Field, Point};
use protocol::robot_io::LeggedKick;

/// What the robot wants of its body for the coming step. Points and angles of the field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Intent {
    /// Stay, turning to this heading if one is given.
    Stand {
        /// Where to look.
        face: Option<Angle>,
    },
    /// Walk to a place, around robots, and end facing `face`.
    Walk {
        /// Where to.
        to: Point<Field>,
        /// Heading at the end.
        face: Angle,
        /// Walk around the ball too.
        shy_of_ball: bool,
    },
    /// Walk with the ball held.
    Carry {
        /// Where to.
        to: Point<Field>,
    },
    /// Turn on the spot, with the ball or without.
    Turn {
        /// To this heading.
        heading: Angle,
    },
    /// Take the ball.
    Grab,
    /// Kick the ball held.
    Kick(LeggedKick),
}
