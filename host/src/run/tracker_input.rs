//! `tracker_input`: the tracker of another program as input: its frames take the place of vision's camera
//! frames while they come, and vision takes over where they fall silent. Sans-IO; times on the host's clock.
//!
//! A tracked frame is handed on as a camera frame of one camera that sees the whole field, so that everything
//! behind it (motion, radio, page, recording) is the same for both. At any time one source alone is used:
//! geometry always comes from vision. The height of a flying ball is not used.

use protocol::{Duration, Instant};
use ssl::Message;
use ssl::tracker::{TeamColor, TrackedFrame, TrackerWrapperPacket};
use ssl::vision::{DetectionBall, DetectionFrame, DetectionRobot, WrapperPacket};

use crate::config::TrackerIn;
use crate::field_geometry::CAMERAS_MAX;

/// A tracker that is silent for longer is replaced by vision: three frames at 60 Hz, after which robots would
/// be blind. A late frame costs nothing: vision shows the same field.
const SILENT_AFTER: Duration = Duration::millis(50);
/// It is used (again) once it has come without such a gap for this long: one that stutters must not make the
/// field jump between two sources with every gap.
const STEADY_FOR: Duration = Duration::millis(500);
/// The camera that its frames are of: the last number, which no field has.
const CAMERA: u32 = CAMERAS_MAX - 1;
/// m in mm.
const MM: f32 = 1000.0;

/// The followed tracker, and whether it is used.
#[derive(Debug)]
pub(super) struct TrackerInput {
    wanted: TrackerIn,
    /// Identifier of our own packets, which are never followed.
    own: String,
    /// Identifier and name of the source that is followed.
    source: Option<(String, String)>,
    newest: Option<Instant>,
    steady_since: Instant,
    frames: u32,
    used: bool,
}

impl TrackerInput {
    /// Follows what `wanted` names; not packets of `own`.
    pub(super) fn new(wanted: TrackerIn, own: String) -> Self {
        let steady_since = Instant(0);
        Self { wanted, own, source: None, newest: None, steady_since, frames: 0, used: false }
    }

    /// The datagram as vision's, if the tracker is the one that is used now.
    pub(super) fn receive(&mut self, now: Instant, bytes: &[u8]) -> Option<Vec<u8>> {
        let packet = TrackerWrapperPacket::decode(bytes).ok()?;
        let frame = packet.tracked_frame.filter(|_| packet.uuid != self.own)?;
        let name = packet.source_name.unwrap_or_default();
        let wanted = self.wanted.name.as_deref();
        if wanted.is_some_and(|wanted| ![packet.uuid.as_str(), &name].contains(&wanted)) {
            return None;
        }
        let silent = self.is_silent(now);
        if !silent && self.source.as_ref().is_some_and(|(uuid, _)| *uuid != packet.uuid) {
            return None;
        }
        if silent {
            self.steady_since = now;
            self.source = Some((packet.uuid, name));
        }
        self.newest = Some(now);
        self.frames = self.frames.wrapping_add(1);
        self.is_used(now).then(|| vision_of(&frame, self.frames).encode_to_vec())
    }

    fn is_silent(&self, now: Instant) -> bool {
        self.newest.is_none_or(|newest| now.since(newest) > SILENT_AFTER)
    }

    /// Whether the tracker is used at this time, and vision's camera frames are not.
    pub(super) fn is_used(&self, now: Instant) -> bool {
        !self.is_silent(now) && now.since(self.steady_since) >= STEADY_FOR
    }

    /// What vision's datagram is used for: all of it, or its geometry alone; nothing where it has none.
    pub(super) fn vision(&self, now: Instant, bytes: Vec<u8>) -> Option<Vec<u8>> {
        if !self.is_used(now) {
            return Some(bytes);
        }
        let geometry = WrapperPacket::decode(&bytes[..]).ok()?.geometry?;
        Some(WrapperPacket { geometry: Some(geometry), ..WrapperPacket::default() }.encode_to_vec())
    }

    /// Where the field comes from, as it is shown.
    pub(super) fn source(&self, now: Instant) -> String {
        if self.is_used(now) { format!("tracker {}", self.name()) } else { "vision".to_owned() }
    }

    /// What is missing, for the page's health; none while the tracker is used.
    pub(super) fn missing(&self, now: Instant) -> Option<String> {
        let name = self.wanted.name.as_deref().map_or_else(String::new, |name| format!(" of {name}"));
        let address = self.wanted.address;
        (!self.is_used(now)).then(|| match &self.source {
            Some(_) => format!(
                "the tracker {} is silent: the field comes from vision until it has sent for 0.5 s",
                self.name()
            ),
            None => format!(
                "no tracker{name} is received at {address}: the field comes from vision; does it send there (--tracker-in)?"
            ),
        })
    }

    /// A line where the source of the field has changed since the last call.
    pub(super) fn look(&mut self, now: Instant) -> Option<String> {
        let used = self.is_used(now);
        (std::mem::replace(&mut self.used, used) != used)
            .then(|| format!("tracker  the field comes from {}", self.source(now)))
    }

    fn name(&self) -> &str {
        self.source.as_ref().map_or("", |(uuid, name)| if name.is_empty() { uuid } else { name })
    }
}

