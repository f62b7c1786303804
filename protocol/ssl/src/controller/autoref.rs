//! `autoref`: messages between automatic referee and game controller. Port
//! 10007.

use prost::Message;

use super::{ControllerReply, Signature};
use crate::event::GameEvent;

messages! {
    /// An automatic referee's first message.
    #[derive(Clone, PartialEq, Message)]
    pub struct AutoRefRegistration {
        /// Name of the automatic referee, unique at the controller.
        identifier: String [string, required] = 1;
        /// Proof, where the controller has its key.
        signature: Option<Signature> [message, optional] = 2;
    }

    /// An automatic referee's message to the controller: an event that it saw.
    #[derive(Clone, PartialEq, Message)]
    pub struct AutoRefToController {
        /// Proof that the sender is registered.
        signature: Option<Signature> [message, optional] = 1;
        /// The event that it reports.
        game_event: Option<GameEvent> [message, optional] = 2;
    }

    /// The controller's message to an automatic referee: a reply.
    #[derive(Clone, PartialEq, Message)]
    pub struct ControllerToAutoRef {
        /// The answer to its last message.
        controller_reply: Option<ControllerReply> [message, optional] = 1;
    }
}
