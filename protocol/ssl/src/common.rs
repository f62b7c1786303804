//! `common`: types shared by several of the league's messages. Teams, points, robot ids, and the two messages
//! of protobuf itself.
//!
//! Units of the game controller, the tracker and the simulation protocol: metres in the field frame (origin
//! at the centre, +x along the length, +y to the left, angles counter-clockwise).

use prost::{Enumeration, Message};

/// Team, by the colour of its centre markers.
#[expect(missing_docs, reason = "the league's own names")]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Enumeration)]
#[repr(i32)]
pub enum Team {
    Unknown = 0,
    Yellow = 1,
    Blue = 2,
}

/// Division of the league.
#[expect(missing_docs, reason = "the league's own names")]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Enumeration)]
#[repr(i32)]
pub enum Division {
    Unknown = 0,
    A = 1,
    B = 2,
}

/// A point or velocity in the field frame, m or m/s.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct Vector2 {
    /// Along the field's length, m (m/s).
    #[prost(float, required, tag = "1")]
    pub x: f32,
    /// Coordinate to the left of +x, m (m/s).
    #[prost(float, required, tag = "2")]
    pub y: f32,
}

/// A point or velocity in the field frame, m or m/s.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct Vector3 {
    /// Along the field's length, m (m/s).
    #[prost(float, required, tag = "1")]
    pub x: f32,
    /// Coordinate to the left of +x, m (m/s).
    #[prost(float, required, tag = "2")]
    pub y: f32,
    /// Up from the ground, m (m/s).
    #[prost(float, required, tag = "3")]
    pub z: f32,
}

/// A robot by shell number and team, as the game controller and the simulation protocol name it.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct RobotId {
    /// Shell number, 0–15.
    #[prost(uint32, optional, tag = "1")]
    pub id: Option<u32>,
    /// Team of the robot, [`Team`].
    #[prost(enumeration = "Team", optional, tag = "2")]
    pub team: Option<i32>,
}

/// `google.protobuf.Any`: a message whose type the sender names.
#[derive(Clone, PartialEq, Message)]
pub struct Any {
    /// Type of `value`, `type.googleapis.com/` and the full name of the message.
    #[prost(string, optional, tag = "1")]
    pub type_url: Option<String>,
    /// The message, encoded.
    #[prost(bytes = "vec", optional, tag = "2")]
    pub value: Option<Vec<u8>>,
}

/// `google.protobuf.Duration`.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct Duration {
    /// Whole seconds.
    #[prost(int64, optional, tag = "1")]
    pub seconds: Option<i64>,
    /// Remaining nanoseconds, of the same sign.
    #[prost(int32, optional, tag = "2")]
    pub nanos: Option<i32>,
}
