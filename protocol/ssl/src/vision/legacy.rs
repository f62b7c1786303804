//! `legacy`: vision packets of 2014. The same detections with a flat geometry (port 10005, log message type
//! 2).
//!
//! Units: mm, rad, s, as today. The defence area was a quarter circle round each post.

use prost::Message;

use super::{DetectionFrame, GeometryCameraCalibration};

/// Field geometry: eleven dimensions and three for restarts, mm.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct GeometryFieldSize {
    /// Width of every line, mm.
    #[prost(int32, required, tag = "1")]
    pub line_width: i32,
    /// Goal line to goal line, mm.
    #[prost(int32, required, tag = "2")]
    pub field_length: i32,
    /// Touch line to touch line, mm.
    #[prost(int32, required, tag = "3")]
    pub field_width: i32,
    /// Line to the referee's walk, mm.
    #[prost(int32, required, tag = "4")]
    pub boundary_width: i32,
    /// Width of the referee's walk, mm.
    #[prost(int32, required, tag = "5")]
    pub referee_width: i32,
    /// Between the posts, mm.
    #[prost(int32, required, tag = "6")]
    pub goal_width: i32,
    /// Goal line to the goal's back, mm.
    #[prost(int32, required, tag = "7")]
    pub goal_depth: i32,
    /// Thickness of the goal's walls, mm.
    #[prost(int32, required, tag = "8")]
    pub goal_wall_width: i32,
    /// Radius of the centre circle, mm.
    #[prost(int32, required, tag = "9")]
    pub center_circle_radius: i32,
    /// Radius of the defence area's quarter circles, mm.
    #[prost(int32, required, tag = "10")]
    pub defense_radius: i32,
    /// Straight part of the defence area between them, mm.
    #[prost(int32, required, tag = "11")]
    pub defense_stretch: i32,
    /// Free kick to the defence area, at least, mm.
    #[prost(int32, required, tag = "12")]
    pub free_kick_from_defense_dist: i32,
    /// Goal line to penalty mark, mm.
    #[prost(int32, required, tag = "13")]
    pub penalty_spot_from_field_line_dist: i32,
    /// Penalty mark to the line the others stay behind, mm.
    #[prost(int32, required, tag = "14")]
    pub penalty_line_from_spot_dist: i32,
}

/// The field and its cameras.
#[derive(Clone, PartialEq, Message)]
pub struct GeometryData {
    /// Dimensions of the field.
    #[prost(message, required, tag = "1")]
    pub field: GeometryFieldSize,
    /// Calibration of the cameras.
    #[prost(message, repeated, tag = "2")]
    pub calib: Vec<GeometryCameraCalibration>,
}

/// A datagram of vision in 2014: a camera's frame, the field, or both.
#[derive(Clone, PartialEq, Message)]
pub struct WrapperPacket {
    /// Detections of one camera.
    #[prost(message, optional, tag = "1")]
    pub detection: Option<DetectionFrame>,
    /// The field and cameras.
    #[prost(message, optional, tag = "2")]
    pub geometry: Option<GeometryData>,
}
