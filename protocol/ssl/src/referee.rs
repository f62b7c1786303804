//! `referee`: referee packets. One [`Referee`] a datagram from the game controller, to 224.5.23.1:10003,
//! about 38 a second.
//!
//! Units: all times in µs; `designated_position` in **mm**; positions in game events in **m**; field frame.

use prost::{Enumeration, Message};

use crate::event::GameEvent;

/// The state of the match, repeated whether it changed or not.
#[derive(Clone, PartialEq, Message)]
pub struct Referee {
    /// When this packet was sent, µs, Unix time.
    #[prost(uint64, required, tag = "1")]
    pub packet_timestamp: u64,
    /// Part of the match, [`Stage`].
    #[prost(enumeration = "Stage", required, tag = "2")]
    pub stage: i32,
    /// Playing time left in the stage, µs; negative when it ran over.
    #[prost(sint64, optional, tag = "3")]
    pub stage_time_left: Option<i64>,
    /// Command in force, [`Command`].
    #[prost(enumeration = "Command", required, tag = "4")]
    pub command: i32,
    /// Rises with each command; the same command may come again with a new count (README, trap 4).
    #[prost(uint32, required, tag = "5")]
    pub command_counter: u32,
    /// When the command was given, µs, Unix time.
    #[prost(uint64, required, tag = "6")]
    pub command_timestamp: u64,
    /// The yellow team.
    #[prost(message, required, tag = "7")]
    pub yellow: TeamInfo,
    /// The blue team.
    #[prost(message, required, tag = "8")]
    pub blue: TeamInfo,
    /// Target of a ball placement, mm. Only valid in ball placement (README, trap 3).
    #[prost(message, optional, tag = "9")]
    pub designated_position: Option<Point>,
    /// True: blue's own goal is at +x.
    #[prost(bool, optional, tag = "10")]
    pub blue_team_on_positive_half: Option<bool>,
    /// Command that will follow the current stop, [`Command`].
    #[prost(enumeration = "Command", optional, tag = "12")]
    pub next_command: Option<i32>,
    /// Time left for placement, free kick, kickoff or penalty, µs; negative when it ran over.
    #[prost(int64, optional, tag = "15")]
    pub current_action_time_remaining: Option<i64>,
    /// Events decided since the last command that let the ball move.
    #[prost(message, repeated, tag = "16")]
    pub game_events: Vec<GameEvent>,
    /// Events that automatic referees proposed and that are not decided yet.
    #[prost(message, repeated, tag = "17")]
    pub game_event_proposals: Vec<GameEventProposalGroup>,
    /// Identifier of the sending program, the same through a session.
    #[prost(string, optional, tag = "18")]
    pub source_identifier: Option<String>,
    /// Kind of match, [`MatchType`].
    #[prost(enumeration = "MatchType", optional, tag = "19")]
    pub match_type: Option<i32>,
    /// What the controller waits for, as text.
    #[prost(string, optional, tag = "20")]
    pub status_message: Option<String>,
}

