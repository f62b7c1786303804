//! `observation`: input of the referee. The true state of the world at one moment, filled in by the
//! simulator.
//!
//! m, m/s, rad, field frame; times in µs since the simulation's start.

use geometry::{Field, Point, Pose, Vector};
use protocol::{Instant, Who};

/// True state of the ball at the moment of an observation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BallSeen {
    /// Position projected on the ground, m.
    pub position: Point<Field>,
    /// Height of its lowest point above the field surface, m: 0 while it rolls.
    pub height: f32,
    /// Along the ground, m/s.
    pub velocity: Vector<Field>,
    /// Velocity upwards, m/s; negative while it falls.
    pub climb: f32,
}

impl BallSeen {
    /// Resting on the ground.
    pub fn at(position: Point<Field>) -> Self {
        Self { position, height: 0.0, velocity: Vector::default(), climb: 0.0 }
    }

    /// Speed in 3-D, m/s.
    pub fn speed(&self) -> f32 {
        geometry::math::sqrt(self.velocity.dot(self.velocity) + self.climb * self.climb)
    }

    pub(super) fn is_finite(&self) -> bool {
        self.position.is_finite()
            && self.velocity.is_finite()
            && self.height.is_finite()
            && self.climb.is_finite()
    }
}

/// A robot on the field surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RobotSeen {
    /// The robot's team and number.
    pub who: Who,
    /// Position of its centre, m, and heading.
    pub pose: Pose<Field>,
    /// Velocity of its centre, m/s.
    pub velocity: Vector<Field>,
    /// True where the robot touched the ball since the last observation.
    pub touches_ball: bool,
}

/// Two robots collided since the last observation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CrashSeen {
    /// The two robots that collided.
    pub between: [Who; 2],
    /// Their velocities just before, in the same order, m/s.
    pub velocities: [Vector<Field>; 2],
}

/// One moment of the world, every 1 to 20 ms (10 ms is what detectors are tuned and tested with).
#[derive(Clone, Copy, Debug)]
pub struct Observation<'a> {
    /// µs since the simulation's start; must not go back (an earlier one is ignored).
    pub time: Instant,
    /// `None` while there is no ball on the field surface.
    pub ball: Option<BallSeen>,
    /// The ball's maximum 3-D speed since the last observation, m/s, where a kick's speed is known more
    /// exactly than from the ball's present speed; else 0.
    pub fastest: f32,
    /// Robots on the field surface, in any order; a robot with a number that is not finite is ignored.
    pub robots: &'a [RobotSeen],
    /// Collisions of robots since the last observation.
    pub crashes: &'a [CrashSeen],
}
