//! Events of the ball: it left, went in, was kicked wrongly, was held or placed. Units: m, m/s, s; field
//! frame.

use prost::Message;

use crate::common::{Team, Vector2};

/// The ball left the field.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct BallLeftField {
    /// The team that caused the event, [`Team`].
    #[prost(enumeration = "Team", required, tag = "1")]
    pub by_team: i32,
    /// The robot that touched it last.
    #[prost(uint32, optional, tag = "2")]
    pub by_bot: Option<u32>,
    /// Point at which it crossed the line, m.
    #[prost(message, optional, tag = "3")]
    pub location: Option<Vector2>,
}

/// The ball was kicked over the opponent's goal line from the own half.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct AimlessKick {
    /// The team that caused the event, [`Team`].
    #[prost(enumeration = "Team", required, tag = "1")]
    pub by_team: i32,
    /// The robot that kicked.
    #[prost(uint32, optional, tag = "2")]
    pub by_bot: Option<u32>,
    /// Point at which it crossed the line, m.
    #[prost(message, optional, tag = "3")]
    pub location: Option<Vector2>,
    /// Position of the kick, m.
    #[prost(message, optional, tag = "4")]
    pub kick_location: Option<Vector2>,
}

/// The ball is in a goal.
#[derive(Clone, PartialEq, Message)]
pub struct Goal {
    /// The team that scores.
    #[prost(enumeration = "Team", required, tag = "1")]
    pub by_team: i32,
    /// The robot that kicked.
    #[prost(uint32, optional, tag = "2")]
    pub kicking_bot: Option<u32>,
    /// Point at which it crossed the line, m.
    #[prost(message, optional, tag = "3")]
    pub location: Option<Vector2>,
    /// Position of the kick, m.
    #[prost(message, optional, tag = "4")]
    pub kick_location: Option<Vector2>,
    /// Its greatest height between kick and goal, m.
    #[prost(float, optional, tag = "5")]
    pub max_ball_height: Option<f32>,
    /// The team that kicked: not `by_team` where it is an own goal, [`Team`].
    #[prost(enumeration = "Team", optional, tag = "6")]
    pub kicking_team: Option<i32>,
    /// Number of robots that `by_team` had on the field.
    #[prost(uint32, optional, tag = "7")]
    pub num_robots_by_team: Option<u32>,
    /// When `by_team` touched it last, µs, Unix time.
    #[prost(uint64, optional, tag = "8")]
    pub last_touch_by_team: Option<u64>,
    /// Reason why it counts or does not.
    #[prost(string, optional, tag = "9")]
    pub message: Option<String>,
}

/// A goal straight from an indirect free kick (deprecated).
#[derive(Clone, Copy, PartialEq, Message)]
pub struct IndirectGoal {
    /// The team that caused the event, [`Team`].
    #[prost(enumeration = "Team", required, tag = "1")]
    pub by_team: i32,
    /// The robot that kicked.
    #[prost(uint32, optional, tag = "2")]
    pub by_bot: Option<u32>,
    /// Point at which it crossed the line, m.
    #[prost(message, optional, tag = "3")]
    pub location: Option<Vector2>,
    /// Position of the kick, m.
    #[prost(message, optional, tag = "4")]
    pub kick_location: Option<Vector2>,
}

/// A goal by a ball that was too high (deprecated).
#[derive(Clone, Copy, PartialEq, Message)]
pub struct ChippedGoal {
    /// The team that caused the event, [`Team`].
    #[prost(enumeration = "Team", required, tag = "1")]
    pub by_team: i32,
    /// The robot that kicked.
    #[prost(uint32, optional, tag = "2")]
    pub by_bot: Option<u32>,
    /// Point at which it crossed the line, m.
    #[prost(message, optional, tag = "3")]
    pub location: Option<Vector2>,
    /// Position of the kick, m.
    #[prost(message, optional, tag = "4")]
    pub kick_location: Option<Vector2>,
    /// Its greatest height, m.
    #[prost(float, optional, tag = "5")]
    pub max_ball_height: Option<f32>,
}

/// A kick over the speed limit.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct BotKickedBallTooFast {
    /// The team that caused the event, [`Team`].
    #[prost(enumeration = "Team", required, tag = "1")]
    pub by_team: i32,
    /// The robot that did it.
    #[prost(uint32, optional, tag = "2")]
    pub by_bot: Option<u32>,
    /// Position of the kick, m.
    #[prost(message, optional, tag = "3")]
    pub location: Option<Vector2>,
    /// The ball's speed after the kick, in space, m/s.
    #[prost(float, optional, tag = "4")]
    pub initial_ball_speed: Option<f32>,
    /// Whether it was chipped.
    #[prost(bool, optional, tag = "5")]
    pub chipped: Option<bool>,
}

