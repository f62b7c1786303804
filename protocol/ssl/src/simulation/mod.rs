//! `simulation`: simulation control. [`SimulatorCommand`] to port 10300, [`RobotControl`] to 10301 (blue) and
//! 10302 (yellow).
//!
//! Units: m, m/s, m/s², rad, rad/s, kg in the field frame; `kick_angle` in degrees, `dribbler_speed` in rpm.
//! Absent fields stay as they are. A simulator answers requests that it cannot fulfil with a
//! [`SimulatorError`].

mod custom;
mod grsim;
mod robot;

use prost::Message;

use crate::common::{Any, RobotId};
use crate::vision::{DetectionFrame, GeometryData};

pub use custom::{RealismConfigErForce, RobotSpecErForce};
pub use grsim::{
    GrsimBallReplacement, GrsimCommands, GrsimPacket, GrsimReplacement, GrsimRobotCommand,
    GrsimRobotReplacement, RobotStatus, RobotsStatus,
};
pub use robot::{
    MoveCommand, MoveGlobalVelocity, MoveLocalVelocity, MoveWheelVelocity, RobotCommand, RobotControl,
    RobotControlResponse, RobotFeedback, RobotMoveCommand,
};

/// Failed request to a simulator.
#[derive(Clone, PartialEq, Message)]
pub struct SimulatorError {
    /// Error code, of the simulator's own choice.
    #[prost(string, optional, tag = "1")]
    pub code: Option<String>,
    /// Text for the user.
    #[prost(string, optional, tag = "2")]
    pub message: Option<String>,
}

/// To port 10300: teleports, or settings.
#[derive(Clone, PartialEq, Message)]
pub struct SimulatorCommand {
    /// Objects to be moved.
    #[prost(message, optional, tag = "1")]
    pub control: Option<SimulatorControl>,
    /// Settings to change.
    #[prost(message, optional, tag = "2")]
    pub config: Option<SimulatorConfig>,
}

/// Answer from port 10300.
#[derive(Clone, PartialEq, Message)]
pub struct SimulatorResponse {
    /// Failed requests; empty when all succeeded.
    #[prost(message, repeated, tag = "1")]
    pub errors: Vec<SimulatorError>,
}

/// Move ball and robots, change the pace.
#[derive(Clone, PartialEq, Message)]
pub struct SimulatorControl {
    /// Move the ball.
    #[prost(message, optional, tag = "1")]
    pub teleport_ball: Option<TeleportBall>,
    /// Robots to be moved.
    #[prost(message, repeated, tag = "2")]
    pub teleport_robot: Vec<TeleportRobot>,
    /// Simulated seconds a second: 1 is real time, 0 stands still.
    #[prost(float, optional, tag = "3")]
    pub simulation_speed: Option<f32>,
}

/// Move the ball.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct TeleportBall {
    /// Along the field's length, m.
    #[prost(float, optional, tag = "1")]
    pub x: Option<f32>,
    /// Coordinate to the left of +x, m.
    #[prost(float, optional, tag = "2")]
    pub y: Option<f32>,
    /// Up, m.
    #[prost(float, optional, tag = "3")]
    pub z: Option<f32>,
    /// Velocity along x, m/s.
    #[prost(float, optional, tag = "4")]
    pub vx: Option<f32>,
    /// Velocity along y, m/s.
    #[prost(float, optional, tag = "5")]
    pub vy: Option<f32>,
    /// Velocity upwards, m/s.
    #[prost(float, optional, tag = "6")]
    pub vz: Option<f32>,
    /// Push robots aside instead of putting the ball inside one.
    #[prost(bool, optional, tag = "7")]
    pub teleport_safely: Option<bool>,
    /// Start as a rolling ball, without a sliding phase.
    #[prost(bool, optional, tag = "8")]
    pub roll: Option<bool>,
    /// Move it by forces, through obstacles in between, instead of at once.
    #[prost(bool, optional, tag = "9")]
    pub by_force: Option<bool>,
}

/// Move a robot, or remove it.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct TeleportRobot {
    /// Robot to be moved.
    #[prost(message, required, tag = "1")]
    pub id: RobotId,
    /// Along the field's length, m.
    #[prost(float, optional, tag = "2")]
    pub x: Option<f32>,
    /// Coordinate to the left of +x, m.
    #[prost(float, optional, tag = "3")]
    pub y: Option<f32>,
    /// Heading, rad, counter-clockwise from +x.
    #[prost(float, optional, tag = "4")]
    pub orientation: Option<f32>,
    /// Velocity along x, m/s, field frame.
    #[prost(float, optional, default = "0", tag = "5")]
    pub v_x: Option<f32>,
    /// Velocity along y, m/s, field frame.
    #[prost(float, optional, default = "0", tag = "6")]
    pub v_y: Option<f32>,
    /// Rate of turn, rad/s, counter-clockwise.
    #[prost(float, optional, default = "0", tag = "7")]
    pub v_angular: Option<f32>,
    /// False removes the robot, true adds it.
    #[prost(bool, optional, tag = "8")]
    pub present: Option<bool>,
    /// Move it by forces instead of at once.
    #[prost(bool, optional, tag = "9")]
    pub by_force: Option<bool>,
}

