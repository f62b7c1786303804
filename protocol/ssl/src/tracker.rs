//! `tracker`: tracker packets. One [`TrackerWrapperPacket`] a datagram, to 224.5.23.2:10010.
//!
//! Units: m, m/s, rad, rad/s, s in the field frame. Several sources may share the port: they are
//! distinguished by `uuid`.

use prost::{Enumeration, Message};

use crate::common::{Vector2, Vector3};

messages! {
    /// A frame with who made it.
    #[derive(Clone, PartialEq, Message)]
    pub struct TrackerWrapperPacket {
        /// Names the source, the same through a session.
        uuid: String [string, required] = 1;
        /// The source as text.
        source_name: Option<String> [string, optional] = 2;
        /// The field as this source estimates it.
        tracked_frame: Option<TrackedFrame> [message, optional] = 3;
    }

    /// The field at one moment.
    #[derive(Clone, PartialEq, Message)]
    pub struct TrackedFrame {
        /// Counts this source's frames.
        frame_number: u32 [uint32, required] = 1;
        /// The moment, s, on the clock of vision's `t_capture`.
        timestamp: f64 [double, required] = 2;
        /// Balls; the first is the one in play.
        balls: Vec<TrackedBall> [message, repeated] = 3;
        /// Robots of both teams.
        robots: Vec<TrackedRobot> [message, repeated] = 4;
        /// The last kick while it lasts.
        kicked_ball: Option<KickedBall> [message, optional] = 5;
        /// Capabilities of this source, [`Capability`].
        capabilities: Vec<i32> [enumeration = "Capability", repeated, packed = "false"] = 6;
    }

    /// A ball as a tracker estimates it.
    #[derive(Clone, Copy, PartialEq, Message)]
    pub struct TrackedBall {
        /// Position of its centre, m.
        pos: Vector3 [message, required] = 1;
        /// Velocity in space, m/s.
        vel: Option<Vector3> [message, optional] = 2;
        /// Share of recent frames in which it was seen, 0–1.
        visibility: Option<f32> [float, optional] = 3;
    }

    /// A ball that was kicked, and where it will end if no robot touches it.
    #[derive(Clone, Copy, PartialEq, Message)]
    pub struct KickedBall {
        /// Point of the kick, m.
        pos: Vector2 [message, required] = 1;
        /// Velocity after the kick, m/s.
        vel: Vector3 [message, required] = 2;
        /// Time of the kick, s.
        start_timestamp: f64 [double, required] = 3;
        /// Time at which the ball will be at rest, s.
        stop_timestamp: Option<f64> [double, optional] = 4;
        /// Point at which the ball will be at rest, m.
        stop_pos: Option<Vector2> [message, optional] = 5;
        /// The robot that kicked it.
        robot_id: Option<TrackedRobotId> [message, optional] = 6;
    }

    /// A robot as a tracker estimates it.
    #[derive(Clone, Copy, PartialEq, Message)]
    pub struct TrackedRobot {
        /// Robot by shell number and team.
        robot_id: TrackedRobotId [message, required] = 1;
        /// Position of its centre, m.
        pos: Vector2 [message, required] = 2;
        /// Heading, rad, counter-clockwise from +x.
        orientation: f32 [float, required] = 3;
        /// Velocity, m/s, field frame.
        vel: Option<Vector2> [message, optional] = 4;
        /// Turning rate, rad/s, counter-clockwise.
        vel_angular: Option<f32> [float, optional] = 5;
        /// Share of recent frames in which it was seen, 0–1.
        visibility: Option<f32> [float, optional] = 6;
    }

    /// A robot by shell number and team, as trackers name it.
    #[derive(Clone, Copy, PartialEq, Message)]
    pub struct TrackedRobotId {
        /// Shell number of the robot, 0–15.
        id: u32 [uint32, required] = 1;
        /// Team of the robot, [`TeamColor`].
        team_color: i32 [enumeration = "TeamColor", required] = 2;
    }
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
