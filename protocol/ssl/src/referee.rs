//! `referee`: referee packets. One [`Referee`] a datagram from the game controller, to 224.5.23.1:10003,
//! about 38 a second.
//!
//! Units: all times in µs; `designated_position` in **mm**; positions in game events in **m**; field frame.

use prost::{Enumeration, Message};

use crate::event::GameEvent;

messages! {
    /// The state of the match, repeated whether it changed or not.
    #[derive(Clone, PartialEq, Message)]
    pub struct Referee {
        /// Time of sending, µs, Unix time.
        packet_timestamp: u64 [uint64, required] = 1;
        /// Part of the match, [`Stage`].
        stage: i32 [enumeration = "Stage", required] = 2;
        /// Playing time left in the stage, µs; negative when it ran over.
        stage_time_left: Option<i64> [sint64, optional] = 3;
        /// Command in force, [`Command`].
        command: i32 [enumeration = "Command", required] = 4;
        /// Rises with each command; the same command may come again with a new count (README, trap 4).
        command_counter: u32 [uint32, required] = 5;
        /// Time of the command, µs, Unix time.
        command_timestamp: u64 [uint64, required] = 6;
        /// State of the yellow team.
        yellow: TeamInfo [message, required] = 7;
        /// State of the blue team.
        blue: TeamInfo [message, required] = 8;
        /// Target of the ball's placement, mm. Only to be read in ball placement (README, trap 3).
        designated_position: Option<Point> [message, optional] = 9;
        /// True: blue's own goal is at +x.
        blue_team_on_positive_half: Option<bool> [bool, optional] = 10;
        /// Command that will follow the current stop, [`Command`].
        next_command: Option<i32> [enumeration = "Command", optional] = 12;
        /// Time left for placement, free kick, kickoff or penalty, µs; negative when it ran over.
        current_action_time_remaining: Option<i64> [int64, optional] = 15;
        /// Events decided since the last command that let the ball move.
        game_events: Vec<GameEvent> [message, repeated] = 16;
        /// Events that automatic referees proposed and that are not decided yet.
        game_event_proposals: Vec<GameEventProposalGroup> [message, repeated] = 17;
        /// Identifier of the sending program, the same through a session.
        source_identifier: Option<String> [string, optional] = 18;
        /// Kind of match, [`MatchType`].
        match_type: Option<i32> [enumeration = "MatchType", optional] = 19;
        /// Text about what the controller waits for.
        status_message: Option<String> [string, optional] = 20;
    }

    /// One team's state: score, cards, times, keeper.
    #[derive(Clone, PartialEq, Message)]
    pub struct TeamInfo {
        /// The team's name; empty while unknown.
        name: String [string, required] = 1;
        /// Goals in normal play and overtime.
        score: u32 [uint32, required] = 2;
        /// Red cards since the match's start.
        red_cards: u32 [uint32, required] = 3;
        /// Time left of each active yellow card, µs.
        yellow_card_times: Vec<u32> [uint32, repeated] = 4;
        /// Yellow cards ever given.
        yellow_cards: u32 [uint32, required] = 5;
        /// Time-outs left, without the running one.
        timeouts: u32 [uint32, required] = 6;
        /// Time left for time-outs, µs.
        timeout_time: u32 [uint32, required] = 7;
        /// Shell number of the keeper.
        goalkeeper: u32 [uint32, required] = 8;
        /// Fouls that count towards a yellow card.
        foul_counter: Option<u32> [uint32, optional] = 9;
        /// Failed placements in a row.
        ball_placement_failures: Option<u32> [uint32, optional] = 10;
        /// Can the team place the ball?
        can_place_ball: Option<bool> [bool, optional] = 12;
        /// Robots it may have on the field now.
        max_allowed_bots: Option<u32> [uint32, optional] = 13;
        /// True if the team asked to substitute a robot at the next chance.
        bot_substitution_intent: Option<bool> [bool, optional] = 14;
        /// True if the team failed so often that it no longer may place the ball.
        ball_placement_failures_reached: Option<bool> [bool, optional] = 15;
        /// True if the team may substitute now.
        bot_substitution_allowed: Option<bool> [bool, optional] = 16;
        /// Substitutions left in this half.
        bot_substitutions_left: Option<u32> [uint32, optional] = 17;
        /// Time left of the running substitution, µs.
        bot_substitution_time_left: Option<u32> [uint32, optional] = 18;
        /// Shade of its robots' hulls, [`HullColor`].
        hull_color: Option<i32> [enumeration = "HullColor", optional] = 19;
    }

    /// A point on the ground in **mm**, field frame.
    #[derive(Clone, Copy, PartialEq, Message)]
    pub struct Point {
        /// Along the field's length, mm.
        x: f32 [float, required] = 1;
        /// Coordinate to the left of +x, mm.
        y: f32 [float, required] = 2;
    }

    /// The same event as several automatic referees saw it.
    #[derive(Clone, PartialEq, Message)]
    pub struct GameEventProposalGroup {
        /// The report of each automatic referee.
        game_events: Vec<GameEvent> [message, repeated] = 1;
        /// Was it accepted? Absent while open.
        accepted: Option<bool> [bool, optional] = 2;
        /// Identifier of the group, unique.
        id: Option<String> [string, optional] = 3;
    }
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

/// Kinds of matches of a tournament.
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
