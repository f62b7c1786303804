//! `robot_io`: interface between body and brain (docs/architecture.md §3.2). SI units, field frame where not
//! stated otherwise.
//!
//! Noise enters the system only here: the simulator (or a real camera) fills a [`SensorFrame`], and that is
//! all a robot knows of the world besides its teammates' beacons.

use geometry::{Angle, Body, Field, Point, Pose, Twist, math};
use serde::{Deserialize, Serialize};

use crate::Duration;
use crate::quantized::{from_mm, length_to_mm, saturate};

/// A wheeled brain steps this often, and gets a sensor frame (docs/architecture.md §2.3).
pub const WHEELED_STEP: Duration = Duration::millis(10);
/// Opponents a robot can see at once: a whole team of the largest league.
pub const OPPONENTS_MAX: usize = 11;

/// Opponents in a sensor frame: a team of walking robots. Robots on wheels know opponents from their host.
pub const OPPONENTS_SEEN_MAX: usize = 4;
/// Landmarks in one camera frame.
pub const LANDMARKS_SEEN_MAX: usize = 4;

/// Measurements of a robot at one moment; by default of one that stands, sees nothing and holds no ball.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SensorFrame {
    /// Own pose, where something measures it as a whole: a simulator without noise, or the placing by hand at
    /// kick-off. A robot on wheels has no camera and knows its pose from its host alone.
    pub pose: Option<Pose<Field>>,
    /// The ball in the field frame, if it is detected so: in a simulator without noise.
    pub ball: Option<BallSight>,
    /// Opponents' positions as they report them (paper §5.3), always in the same order.
    pub opponents: heapless::Vec<Point<Field>, OPPONENTS_SEEN_MAX>,
    /// The robot holds the ball: between the legs, or on the dribbler.
    pub ball_contact: bool,
    /// A grab or kick is running; the body takes no other until it ends.
    pub busy: bool,
    /// Motion by its own measurement (joints, or wheels and gyroscope), in the body frame.
    pub odometry: Twist<Body>,
    /// State of the body.
    pub health: Health,
    /// Frame of the robot's own camera, relative to the body.
    pub camera: Option<CameraFrame>,
}

/// Objects that a walking robot's camera sees in one frame, relative to the body.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CameraFrame {
    /// Landmarks of the field (`rules::LANDMARKS`).
    pub landmarks: heapless::Vec<LandmarkSight, LANDMARKS_SEEN_MAX>,
    /// The ball, if it is seen.
    pub ball: Option<Sight>,
}

/// Landmark that the camera has detected.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct LandmarkSight {
    /// Index in `rules::LANDMARKS`: their colours are all different.
    pub landmark: u8,
    /// Position of the landmark.
    pub sight: Sight,
}

/// A detection relative to the robot's centre and heading.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sight {
    /// Distance along the ground, mm.
    range: u16,
    /// Angle to the left of the heading, 0.1 mrad.
    bearing: i16,
}

impl Sight {
    /// A detection at `range` m, `bearing` to the left of the heading.
    pub fn new(range: f32, bearing: Angle) -> Self {
        let bearing = saturate(math::round_to_i32(bearing.radians() * 10_000.0));
        Self { range: length_to_mm(range), bearing }
    }

    /// Distance along the ground, m.
    pub fn range(self) -> f32 {
        from_mm(i32::from(self.range))
    }

    /// Direction, to the left of the heading.
    pub fn bearing(self) -> Angle {
        Angle::new(f32::from(self.bearing) * 0.000_1)
    }
}

/// State of a body.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
pub struct Health {
    /// Battery voltage, V; `None` where it is not measured.
    pub battery: Option<f32>,
    /// The robot lies on its side.
    pub tipped: bool,
    /// The kicker is charged; never for a walking robot.
    pub kicker_ready: bool,
}

/// A detection of the ball.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct BallSight {
    /// Measured position, m, field frame.
    pub position: Point<Field>,
    /// Standard deviation of the position, m.
    pub sigma: f32,
    /// Age of the sensor frame.
    pub age: Duration,
}

/// Orders of the brain to its body for the coming step.
// In memory 0 and 1 stay free for a mailbox without an order: a static with mailboxes is then all zeros, and
// has no 2 kB of initial values in flash.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[repr(u8)]
pub enum ActuatorFrame {
    /// Orders to a walking robot.
    Legged {
        /// Wanted velocity in the body frame, m/s and rad/s; the body follows within its limits.
        walk: Twist<Body>,
        /// A primitive to start, unless one is running.
        primitive: LeggedPrimitive,
    } = 2,
    /// A robot on omnidirectional wheels.
    Omni {
        /// Rim speed of each wheel, m/s.
        wheels: [f32; 4],
        /// Share of the dribbler's full speed, 0–1.
        dribbler: f32,
        /// Kick order to the kicker.
        kick: OmniKick,
    },
    /// A robot on wheels that stands without a command: no current in the motors, dribbler off, kicker
    /// discharged (docs/architecture.md §6.1).
    Released,
}

/// A short motion of the whole body of a walking robot.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum LeggedPrimitive {
    /// No primitive: walking only.
    None,
    /// Take the ball between the front legs.
    Grab,
    /// Kick the ball held.
    Kick(LeggedKick),
}

/// Kicks of a walking robot; directions relative to its heading.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum LeggedKick {
    /// Short kick straight ahead.
    ForwardSoft,
    /// Long kick straight ahead.
    ForwardHard,
    /// Head kick to the left.
    Left,
    /// Head kick to the right.
    Right,
    /// Pass straight ahead, nominally this far, m.
    Pass(f32),
}

/// Order to the kicker.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum OmniKick {
    /// No kick: neither coil fires.
    None,
    /// Along the ground, ball speed in m/s.
    Flat(f32),
    /// Through the air, ball speed in m/s.
    Chip(f32),
    /// Discharge without touching a ball: the order of a robot without a command.
    Discharge,
}
