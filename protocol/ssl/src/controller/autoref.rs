//! `autoref`: messages between automatic referee and game controller. Port
//! 10007.

use prost::Message;

use super::{ControllerReply, Signature};
use crate::event::GameEvent;

/// An automatic referee's first message.
#[derive(Clone, PartialEq, Message)]
pub struct AutoRefRegistration {
    /// Its name.
    #[prost(string, required, tag = "1")]
    pub identifier: String,
    /// Proof, where the controller has its key.
    #[prost(message, optional, tag = "2")]
    pub signature: Option<Signature>,
}

/// What it saw.
#[derive(Clone, PartialEq, Message)]
pub struct AutoRefToController {
    /// Proof.
    #[prost(message, optional, tag = "1")]
    pub signature: Option<Signature>,
    /// The event.
    #[prost(message, optional, tag = "2")]
    pub game_event: Option<GameEvent>,
}

/// What it hears.
#[derive(Clone, PartialEq, Message)]
pub struct ControllerToAutoRef {
    /// The answer to its last message.
    #[prost(message, optional, tag = "1")]
    pub controller_reply: Option<ControllerReply>,
}
