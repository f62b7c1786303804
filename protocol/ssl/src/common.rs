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

messages! {
    /// A point or velocity in the field frame, m or m/s.
    #[derive(Clone, Copy, PartialEq, Message)]
    pub struct Vector2 {
        /// Along the field's length, m (m/s).
        x: f32 [float, required] = 1;
        /// Coordinate to the left of +x, m (m/s).
        y: f32 [float, required] = 2;
    }

    /// A point or velocity in the field frame, m or m/s.
    #[derive(Clone, Copy, PartialEq, Message)]
    pub struct Vector3 {
        /// Along the field's length, m (m/s).
        x: f32 [float, required] = 1;
        /// Coordinate to the left of +x, m (m/s).
        y: f32 [float, required] = 2;
        /// Up from the ground, m (m/s).
        z: f32 [float, required] = 3;
    }

    /// A robot by shell number and team, as the game controller and the simulation protocol name it.
    #[derive(Clone, Copy, PartialEq, Message)]
    pub struct RobotId {
        /// Shell number of the robot, 0–15.
        id: Option<u32> [uint32, optional] = 1;
        /// Team of the robot, [`Team`].
        team: Option<i32> [enumeration = "Team", optional] = 2;
    }

    /// `google.protobuf.Any`: a message whose type the sender names.
    #[derive(Clone, PartialEq, Message)]
    pub struct Any {
        /// Type of `value`, `type.googleapis.com/` and the full name of the message.
        type_url: Option<String> [string, optional] = 1;
        /// The message in protobuf's encoding.
        value: Option<Vec<u8>> [bytes = "vec", optional] = 2;
    }

    /// `google.protobuf.Duration`: seconds and nanoseconds.
    #[derive(Clone, Copy, PartialEq, Message)]
    pub struct Duration {
        /// Whole seconds, of either sign.
        seconds: Option<i64> [int64, optional] = 1;
        /// The rest, ns, of the same sign.
        nanos: Option<i32> [int32, optional] = 2;
    }
}
