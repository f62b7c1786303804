//! `remote`: messages between a team's remote control and the game controller. Port 10011.

use prost::{Enumeration, Message, Oneof};

use super::{ControllerReply, Signature};
use crate::common::Team;

/// A remote control's first message.
#[derive(Clone, PartialEq, Message)]
pub struct RemoteControlRegistration {
    /// Team colour, [`Team`].
    #[prost(enumeration = "Team", required, tag = "1")]
    pub team: i32,
    /// Signature of the sender.
    #[prost(message, optional, tag = "2")]
    pub signature: Option<Signature>,
}

/// A press of a button.
#[derive(Clone, PartialEq, Message)]
pub struct RemoteControlToController {
    /// Signature of the sender.
    #[prost(message, optional, tag = "1")]
    pub signature: Option<Signature>,
    /// The button pressed.
    #[prost(oneof = "RemoteControlMessage", tags = "2, 3, 4, 5, 6")]
    pub msg: Option<RemoteControlMessage>,
}

/// Requests of a remote control.
#[derive(Clone, PartialEq, Oneof)]
pub enum RemoteControlMessage {
    /// A request without a value, [`RemoteControlRequest`].
    #[prost(enumeration = "RemoteControlRequest", tag = "2")]
    Request(i32),
    /// Make this robot the keeper.
    #[prost(int32, tag = "3")]
    DesiredKeeper(i32),
    /// Request, or withdraw, a substitution.
    #[prost(bool, tag = "4")]
    RequestRobotSubstitution(bool),
    /// Request, or withdraw, a time-out.
    #[prost(bool, tag = "5")]
    RequestTimeout(bool),
    /// Request, or withdraw, an emergency stop.
    #[prost(bool, tag = "6")]
    RequestEmergencyStop(bool),
}

/// Requests without a value.
#[expect(missing_docs, reason = "the league's own names")]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Enumeration)]
#[repr(i32)]
pub enum RemoteControlRequest {
    Unknown = 0,
    Ping = 1,
    ChallengeFlag = 2,
    StopTimeout = 3,
    FailBallplacement = 4,
}

/// Messages from the controller to a remote control.
#[derive(Clone, PartialEq, Message)]
pub struct ControllerToRemoteControl {
    /// The answer to its last message.
    #[prost(message, optional, tag = "1")]
    pub controller_reply: Option<ControllerReply>,
    /// State to display on its buttons.
    #[prost(message, optional, tag = "2")]
    pub state: Option<RemoteControlTeamState>,
}

/// State of a team for display on a remote control.
#[derive(Clone, PartialEq, Message)]
pub struct RemoteControlTeamState {
    /// Requests available now, [`RemoteControlRequestType`].
    #[prost(enumeration = "RemoteControlRequestType", repeated, packed = "false", tag = "1")]
    pub available_requests: Vec<i32>,
    /// Requests that were made and still wait, [`RemoteControlRequestType`].
    #[prost(enumeration = "RemoteControlRequestType", repeated, packed = "false", tag = "2")]
    pub active_requests: Vec<i32>,
    /// Shell number of the keeper.
    #[prost(int32, optional, tag = "3")]
    pub keeper_id: Option<i32>,
    /// Time until the emergency stop comes, s.
    #[prost(float, optional, tag = "4")]
    pub emergency_stop_in: Option<f32>,
    /// Number of time-outs left.
    #[prost(int32, optional, tag = "5")]
    pub timeouts_left: Option<i32>,
    /// Number of challenges left.
    #[prost(int32, optional, tag = "6")]
    pub challenge_flags_left: Option<i32>,
    /// Number of robots it may have on the field.
    #[prost(int32, optional, tag = "7")]
    pub max_robots: Option<i32>,
    /// Time left of each yellow card, s.
    #[prost(float, repeated, packed = "false", tag = "8")]
    pub yellow_cards_due: Vec<f32>,
    /// Number of robots it has on the field.
    #[prost(int32, optional, tag = "9")]
    pub robots_on_field: Option<i32>,
    /// Time left for time-outs, s.
    #[prost(float, optional, tag = "10")]
    pub timeout_time_left: Option<f32>,
    /// Whether it may substitute now.
    #[prost(bool, optional, tag = "11")]
    pub can_substitute_robot: Option<bool>,
    /// Team colour, [`Team`].
    #[prost(enumeration = "Team", optional, tag = "12")]
    pub team: Option<i32>,
    /// Substitutions left in this half.
    #[prost(uint32, optional, tag = "13")]
    pub bot_substitutions_left: Option<u32>,
    /// Time left of the running substitution, s.
    #[prost(float, optional, tag = "14")]
    pub bot_substitution_time_left: Option<f32>,
}

/// Requests a remote control can make.
#[expect(missing_docs, reason = "the league's own names")]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Enumeration)]
#[repr(i32)]
pub enum RemoteControlRequestType {
    Unknown = 0,
    EmergencyStop = 1,
    RobotSubstitution = 2,
    Timeout = 3,
    ChallengeFlag = 4,
    ChangeKeeperId = 5,
    StopTimeout = 6,
    FailBallplacement = 7,
}
