//! `controller`: messages of the game controller's ports. Length-delimited over TCP ([`crate::stream`]), the
//! controller first.
//!
//! Teams: port 10008. It sends a [`ControllerReply`] with `next_token`; unsigned clients leave `signature`
//! out.

mod api;
mod autoref;
mod remote;

use prost::{Enumeration, Message, Oneof};

use crate::common::Team;

pub use api::{CiInput, CiOutput, Input, Output, Protocol, ProtocolEntry};
pub use autoref::{
    AutoRefCiInput, AutoRefCiOutput, AutoRefRegistration, AutoRefToController, ControllerToAutoRef,
};
pub use remote::{
    ControllerToRemoteControl, RemoteControlMessage, RemoteControlRegistration, RemoteControlRequest,
    RemoteControlRequestType, RemoteControlTeamState, RemoteControlToController,
};

/// The controller's answer to any message.
#[derive(Clone, PartialEq, Message)]
pub struct ControllerReply {
    /// Result, [`StatusCode`].
    #[prost(enumeration = "StatusCode", optional, tag = "1")]
    pub status_code: Option<i32>,
    /// Reason of a refusal.
    #[prost(string, optional, tag = "2")]
    pub reason: Option<String>,
    /// Token that the next signature must sign.
    #[prost(string, optional, tag = "3")]
    pub next_token: Option<String>,
    /// Result of the signature check, [`Verification`].
    #[prost(enumeration = "Verification", optional, tag = "4")]
    pub verification: Option<i32>,
}

/// Result of a request.
#[expect(missing_docs, reason = "the league's own names")]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Enumeration)]
#[repr(i32)]
pub enum StatusCode {
    Unknown = 0,
    Ok = 1,
    Rejected = 2,
}

/// Whether the sender's signature was checked.
#[expect(missing_docs, reason = "the league's own names")]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Enumeration)]
#[repr(i32)]
pub enum Verification {
    Unknown = 0,
    Verified = 1,
    Unverified = 2,
}

/// Proof of the sender's identity.
#[derive(Clone, PartialEq, Message)]
pub struct Signature {
    /// The controller's last `next_token`.
    #[prost(string, required, tag = "1")]
    pub token: String,
    /// Signature over the message with this field empty: RSA, PKCS #1 v1.5, SHA-256.
    #[prost(bytes = "vec", required, tag = "2")]
    pub pkcs1v15: Vec<u8>,
}

/// A team's first message.
#[derive(Clone, PartialEq, Message)]
pub struct TeamRegistration {
    /// Must be the team's name in the controller.
    #[prost(string, required, tag = "1")]
    pub team_name: String,
    /// Signature, where the controller has the team's key.
    #[prost(message, optional, tag = "2")]
    pub signature: Option<Signature>,
    /// Team colour, where both teams have one name, [`Team`].
    #[prost(enumeration = "Team", optional, tag = "3")]
    pub team: Option<i32>,
}

/// A team's request; with `msg` absent it does nothing.
#[derive(Clone, PartialEq, Message)]
pub struct TeamToController {
    /// Signature of the sender.
    #[prost(message, optional, tag = "1")]
    pub signature: Option<Signature>,
    /// The request.
    #[prost(oneof = "TeamRequest", tags = "2, 3, 4, 5")]
    pub msg: Option<TeamRequest>,
}

/// Requests of a team.
#[derive(Clone, PartialEq, Oneof)]
pub enum TeamRequest {
    /// Make this robot the keeper.
    #[prost(int32, tag = "2")]
    DesiredKeeper(i32),
    /// Stop or continue after a foul against us, [`AdvantageChoice`].
    #[prost(enumeration = "AdvantageChoice", tag = "3")]
    AdvantageChoice(i32),
    /// Request, or withdraw, a substitution.
    #[prost(bool, tag = "4")]
    SubstituteBot(bool),
    /// Requests a reply as a sign of life.
    #[prost(bool, tag = "5")]
    Ping(bool),
}

/// Messages from the controller to a team.
#[derive(Clone, PartialEq, Message)]
pub struct ControllerToTeam {
    /// The answer to its last message.
    #[prost(message, optional, tag = "1")]
    pub controller_reply: Option<ControllerReply>,
}

/// Stop or continue after a foul against us.
#[expect(missing_docs, reason = "the league's own names")]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Enumeration)]
#[repr(i32)]
pub enum AdvantageChoice {
    Stop = 0,
    Continue = 1,
}
