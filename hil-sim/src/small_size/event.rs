//! `event`: events of the physics. m, m/s, field frame.

use geometry::{Field, Point, Vector};

use protocol::Who;

/// What happened in a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Event {
    /// Ball and robot came to touch, after at least [`super::TOUCH_GAP_STEPS`] apart.
    Touched {
        /// Who.
        robot: Who,
        /// The ball was here.
        at: Point<Field>,
    },
    /// A kicker moved the ball.
    Kicked {
        /// Whose.
        robot: Who,
        /// From here.
        at: Point<Field>,
        /// The ball's velocity along the carpet after it, m/s.
        velocity: Vector<Field>,
        /// The ball's speed in 3-D after it, m/s.
        speed: f32,
        /// It left the carpet.
        chip: bool,
    },
    /// Two robots came to touch.
    Crash {
        /// Both, sorted.
        robots: [Who; 2],
        /// Between them.
        at: Point<Field>,
        /// Their velocities before it, in that order, m/s.
        velocities: [Vector<Field>; 2],
        /// Difference of the velocities, projected on the line between their centres, m/s: what the rules call crash speed.
        closing: f32,
    },
    /// The ball hit a goal's post, bar, wall or net.
    GoalHit {
        /// Here.
        at: Point<Field>,
        /// So fast, m/s.
        speed: f32,
    },
    /// The ball hit a board round the carpet.
    BoardHit {
        /// Here.
        at: Point<Field>,
    },
    /// A flying ball came down.
    Landed {
        /// Here.
        at: Point<Field>,
    },
}
