//! `api`: messages that drive the game controller. [`CiInput`] on port 10009; [`Input`] also as JSON text
//! over its web socket.
//!
//! The controller's inner state, settings and changes are its own; they stay encoded here (`Vec<u8>`), so
//! that they can be carried and stored.

use prost::Message;

use crate::common::Duration;
use crate::referee::Referee;
use crate::tracker::TrackerWrapperPacket;
use crate::vision::GeometryData;

/// One step of a controller whose clock the sender drives.
#[derive(Clone, PartialEq, Message)]
pub struct CiInput {
    /// The time now, ns, Unix time.
    #[prost(int64, optional, tag = "1")]
    pub timestamp: Option<i64>,
    /// Frame of a tracker.
    #[prost(message, optional, tag = "2")]
    pub tracker_packet: Option<TrackerWrapperPacket>,
    /// Buttons pressed in the interface.
    #[prost(message, repeated, tag = "3")]
    pub api_inputs: Vec<Input>,
    /// Field geometry.
    #[prost(message, optional, tag = "4")]
    pub geometry: Option<GeometryData>,
}

/// Output of the step: none, one or several a step.
#[derive(Clone, PartialEq, Message)]
pub struct CiOutput {
    /// The referee's message.
    #[prost(message, optional, tag = "1")]
    pub referee_msg: Option<Referee>,
}

/// A button pressed in the controller's interface.
#[derive(Clone, PartialEq, Message)]
pub struct Input {
    /// A change of the match, encoded.
    #[prost(bytes = "vec", optional, tag = "1")]
    pub change: Option<Vec<u8>>,
    /// Restart the match.
    #[prost(bool, optional, tag = "2")]
    pub reset_match: Option<bool>,
    /// Changed settings, encoded.
    #[prost(bytes = "vec", optional, tag = "3")]
    pub config_delta: Option<Vec<u8>>,
    /// A continue action, encoded.
    #[prost(bytes = "vec", optional, tag = "4")]
    pub continue_action: Option<Vec<u8>>,
}

/// State for the controller's interface; absent parts did not change.
#[derive(Clone, PartialEq, Message)]
pub struct Output {
    /// Score, cards and further state of the match, encoded.
    #[prost(bytes = "vec", optional, tag = "1")]
    pub match_state: Option<Vec<u8>>,
    /// Connected programs and continue actions, encoded.
    #[prost(bytes = "vec", optional, tag = "2")]
    pub gc_state: Option<Vec<u8>>,
    /// Protocol of the match so far.
    #[prost(message, optional, tag = "3")]
    pub protocol: Option<Protocol>,
    /// Settings of the controller, encoded.
    #[prost(bytes = "vec", optional, tag = "4")]
    pub config: Option<Vec<u8>>,
}

/// Protocol of the match so far.
#[derive(Clone, PartialEq, Message)]
pub struct Protocol {
    /// True: only new entries.
    #[prost(bool, optional, tag = "1")]
    pub delta: Option<bool>,
    /// Entries, newest first.
    #[prost(message, repeated, tag = "2")]
    pub entry: Vec<ProtocolEntry>,
}

/// Entry of one change.
#[derive(Clone, PartialEq, Message)]
pub struct ProtocolEntry {
    /// Number of the change.
    #[prost(int32, optional, tag = "1")]
    pub id: Option<i32>,
    /// The change, encoded.
    #[prost(bytes = "vec", optional, tag = "2")]
    pub change: Option<Vec<u8>>,
    /// Since the start of the match.
    #[prost(message, optional, tag = "3")]
    pub match_time_elapsed: Option<Duration>,
    /// Since the start of the stage.
    #[prost(message, optional, tag = "4")]
    pub stage_time_elapsed: Option<Duration>,
}
