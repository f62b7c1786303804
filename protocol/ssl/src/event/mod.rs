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

/// Kind of event; deprecated ones are still in old log files.
#[derive(Clone, PartialEq, Oneof)]
pub enum Event {
    /// Both teams were ready for the restart (deprecated).
    #[prost(message, tag = "1")]
    Prepared(Prepared),
    /// No team got the ball moving.
    #[prost(message, tag = "2")]
    NoProgressInGame(NoProgressInGame),
    /// A team failed to place the ball.
    #[prost(message, tag = "3")]
    PlacementFailed(PlacementFailed),
    /// A team placed the ball.
    #[prost(message, tag = "5")]
    PlacementSucceeded(PlacementSucceeded),
    /// The ball left over a touch line.
    #[prost(message, tag = "6")]
    BallLeftFieldTouchLine(BallLeftField),
    /// The ball left over a goal line.
    #[prost(message, tag = "7")]
    BallLeftFieldGoalLine(BallLeftField),
    /// A goal was scored.
    #[prost(message, tag = "8")]
    Goal(Goal),
    /// A goal straight from an indirect free kick (deprecated).
    #[prost(message, tag = "9")]
    IndirectGoal(IndirectGoal),
    /// A goal by a ball too high (deprecated).
    #[prost(message, tag = "10")]
    ChippedGoal(ChippedGoal),
    /// A kick from the own half over the opponent's goal line (division B).
    #[prost(message, tag = "11")]
    AimlessKick(AimlessKick),
    /// The kick was not taken in time (deprecated).
    #[prost(message, tag = "12")]
    KickTimeout(KickTimeout),
    /// The keeper held the ball too long.
    #[prost(message, tag = "13")]
    KeeperHeldBall(KeeperHeldBall),
    /// The kicker touched the ball twice.
    #[prost(message, tag = "14")]
    AttackerDoubleTouchedBall(AttackerDoubleTouchedBall),
    /// An attacker touched the ball in the opponent's defence area.
    #[prost(message, tag = "15")]
    AttackerTouchedBallInDefenseArea(AttackerTouchedBallInDefenseArea),
    /// An attacker touched an opponent in its defence area (deprecated).
    #[prost(message, tag = "16")]
    AttackerTouchedOpponentInDefenseArea(AttackerTouchedOpponentInDefenseArea),
    /// A robot dribbled more than a metre.
    #[prost(message, tag = "17")]
    BotDribbledBallTooFar(BotDribbledBallTooFar),
    /// A ball faster than 6.5 m/s.
    #[prost(message, tag = "18")]
    BotKickedBallTooFast(BotKickedBallTooFast),
    /// An attacker was within 0.2 m of the opponent's defence area at a restart.
    #[prost(message, tag = "19")]
    AttackerTooCloseToDefenseArea(AttackerTooCloseToDefenseArea),
    /// A robot interfered with the placement.
    #[prost(message, tag = "20")]
    BotInterferedPlacement(BotInterferedPlacement),
    /// Two robots crashed, both at fault.
    #[prost(message, tag = "21")]
    BotCrashDrawn(BotCrashDrawn),
    /// Two robots crashed, one at fault.
    #[prost(message, tag = "22")]
    BotCrashUnique(BotCrashUnique),
    /// The same, play continued (deprecated).
    #[prost(message, tag = "23")]
    BotCrashUniqueSkipped(BotCrashUnique),
    /// A robot pushed another.
    #[prost(message, tag = "24")]
    BotPushedBot(BotPushedBot),
    /// The same, play continued (deprecated).
    #[prost(message, tag = "25")]
    BotPushedBotSkipped(BotPushedBot),
    /// A robot held the ball so that no other robot could reach it.
    #[prost(message, tag = "26")]
    BotHeldBallDeliberately(BotHeldBallDeliberately),
    /// A robot fell over.
    #[prost(message, tag = "27")]
    BotTippedOver(BotTippedOver),
    /// A robot was faster than 1.5 m/s in STOP.
    #[prost(message, tag = "28")]
    BotTooFastInStop(BotTooFastInStop),
    /// An opponent was within 0.5 m of the ball at a free kick.
    #[prost(message, tag = "29")]
    DefenderTooCloseToKickPoint(DefenderTooCloseToKickPoint),
    /// A defender touched the ball while partly in its defence area (deprecated).
    #[prost(message, tag = "30")]
    DefenderInDefenseAreaPartially(DefenderInDefenseAreaPartially),
    /// A defender touched the ball while entirely in its defence area.
    #[prost(message, tag = "31")]
    DefenderInDefenseArea(DefenderInDefenseArea),
    /// A team got several yellow cards.
    #[prost(message, tag = "32")]
    MultipleCards(MultipleCards),
    /// A team failed to place several times (deprecated).
    #[prost(message, tag = "33")]
    MultiplePlacementFailures(MultiplePlacementFailures),
    /// A team committed several fouls: a yellow card.
    #[prost(message, tag = "34")]
    MultipleFouls(MultipleFouls),
    /// A human referee saw minor unsporting behaviour.
    #[prost(message, tag = "35")]
    UnsportingBehaviorMinor(UnsportingBehaviorMinor),
    /// A human referee saw major unsporting behaviour.
    #[prost(message, tag = "36")]
    UnsportingBehaviorMajor(UnsportingBehaviorMajor),
    /// A team requests to substitute a robot.
    #[prost(message, tag = "37")]
    BotSubstitution(BotSubstitution),
    /// A team had too many robots on the field.
    #[prost(message, tag = "38")]
    TooManyRobots(TooManyRobots),
    /// A possible goal: the human referee decides.
    #[prost(message, tag = "39")]
    PossibleGoal(Goal),
    /// The same as above, play continued (deprecated).
    #[prost(message, tag = "42")]
    AttackerTouchedOpponentInDefenseAreaSkipped(AttackerTouchedOpponentInDefenseArea),
    /// A ball flew over the boundary's wall.
    #[prost(message, tag = "43")]
    BoundaryCrossing(BoundaryCrossing),
    /// The ball was in the goal, but it does not count.
    #[prost(message, tag = "44")]
    InvalidGoal(Goal),
    /// The penalty kick brought no goal.
    #[prost(message, tag = "45")]
    PenaltyKickFailed(PenaltyKickFailed),
    /// A team challenges a decision.
    #[prost(message, tag = "46")]
    ChallengeFlag(ChallengeFlag),
    /// A team stopped the game in an emergency.
    #[prost(message, tag = "47")]
    EmergencyStop(EmergencyStop),
    /// The challenge was decided.
    #[prost(message, tag = "48")]
    ChallengeFlagHandled(ChallengeFlagHandled),
    /// A robot lost parts.
    #[prost(message, tag = "51")]
    BotDroppedParts(BotDroppedParts),
    /// A team substituted more often than is free.
    #[prost(message, tag = "52")]
    ExcessiveBotSubstitution(ExcessiveBotSubstitution),
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
