//! `detection`: detections of a camera. Units: mm and rad in the field frame, confidence 0–1, times in s.

use prost::Message;

messages! {
    /// One orange blob, detected as a ball.
    #[derive(Clone, Copy, PartialEq, Message)]
    pub struct DetectionBall {
        /// Confidence that it is a ball, 0–1.
        confidence: f32 [float, required] = 1;
        /// Pixels of the blob.
        area: Option<u32> [uint32, optional] = 2;
        /// Along the field's length, mm.
        x: f32 [float, required] = 3;
        /// Coordinate to the left of +x, mm.
        y: f32 [float, required] = 4;
        /// Height, mm; set by few systems.
        z: Option<f32> [float, optional] = 5;
        /// Column in the camera's image, px; simulators send dummies.
        pixel_x: f32 [float, required] = 6;
        /// Row in the camera's image, px; simulators send dummies.
        pixel_y: f32 [float, required] = 7;
    }

    /// One pattern of markers.
    #[derive(Clone, Copy, PartialEq, Message)]
    pub struct DetectionRobot {
        /// Confidence in the pattern, 0–1.
        confidence: f32 [float, required] = 1;
        /// Shell number, 0–15; absent where only the centre marker was seen.
        robot_id: Option<u32> [uint32, optional] = 2;
        /// Along the field's length, mm.
        x: f32 [float, required] = 3;
        /// Coordinate to the left of +x, mm.
        y: f32 [float, required] = 4;
        /// Heading, rad, counter-clockwise from +x; absent where only the centre marker was seen.
        orientation: Option<f32> [float, optional] = 5;
        /// Column in the camera's image, px; simulators send dummies.
        pixel_x: f32 [float, required] = 6;
        /// Row in the camera's image, px; simulators send dummies.
        pixel_y: f32 [float, required] = 7;
        /// Height of the pattern, mm.
        height: Option<f32> [float, optional] = 8;
    }

    /// Detections of one camera in one image.
    #[derive(Clone, PartialEq, Message)]
    pub struct DetectionFrame {
        /// Counts this camera's images.
        frame_number: u32 [uint32, required] = 1;
        /// Time of the image, s: Unix time, or the simulation's own (README, trap 1).
        t_capture: f64 [double, required] = 2;
        /// Time of sending, s, on the same clock.
        t_sent: f64 [double, required] = 3;
        /// Number of the camera, from 0.
        camera_id: u32 [uint32, required] = 4;
        /// Every orange blob: none or two are normal.
        balls: Vec<DetectionBall> [message, repeated] = 5;
        /// Robots with a yellow centre marker.
        robots_yellow: Vec<DetectionRobot> [message, repeated] = 6;
        /// Robots with a blue centre marker.
        robots_blue: Vec<DetectionRobot> [message, repeated] = 7;
        /// Time of the image by the camera's own clock, s.
        t_capture_camera: Option<f64> [double, optional] = 8;
    }
}
