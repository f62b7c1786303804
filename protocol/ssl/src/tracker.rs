//! `tracker`: tracker packets. One [`TrackerWrapperPacket`] a datagram, to 224.5.23.2:10010.
//!
//! Units: m, m/s, rad, rad/s, s in the field frame. Several sources may share the port: they are
//! distinguished by `uuid`.

use prost::{Enumeration, Message};

use crate::common::{Vector2, Vector3};

/// A frame with its source.
#[derive(Clone, PartialEq, Message)]
pub struct TrackerWrapperPacket {
    /// Id of the source, the same through a session.
    #[prost(string, required, tag = "1")]
    pub uuid: String,
    /// Name of the source.
    #[prost(string, optional, tag = "2")]
    pub source_name: Option<String>,
    /// The tracked frame.
    #[prost(message, optional, tag = "3")]
    pub tracked_frame: Option<TrackedFrame>,
}

/// The field at one moment.
#[derive(Clone, PartialEq, Message)]
pub struct TrackedFrame {
    /// Counts this source's frames.
    #[prost(uint32, required, tag = "1")]
    pub frame_number: u32,
    /// Time of the frame, s, on the clock of vision's `t_capture`.
    #[prost(double, required, tag = "2")]
    pub timestamp: f64,
    /// Balls; the first is the one in play.
    #[prost(message, repeated, tag = "3")]
    pub balls: Vec<TrackedBall>,
    /// Robots of both teams.
    #[prost(message, repeated, tag = "4")]
    pub robots: Vec<TrackedRobot>,
    /// The last kick while its ball moves.
    #[prost(message, optional, tag = "5")]
    pub kicked_ball: Option<KickedBall>,
    /// Abilities of this source, [`Capability`].
    #[prost(enumeration = "Capability", repeated, packed = "false", tag = "6")]
    pub capabilities: Vec<i32>,
}

/// State of a ball.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct TrackedBall {
    /// Position, m.
    #[prost(message, required, tag = "1")]
    pub pos: Vector3,
    /// Velocity, m/s.
    #[prost(message, optional, tag = "2")]
    pub vel: Option<Vector3>,
    /// Recent visibility, 0–1.
    #[prost(float, optional, tag = "3")]
    pub visibility: Option<f32>,
}

/// A ball that was kicked, and where it will end if it is not touched.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct KickedBall {
    /// Position of the kick, m.
    #[prost(message, required, tag = "1")]
    pub pos: Vector2,
    /// Its velocity after the kick, m/s.
    #[prost(message, required, tag = "2")]
    pub vel: Vector3,
    /// When it was kicked, s.
    #[prost(double, required, tag = "3")]
    pub start_timestamp: f64,
    /// When it will stop, s.
    #[prost(double, optional, tag = "4")]
    pub stop_timestamp: Option<f64>,
    /// Stop position, m.
    #[prost(message, optional, tag = "5")]
    pub stop_pos: Option<Vector2>,
    /// The robot that kicked.
    #[prost(message, optional, tag = "6")]
    pub robot_id: Option<TrackedRobotId>,
}

/// State of a robot.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct TrackedRobot {
    /// Identity of the robot.
    #[prost(message, required, tag = "1")]
    pub robot_id: TrackedRobotId,
    /// Position, m.
    #[prost(message, required, tag = "2")]
    pub pos: Vector2,
    /// Heading, rad, counter-clockwise from +x.
    #[prost(float, required, tag = "3")]
    pub orientation: f32,
    /// Velocity, m/s, field frame.
    #[prost(message, optional, tag = "4")]
    pub vel: Option<Vector2>,
    /// Turning rate, rad/s, counter-clockwise.
    #[prost(float, optional, tag = "5")]
    pub vel_angular: Option<f32>,
    /// Recent visibility, 0–1.
    #[prost(float, optional, tag = "6")]
    pub visibility: Option<f32>,
}

/// A robot by shell number and team, as in tracker packets.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct TrackedRobotId {
    /// Shell number, 0–15.
    #[prost(uint32, required, tag = "1")]
    pub id: u32,
    /// Its team, [`TeamColor`].
    #[prost(enumeration = "TeamColor", required, tag = "2")]
    pub team_color: i32,
}

/// Team, with the numbers of [`crate::common::Team`].
#[expect(missing_docs, reason = "the league's own names")]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Enumeration)]
#[repr(i32)]
pub enum TeamColor {
    Unknown = 0,
    Yellow = 1,
    Blue = 2,
}

/// Abilities of a tracker.
#[expect(missing_docs, reason = "the league's own names")]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Enumeration)]
#[repr(i32)]
pub enum Capability {
    Unknown = 0,
    DetectFlyingBalls = 1,
    DetectMultipleBalls = 2,
    DetectKickedBalls = 3,
}
