//! `robot`: game events about robots. Units: m, m/s, rad; field frame.

use prost::Message;

use crate::common::{Team, Vector2};

/// A robot was too fast in STOP.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct BotTooFastInStop {
    /// The team that caused the event, [`Team`].
    #[prost(enumeration = "Team", required, tag = "1")]
    pub by_team: i32,
    /// The robot that did it.
    #[prost(uint32, optional, tag = "2")]
    pub by_bot: Option<u32>,
    /// Position, m.
    #[prost(message, optional, tag = "3")]
    pub location: Option<Vector2>,
    /// Speed of the robot, m/s.
    #[prost(float, optional, tag = "4")]
    pub speed: Option<f32>,
}

/// An opponent was too close to the ball at a free kick.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct DefenderTooCloseToKickPoint {
    /// The team that caused the event, [`Team`].
    #[prost(enumeration = "Team", required, tag = "1")]
    pub by_team: i32,
    /// The robot that did it.
    #[prost(uint32, optional, tag = "2")]
    pub by_bot: Option<u32>,
    /// Position, m.
    #[prost(message, optional, tag = "3")]
    pub location: Option<Vector2>,
    /// Distance from robot to ball, without the robot's radius, m.
    #[prost(float, optional, tag = "4")]
    pub distance: Option<f32>,
}

/// Two robots crashed; the difference of speeds was small.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct BotCrashDrawn {
    /// The yellow robot.
    #[prost(uint32, optional, tag = "1")]
    pub bot_yellow: Option<u32>,
    /// The blue robot.
    #[prost(uint32, optional, tag = "2")]
    pub bot_blue: Option<u32>,
    /// Position, m.
    #[prost(message, optional, tag = "3")]
    pub location: Option<Vector2>,
    /// Relative speed along the line between them, m/s.
    #[prost(float, optional, tag = "4")]
    pub crash_speed: Option<f32>,
    /// Difference of their speeds, m/s.
    #[prost(float, optional, tag = "5")]
    pub speed_diff: Option<f32>,
    /// Angle between their velocities, rad, 0…π.
    #[prost(float, optional, tag = "6")]
    pub crash_angle: Option<f32>,
}

/// Two robots crashed; the faster one is at fault.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct BotCrashUnique {
    /// The team that caused the event, [`Team`].
    #[prost(enumeration = "Team", required, tag = "1")]
    pub by_team: i32,
    /// The faster robot, of `by_team`.
    #[prost(uint32, optional, tag = "2")]
    pub violator: Option<u32>,
    /// The other robot, of the other team.
    #[prost(uint32, optional, tag = "3")]
    pub victim: Option<u32>,
    /// Position, m.
    #[prost(message, optional, tag = "4")]
    pub location: Option<Vector2>,
    /// Relative speed along the line between them, m/s.
    #[prost(float, optional, tag = "5")]
    pub crash_speed: Option<f32>,
    /// Difference of their speeds, m/s.
    #[prost(float, optional, tag = "6")]
    pub speed_diff: Option<f32>,
    /// Angle between their velocities, rad, 0…π.
    #[prost(float, optional, tag = "7")]
    pub crash_angle: Option<f32>,
}

/// A robot pushed another.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct BotPushedBot {
    /// The team that caused the event, [`Team`].
    #[prost(enumeration = "Team", required, tag = "1")]
    pub by_team: i32,
    /// The robot that pushed, of `by_team`.
    #[prost(uint32, optional, tag = "2")]
    pub violator: Option<u32>,
    /// The robot that was pushed.
    #[prost(uint32, optional, tag = "3")]
    pub victim: Option<u32>,
    /// Position, m.
    #[prost(message, optional, tag = "4")]
    pub location: Option<Vector2>,
    /// Distance of the push, m.
    #[prost(float, optional, tag = "5")]
    pub pushed_distance: Option<f32>,
}

/// A robot fell over.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct BotTippedOver {
    /// The team that caused the event, [`Team`].
    #[prost(enumeration = "Team", required, tag = "1")]
    pub by_team: i32,
    /// The robot that did it.
    #[prost(uint32, optional, tag = "2")]
    pub by_bot: Option<u32>,
    /// Position, m.
    #[prost(message, optional, tag = "3")]
    pub location: Option<Vector2>,
    /// Position of the ball, m.
    #[prost(message, optional, tag = "4")]
    pub ball_location: Option<Vector2>,
}

