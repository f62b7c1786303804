//! Events of a whole team: cards, fouls that add up, behaviour, substitutions, challenges.

use prost::Message;

use super::GameEvent;
use crate::common::Team;

events! {
    /// A team got several yellow cards.
    team MultipleCards {}

    /// A team failed to place several times (deprecated).
    team MultiplePlacementFailures {}

    /// A team wants to substitute a robot.
    team BotSubstitution {}

    /// A team substituted more often than is free.
    team ExcessiveBotSubstitution {}

    /// A team challenges a decision.
    team ChallengeFlag {}

    /// A challenge was decided.
    team ChallengeFlagHandled {
        /// Was the challenge right?
        accepted: bool [bool, required] = 2;
    }

    /// A team stopped the game in an emergency.
    team EmergencyStop {}
}

messages! {
    /// A team committed several fouls: a yellow card.
    #[derive(Clone, PartialEq, Message)]
    pub struct MultipleFouls {
        /// Team that the event concerns, [`Team`].
        by_team: i32 [enumeration = "Team", required] = 1;
        /// The fouls that were counted together.
        caused_game_events: Vec<GameEvent> [message, repeated] = 2;
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
}
