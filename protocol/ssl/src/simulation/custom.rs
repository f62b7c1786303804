//! `custom`: messages of ER-Force's simulator and its relatives, which travel in `custom` fields as
//! [`crate::common::Any`].
//!
//! Units: m, rad, ns as named. The `type_url` must match: ER-Force has the specification in package `sslsim`,
//! the realism in none.

use prost::Message;

messages! {
    /// Deviations of ER-Force's simulator from an ideal camera and radio.
    #[derive(Clone, Copy, PartialEq, Message)]
    pub struct RealismConfigErForce {
        /// Noise of the ball's place, m (standard deviation).
        stddev_ball_p: Option<f32> [float, optional] = 1;
        /// Noise of a robot's place, m.
        stddev_robot_p: Option<f32> [float, optional] = 2;
        /// Noise of a robot's heading, rad.
        stddev_robot_phi: Option<f32> [float, optional] = 3;
        /// Noise of the ball's area, px.
        stddev_ball_area: Option<f32> [float, optional] = 4;
        /// Robots can hide the ball from the camera.
        enable_invisible_ball: Option<bool> [bool, optional] = 5;
        /// The ball is seen where at least this part of it shows, 0–1.
        ball_visibility_threshold: Option<f32> [float, optional] = 6;
        /// Overlap of the cameras' views, m.
        camera_overlap: Option<f32> [float, optional] = 7;
        /// False balls seen at dribblers, probability.
        dribbler_ball_detections: Option<f32> [float, optional] = 8;
        /// Error of the announced camera positions, m.
        camera_position_error: Option<f32> [float, optional] = 9;
        /// Commands lost in transmission, probability.
        robot_command_loss: Option<f32> [float, optional] = 10;
        /// Feedback lost in transmission, probability.
        robot_response_loss: Option<f32> [float, optional] = 11;
        /// Balls not seen, probability a frame.
        missing_ball_detections: Option<f32> [float, optional] = 12;
        /// Image to packet, ns.
        vision_delay: Option<i64> [int64, optional] = 13;
        /// Part of it that `t_sent` − `t_capture` reports, ns.
        vision_processing_time: Option<i64> [int64, optional] = 14;
        /// Simulate the dribbler's roller instead of a force.
        simulate_dribbling: Option<bool> [bool, optional] = 15;
        /// Shift of what is seen, growing with the distance to the camera's centre, m.
        object_position_offset: Option<f32> [float, optional] = 16;
        /// Robots not seen, probability a frame.
        missing_robot_detections: Option<f32> [float, optional] = 17;
        /// Command to effect, ns.
        command_delay: Option<u64> [uint64, optional] = 18;
    }

    /// Measures of a robot's dribbler opening.
    #[derive(Clone, Copy, PartialEq, Message)]
    pub struct RobotSpecErForce {
        /// Centre to the kicker, m.
        shoot_radius: Option<f32> [float, optional] = 1;
        /// Width of the dribbler, m.
        dribbler_width: Option<f32> [float, optional] = 3;
    }
}