/// A robot lost parts.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct BotDroppedParts {
    /// The team that caused the event, [`Team`].
    #[prost(enumeration = "Team", required, tag = "1")]
    pub by_team: i32,
    /// The robot that did it.
    #[prost(uint32, optional, tag = "2")]
    pub by_bot: Option<u32>,
    /// Position, m.
    #[prost(message, optional, tag = "3")]
    pub location: Option<Vector2>,
    /// Position of the ball, m.
    #[prost(message, optional, tag = "4")]
    pub ball_location: Option<Vector2>,
}

/// A defender other than the keeper touched the ball, entirely in its own defence area.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct DefenderInDefenseArea {
    /// The team that caused the event, [`Team`].
    #[prost(enumeration = "Team", required, tag = "1")]
    pub by_team: i32,
    /// The robot that did it.
    #[prost(uint32, optional, tag = "2")]
    pub by_bot: Option<u32>,
    /// Position, m.
    #[prost(message, optional, tag = "3")]
    pub location: Option<Vector2>,
    /// Distance from the robot to the nearest point outside the area, m.
    #[prost(float, optional, tag = "4")]
    pub distance: Option<f32>,
}

/// The same, partly in the area (deprecated).
#[derive(Clone, Copy, PartialEq, Message)]
pub struct DefenderInDefenseAreaPartially {
    /// The team that caused the event, [`Team`].
    #[prost(enumeration = "Team", required, tag = "1")]
    pub by_team: i32,
    /// The robot that did it.
    #[prost(uint32, optional, tag = "2")]
    pub by_bot: Option<u32>,
    /// Position, m.
    #[prost(message, optional, tag = "3")]
    pub location: Option<Vector2>,
    /// Depth inside the area, m.
    #[prost(float, optional, tag = "4")]
    pub distance: Option<f32>,
    /// Position of the ball, m.
    #[prost(message, optional, tag = "5")]
    pub ball_location: Option<Vector2>,
}

/// An attacker touched an opponent in the opponent's defence area (deprecated).
#[derive(Clone, Copy, PartialEq, Message)]
pub struct AttackerTouchedOpponentInDefenseArea {
    /// The team that caused the event, [`Team`].
    #[prost(enumeration = "Team", required, tag = "1")]
    pub by_team: i32,
    /// The robot that did it.
    #[prost(uint32, optional, tag = "2")]
    pub by_bot: Option<u32>,
    /// Position, m.
    #[prost(message, optional, tag = "3")]
    pub location: Option<Vector2>,
    /// The robot that was touched.
    #[prost(uint32, optional, tag = "4")]
    pub victim: Option<u32>,
}

/// An attacker was too close to the opponent's defence area at a restart.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct AttackerTooCloseToDefenseArea {
    /// The team that caused the event, [`Team`].
    #[prost(enumeration = "Team", required, tag = "1")]
    pub by_team: i32,
    /// The robot that did it.
    #[prost(uint32, optional, tag = "2")]
    pub by_bot: Option<u32>,
    /// Position, m.
    #[prost(message, optional, tag = "3")]
    pub location: Option<Vector2>,
    /// Distance from the robot to the area, m.
    #[prost(float, optional, tag = "4")]
    pub distance: Option<f32>,
    /// Position of the ball, m.
    #[prost(message, optional, tag = "5")]
    pub ball_location: Option<Vector2>,
}

/// A robot was too close to the line between ball and target.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct BotInterferedPlacement {
    /// The team that caused the event, [`Team`].
    #[prost(enumeration = "Team", required, tag = "1")]
    pub by_team: i32,
    /// The robot that did it.
    #[prost(uint32, optional, tag = "2")]
    pub by_bot: Option<u32>,
    /// Position, m.
    #[prost(message, optional, tag = "3")]
    pub location: Option<Vector2>,
}

/// A team had too many robots on the field.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct TooManyRobots {
    /// The team that caused the event, [`Team`].
    #[prost(enumeration = "Team", required, tag = "1")]
    pub by_team: i32,
    /// Number of robots it may have.
    #[prost(int32, optional, tag = "2")]
    pub num_robots_allowed: Option<i32>,
    /// Number of robots it had.
    #[prost(int32, optional, tag = "3")]
    pub num_robots_on_field: Option<i32>,
    /// Position of the ball, m.
    #[prost(message, optional, tag = "4")]
    pub ball_location: Option<Vector2>,
}
