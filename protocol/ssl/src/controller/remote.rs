//! `remote`: messages between a team's remote control and the game controller. Port 10011.

use prost::{Enumeration, Message, Oneof};

use super::{ControllerReply, Signature};
use crate::common::Team;

messages! {
    /// A remote control's first message.
    #[derive(Clone, PartialEq, Message)]
    pub struct RemoteRegistration {
        /// The team that it is for, [`Team`].
        team: i32 [enumeration = "Team", required] = 1;
        /// Proof, where the controller has the team's key.
        signature: Option<Signature> [message, optional] = 2;
    }
}

/// A remote control's message.
#[derive(Clone, PartialEq, Message)]
pub struct RemoteToController {
    /// Signature of the sender.
    #[prost(message, optional, tag = "1")]
    pub signature: Option<Signature>,
    /// What is asked for, one of [`RemoteMessage`].
    #[prost(oneof = "RemoteMessage", tags = "2, 3, 4, 5, 6")]
    pub msg: Option<RemoteMessage>,
}

one_of! {
    /// What a remote control asks for.
    #[derive(Clone, PartialEq, Oneof)]
    pub enum RemoteMessage {
        /// What takes no value, [`RemoteOnce`].
        Once(i32) [enumeration = "RemoteOnce"] = 2;
        /// Make this robot the keeper.
        DesiredKeeper(i32) [int32] = 3;
        /// Request, or withdraw, a substitution at the next opportunity.
        Substitution(bool) [bool] = 4;
        /// Request, or withdraw, a timeout at the next stoppage.
        Timeout(bool) [bool] = 5;
        /// Request, or withdraw, an emergency stop.
        EmergencyStop(bool) [bool] = 6;
    }
}

/// Requests that take no value.
#[expect(missing_docs, reason = "the league's own names")]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Enumeration)]
#[repr(i32)]
pub enum RemoteOnce {
    Unknown = 0,
    Ping = 1,
    ChallengeFlag = 2,
    StopTimeout = 3,
    FailBallPlacement = 4,
}

/// Kinds of requests, as the controller lists those that are possible and those that wait.
#[expect(missing_docs, reason = "the league's own names")]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Enumeration)]
#[repr(i32)]
pub enum RemoteKind {
    Unknown = 0,
    EmergencyStop = 1,
    RobotSubstitution = 2,
    Timeout = 3,
    ChallengeFlag = 4,
    ChangeKeeper = 5,
    StopTimeout = 6,
    FailBallPlacement = 7,
}

messages! {
    /// Message from the game controller to a remote control.
    #[derive(Clone, PartialEq, Message)]
    pub struct ControllerToRemote {
        /// The answer to its last message.
        controller_reply: Option<ControllerReply> [message, optional] = 1;
        /// The team's state; with every answer but those before a request.
        state: Option<RemoteTeamState> [message, optional] = 2;
    }

    /// State of a team, as its remote control is given it.
    #[derive(Clone, PartialEq, Message)]
    pub struct RemoteTeamState {
        /// The team, [`Team`].
        team: Option<i32> [enumeration = "Team", optional] = 12;
        /// Requests that can be made now, [`RemoteKind`].
        available_requests: Vec<i32> [enumeration = "RemoteKind", repeated, packed = "false"] = 1;
        /// Requests that wait, [`RemoteKind`].
        active_requests: Vec<i32> [enumeration = "RemoteKind", repeated, packed = "false"] = 2;
        /// Shell number of the keeper.
        keeper_id: Option<i32> [int32, optional] = 3;
        /// Time until the emergency stop, s; 0: none is requested.
        emergency_stop_in: Option<f32> [float, optional] = 4;
        /// Number of timeouts left.
        timeouts_left: Option<i32> [int32, optional] = 5;
        /// Time of timeouts left, s.
        timeout_time_left: Option<f32> [float, optional] = 10;
        /// Number of challenge flags left.
        challenge_flags_left: Option<i32> [int32, optional] = 6;
        /// Number of robots allowed now.
        max_robots: Option<i32> [int32, optional] = 7;
        /// Number of robots that the controller's vision has on the field.
        robots_on_field: Option<i32> [int32, optional] = 9;
        /// Time until each yellow card ends, s.
        yellow_cards_due: Vec<f32> [float, repeated, packed = "false"] = 8;
        /// Whether robots may be substituted now.
        can_substitute_robot: Option<bool> [bool, optional] = 11;
        /// Number of substitutions left in this half.
        bot_substitutions_left: Option<u32> [uint32, optional] = 13;
        /// Time left for the present substitution, s.
        bot_substitution_time_left: Option<f32> [float, optional] = 14;
    }
}
