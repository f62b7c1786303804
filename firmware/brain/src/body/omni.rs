//! `omni`: numbers of the wheeled robot, and a target for it to drive to. SI.
//!
//! [`Drivetrain`](crate::actuation::Drivetrain) turns it into a body's motion.

use geometry::{Angle, Field, Point};
use motion::trajectory::FreeLimits;
use protocol::Duration;
use protocol::robot_io::OmniKick;
use rules::{RobotSpec, contact};

use super::{BodySpec, Intent};

/// From the robot's centre to its flat front, m.
pub const FRONT: f32 = RobotSpec::OURS.hull.front;
/// From the robot's centre to a ball at its front, m.
pub const BALL_AT: f32 = RobotSpec::OURS.hull.ball_at();

/// A target to drive to, and what dribbler and kicker do meanwhile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drive {
    /// Target position, at which the robot stops.
    pub to: Point<Field>,
    /// Heading to turn to.
    pub face: Angle,
    /// Speed limit, m/s, of the robot's centre.
    pub speed: f32,
    /// How the ball is treated on the path.
    pub mode: DriveMode,
    /// Share of the dribbler's full speed, 0–1.
    pub dribbler: f32,
    /// Kick to fire as soon as the ball touches the kicker, once it is armed.
    pub kick: OmniKick,
    /// Whether it is armed: the robot faces the direction of the kick.
    pub armed: bool,
    /// Share of the acceleration that is planned with, with or without the ball; more than 1 for a step to
    /// the ball.
    pub acceleration_share: f32,
    /// Instructions that choosing the target took, by the search's estimate: its path has so much less.
    pub effort: u32,
}

/// How a robot treats the ball on its path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DriveMode {
    /// An obstacle to go around.
    Avoiding,
    /// It is no obstacle: it may be touched.
    Bold,
    /// It is held and must stay held: gentle accelerations.
    Holding,
}

impl Drive {
    /// Drives to a place, around the ball, at full speed.
    pub fn avoiding(to: Point<Field>, face: Angle) -> Self {
        Self {
            to,
            face,
            speed: f32::INFINITY,
            mode: DriveMode::Avoiding,
            dribbler: 0.0,
            kick: OmniKick::None,
            armed: true,
            acceleration_share: 1.0,
            effort: 0,
        }
    }

    /// Drives to a place; the ball may be touched.
    pub fn bold(to: Point<Field>, face: Angle) -> Self {
        Self { mode: DriveMode::Bold, ..Self::avoiding(to, face) }
    }

    /// Drives to a place with the ball.
    pub fn holding(to: Point<Field>, face: Angle) -> Self {
        Self { mode: DriveMode::Holding, dribbler: 1.0, ..Self::avoiding(to, face) }
    }

    /// Deceleration of a robot that touches something otherwise, m/s²: what wheels hold, without the ball.
    pub(crate) fn hardest_braking(&self) -> f32 {
        match self.mode {
            DriveMode::Holding => RobotSpec::OURS.plan_holding.braking,
            DriveMode::Avoiding | DriveMode::Bold => RobotSpec::OURS.governor.brake,
        }
    }
}

impl From<Drive> for Intent {
    fn from(drive: Drive) -> Self {
        Self::Drive(drive)
    }
}

/// The fastest kick wanted, m/s; the governor has the last word.
pub const SHOT: f32 = RobotSpec::OURS.kicker.fastest;
/// Planning limits without the ball.
pub const LIMITS: FreeLimits = FreeLimits::of(&RobotSpec::OURS.plan);
/// What planning takes of robots on omnidirectional wheels.
pub(crate) const SPEC: BodySpec = BodySpec {
    // Two metres from standstill to standstill take 1.5 s with 3.5 m/s².
    speed: 1.3,
    carry_speed: 0.7,
    // A quarter turn at 3 rad/s, including acceleration.
    turn: 0.8,
    grab: 0.7,
    kick: 0.2,
    longest_fetch: 2.5,
    arrived_within: 0.05,
    next_to_ball: 0.25,
    receiver_haste: 0.7,
    receiver_near: 0.15,
    shot_patience: Duration::millis(1000),
    opponent_holds_within: contact::HELD_WITHIN,
    disputed_within: 0.15,
    doubt_steps: 20,
    meets_rolling_balls: true,
};
