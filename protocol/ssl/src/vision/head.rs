//! `head`: camera, number and times of a camera frame, without what it shows. Times in s.

use prost::Message;

use crate::wire::{Fields, Value};

/// Identification of a camera frame. Decoding skips its balls and robots.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct FrameHead {
    /// Counts this camera's images.
    #[prost(uint32, required, tag = "1")]
    pub frame_number: u32,
    /// Time of the image, s, on the sender's clock.
    #[prost(double, required, tag = "2")]
    pub t_capture: f64,
    /// Time of sending, s, on the same clock.
    #[prost(double, required, tag = "3")]
    pub t_sent: f64,
    /// Number of the camera, from 0.
    #[prost(uint32, required, tag = "4")]
    pub camera_id: u32,
}

impl FrameHead {
    /// Reads the head of a datagram of vision; `None` where it has no camera frame, or cannot be read.
    pub fn of(packet: &[u8]) -> Option<Self> {
        let detection = Fields::of(packet).map_while(Result::ok).find_map(|field| match field.value {
            Value::Bytes(bytes) if field.number == 1 => Some(bytes),
            _ => None,
        })?;
        Self::decode(detection).ok()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vision::{DetectionFrame, DetectionRobot, WrapperPacket};

    #[test]
    fn the_head_is_the_frame_s_own() {
        let robots_blue = vec![DetectionRobot { robot_id: Some(3), x: 120.0, ..DetectionRobot::default() }];
        let frame = DetectionFrame {
            frame_number: 9,
            t_capture: 1.25,
            t_sent: 1.5,
            camera_id: 2,
            robots_blue,
            ..DetectionFrame::default()
        };
        let packet = WrapperPacket { detection: Some(frame), ..WrapperPacket::default() }.encode_to_vec();
        let head = FrameHead { frame_number: 9, t_capture: 1.25, t_sent: 1.5, camera_id: 2 };
        assert_eq!(FrameHead::of(&packet), Some(head));
        assert_eq!(FrameHead::of(&WrapperPacket::default().encode_to_vec()), None);
        assert_eq!(FrameHead::of(&packet[..5]), None);
    }
}
