//! `controller`: messages of the game controller's ports. Length-delimited over TCP ([`crate::stream`]), the
//! controller first.
//!
//! Teams: port 10008. It sends a [`ControllerReply`] with `next_token`; unsigned clients leave `signature` out.

mod autoref;

use prost::{Enumeration, Message, Oneof};

use crate::common::Team;

pub use autoref::{AutoRefRegistration, AutoRefToController, ControllerToAutoRef};

/// The controller's answer to whatever was sent.
#[derive(Clone, PartialEq, Message)]
pub struct ControllerReply {
    /// Accepted or not, [`StatusCode`].
    #[prost(enumeration = "StatusCode", optional, tag = "1")]
    pub status_code: Option<i32>,
    /// Why not.
    #[prost(string, optional, tag = "2")]
    pub reason: Option<String>,
    /// What the next signature must be over.
    #[prost(string, optional, tag = "3")]
    pub next_token: Option<String>,
    /// Was the signature checked? [`Verification`].
    #[prost(enumeration = "Verification", optional, tag = "4")]
    pub verification: Option<i32>,
}

/// Accepted or not.
#[expect(missing_docs, reason = "the league's own names")]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Enumeration)]
#[repr(i32)]
pub enum StatusCode {
    Unknown = 0,
    Ok = 1,
    Rejected = 2,
}

/// Was the sender's signature checked?
#[expect(missing_docs, reason = "the league's own names")]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Enumeration)]
#[repr(i32)]
pub enum Verification {
    Unknown = 0,
    Verified = 1,
    Unverified = 2,
}

/// Proof of who sends.
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
    /// Must be the name the controller shows.
    #[prost(string, required, tag = "1")]
    pub team_name: String,
    /// Proof, where the controller has the team's key.
    #[prost(message, optional, tag = "2")]
    pub signature: Option<Signature>,
    /// Which side, where both teams have one name, [`Team`].
    #[prost(enumeration = "Team", optional, tag = "3")]
    pub team: Option<i32>,
}

/// A team's wish; with `msg` absent it does nothing.
#[derive(Clone, PartialEq, Message)]
pub struct TeamToController {
    /// Proof.
    #[prost(message, optional, tag = "1")]
    pub signature: Option<Signature>,
    /// The wish.
    #[prost(oneof = "TeamRequest", tags = "2, 3, 4, 5")]
    pub msg: Option<TeamRequest>,
}

/// What a team may ask for.
#[derive(Clone, PartialEq, Oneof)]
pub enum TeamRequest {
    /// Make this robot the keeper.
    #[prost(int32, tag = "2")]
    DesiredKeeper(i32),
    /// Stop or go on after a foul against us, [`AdvantageChoice`].
    #[prost(enumeration = "AdvantageChoice", tag = "3")]
    AdvantageChoice(i32),
    /// Ask for, or take back, a substitution.
    #[prost(bool, tag = "4")]
    SubstituteBot(bool),
    /// Is anybody there? The answer is a reply.
    #[prost(bool, tag = "5")]
    Ping(bool),
}

/// What a team hears.
#[derive(Clone, PartialEq, Message)]
pub struct ControllerToTeam {
    /// The answer to its last message.
    #[prost(message, optional, tag = "1")]
    pub controller_reply: Option<ControllerReply>,
}

/// Stop or go on after a foul against us.
#[expect(missing_docs, reason = "the league's own names")]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Enumeration)]
#[repr(i32)]
pub enum AdvantageChoice {
    Stop = 0,
    Continue = 1,
}
