//! `look`: the ball and the robots at one moment, in truth or as a host sees them. s, m, m/s, field frame.

use geometry::{Field, GoalEnd, Point, Vector};
use protocol::Who;
use rules::limits::BALL_RADIUS;
use rules::{Colour, FieldSpec, Phase};

/// A moment of a match, as [`AttackWatch`](super::AttackWatch) takes it.
#[derive(Clone, Copy, Debug)]
pub struct BallLook<'a> {
    /// The moment.
    pub now: f64,
    /// Dimensions of the field.
    pub field: &'a FieldSpec,
    /// Position of the ball, or the point below it.
    pub ball: Point<Field>,
    /// Height of the ball above the field surface.
    pub height: f32,
    /// Robots on the field.
    pub robots: &'a [(Who, Point<Field>)],
    /// The phase of the game.
    pub phase: Phase<Colour>,
    /// Goals of yellow and blue.
    pub score: [u32; 2],
    /// Ends that yellow and blue defend.
    pub own_ends: [GoalEnd; 2],
    /// Robots that kicked or touched the ball since the moment before.
    pub contacts: &'a [BallContact],
}

/// A robot at the ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BallContact {
    /// A kick.
    Kicked {
        /// The robot.
        by: Who,
        /// Time of the kick, s.
        at: f64,
        /// The ball's position then.
        from: Point<Field>,
        /// The ball's velocity along the field surface after it.
        velocity: Vector<Field>,
    },
    /// The ball has come to a robot.
    Touched {
        /// The robot.
        by: Who,
        /// The ball's position.
        at: Point<Field>,
    },
}

impl BallLook<'_> {
    pub(super) fn is_out(&self) -> bool {
        self.field.clamp(self.ball, -BALL_RADIUS).distance(self.ball) > 0.0
    }
}
