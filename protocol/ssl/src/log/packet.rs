//! `packet`: decoding of a payload.

use prost::Message;

use super::{MessageKind, guess};
use crate::{referee, tracker, vision};

/// A message of a log file, decoded.
#[derive(Clone, Debug, PartialEq)]
pub enum Packet {
    /// Vision packet of the present format.
    Vision(vision::WrapperPacket),
    /// Vision packet until 2014.
    VisionLegacy(vision::legacy::WrapperPacket),
    /// A packet of the game controller.
    Referee(referee::Referee),
    /// A packet of a tracker.
    Tracker(tracker::TrackerWrapperPacket),
}

impl Packet {
    /// Decodes a payload of the type `kind`, or of the type that [`guess`] finds where it is `Unknown`;
    /// `None` for blank and index.
    pub fn decode(kind: MessageKind, payload: &[u8]) -> Result<Option<Self>, PacketError> {
        let broken = |kind| move |error| PacketError::Broken { kind, error };
        let packet = match kind {
            MessageKind::Blank | MessageKind::Index2021 => return Ok(None),
            MessageKind::Vision2014 => Self::Vision(Message::decode(payload).map_err(broken(kind))?),
            MessageKind::Vision2010 => Self::VisionLegacy(Message::decode(payload).map_err(broken(kind))?),
            MessageKind::Refbox2013 => Self::Referee(Message::decode(payload).map_err(broken(kind))?),
            MessageKind::Tracker2020 => Self::Tracker(Message::decode(payload).map_err(broken(kind))?),
            MessageKind::Unknown => {
                let found = guess(payload).ok_or(PacketError::NothingKnown)?;
                return Self::decode(found, payload);
            }
            MessageKind::Other(number) => return Err(PacketError::KindNotKnown(number)),
        };
        Ok(Some(packet))
    }

    /// The kind under which a log file stores it.
    pub const fn kind(&self) -> MessageKind {
        match self {
            Self::Vision(_) => MessageKind::Vision2014,
            Self::VisionLegacy(_) => MessageKind::Vision2010,
            Self::Referee(_) => MessageKind::Refbox2013,
            Self::Tracker(_) => MessageKind::Tracker2020,
        }
    }
}

/// A payload without a message.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PacketError {
    /// The payload is not of its declared type.
    #[error("{kind}: {error}")]
    Broken {
        /// The type that the log declares.
        kind: MessageKind,
        /// Error of the decoder.
        error: prost::DecodeError,
    },
    /// The type is not one of the league's.
    #[error("message type {0} is not one of the league's (0–6)")]
    KindNotKnown(i32),
    /// The type is `Unknown`, and the payload is none of the known messages.
    #[error("neither vision nor referee nor tracker")]
    NothingKnown,
}
