//! `custom`: messages of ER-Force's simulator and its relatives, which travel in `custom` fields as
//! [`crate::common::Any`].
//!
//! Units: m, rad, ns as named. The `type_url` must match: ER-Force has the specification in package `sslsim`,
//! the realism in none.

use prost::Message;

/// Deviations of ER-Force's simulator from an ideal camera and radio.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct RealismConfigErForce {
    /// Noise of the ball's position, m (standard deviation).
    #[prost(float, optional, tag = "1")]
    pub stddev_ball_p: Option<f32>,
    /// Noise of a robot's position, m.
    #[prost(float, optional, tag = "2")]
    pub stddev_robot_p: Option<f32>,
    /// Noise of a robot's heading, rad.
    #[prost(float, optional, tag = "3")]
    pub stddev_robot_phi: Option<f32>,
    /// Noise of the ball's area, px.
    #[prost(float, optional, tag = "4")]
    pub stddev_ball_area: Option<f32>,
    /// Robots can hide the ball from the camera.
    #[prost(bool, optional, tag = "5")]
    pub enable_invisible_ball: Option<bool>,
    /// The ball is detected where at least this part of it is visible, 0–1.
    #[prost(float, optional, tag = "6")]
    pub ball_visibility_threshold: Option<f32>,
    /// Overlap of the cameras' views, m.
    #[prost(float, optional, tag = "7")]
    pub camera_overlap: Option<f32>,
    /// False balls detected at dribblers, probability.
    #[prost(float, optional, tag = "8")]
    pub dribbler_ball_detections: Option<f32>,
    /// Error of the reported camera positions, m.
    #[prost(float, optional, tag = "9")]
    pub camera_position_error: Option<f32>,
    /// Commands lost in transmission, probability.
    #[prost(float, optional, tag = "10")]
    pub robot_command_loss: Option<f32>,
    /// Feedback lost in transmission, probability.
    #[prost(float, optional, tag = "11")]
    pub robot_response_loss: Option<f32>,
    /// Balls not detected, probability a frame.
    #[prost(float, optional, tag = "12")]
    pub missing_ball_detections: Option<f32>,
    /// Latency from camera frame to packet, ns.
    #[prost(int64, optional, tag = "13")]
    pub vision_delay: Option<i64>,
    /// Part of it that `t_sent` − `t_capture` includes, ns.
    #[prost(int64, optional, tag = "14")]
    pub vision_processing_time: Option<i64>,
    /// Simulate the dribbler's roller instead of a force.
    #[prost(bool, optional, tag = "15")]
    pub simulate_dribbling: Option<bool>,
    /// Shift of detections, growing with the distance to the camera's centre, m.
    #[prost(float, optional, tag = "16")]
    pub object_position_offset: Option<f32>,
    /// Robots not detected, probability a frame.
    #[prost(float, optional, tag = "17")]
    pub missing_robot_detections: Option<f32>,
    /// Latency from command to effect, ns.
    #[prost(uint64, optional, tag = "18")]
    pub command_delay: Option<u64>,
}

/// Dimensions of a robot's dribbler opening.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct RobotSpecErForce {
    /// Distance from the centre to the kicker, m.
    #[prost(float, optional, tag = "1")]
    pub shoot_radius: Option<f32>,
    /// Width of the dribbler, m.
    #[prost(float, optional, tag = "3")]
    pub dribbler_width: Option<f32>,
}
