//! `legacy`: vision packets of 2014. The same detections with a flat geometry (port 10005, log message type
//! 2).
//!
//! Units: mm, rad, s, as today. The defence area was a quarter circle round each post.

use prost::Message;

use super::{DetectionFrame, GeometryCameraCalibration};

messages! {
    /// The field as eleven measures and three for restarts, mm.
    #[derive(Clone, Copy, PartialEq, Message)]
    pub struct GeometryFieldSize {
        /// Width of every line, mm.
        line_width: i32 [int32, required] = 1;
        /// Goal line to goal line, mm.
        field_length: i32 [int32, required] = 2;
        /// Touch line to touch line, mm.
        field_width: i32 [int32, required] = 3;
        /// Line to the referee's walk, mm.
        boundary_width: i32 [int32, required] = 4;
        /// Width of the referee's walk, mm.
        referee_width: i32 [int32, required] = 5;
        /// Between the posts, mm.
        goal_width: i32 [int32, required] = 6;
        /// Goal line to the goal's back, mm.
        goal_depth: i32 [int32, required] = 7;
        /// Thickness of the goal's walls, mm.
        goal_wall_width: i32 [int32, required] = 8;
        /// Radius of the centre circle, mm.
        center_circle_radius: i32 [int32, required] = 9;
        /// Radius of the defence area's quarter circles, mm.
        defense_radius: i32 [int32, required] = 10;
        /// Straight part of the defence area between them, mm.
        defense_stretch: i32 [int32, required] = 11;
        /// Free kick to the defence area, at least, mm.
        free_kick_from_defense_dist: i32 [int32, required] = 12;
        /// Goal line to penalty mark, mm.
        penalty_spot_from_field_line_dist: i32 [int32, required] = 13;
        /// Penalty mark to the line the others stay behind, mm.
        penalty_line_from_spot_dist: i32 [int32, required] = 14;
    }

    /// The field and its cameras.
    #[derive(Clone, PartialEq, Message)]
    pub struct GeometryData {
        /// Measures of the field, mm.
        field: GeometryFieldSize [message, required] = 1;
        /// Calibrations of the cameras, by camera id.
        calib: Vec<GeometryCameraCalibration> [message, repeated] = 2;
    }

    /// A datagram of vision in 2014: a camera's frame, the field, or both.
    #[derive(Clone, PartialEq, Message)]
    pub struct WrapperPacket {
        /// Detections of one camera.
        detection: Option<DetectionFrame> [message, optional] = 1;
        /// The field and cameras.
        geometry: Option<GeometryData> [message, optional] = 2;
    }
}
