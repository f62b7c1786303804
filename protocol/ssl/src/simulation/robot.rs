//! `robot`: robot commands and feedback of simulators. Units: m/s, rad/s; robot frame: forward, left,
//! counter-clockwise.

use prost::{Message, Oneof};

use super::SimulatorError;
use crate::common::Any;

/// To ports 10301 (blue) and 10302 (yellow): one command a robot.
#[derive(Clone, PartialEq, Message)]
pub struct RobotControl {
    /// Commands.
    #[prost(message, repeated, tag = "1")]
    pub robot_commands: Vec<RobotCommand>,
}

/// What one robot shall do until the next command.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct RobotCommand {
    /// Shell number, 0–15.
    #[prost(uint32, required, tag = "1")]
    pub id: u32,
    /// How to move.
    #[prost(message, optional, tag = "2")]
    pub move_command: Option<RobotMoveCommand>,
    /// Kick as soon as the ball is there, at this speed in space, m/s; 0 or absent: no kick.
    #[prost(float, optional, tag = "3")]
    pub kick_speed: Option<f32>,
    /// How steep the kick is, **degrees** above the ground: 0 flat, 45 a chip.
    #[prost(float, optional, default = "0", tag = "4")]
    pub kick_angle: Option<f32>,
    /// How fast the dribbler turns, rpm.
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

/// How a robot shall move.
#[derive(Clone, Copy, PartialEq, Oneof)]
pub enum MoveCommand {
    /// Each wheel by itself.
    #[prost(message, tag = "1")]
    WheelVelocity(MoveWheelVelocity),
    /// In the robot's frame.
    #[prost(message, tag = "2")]
    LocalVelocity(MoveLocalVelocity),
    /// In the field frame.
    #[prost(message, tag = "3")]
    GlobalVelocity(MoveGlobalVelocity),
}

/// Speed of each wheel at its rim.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct MoveWheelVelocity {
    /// Front right, m/s.
    #[prost(float, required, tag = "1")]
    pub front_right: f32,
    /// Back right, m/s.
    #[prost(float, required, tag = "2")]
    pub back_right: f32,
    /// Back left, m/s.
    #[prost(float, required, tag = "3")]
    pub back_left: f32,
    /// Front left, m/s.
    #[prost(float, required, tag = "4")]
    pub front_left: f32,
}

/// Velocity in the robot's frame.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct MoveLocalVelocity {
    /// Forward, m/s.
    #[prost(float, required, tag = "1")]
    pub forward: f32,
    /// To the left, m/s.
    #[prost(float, required, tag = "2")]
    pub left: f32,
    /// Counter-clockwise, rad/s.
    #[prost(float, required, tag = "3")]
    pub angular: f32,
}

/// Velocity in the field frame.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct MoveGlobalVelocity {
    /// Along the field's length, m/s.
    #[prost(float, required, tag = "1")]
    pub x: f32,
    /// To the left of +x, m/s.
    #[prost(float, required, tag = "2")]
    pub y: f32,
    /// Counter-clockwise, rad/s.
    #[prost(float, required, tag = "3")]
    pub angular: f32,
}

/// What comes back from ports 10301 and 10302.
#[derive(Clone, PartialEq, Message)]
pub struct RobotControlResponse {
    /// What was not done.
    #[prost(message, repeated, tag = "1")]
    pub errors: Vec<SimulatorError>,
    /// What robots feel: every one on the field, or those that were commanded, or also those taken away (README, trap 9).
    #[prost(message, repeated, tag = "2")]
    pub feedback: Vec<RobotFeedback>,
}

/// What one robot feels.
#[derive(Clone, PartialEq, Message)]
pub struct RobotFeedback {
    /// Shell number, 0–15.
    #[prost(uint32, required, tag = "1")]
    pub id: u32,
    /// Whether the ball is at the dribbler.
    #[prost(bool, optional, tag = "2")]
    pub dribbler_ball_contact: Option<bool>,
    /// What this simulator adds.
    #[prost(message, optional, tag = "3")]
    pub custom: Option<Any>,
}
