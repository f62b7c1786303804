//! `robot_io`: interface between body and brain (docs/architecture.md §3.2). SI units, field frame where not
//! said otherwise.
//!
//! Noise enters the system here and nowhere else: the simulator (or a real camera) fills a [`SensorFrame`], and that
//! is all a robot knows of the world besides its teammates' beacons.

use geometry::{Body, Field, Point, Pose, Twist};
use serde::{Deserialize, Serialize};

use crate::Duration;

/// A wheeled brain steps this often, and gets a sensor frame (docs/architecture.md §2.3).
pub const WHEELED_STEP: Duration = Duration::millis(10);
/// Opponents a robot can see at once: a whole team of the largest league.
pub const OPPONENTS_MAX: usize = 11;

/// What a robot perceives at one moment.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SensorFrame {
    /// Where it sees itself; a robot on wheels has no camera and knows that from its host alone.
    pub pose: Option<Pose<Field>>,
    /// The ball, if it is seen.
    pub ball: Option<BallSight>,
    /// Opponents seen, in no meaningful order.
    pub opponents: heapless::Vec<Point<Field>, OPPONENTS_MAX>,
    /// The ball is in the robot's grip: between the legs, or on the dribbler.
    pub ball_contact: bool,
    /// A grab or kick is under way; the body takes no other until it ends.
    pub busy: bool,
    /// How it moves by its own measure (joints, or wheels and gyroscope), in its own frame.
    pub odometry: Twist<Body>,
    /// How the body is.
    pub health: Health,
}

/// How a body is.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
pub struct Health {
    /// Battery, V; `None` where it is not measured.
    pub battery: Option<f32>,
    /// It lies on its side.
    pub tipped: bool,
    /// The kicker is charged; never for a walking robot.
    pub kicker_ready: bool,
}

/// The ball as perceived.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct BallSight {
    /// Where it seems to be.
    pub position: Point<Field>,
    /// Standard deviation of that, m.
    pub sigma: f32,
    /// How old the picture is.
    pub age: Duration,
}

/// What the brain wants of its body for the coming step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum ActuatorFrame {
    /// A walking robot.
    Legged {
        /// Wanted velocity in the body frame, m/s and rad/s; the body does what it can.
        walk: Twist<Body>,
        /// A primitive to begin, unless one is under way.
        primitive: LeggedPrimitive,
    },
    /// A robot on omnidirectional wheels.
    Omni {
        /// Rim speed of each wheel, m/s.
        wheels: [f32; 4],
        /// Share of the dribbler's full speed, 0–1.
        dribbler: f32,
        /// What the kicker shall do.
        kick: OmniKick,
    },
    /// A robot on wheels that stands and that nobody commands: no current in the motors, dribbler off, kicker discharged
    /// (docs/architecture.md §6.1).
    Released,
}

/// A short motion of the whole body of a walking robot.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum LeggedPrimitive {
    /// Just walk.
    None,
    /// Take the ball between the front legs.
    Grab,
    /// Kick the ball held.
    Kick(LeggedKick),
}

/// The kicks a walking robot has; directions relative to where it faces.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum LeggedKick {
    /// Short, straight ahead.
    ForwardSoft,
    /// Long, straight ahead.
    ForwardHard,
    /// With the head, to the left.
    Left,
    /// With the head, to the right.
    Right,
    /// Straight ahead, meant to roll this far, m.
    Pass(f32),
}

/// What a kicker shall do.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum OmniKick {
    /// Nothing.
    None,
    /// Along the ground, ball speed in m/s.
    Flat(f32),
    /// Through the air, ball speed in m/s.
    Chip(f32),
    /// Let the charge go without touching a ball: what a robot that nobody commands does.
    Discharge,
}
