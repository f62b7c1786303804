//! `controller`: messages of the game controller's ports. Length-delimited over TCP ([`crate::stream`]), the
//! controller first.
//!
//! Teams: port 10008. It sends a [`ControllerReply`] with `next_token`; unsigned clients leave `signature`
//! out.

mod autoref;
pub mod ci;
pub mod remote;

use prost::{Enumeration, Message, Oneof};

use crate::common::Team;

pub use autoref::{AutoRefRegistration, AutoRefToController, ControllerToAutoRef};

messages! {
    /// The controller's answer to any request.
    #[derive(Clone, PartialEq, Message)]
    pub struct ControllerReply {
        /// Accepted or not, [`StatusCode`].
        status_code: Option<i32> [enumeration = "StatusCode", optional] = 1;
        /// Reason of a refusal, as text.
        reason: Option<String> [string, optional] = 2;
        /// Token that the next signature must be over.
        next_token: Option<String> [string, optional] = 3;
        /// Was the signature checked? [`Verification`].
        verification: Option<i32> [enumeration = "Verification", optional] = 4;
    }
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

/// Result of the check of the sender's signature.
#[expect(missing_docs, reason = "the league's own names")]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Enumeration)]
#[repr(i32)]
pub enum Verification {
    Unknown = 0,
    Verified = 1,
    Unverified = 2,
}

messages! {
    /// Proof of who sends.
    #[derive(Clone, PartialEq, Message)]
    pub struct Signature {
        /// The controller's last `next_token`.
        token: String [string, required] = 1;
        /// Signature over the message with this field empty: RSA, PKCS #1 v1.5, SHA-256.
        pkcs1v15: Vec<u8> [bytes = "vec", required] = 2;
    }

    /// A team's first message.
    #[derive(Clone, PartialEq, Message)]
    pub struct TeamRegistration {
        /// Must be the name the controller shows.
        team_name: String [string, required] = 1;
        /// Proof, where the controller has the team's key.
        signature: Option<Signature> [message, optional] = 2;
        /// Side, where both teams have one name, [`Team`].
        team: Option<i32> [enumeration = "Team", optional] = 3;
    }
}

/// A team's request; with `msg` absent it does nothing.
#[derive(Clone, PartialEq, Message)]
pub struct TeamToController {
    /// Signature of the sender.
    #[prost(message, optional, tag = "1")]
    pub signature: Option<Signature>,
    /// The request, one of [`TeamRequest`].
    #[prost(oneof = "TeamRequest", tags = "2, 3, 4, 5")]
    pub msg: Option<TeamRequest>,
}

one_of! {
    /// Requests of a team.
    #[derive(Clone, PartialEq, Oneof)]
    pub enum TeamRequest {
        /// Make this robot the keeper.
        DesiredKeeper(i32) [int32] = 2;
        /// Stop or continue after a foul against us, [`AdvantageChoice`].
        AdvantageChoice(i32) [enumeration = "AdvantageChoice"] = 3;
        /// Request, or withdraw, a substitution.
        SubstituteBot(bool) [bool] = 4;
        /// Requests a reply to prove that the peer is alive.
        Ping(bool) [bool] = 5;
    }
}

messages! {
    /// Message from the game controller to a team.
    #[derive(Clone, PartialEq, Message)]
    pub struct ControllerToTeam {
        /// The answer to its last message.
        controller_reply: Option<ControllerReply> [message, optional] = 1;
    }
}

/// Stop or continue after a foul against us.
#[expect(missing_docs, reason = "the league's own names")]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Enumeration)]
#[repr(i32)]
pub enum AdvantageChoice {
    Stop = 0,
    Continue = 1,
}
