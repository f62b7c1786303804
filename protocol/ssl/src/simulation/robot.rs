//! `robot`: robot commands and feedback of simulators. Units: m/s, rad/s; robot frame: forward, left,
//! counter-clockwise.

use prost::{Message, Oneof};

use super::SimulatorError;
use crate::common::Any;

/// To ports 10301 (blue) and 10302 (yellow): one command a robot.
#[derive(Clone, PartialEq, Message)]
pub struct RobotControl {
    /// Commands, one per robot.
    #[prost(message, repeated, tag = "1")]
    pub robot_commands: Vec<RobotCommand>,
}

/// Command to one robot, valid until the next.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct RobotCommand {
    /// Shell number, 0–15.
    #[prost(uint32, required, tag = "1")]
    pub id: u32,
    /// Motion command.
    #[prost(message, optional, tag = "2")]
    pub move_command: Option<RobotMoveCommand>,
    /// Kick as soon as the ball is there, at this speed in space, m/s; 0 or absent: no kick.
    #[prost(float, optional, tag = "3")]
    pub kick_speed: Option<f32>,
    /// Angle of the kick, **degrees** above the ground: 0 flat, 45 a chip.
    #[prost(float, optional, default = "0", tag = "4")]
    pub kick_angle: Option<f32>,
    /// Speed of the dribbler, rpm.
    #[prost(float, optional, tag = "5")]
    pub dribbler_speed: Option<f32>,
}

/// Motion command, in one of three forms.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct RobotMoveCommand {
    /// The form.
    #[prost(oneof = "MoveCommand", tags = "1, 2, 3")]
    pub command: Option<MoveCommand>,
}

/// Motion command of a robot.
#[derive(Clone, Copy, PartialEq, Oneof)]
pub enum MoveCommand {
    /// Speed of each wheel.
    #[prost(message, tag = "1")]
    WheelVelocity(MoveWheelVelocity),
    /// Velocity in the robot's frame.
    #[prost(message, tag = "2")]
    LocalVelocity(MoveLocalVelocity),
    /// Velocity in the field frame.
    #[prost(message, tag = "3")]
    GlobalVelocity(MoveGlobalVelocity),
}

/// Speed of each wheel at its rim.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct MoveWheelVelocity {
    /// Front right wheel, m/s.
    #[prost(float, required, tag = "1")]
    pub front_right: f32,
    /// Back right wheel, m/s.
    #[prost(float, required, tag = "2")]
    pub back_right: f32,
    /// Back left wheel, m/s.
    #[prost(float, required, tag = "3")]
    pub back_left: f32,
    /// Front left wheel, m/s.
    #[prost(float, required, tag = "4")]
    pub front_left: f32,
}

/// Velocity in the robot's frame.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct MoveLocalVelocity {
    /// Velocity forward, m/s.
    #[prost(float, required, tag = "1")]
    pub forward: f32,
    /// Velocity to the left, m/s.
    #[prost(float, required, tag = "2")]
    pub left: f32,
    /// Turning rate, counter-clockwise, rad/s.
    #[prost(float, required, tag = "3")]
    pub angular: f32,
}

/// Velocity in the field frame.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct MoveGlobalVelocity {
    /// Along the field's length, m/s.
    #[prost(float, required, tag = "1")]
    pub x: f32,
    /// Velocity to the left of +x, m/s.
    #[prost(float, required, tag = "2")]
    pub y: f32,
    /// Turning rate, counter-clockwise, rad/s.
    #[prost(float, required, tag = "3")]
    pub angular: f32,
}

/// Answer from ports 10301 and 10302.
#[derive(Clone, PartialEq, Message)]
pub struct RobotControlResponse {
    /// Failed commands.
    #[prost(message, repeated, tag = "1")]
    pub errors: Vec<SimulatorError>,
    /// Feedback of robots: every one on the field, or those that were commanded, or also those taken away
    /// (README, trap 9).
    #[prost(message, repeated, tag = "2")]
    pub feedback: Vec<RobotFeedback>,
}

/// Feedback of one robot.
#[derive(Clone, PartialEq, Message)]
pub struct RobotFeedback {
    /// Shell number, 0–15.
    #[prost(uint32, required, tag = "1")]
    pub id: u32,
    /// Whether the ball is at the dribbler.
    #[prost(bool, optional, tag = "2")]
    pub dribbler_ball_contact: Option<bool>,
    /// Extension of this simulator.
    #[prost(message, optional, tag = "3")]
    pub custom: Option<Any>,
}
