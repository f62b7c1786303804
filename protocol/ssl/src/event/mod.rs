//! `event`: game events, reported by automatic referees, decided and repeated by the game controller.
//!
//! Units: m, m/s, rad, s in the field frame; robots by shell number 0–15; `by_team` is the team that caused
//! the event.

mod ball;
mod robot;
mod team;

use prost::{Enumeration, Message, Oneof};

pub use ball::*;
pub use robot::*;
pub use team::*;

/// One event with its origin.
#[derive(Clone, PartialEq, Message)]
pub struct GameEvent {
    /// Kind of event, [`GameEventType`]; its numbers are not the field numbers of [`Event`].
    #[prost(enumeration = "GameEventType", optional, tag = "40")]
    pub r#type: Option<i32>,
    /// Sources of the event: names of automatic referees, or `UI`.
    #[prost(string, repeated, tag = "41")]
    pub origin: Vec<String>,
    /// Time of its creation, µs, Unix time.
    #[prost(uint64, optional, tag = "49")]
    pub created_timestamp: Option<u64>,
    /// Id of this event.
    #[prost(string, optional, tag = "50")]
    pub id: Option<String>,
    /// The event and its evidence.
    #[prost(
        oneof = "Event",
        tags = "1, 2, 3, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27, 28, 29, 30, 31, 32, 33, 34, 35, 36, 37, 38, 39, 42, 43, 44, 45, 46, 47, 48, 51, 52"
    )]
    pub event: Option<Event>,
}

one_of! {
    /// Kind of event; deprecated ones are still in old log files.
    #[expect(missing_docs, reason = "most are as their message says")]
    #[derive(Clone, PartialEq, Oneof)]
    pub enum Event {
        Prepared(Prepared) [message] = 1;
        NoProgressInGame(NoProgressInGame) [message] = 2;
        PlacementFailed(PlacementFailed) [message] = 3;
        PlacementSucceeded(PlacementSucceeded) [message] = 5;
        /// The ball left over a touch line.
        BallLeftFieldTouchLine(BallLeftField) [message] = 6;
        /// The ball left over a goal line.
        BallLeftFieldGoalLine(BallLeftField) [message] = 7;
        Goal(Goal) [message] = 8;
        IndirectGoal(IndirectGoal) [message] = 9;
        ChippedGoal(ChippedGoal) [message] = 10;
        AimlessKick(AimlessKick) [message] = 11;
        KickTimeout(KickTimeout) [message] = 12;
        KeeperHeldBall(KeeperHeldBall) [message] = 13;
        AttackerDoubleTouchedBall(AttackerDoubleTouchedBall) [message] = 14;
        AttackerTouchedBallInDefenseArea(AttackerTouchedBallInDefenseArea) [message] = 15;
        AttackerTouchedOpponentInDefenseArea(AttackerTouchedOpponentInDefenseArea) [message] = 16;
        BotDribbledBallTooFar(BotDribbledBallTooFar) [message] = 17;
        BotKickedBallTooFast(BotKickedBallTooFast) [message] = 18;
        AttackerTooCloseToDefenseArea(AttackerTooCloseToDefenseArea) [message] = 19;
        BotInterferedPlacement(BotInterferedPlacement) [message] = 20;
        BotCrashDrawn(BotCrashDrawn) [message] = 21;
        BotCrashUnique(BotCrashUnique) [message] = 22;
        /// The same, play continued (deprecated).
        BotCrashUniqueSkipped(BotCrashUnique) [message] = 23;
        BotPushedBot(BotPushedBot) [message] = 24;
        /// The same, play continued (deprecated).
        BotPushedBotSkipped(BotPushedBot) [message] = 25;
        BotHeldBallDeliberately(BotHeldBallDeliberately) [message] = 26;
        BotTippedOver(BotTippedOver) [message] = 27;
        BotTooFastInStop(BotTooFastInStop) [message] = 28;
        DefenderTooCloseToKickPoint(DefenderTooCloseToKickPoint) [message] = 29;
        DefenderInDefenseAreaPartially(DefenderInDefenseAreaPartially) [message] = 30;
        DefenderInDefenseArea(DefenderInDefenseArea) [message] = 31;
        MultipleCards(MultipleCards) [message] = 32;
        MultiplePlacementFailures(MultiplePlacementFailures) [message] = 33;
        MultipleFouls(MultipleFouls) [message] = 34;
        UnsportingBehaviorMinor(UnsportingBehaviorMinor) [message] = 35;
        UnsportingBehaviorMajor(UnsportingBehaviorMajor) [message] = 36;
        BotSubstitution(BotSubstitution) [message] = 37;
        TooManyRobots(TooManyRobots) [message] = 38;
        /// A possible goal: the human referee decides.
        PossibleGoal(Goal) [message] = 39;
        /// The same as above, play continued (deprecated).
        AttackerTouchedOpponentInDefenseAreaSkipped(AttackerTouchedOpponentInDefenseArea) [message] = 42;
        BoundaryCrossing(BoundaryCrossing) [message] = 43;
        /// The ball was in the goal, but it does not count.
        InvalidGoal(Goal) [message] = 44;
        PenaltyKickFailed(PenaltyKickFailed) [message] = 45;
        ChallengeFlag(ChallengeFlag) [message] = 46;
        EmergencyStop(EmergencyStop) [message] = 47;
        ChallengeFlagHandled(ChallengeFlagHandled) [message] = 48;
        BotDroppedParts(BotDroppedParts) [message] = 51;
        ExcessiveBotSubstitution(ExcessiveBotSubstitution) [message] = 52;
    }
}

/// Kinds of game events, by the league's numbers.
#[expect(missing_docs, reason = "the league's own names")]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Enumeration)]
#[repr(i32)]
pub enum GameEventType {
    Unknown = 0,
    Prepared = 1,
    NoProgressInGame = 2,
    PlacementFailed = 3,
    PlacementSucceeded = 5,
    BallLeftFieldTouchLine = 6,
    BallLeftFieldGoalLine = 7,
    Goal = 8,
    IndirectGoal = 9,
    ChippedGoal = 10,
    AimlessKick = 11,
    KickTimeout = 12,
    KeeperHeldBall = 13,
    AttackerDoubleTouchedBall = 14,
    AttackerTouchedBallInDefenseArea = 15,
    AttackerTouchedOpponentInDefenseArea = 16,
    BotDribbledBallTooFar = 17,
    BotKickedBallTooFast = 18,
    AttackerTooCloseToDefenseArea = 19,
    BotInterferedPlacement = 20,
    BotCrashDrawn = 21,
    BotCrashUnique = 22,
    BotCrashUniqueSkipped = 23,
    BotPushedBot = 24,
    BotPushedBotSkipped = 25,
    BotHeldBallDeliberately = 26,
    BotTippedOver = 27,
    BotTooFastInStop = 28,
    DefenderTooCloseToKickPoint = 29,
    DefenderInDefenseAreaPartially = 30,
    DefenderInDefenseArea = 31,
    MultipleCards = 32,
    MultiplePlacementFailures = 33,
    MultipleFouls = 34,
    UnsportingBehaviorMinor = 35,
    UnsportingBehaviorMajor = 36,
    BotSubstitution = 37,
    TooManyRobots = 38,
    PossibleGoal = 39,
    AttackerTouchedOpponentInDefenseAreaSkipped = 40,
    BoundaryCrossing = 41,
    InvalidGoal = 42,
    PenaltyKickFailed = 43,
    ChallengeFlag = 44,
    EmergencyStop = 45,
    ChallengeFlagHandled = 46,
    BotDroppedParts = 47,
    ExcessiveBotSubstitution = 48,
}
