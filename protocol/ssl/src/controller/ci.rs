//! `ci`: messages of the game controller's CI mode, in which a simulator is its clock and its tracker. Port
//! 10009; the simulator first. Each [`CiInput`] with a time makes the controller's engine run once.

use std::collections::BTreeMap;

use prost::{Enumeration, Message, Oneof};

use crate::common::Team;
use crate::event::GameEvent;
use crate::referee::{MatchType, Referee, Stage};
use crate::tracker::TrackerWrapperPacket;
use crate::vision::GeometryData;

messages! {
    /// The simulator's message: time, field and the operator's acts, each where it is new.
    #[derive(Clone, PartialEq, Message)]
    pub struct CiInput {
        /// New time of the controller's clock, ns, Unix time. Without it the engine does not run.
        timestamp: Option<i64> [int64, optional] = 1;
        /// Ball and robots.
        tracker_packet: Option<TrackerWrapperPacket> [message, optional] = 2;
        /// Acts of the operator.
        api_inputs: Vec<ApiInput> [message, repeated] = 3;
        /// Dimensions of the field.
        geometry: Option<GeometryData> [message, optional] = 4;
    }

    /// The controller's message: one for each run of its engine and for each change of its state.
    #[derive(Clone, PartialEq, Message)]
    pub struct CiOutput {
        /// The referee message after it.
        referee_msg: Option<Referee> [message, optional] = 1;
    }

    /// An act of the operator.
    #[derive(Clone, PartialEq, Message)]
    pub struct ApiInput {
        /// A change of the match's state.
        change: Option<Change> [message, optional] = 1;
        /// True: the match starts from nothing.
        reset_match: Option<bool> [bool, optional] = 2;
        /// Settings of the engine that change.
        config_delta: Option<EngineConfig> [message, optional] = 3;
    }

    /// Settings of the engine; those that are absent stay.
    #[derive(Clone, PartialEq, Message)]
    pub struct EngineConfig {
        /// What it does with a reported event, [`Behavior`], by the league's name of the event.
        game_event_behavior: BTreeMap<String, i32> [btree_map = "string, enumeration(Behavior)"] = 1;
        /// True: it continues by itself where nothing prevents it.
        auto_continue: Option<bool> [bool, optional] = 5;
    }

    /// A command of the referee, with the team that it is for.
    #[derive(Clone, Copy, PartialEq, Message)]
    pub struct ControllerCommand {
        /// The command, [`CommandType`].
        r#type: i32 [enumeration = "CommandType", required] = 1;
        /// Team that it is for, [`Team`].
        for_team: i32 [enumeration = "Team", required] = 2;
    }

    /// A new command.
    #[derive(Clone, Copy, PartialEq, Message)]
    pub struct NewCommand {
        /// The command.
        command: Option<ControllerCommand> [message, optional] = 1;
    }

    /// A new stage of the match.
    #[derive(Clone, Copy, PartialEq, Message)]
    pub struct ChangeStage {
        /// The stage, [`Stage`].
        new_stage: Option<i32> [enumeration = "Stage", optional] = 1;
    }

    /// A game event that was reported.
    #[derive(Clone, PartialEq, Message)]
    pub struct AddGameEvent {
        /// The event.
        game_event: Option<GameEvent> [message, optional] = 1;
    }

    /// Settings of the match; those that are absent stay.
    #[derive(Clone, Copy, PartialEq, Message)]
    pub struct UpdateConfig {
        /// Division, [`crate::common::Division`].
        division: Option<i32> [enumeration = "crate::common::Division", optional] = 1;
        /// Team of the first kick-off, [`Team`].
        first_kickoff_team: Option<i32> [enumeration = "Team", optional] = 2;
        /// Kind of match, [`MatchType`]; the controller does not leave HALT before it is set.
        match_type: Option<i32> [enumeration = "MatchType", optional] = 4;
        /// Robots of each team.
        max_robots_per_team: Option<i32> [message, optional] = 5;
    }

    /// State of one team; what is absent stays.
    #[derive(Clone, PartialEq, Message)]
    pub struct UpdateTeamState {
        /// The team, [`Team`].
        for_team: Option<i32> [enumeration = "Team", optional] = 1;
        /// Name of the team.
        team_name: Option<String> [message, optional] = 2;
        /// Shell number of the keeper.
        goalkeeper: Option<i32> [message, optional] = 4;
        /// True: its own goal is at +x.
        on_positive_half: Option<bool> [message, optional] = 7;
        /// Can the team place the ball?
        can_place_ball: Option<bool> [message, optional] = 9;
    }

    /// A text that all receivers of referee messages see.
    #[derive(Clone, PartialEq, Message)]
    pub struct SetStatusMessage {
        /// The text.
        status_message: Option<String> [string, optional] = 1;
    }
}

/// A change of the match's state.
#[derive(Clone, PartialEq, Message)]
pub struct Change {
    /// The change, one of [`ChangeOf`].
    #[prost(oneof = "ChangeOf", tags = "2, 3, 8, 12, 13, 20")]
    pub change: Option<ChangeOf>,
}

one_of! {
    /// What changes.
    #[derive(Clone, PartialEq, Oneof)]
    pub enum ChangeOf {
        /// The command in force.
        NewCommand(NewCommand) [message] = 2;
        /// The stage of the match.
        ChangeStage(ChangeStage) [message] = 3;
        /// The events.
        AddGameEvent(AddGameEvent) [message] = 8;
        /// Settings of the match.
        UpdateConfig(UpdateConfig) [message] = 12;
        /// State of a team.
        UpdateTeamState(UpdateTeamState) [message] = 13;
        /// The text for all.
        SetStatusMessage(SetStatusMessage) [message] = 20;
    }
}

/// What the engine does with a reported event.
#[expect(missing_docs, reason = "the league's own names")]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Enumeration)]
#[repr(i32)]
pub enum Behavior {
    Unknown = 0,
    Accept = 1,
    AcceptMajority = 2,
    ProposeOnly = 3,
    Log = 4,
    Ignore = 5,
}

/// Commands of the controller, the team apart.
#[expect(missing_docs, reason = "the league's own names")]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Enumeration)]
#[repr(i32)]
pub enum CommandType {
    Unknown = 0,
    Halt = 1,
    Stop = 2,
    NormalStart = 3,
    ForceStart = 4,
    Direct = 5,
    Kickoff = 7,
    Penalty = 8,
    Timeout = 9,
    BallPlacement = 10,
}
