//! `vision`: packets of SSL-Vision. One [`WrapperPacket`] a datagram, to 224.5.23.2:10006 (simulators:
//! 10020).
//!
//! Units: mm and rad in the field frame, times in s as `f64`: Unix time, but grSim counts from its own start
//! (README, trap 1). Fields that newer versions added are optional here; older ones lack them.

mod decoder;
mod detection;
mod geometry;
mod head;
pub mod legacy;

use prost::{Enumeration, Message};

pub use decoder::Decoder;
pub use detection::{DetectionBall, DetectionFrame, DetectionRobot};
pub use geometry::{
    BallModelChipFixedLoss, BallModelStraightTwoPhase, FieldCircularArc, FieldLineSegment, FieldShapeType,
    GeometryCameraCalibration, GeometryData, GeometryFieldSize, GeometryModels, Vector2f,
};
pub use head::FrameHead;

messages! {
    /// A datagram of vision: a camera's frame, the field, or both.
    #[derive(Clone, PartialEq, Message)]
    pub struct WrapperPacket {
        /// Detections of one camera.
        detection: Option<DetectionFrame> [message, optional] = 1;
        /// The field and cameras; grSim sends one camera's calibration a packet, so merge by camera id.
        geometry: Option<GeometryData> [message, optional] = 2;
        /// Kind of program that sent it, [`Source`]; most leave it out.
        source: Option<i32> [enumeration = "Source", optional] = 3;
    }
}

/// Program that sends vision.
#[expect(missing_docs, reason = "the league's own names")]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Enumeration)]
#[repr(i32)]
pub enum Source {
    Unknown = 0,
    Other = 1,
    SslVision = 2,
    VisionProcessor = 3,
    Grsim = 4,
    ErforceSim = 5,
}
