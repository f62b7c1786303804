//! `cameras`: what each camera sends: rate, losses by frame number, delay by the sender's clock. s, ms.

use std::collections::BTreeMap;

use page::{CameraNote, milli};
use ssl::vision::FrameHead;

use super::windows::{Peak, Window, Worst};

/// A field has at most this many cameras; further numbers are not kept.
const CAMERAS_MAX: usize = 16;
/// A frame number that jumps by more than this is a restarted camera, not a loss: 1 s at 100 Hz.
const JUMP_MAX: u32 = 100;

#[derive(Debug, Default)]
pub(super) struct Cameras {
    cameras: BTreeMap<u32, Camera>,
}

#[derive(Debug, Default)]
struct Camera {
    last: Option<u32>,
    frames: u64,
    lost: u64,
    /// Sum of its delays, ms.
    delay_ms: f64,
    /// Number of its frames when looked at last, and when they had last risen.
    seen: (u64, f64),
    window: Window<3>,
    peaks: [Peak; 3],
}

impl Cameras {
    pub(super) fn receive(&mut self, bytes: &[u8]) {
        let Some(head) = FrameHead::of(bytes) else { return };
        if self.cameras.len() >= CAMERAS_MAX && !self.cameras.contains_key(&head.camera_id) {
            return;
        }
        let camera = self.cameras.entry(head.camera_id).or_default();
        let ahead = camera.last.map_or(1, |last| head.frame_number.wrapping_sub(last));
        if ahead == 0 || ahead > u32::MAX / 2 {
            // A copy, or a frame that was overtaken: it was counted as lost.
            camera.lost -= u64::from(ahead != 0 && camera.lost > 0);
        } else {
            camera.lost += if ahead <= JUMP_MAX { u64::from(ahead - 1) } else { 0 };
            camera.last = Some(head.frame_number);
        }
        camera.frames += 1;
        let delay = (head.t_sent - head.t_capture) * 1e3;
        camera.delay_ms += if (0.0..10_000.0).contains(&delay) { delay } else { 0.0 };
    }

    pub(super) fn look(&mut self, t: f64) -> Vec<CameraNote> {
        self.cameras.iter_mut().map(|(id, camera)| camera.look(*id, t)).collect()
    }
}

impl Camera {
    fn look(&mut self, id: u32, t: f64) -> CameraNote {
        if self.frames != self.seen.0 || t < self.seen.1 {
            self.seen = (self.frames, t);
        }
        let over = self.window.of(t, [self.frames as f64, self.lost as f64, self.delay_ms]);
        let rate = over.map(|(length, [frames, ..])| frames / length);
        let delay = over.and_then(|(_, [frames, _, ms])| (frames > 0.0).then(|| ms / frames));
        let lost = over
            .and_then(|(_, [frames, lost, _])| (frames + lost > 0.0).then(|| 100.0 * lost / (frames + lost)));
        let [frames, delays, losses] = &mut self.peaks;
        CameraNote {
            id,
            frames: frames.of(t, rate, Worst::Lowest),
            delay_ms: delays.of(t, delay, Worst::Largest),
            lost: losses.of(t, lost, Worst::Largest),
            lost_total: self.lost,
            age_ms: milli(((t - self.seen.1) * 1e3) as f32),
        }
    }
}

#[cfg(test)]
mod tests {
    use ssl::Message;
    use ssl::vision::{DetectionFrame, WrapperPacket};

    use super::*;

    fn frame(camera_id: u32, frame_number: u32, delay_s: f64) -> Vec<u8> {
        let t_capture = f64::from(frame_number) * 0.01;
        let t_sent = t_capture + delay_s;
        let frame =
            DetectionFrame { camera_id, frame_number, t_capture, t_sent, ..DetectionFrame::default() };
        WrapperPacket { detection: Some(frame), ..WrapperPacket::default() }.encode_to_vec()
    }

    #[test]
    fn rate_loss_and_delay_of_each_camera_are_its_own() {
        let mut cameras = Cameras::default();
        let mut notes = Vec::new();
        for i in 0..400_u32 {
            // Camera 0 at 100 Hz; of camera 1 every fourth frame is lost, and none comes after 3 s.
            cameras.receive(&frame(0, i, 0.008));
            if i % 4 != 2 && i < 300 {
                cameras.receive(&frame(1, i, 0.020));
            }
            notes = cameras.look(f64::from(i) * 0.01);
            if i == 299 {
                let [frames, lost] = [notes[1].frames[0], notes[1].lost[0]].map(Option::unwrap_or_default);
                assert!((frames - 75.0).abs() < 1.5 && (lost - 25.0).abs() < 1.5, "{frames} {lost}");
            }
        }
        let [zero, one] = [notes[0], notes[1]];
        assert!((zero.frames[0].unwrap_or_default() - 100.0).abs() < 1.5 && zero.lost_total == 0);
        assert_eq!((zero.delay_ms, zero.age_ms), ([Some(8.0); 2], 0.0));
        assert_eq!((one.frames, one.delay_ms[0]), ([Some(0.0); 2], None));
        assert!(one.delay_ms[1].is_some_and(|ms| (ms - 20.0).abs() < 0.01));
        assert!((one.age_ms - 1_000.0).abs() < 20.0 && one.lost_total >= 74, "{one:?}");
    }

    #[test]
    fn a_restart_is_no_loss_and_an_overtaken_frame_is_found_again() {
        let mut cameras = Cameras::default();
        for number in [1_u32, 2, 4, 3, 5, 900_000, 1, 2] {
            cameras.receive(&frame(0, number, 0.0));
        }
        assert_eq!(cameras.look(0.0)[0].lost_total, 0);
        cameras.receive(b"no packet");
        for id in 1..100 {
            cameras.receive(&frame(id, 1, 0.0));
        }
        assert_eq!(cameras.look(0.0).len(), CAMERAS_MAX);
    }
}
