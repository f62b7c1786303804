//! `event`: events of the physics. m, m/s, field frame.

use geometry::{Field, Point, Vector};

use protocol::Who;
use serde::{Deserialize, Serialize};

/// Events of a step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum PhysicsEvent {
    /// Contact of ball and robot, after at least [`super::TOUCH_GAP_STEPS`] apart.
    Touched {
        /// The robot that the ball touched.
        robot: Who,
        /// The ball's position, m.
        at: Point<Field>,
    },
    /// A kicker moved the ball.
    Kicked {
        /// The robot whose kicker fired.
        robot: Who,
        /// The ball's position, m.
        at: Point<Field>,
        /// The ball's velocity along the field surface after it, m/s.
        velocity: Vector<Field>,
        /// The ball's speed in 3-D after it, m/s.
        speed: f32,
        /// True where the ball left the field surface.
        chip: bool,
    },
    /// Contact of two robots.
    Crash {
        /// Both robots, in ascending order.
        robots: [Who; 2],
        /// Point between them, m.
        at: Point<Field>,
        /// Their velocities before it, in the order of `robots`, m/s.
        velocities: [Vector<Field>; 2],
        /// Difference of the velocities, projected on the line between their centres, m/s: what the rules
        /// call crash speed.
        closing: f32,
    },
    /// The ball hit a goal's post, bar, wall or net.
    GoalHit {
        /// The ball's position, m.
        at: Point<Field>,
        /// The ball's speed, m/s.
        speed: f32,
    },
    /// The ball hit a board round the field surface, at this position, m.
    BoardHit(Point<Field>),
    /// A flying ball landed, at this position, m.
    Landed(Point<Field>),
}