/// A dribble over the limit.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct BotDribbledBallTooFar {
    /// The team that caused the event, [`Team`].
    #[prost(enumeration = "Team", required, tag = "1")]
    pub by_team: i32,
    /// The robot that did it.
    #[prost(uint32, optional, tag = "2")]
    pub by_bot: Option<u32>,
    /// Where the contact started, m.
    #[prost(message, optional, tag = "3")]
    pub start: Option<Vector2>,
    /// Where the distance was over the limit, m.
    #[prost(message, optional, tag = "4")]
    pub end: Option<Vector2>,
}

/// An attacker touched the ball in the opponent's defence area.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct AttackerTouchedBallInDefenseArea {
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
}

/// The kicker touched the ball again before another robot did.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct AttackerDoubleTouchedBall {
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

/// A robot held the ball.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct BotHeldBallDeliberately {
    /// The team that caused the event, [`Team`].
    #[prost(enumeration = "Team", required, tag = "1")]
    pub by_team: i32,
    /// The robot that did it.
    #[prost(uint32, optional, tag = "2")]
    pub by_bot: Option<u32>,
    /// Position, m.
    #[prost(message, optional, tag = "3")]
    pub location: Option<Vector2>,
    /// Duration, s.
    #[prost(float, optional, tag = "4")]
    pub duration: Option<f32>,
}

/// The keeper held the ball in its defence area.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct KeeperHeldBall {
    /// The team that caused the event, [`Team`].
    #[prost(enumeration = "Team", required, tag = "1")]
    pub by_team: i32,
    /// Position, m.
    #[prost(message, optional, tag = "2")]
    pub location: Option<Vector2>,
    /// Duration, s.
    #[prost(float, optional, tag = "3")]
    pub duration: Option<f32>,
}

/// The kick was not taken in time (deprecated).
#[derive(Clone, Copy, PartialEq, Message)]
pub struct KickTimeout {
    /// The team that caused the event, [`Team`].
    #[prost(enumeration = "Team", required, tag = "1")]
    pub by_team: i32,
    /// Position of the ball, m.
    #[prost(message, optional, tag = "2")]
    pub location: Option<Vector2>,
    /// Waiting time, s.
    #[prost(float, optional, tag = "3")]
    pub time: Option<f32>,
}

/// No team got the ball moving.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct NoProgressInGame {
    /// Position of the ball, m.
    #[prost(message, optional, tag = "1")]
    pub location: Option<Vector2>,
    /// Duration, s.
    #[prost(float, optional, tag = "2")]
    pub time: Option<f32>,
}

/// The ball was not placed in time.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct PlacementFailed {
    /// The team that caused the event, [`Team`].
    #[prost(enumeration = "Team", required, tag = "1")]
    pub by_team: i32,
    /// Distance from the ball to its target, m.
    #[prost(float, optional, tag = "2")]
    pub remaining_distance: Option<f32>,
    /// The nearest robot of the placing team to the ball, m.
    #[prost(float, optional, tag = "3")]
    pub nearest_own_bot_distance: Option<f32>,
}

/// The ball was placed.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct PlacementSucceeded {
    /// The team that caused the event, [`Team`].
    #[prost(enumeration = "Team", required, tag = "1")]
    pub by_team: i32,
    /// Duration of the preparation, s.
    #[prost(float, optional, tag = "2")]
    pub time_taken: Option<f32>,
    /// Distance from the ball to its target, m.
    #[prost(float, optional, tag = "3")]
    pub precision: Option<f32>,
    /// Distance from the ball to the target, m.
    #[prost(float, optional, tag = "4")]
    pub distance: Option<f32>,
}

/// Both teams were ready (deprecated).
#[derive(Clone, Copy, PartialEq, Message)]
pub struct Prepared {
    /// Duration of the preparation, s.
    #[prost(float, optional, tag = "1")]
    pub time_taken: Option<f32>,
}

/// A ball flew over the boundary's wall.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct BoundaryCrossing {
    /// The team that caused the event, [`Team`].
    #[prost(enumeration = "Team", required, tag = "1")]
    pub by_team: i32,
    /// Where it crossed, m.
    #[prost(message, optional, tag = "2")]
    pub location: Option<Vector2>,
}

/// The penalty kick brought no goal.
#[derive(Clone, PartialEq, Message)]
pub struct PenaltyKickFailed {
    /// The team that caused the event, [`Team`].
    #[prost(enumeration = "Team", required, tag = "1")]
    pub by_team: i32,
    /// Position of the ball, m.
    #[prost(message, optional, tag = "2")]
    pub location: Option<Vector2>,
    /// Reason, as text.
    #[prost(string, optional, tag = "3")]
    pub reason: Option<String>,
}
