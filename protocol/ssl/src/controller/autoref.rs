//! `autoref`: messages between automatic referee and game controller. Port 10007; under an external clock
//! port 10013.

use prost::Message;

use super::{ControllerReply, Signature};
use crate::event::GameEvent;
use crate::referee::Referee;
use crate::tracker::TrackerWrapperPacket;
use crate::vision::{DetectionFrame, GeometryData};

/// An automatic referee's first message.
#[derive(Clone, PartialEq, Message)]
pub struct AutoRefRegistration {
    /// Name of the automatic referee.
    #[prost(string, required, tag = "1")]
    pub identifier: String,
    /// Signature, where the controller has its key.
    #[prost(message, optional, tag = "2")]
    pub signature: Option<Signature>,
}

/// Report of an automatic referee.
#[derive(Clone, PartialEq, Message)]
pub struct AutoRefToController {
    /// Signature of the sender.
    #[prost(message, optional, tag = "1")]
    pub signature: Option<Signature>,
    /// The event reported.
    #[prost(message, optional, tag = "2")]
    pub game_event: Option<GameEvent>,
}

/// Messages from the controller to an automatic referee.
#[derive(Clone, PartialEq, Message)]
pub struct ControllerToAutoRef {
    /// The answer to its last message.
    #[prost(message, optional, tag = "1")]
    pub controller_reply: Option<ControllerReply>,
}

/// One step of an automatic referee whose clock the sender drives.
#[derive(Clone, PartialEq, Message)]
pub struct AutoRefCiInput {
    /// The referee's message.
    #[prost(message, optional, tag = "1")]
    pub referee_message: Option<Referee>,
    /// Frame of a tracker.
    #[prost(message, optional, tag = "2")]
    pub tracker_wrapper_packet: Option<TrackerWrapperPacket>,
    /// Detections of the cameras.
    #[prost(message, repeated, tag = "3")]
    pub detection: Vec<DetectionFrame>,
    /// Field geometry.
    #[prost(message, optional, tag = "4")]
    pub geometry: Option<GeometryData>,
}

/// Output of the step.
#[derive(Clone, PartialEq, Message)]
pub struct AutoRefCiOutput {
    /// Frame of its own tracker.
    #[prost(message, optional, tag = "1")]
    pub tracker_wrapper_packet: Option<TrackerWrapperPacket>,
}
