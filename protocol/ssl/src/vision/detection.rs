//! `detection`: detections of a camera. Units: mm and rad in the field frame, confidence 0–1, times in s.

use prost::Message;

/// Detection of one orange blob.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct DetectionBall {
    /// Confidence that it is a ball, 0–1.
    #[prost(float, required, tag = "1")]
    pub confidence: f32,
    /// Area of the blob, px.
    #[prost(uint32, optional, tag = "2")]
    pub area: Option<u32>,
    /// Along the field's length, mm.
    #[prost(float, required, tag = "3")]
    pub x: f32,
    /// Coordinate to the left of +x, mm.
    #[prost(float, required, tag = "4")]
    pub y: f32,
    /// Height, mm; set by few programs.
    #[prost(float, optional, tag = "5")]
    pub z: Option<f32>,
    /// Column in the camera frame, px; simulators send dummies.
    #[prost(float, required, tag = "6")]
    pub pixel_x: f32,
    /// Row in the camera frame, px; simulators send dummies.
    #[prost(float, required, tag = "7")]
    pub pixel_y: f32,
}

/// Detection of one marker pattern.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct DetectionRobot {
    /// Confidence of the pattern, 0–1.
    #[prost(float, required, tag = "1")]
    pub confidence: f32,
    /// Shell number, 0–15; absent where only the centre marker was detected.
    #[prost(uint32, optional, tag = "2")]
    pub robot_id: Option<u32>,
    /// Along the field's length, mm.
    #[prost(float, required, tag = "3")]
    pub x: f32,
    /// Coordinate to the left of +x, mm.
    #[prost(float, required, tag = "4")]
    pub y: f32,
    /// Heading, rad, counter-clockwise from +x; absent where only the centre marker was detected.
    #[prost(float, optional, tag = "5")]
    pub orientation: Option<f32>,
    /// Column in the camera frame, px; simulators send dummies.
    #[prost(float, required, tag = "6")]
    pub pixel_x: f32,
    /// Row in the camera frame, px; simulators send dummies.
    #[prost(float, required, tag = "7")]
    pub pixel_y: f32,
    /// Height of the pattern, mm.
    #[prost(float, optional, tag = "8")]
    pub height: Option<f32>,
}

/// Detections of one camera in one camera frame.
#[derive(Clone, PartialEq, Message)]
pub struct DetectionFrame {
    /// Counts this camera's frames.
    #[prost(uint32, required, tag = "1")]
    pub frame_number: u32,
    /// Capture time of the camera frame, s: Unix time, or the simulation's own (README, trap 1).
    #[prost(double, required, tag = "2")]
    pub t_capture: f64,
    /// When the packet was sent, s, on the same clock.
    #[prost(double, required, tag = "3")]
    pub t_sent: f64,
    /// Number of the camera.
    #[prost(uint32, required, tag = "4")]
    pub camera_id: u32,
    /// Every orange blob: none or two are normal.
    #[prost(message, repeated, tag = "5")]
    pub balls: Vec<DetectionBall>,
    /// Robots with a yellow centre marker.
    #[prost(message, repeated, tag = "6")]
    pub robots_yellow: Vec<DetectionRobot>,
    /// Robots with a blue centre marker.
    #[prost(message, repeated, tag = "7")]
    pub robots_blue: Vec<DetectionRobot>,
    /// Capture time of the camera frame by the camera's own clock, s.
    #[prost(double, optional, tag = "8")]
    pub t_capture_camera: Option<f64>,
}