/// The camera frame that a tracked frame stands for.
fn vision_of(frame: &TrackedFrame, number: u32) -> WrapperPacket {
    // The first ball is the one in play; others would compete with it.
    let balls = frame.balls.iter().take(1).map(|ball| DetectionBall {
        confidence: ball.visibility.unwrap_or(1.0),
        x: ball.pos.x * MM,
        y: ball.pos.y * MM,
        ..DetectionBall::default()
    });
    let detection = DetectionFrame {
        frame_number: number,
        t_capture: frame.timestamp,
        t_sent: frame.timestamp,
        camera_id: CAMERA,
        balls: balls.collect(),
        robots_yellow: robots_of(frame, TeamColor::Yellow),
        robots_blue: robots_of(frame, TeamColor::Blue),
        t_capture_camera: None,
    };
    WrapperPacket { detection: Some(detection), ..WrapperPacket::default() }
}

fn robots_of(frame: &TrackedFrame, team: TeamColor) -> Vec<DetectionRobot> {
    let of_team = frame.robots.iter().filter(|robot| robot.robot_id.team_color == team as i32);
    let robots = of_team.map(|robot| DetectionRobot {
        confidence: robot.visibility.unwrap_or(1.0),
        robot_id: Some(robot.robot_id.id),
        x: robot.pos.x * MM,
        y: robot.pos.y * MM,
        orientation: Some(robot.orientation),
        ..DetectionRobot::default()
    });
    robots.collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tracking::{Publisher, Tracker};

    /// A ball at 1 m/s along +x, as vision sends it and as another program's tracker does.
    struct Both {
        tracker: Tracker,
        publisher: Publisher,
    }

    impl Both {
        fn at(&mut self, now: Instant, camera: u32) -> (Vec<u8>, Vec<u8>) {
            let t = now.0 as f64 * 1e-6;
            let ball = DetectionBall { confidence: 1.0, x: (t * 1000.0) as f32, ..DetectionBall::default() };
            let frame_number = (t * 60.0) as u32;
            let image = DetectionFrame {
                frame_number,
                t_capture: t,
                t_sent: t,
                camera_id: camera,
                balls: vec![ball],
                ..DetectionFrame::default()
            };
            let packet = WrapperPacket { detection: Some(image), ..WrapperPacket::default() };
            self.tracker.handle(&packet, now);
            let tracked = self.publisher.publish(&self.tracker).expect("a frame").encode_to_vec();
            (packet.encode_to_vec(), tracked)
        }
    }

    #[test]
    fn the_tracker_leads_vision_takes_over_in_its_silence_and_back() {
        let wanted = TrackerIn::parse("127.0.0.1:10010,other").expect("an address");
        let mut input = TrackerInput::new(wanted, "ours".to_owned());
        let mut both = Both { tracker: Tracker::default(), publisher: Publisher::new("uuid", "other") };
        let (mut host, mut used, mut lines) = (Tracker::default(), Vec::new(), Vec::new());
        for step in 0..180_u64 {
            let now = Instant(1_000_000 + step * 16_667);
            let (vision, tracked) = both.at(now, 0);
            let silent = (60..90).contains(&step);
            let frames =
                [(!silent).then(|| input.receive(now, &tracked)).flatten(), input.vision(now, vision)];
            let frames: Vec<_> = frames.into_iter().flatten().collect();
            assert!(frames.len() <= 1, "one source alone at step {step}");
            used.push(input.is_used(now));
            lines.extend(input.look(now));
            for bytes in frames {
                let packet = WrapperPacket::decode(&bytes[..]).expect("a packet");
                let camera = packet.detection.as_ref().expect("an image").camera_id;
                assert_eq!(camera == CAMERA, input.is_used(now), "step {step}");
                host.handle(&packet, now);
            }
            if step > 10 {
                let ball = host.world(now).ball.expect("a ball");
                assert!(
                    (ball.position.x() - (1.0 + step as f32 / 60.0)).abs() < 0.03,
                    "step {step}: {ball:?}"
                );
                assert!((ball.velocity.x() - 1.0).abs() < 0.2, "step {step}: {ball:?}");
            }
        }
        let changes: Vec<_> = (1..used.len()).filter(|step| used[*step] != used[step - 1]).collect();
        // From 0.5 s on; three frames after the last one; 0.5 s after the first one again.
        assert_eq!(changes, [30, 62, 120], "{lines:?}");
        assert_eq!(lines[0], "tracker  the field comes from tracker other");
        assert_eq!(lines[1], "tracker  the field comes from vision");
    }

    #[test]
    fn our_own_packets_and_other_sources_than_the_named_one_are_ignored() {
        let mut both = Both { tracker: Tracker::default(), publisher: Publisher::new("uuid", "other") };
        let (_, tracked) = both.at(Instant(1_000_000), 0);
        for (wanted, own) in [("127.0.0.1:10010", "uuid"), ("127.0.0.1:10010,autoref", "ours")] {
            let mut input = TrackerInput::new(TrackerIn::parse(wanted).expect("an address"), own.to_owned());
            input.receive(Instant(1_000_000), &tracked);
            assert_eq!(input.source, None, "{wanted}");
        }
    }
}