/// State of one team.
#[derive(Clone, PartialEq, Message)]
pub struct TeamInfo {
    /// The team's name; empty while unknown.
    #[prost(string, required, tag = "1")]
    pub name: String,
    /// Number of goals.
    #[prost(uint32, required, tag = "2")]
    pub score: u32,
    /// Number of red cards.
    #[prost(uint32, required, tag = "3")]
    pub red_cards: u32,
    /// Time left of each active yellow card, µs.
    #[prost(uint32, repeated, tag = "4")]
    pub yellow_card_times: Vec<u32>,
    /// Yellow cards ever given.
    #[prost(uint32, required, tag = "5")]
    pub yellow_cards: u32,
    /// Number of time-outs left.
    #[prost(uint32, required, tag = "6")]
    pub timeouts: u32,
    /// Time left for time-outs, µs.
    #[prost(uint32, required, tag = "7")]
    pub timeout_time: u32,
    /// Shell number of the keeper.
    #[prost(uint32, required, tag = "8")]
    pub goalkeeper: u32,
    /// Number of fouls that count towards a yellow card.
    #[prost(uint32, optional, tag = "9")]
    pub foul_counter: Option<u32>,
    /// Number of failed placements in a row.
    #[prost(uint32, optional, tag = "10")]
    pub ball_placement_failures: Option<u32>,
    /// Whether the team can place the ball.
    #[prost(bool, optional, tag = "12")]
    pub can_place_ball: Option<bool>,
    /// Number of robots it may have on the field now.
    #[prost(uint32, optional, tag = "13")]
    pub max_allowed_bots: Option<u32>,
    /// It requested to substitute a robot at the next opportunity.
    #[prost(bool, optional, tag = "14")]
    pub bot_substitution_intent: Option<bool>,
    /// Whether it failed so often that it may no longer place the ball.
    #[prost(bool, optional, tag = "15")]
    pub ball_placement_failures_reached: Option<bool>,
    /// Whether it may substitute now.
    #[prost(bool, optional, tag = "16")]
    pub bot_substitution_allowed: Option<bool>,
    /// Substitutions left in this half.
    #[prost(uint32, optional, tag = "17")]
    pub bot_substitutions_left: Option<u32>,
    /// Time left of the running substitution, µs.
    #[prost(uint32, optional, tag = "18")]
    pub bot_substitution_time_left: Option<u32>,
    /// Shade of its robots' hulls, [`HullColor`].
    #[prost(enumeration = "HullColor", optional, tag = "19")]
    pub hull_color: Option<i32>,
}

/// A point on the ground in **mm**, field frame.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct Point {
    /// Along the field's length, mm.
    #[prost(float, required, tag = "1")]
    pub x: f32,
    /// Coordinate to the left of +x, mm.
    #[prost(float, required, tag = "2")]
    pub y: f32,
}

/// The same event as reported by several automatic referees.
#[derive(Clone, PartialEq, Message)]
pub struct GameEventProposalGroup {
    /// Events as reported by each referee.
    #[prost(message, repeated, tag = "1")]
    pub game_events: Vec<GameEvent>,
    /// Whether it was accepted; absent while open.
    #[prost(bool, optional, tag = "2")]
    pub accepted: Option<bool>,
    /// Id of the group.
    #[prost(string, optional, tag = "3")]
    pub id: Option<String>,
}

/// Parts of a match.
#[expect(missing_docs, reason = "the league's own names")]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Enumeration)]
#[repr(i32)]
pub enum Stage {
    NormalFirstHalfPre = 0,
    NormalFirstHalf = 1,
    NormalHalfTime = 2,
    NormalSecondHalfPre = 3,
    NormalSecondHalf = 4,
    ExtraTimeBreak = 5,
    ExtraFirstHalfPre = 6,
    ExtraFirstHalf = 7,
    ExtraHalfTime = 8,
    ExtraSecondHalfPre = 9,
    ExtraSecondHalf = 10,
    PenaltyShootoutBreak = 11,
    PenaltyShootout = 12,
    PostGame = 13,
}

/// Commands of the referee. Unknown numbers read as [`Command::Halt`] through the accessor, which is the safe
/// one.
#[expect(missing_docs, reason = "the league's own names")]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Enumeration)]
#[repr(i32)]
pub enum Command {
    Halt = 0,
    Stop = 1,
    NormalStart = 2,
    ForceStart = 3,
    PrepareKickoffYellow = 4,
    PrepareKickoffBlue = 5,
    PreparePenaltyYellow = 6,
    PreparePenaltyBlue = 7,
    DirectFreeYellow = 8,
    DirectFreeBlue = 9,
    IndirectFreeYellow = 10,
    IndirectFreeBlue = 11,
    TimeoutYellow = 12,
    TimeoutBlue = 13,
    GoalYellow = 14,
    GoalBlue = 15,
    BallPlacementYellow = 16,
    BallPlacementBlue = 17,
}

/// Kinds of matches.
#[expect(missing_docs, reason = "the league's own names")]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Enumeration)]
#[repr(i32)]
pub enum MatchType {
    Unknown = 0,
    GroupPhase = 1,
    EliminationPhase = 2,
    Friendly = 3,
}

/// Shades of robots' hulls.
#[expect(missing_docs, reason = "the league's own names")]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Enumeration)]
#[repr(i32)]
pub enum HullColor {
    Unknown = 0,
    Dark = 1,
    Light = 2,
}
