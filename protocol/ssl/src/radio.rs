//! `radio`: the radio protocol proposed in 2015: commands over UDP; no current team uses it.
//!
//! Units: m/s, rad/s in the robot's frame.

use prost::Message;

/// A datagram: one command a robot.
#[derive(Clone, PartialEq, Message)]
pub struct RadioProtocolWrapper {
    /// Commands.
    #[prost(message, repeated, tag = "1")]
    pub command: Vec<RadioProtocolCommand>,
}

/// Command to one robot.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct RadioProtocolCommand {
    /// Shell number.
    #[prost(int32, required, tag = "1")]
    pub robot_id: i32,
    /// Velocity forward, m/s.
    #[prost(float, required, tag = "2")]
    pub velocity_x: f32,
    /// Velocity to the left, m/s.
    #[prost(float, required, tag = "3")]
    pub velocity_y: f32,
    /// Turning rate, counter-clockwise, rad/s.
    #[prost(float, required, tag = "4")]
    pub velocity_r: f32,
    /// Kick flat at this speed, m/s; overrides `chip_kick`.
    #[prost(float, optional, tag = "5")]
    pub flat_kick: Option<f32>,
    /// Distance of a chip kick, **m**.
    #[prost(float, optional, tag = "6")]
    pub chip_kick: Option<f32>,
    /// Dribbler, −1 (out) to +1 (in).
    #[prost(float, optional, tag = "7")]
    pub dribbler_spin: Option<f32>,
}
