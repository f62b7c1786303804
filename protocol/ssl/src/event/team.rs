//! Events of a whole team: cards, fouls that add up, behaviour, substitutions, challenges.

use prost::Message;

use super::GameEvent;
use crate::common::Team;

/// A team got several yellow cards.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct MultipleCards {
    /// The team that caused the event, [`Team`].
    #[prost(enumeration = "Team", required, tag = "1")]
    pub by_team: i32,
}

/// A team committed several fouls.
#[derive(Clone, PartialEq, Message)]
pub struct MultipleFouls {
    /// The team that caused the event, [`Team`].
    #[prost(enumeration = "Team", required, tag = "1")]
    pub by_team: i32,
    /// The fouls that were counted.
    #[prost(message, repeated, tag = "2")]
    pub caused_game_events: Vec<GameEvent>,
}

/// A team failed to place several times (deprecated).
#[derive(Clone, Copy, PartialEq, Message)]
pub struct MultiplePlacementFailures {
    /// The team that caused the event, [`Team`].
    #[prost(enumeration = "Team", required, tag = "1")]
    pub by_team: i32,
}

/// A human referee saw minor unsporting behaviour.
#[derive(Clone, PartialEq, Message)]
pub struct UnsportingBehaviorMinor {
    /// The team that caused the event, [`Team`].
    #[prost(enumeration = "Team", required, tag = "1")]
    pub by_team: i32,
    /// Reason, as text.
    #[prost(string, required, tag = "2")]
    pub reason: String,
}

/// A human referee saw major unsporting behaviour.
#[derive(Clone, PartialEq, Message)]
pub struct UnsportingBehaviorMajor {
    /// The team that caused the event, [`Team`].
    #[prost(enumeration = "Team", required, tag = "1")]
    pub by_team: i32,
    /// Reason, as text.
    #[prost(string, required, tag = "2")]
    pub reason: String,
}

/// A team requests to substitute a robot.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct BotSubstitution {
    /// The team that caused the event, [`Team`].
    #[prost(enumeration = "Team", required, tag = "1")]
    pub by_team: i32,
}

/// A team substituted more often than is free.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct ExcessiveBotSubstitution {
    /// The team that caused the event, [`Team`].
    #[prost(enumeration = "Team", required, tag = "1")]
    pub by_team: i32,
}

/// A team challenges a decision.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct ChallengeFlag {
    /// The team that caused the event, [`Team`].
    #[prost(enumeration = "Team", required, tag = "1")]
    pub by_team: i32,
}

/// A challenge was decided.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct ChallengeFlagHandled {
    /// The team that caused the event, [`Team`].
    #[prost(enumeration = "Team", required, tag = "1")]
    pub by_team: i32,
    /// Whether the challenge was accepted.
    #[prost(bool, required, tag = "2")]
    pub accepted: bool,
}

/// A team stopped the game in an emergency.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct EmergencyStop {
    /// The team that caused the event, [`Team`].
    #[prost(enumeration = "Team", required, tag = "1")]
    pub by_team: i32,
}
