//! Events of a whole team: cards, fouls that add up, behaviour, substitutions, challenges.

use prost::Message;

use super::GameEvent;
use crate::common::Team;

messages! {
    /// A team got several yellow cards.
    #[derive(Clone, Copy, PartialEq, Message)]
    pub struct MultipleCards {
        /// Team that the event concerns, [`Team`].
        by_team: i32 [enumeration = "Team", required] = 1;
    }

    /// A team committed several fouls.
    #[derive(Clone, PartialEq, Message)]
    pub struct MultipleFouls {
        /// Team that the event concerns, [`Team`].
        by_team: i32 [enumeration = "Team", required] = 1;
        /// The fouls that were counted together.
        caused_game_events: Vec<GameEvent> [message, repeated] = 2;
    }

    /// A team failed to place several times (deprecated).
    #[derive(Clone, Copy, PartialEq, Message)]
    pub struct MultiplePlacementFailures {
        /// Team that the event concerns, [`Team`].
        by_team: i32 [enumeration = "Team", required] = 1;
    }

    /// A human saw minor unsporting behaviour.
    #[derive(Clone, PartialEq, Message)]
    pub struct UnsportingBehaviorMinor {
        /// Team that the event concerns, [`Team`].
        by_team: i32 [enumeration = "Team", required] = 1;
        /// Observation of the referees, as text.
        reason: String [string, required] = 2;
    }

    /// A human saw major unsporting behaviour.
    #[derive(Clone, PartialEq, Message)]
    pub struct UnsportingBehaviorMajor {
        /// Team that the event concerns, [`Team`].
        by_team: i32 [enumeration = "Team", required] = 1;
        /// Observation of the referees, as text.
        reason: String [string, required] = 2;
    }

    /// A team wants to substitute a robot.
    #[derive(Clone, Copy, PartialEq, Message)]
    pub struct BotSubstitution {
        /// Team that the event concerns, [`Team`].
        by_team: i32 [enumeration = "Team", required] = 1;
    }

    /// A team substituted more often than is free.
    #[derive(Clone, Copy, PartialEq, Message)]
    pub struct ExcessiveBotSubstitution {
        /// Team that the event concerns, [`Team`].
        by_team: i32 [enumeration = "Team", required] = 1;
    }

    /// A team challenges a decision.
    #[derive(Clone, Copy, PartialEq, Message)]
    pub struct ChallengeFlag {
        /// Team that the event concerns, [`Team`].
        by_team: i32 [enumeration = "Team", required] = 1;
    }

    /// A challenge was decided.
    #[derive(Clone, Copy, PartialEq, Message)]
    pub struct ChallengeFlagHandled {
        /// Team that the event concerns, [`Team`].
        by_team: i32 [enumeration = "Team", required] = 1;
        /// Was the challenge right?
        accepted: bool [bool, required] = 2;
    }

    /// A team stopped the game in an emergency.
    #[derive(Clone, Copy, PartialEq, Message)]
    pub struct EmergencyStop {
        /// Team that the event concerns, [`Team`].
        by_team: i32 [enumeration = "Team", required] = 1;
    }
}
