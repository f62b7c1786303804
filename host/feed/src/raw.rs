//! `raw`: unfiltered detections. The newest frame of each camera, decoded only when it is displayed.

use std::collections::{BTreeMap, VecDeque};

use page::{Raw, milli};
use rules::Colour;
use ssl::Message;
use ssl::vision::{DetectionFrame, WrapperPacket};

/// Number of newest packets that are kept: they hold a frame of each camera, of which a field has at most
/// eight.
const PACKETS_MAX: usize = 8;
/// A camera whose frame is older than the newest by more than this, s, is left out: it sees nothing any more.
const OLD_S: f64 = 0.2;

#[derive(Debug, Default)]
pub(super) struct Images {
    packets: VecDeque<Vec<u8>>,
    /// Packets so far, for rates.
    pub(super) count: u64,
}

impl Images {
    pub(super) fn receive(&mut self, bytes: &[u8]) {
        self.count += 1;
        // The oldest packet's buffer is used again.
        let mut room = if self.packets.len() >= PACKETS_MAX {
            self.packets.pop_front().unwrap_or_default()
        } else {
            Vec::new()
        };
        room.clear();
        room.extend_from_slice(bytes);
        self.packets.push_back(room);
    }

    pub(super) fn seen(&self) -> Raw {
        let mut cameras: BTreeMap<u32, DetectionFrame> = BTreeMap::new();
        for packet in &self.packets {
            let frame = WrapperPacket::decode(&packet[..]).ok().and_then(|packet| packet.detection);
            cameras.extend(frame.map(|frame| (frame.camera_id, frame)));
        }
        let newest = cameras.values().map(|frame| frame.t_capture).fold(f64::NEG_INFINITY, f64::max);
        let mut raw = Raw::default();
        for frame in cameras.values().filter(|frame| newest - frame.t_capture < OLD_S) {
            raw.balls.extend(frame.balls.iter().map(|ball| [metres(ball.x), metres(ball.y)]));
            for (colour, robots) in
                [(Colour::Yellow, &frame.robots_yellow), (Colour::Blue, &frame.robots_blue)]
            {
                raw.robots.extend(robots.iter().map(|robot| {
                    let id = robot.robot_id.and_then(|id| u8::try_from(id).ok()).unwrap_or(u8::MAX);
                    let heading = milli(robot.orientation.unwrap_or_default());
                    (super::team(colour), id, metres(robot.x), metres(robot.y), heading)
                }));
            }
        }
        raw
    }
}

fn metres(mm: f32) -> f32 {
    milli(mm * 0.001)
}

#[cfg(test)]
mod tests {
    use ssl::vision::DetectionRobot;

    use super::*;

    fn image(camera: u32, t: f64, x: f32) -> Vec<u8> {
        let robot = DetectionRobot { robot_id: Some(3), x, ..DetectionRobot::default() };
        let frame = DetectionFrame {
            camera_id: camera,
            t_capture: t,
            robots_blue: vec![robot],
            ..DetectionFrame::default()
        };
        WrapperPacket { detection: Some(frame), ..WrapperPacket::default() }.encode_to_vec()
    }

    #[test]
    fn the_newest_image_of_each_camera_is_displayed_and_a_dead_camera_is_not() {
        let mut images = Images::default();
        for (camera, t, x) in [(2, 0.5, 900.0), (0, 1.0, 100.0), (1, 1.0, 200.0), (0, 1.02, 110.0)] {
            images.receive(&image(camera, t, x));
        }
        let xs: Vec<f32> = images.seen().robots.iter().map(|robot| robot.2).collect();
        assert_eq!(xs, [0.11, 0.2]);
    }
}