/// The simulator's settings.
#[derive(Clone, PartialEq, Message)]
pub struct SimulatorConfig {
    /// The field, in vision's units (mm).
    #[prost(message, optional, tag = "1")]
    pub geometry: Option<GeometryData>,
    /// Properties of robots.
    #[prost(message, repeated, tag = "2")]
    pub robot_specs: Vec<RobotSpecs>,
    /// Noise, delay and losses, in a form of the simulator's own.
    #[prost(message, optional, tag = "3")]
    pub realism_config: Option<RealismConfig>,
    /// Port for vision packets.
    #[prost(uint32, optional, tag = "4")]
    pub vision_port: Option<u32>,
}

/// Noise, delay and losses.
#[derive(Clone, PartialEq, Message)]
pub struct RealismConfig {
    /// For ER-Force's simulator a [`RealismConfigErForce`].
    #[prost(message, repeated, tag = "1")]
    pub custom: Vec<Any>,
}

/// Properties of a robot.
#[derive(Clone, PartialEq, Message)]
pub struct RobotSpecs {
    /// The robot.
    #[prost(message, required, tag = "1")]
    pub id: RobotId,
    /// Radius of its hull, m.
    #[prost(float, optional, default = "0.09", tag = "2")]
    pub radius: Option<f32>,
    /// Height of its hull, m.
    #[prost(float, optional, default = "0.15", tag = "3")]
    pub height: Option<f32>,
    /// Mass, kg.
    #[prost(float, optional, tag = "4")]
    pub mass: Option<f32>,
    /// Fastest flat kick, m/s.
    #[prost(float, optional, tag = "7")]
    pub max_linear_kick_speed: Option<f32>,
    /// Fastest chip kick, m/s, in space.
    #[prost(float, optional, tag = "8")]
    pub max_chip_kick_speed: Option<f32>,
    /// Distance from the centre to the flat front, m.
    #[prost(float, optional, tag = "9")]
    pub center_to_dribbler: Option<f32>,
    /// Limits of its motion.
    #[prost(message, optional, tag = "10")]
    pub limits: Option<RobotLimits>,
    /// Angles of its wheels.
    #[prost(message, optional, tag = "13")]
    pub wheel_angles: Option<RobotWheelAngles>,
    /// For ER-Force's simulator a [`RobotSpecErForce`].
    #[prost(message, repeated, tag = "14")]
    pub custom: Vec<Any>,
}

/// Limits of a robot's motion.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct RobotLimits {
    /// Largest acceleration, m/s².
    #[prost(float, optional, tag = "1")]
    pub acc_speedup_absolute_max: Option<f32>,
    /// Largest angular acceleration, rad/s².
    #[prost(float, optional, tag = "2")]
    pub acc_speedup_angular_max: Option<f32>,
    /// Braking, m/s².
    #[prost(float, optional, tag = "3")]
    pub acc_brake_absolute_max: Option<f32>,
    /// Largest angular braking, rad/s².
    #[prost(float, optional, tag = "4")]
    pub acc_brake_angular_max: Option<f32>,
    /// Speed, m/s.
    #[prost(float, optional, tag = "5")]
    pub vel_absolute_max: Option<f32>,
    /// Rate of turn, rad/s.
    #[prost(float, optional, tag = "6")]
    pub vel_angular_max: Option<f32>,
}

/// Directions of the wheels' axles, rad, counter-clockwise from the robot's front.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct RobotWheelAngles {
    /// Axle of the front right wheel, rad.
    #[prost(float, required, tag = "1")]
    pub front_right: f32,
    /// Axle of the back right wheel, rad.
    #[prost(float, required, tag = "2")]
    pub back_right: f32,
    /// Axle of the back left wheel, rad.
    #[prost(float, required, tag = "3")]
    pub back_left: f32,
    /// Axle of the front left wheel, rad.
    #[prost(float, required, tag = "4")]
    pub front_left: f32,
}

/// One step of a simulator whose clock the sender drives.
#[derive(Clone, PartialEq, Message)]
pub struct SimulationSyncRequest {
    /// Length of the step, s.
    #[prost(float, optional, tag = "1")]
    pub sim_step: Option<f32>,
    /// Message as to port 10300.
    #[prost(message, optional, tag = "2")]
    pub simulator_command: Option<SimulatorCommand>,
    /// Message as to ports 10301 and 10302.
    #[prost(message, optional, tag = "3")]
    pub robot_control: Option<RobotControl>,
}

/// Output of the step.
#[derive(Clone, PartialEq, Message)]
pub struct SimulationSyncResponse {
    /// Detections of each camera.
    #[prost(message, repeated, tag = "1")]
    pub detection: Vec<DetectionFrame>,
    /// Message as from ports 10301 and 10302.
    #[prost(message, optional, tag = "2")]
    pub robot_control_response: Option<RobotControlResponse>,
}
