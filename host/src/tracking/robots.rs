//! `robots`: robot tracking. One track per shell number and colour, merged over all cameras.
//!
//! A robot is confirmed once it was seen in several camera frames. A detection far from its robot's possible
//! place is a misread pattern until it stays there while the robot is seen nowhere else; a number read where
//! another robot stands is a wrong number. An unseen robot is extrapolated, its confidence falls, and after a
//! second it is dropped.

use geometry::{Angle, Field, Point, Pose, Vector};
use protocol::{Instant, RobotId, Who};
use rules::Colour;

use super::filter::{Freedom, Plane, Turning};
use super::seen::{Captured, Frame, RobotSeen};
use crate::world::{Robot, index};

/// Camera frames that confirm a robot: 50 ms of one camera; misread patterns of one or two frames are
/// excluded.
const FRAMES_TO_BELIEVE: u16 = 3;
/// Camera frames after which confidence is full.
const FRAMES_FULL: u16 = 10;
/// Detections nearer to each other than this are of one tick (two cameras see the robot), µs.
const TICK_US: Captured = 5_000;
/// A robot may be seen this far from its prediction, m: two cameras may disagree by 20 mm each (ER-Force's
/// "object position offset"), the remainder is margin below a robot's radius.
const GATE_M: f32 = 0.08;
/// Growth of that distance for every second unseen, m/s: the fastest robots' speed.
const GATE_GROWTH_M_S: f32 = 4.0;
/// Longest time for which that distance grows, s.
const GATE_TIME_MAX_S: f32 = 0.25;
/// Within this time a robot was seen "just now", s: six frames of 60 Hz, three of a camera with dropouts.
const SEEN_LATELY_S: f32 = 0.1;
/// The same for a slow camera, in times between its frames.
const GAPS_OF_PATIENCE: f32 = 1.25;
/// A robot that crosses from one camera's view into another's shows the cameras' clocks: it was seen by the
/// other within this time, µs, in this number of frames, and drives at least this fast, m/s.
const CROSSING_US: Captured = 100_000;
const CROSSING_FRAMES: u16 = FRAMES_FULL;
const CROSSING_SPEED_M_S: f32 = 1.0;
/// It is no farther off than this, m: another place is another robot.
const CROSSING_WITHIN_M: f32 = 0.7;
/// Two robots' centres are never nearer, m: the smallest hulls have a radius of 0.085 m, half of it is
/// certainly a misreading.
const SAME_PLACE_WITHIN_M: f32 = 0.09;
/// An unseen robot is extrapolated straight on for this time, s, then assumed to stand still.
const COASTS_FOR_S: f32 = 0.25;
/// Time unseen after which a robot is forgotten, s.
const FORGOTTEN_AFTER_S: f32 = 1.0;
/// Uncertainty of the heading after extrapolation, rad.
const LOST_HEADING_SIGMA_RAD: f32 = 1.0;
/// Standard deviations of a new robot's speed, m/s, and rate, rad/s.
const SPEED_SIGMA_M_S: f32 = 2.0;
const RATE_SIGMA_RAD_S: f32 = 5.0;
/// White acceleration, m²/s³: `steady` is a robot that holds its speed within 0.1 m/s; `changing` is 5 m/s²
/// held for 0.2 s.
const PLACE_FREEDOM: Freedom = Freedom { steady: 0.15, changing: 10.0 };
/// White angular acceleration, rad²/s³: as above with 0.3 rad/s, and 50 rad/s² held for 0.1 s.
const HEADING_FREEDOM: Freedom = Freedom { steady: 2.0, changing: 250.0 };
/// Weight of the newest detection in the quality.
const QUALITY_SHARE: f32 = 0.1;

/// Counts of robot detections by result.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct RobotCounts {
    /// Taken into a robot's track.
    pub taken: u64,
    /// Seen too seldom yet to be confirmed.
    pub new: u64,
    /// Farther from the robot of that number than it can have moved.
    pub jumped: u64,
    /// Detections where another robot stands: a wrong number or colour.
    pub wrong_name: u64,
}

#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Robots {
    believed: [[Option<Track>; RobotId::COUNT]; 2],
    candidates: [[Option<Track>; RobotId::COUNT]; 2],
    pub(super) counts: RobotCounts,
}

/// Noise of robot detections in camera frames.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RobotNoise {
    /// Standard deviation of a robot's coordinate, m.
    pub place: f32,
    /// Standard deviation of its heading, rad.
    pub heading: f32,
}

impl Default for RobotNoise {
    /// The noisier of the recordings (grSim with noise: 3.0 mm, 0.035 rad; ER-Force's "realistic": 1.3 mm,
    /// 0.010 rad; both from second differences, `cargo run -p onetwo-host --example track`).
    fn default() -> Self {
        Self { place: 0.003, heading: 0.03 }
    }
}

/// A robot's state at one moment.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moved {
    pub(super) pose: Pose<Field>,
    pub(super) velocity: Vector<Field>,
    pub(super) angular: f32,
}

#[derive(Clone, Copy, Debug)]
struct Track {
    plane: Plane,
    turning: Turning,
    at: Captured,
    /// Frame times of the last detection and of the last that counted.
    seen: Captured,
    counted: Captured,
    images: u16,
    /// The cameras' confidence in their detections, averaged, 0–1.
    quality: f32,
    /// The camera that saw it last.
    camera: u32,
}

impl Track {
    fn new(seen: &RobotSeen, frame: &Frame, noise: RobotNoise) -> Self {
        let at = frame.at;
        Self {
            plane: Plane::new(seen.position, noise.place, SPEED_SIGMA_M_S),
            turning: Turning::new(seen.heading.unwrap_or(Angle::ZERO), noise.heading, RATE_SIGMA_RAD_S),
            at,
            seen: at,
            counted: at,
            images: 1,
            quality: seen.confidence,
            camera: frame.camera,
        }
    }

    /// Distance of a detection at `at` from the prediction, beyond the robot's possible motion, m.
    fn misses_by(&self, position: Point<Field>, at: Captured) -> f32 {
        let unseen = seconds(at - self.seen);
        self.moved(at).pose.position.distance(position)
            - (GATE_M + GATE_GROWTH_M_S * unseen.min(GATE_TIME_MAX_S))
    }

    fn see(&mut self, seen: &RobotSeen, frame: &Frame, noise: RobotNoise) {
        let at = frame.at;
        let dt = seconds(at - self.at);
        if dt > COASTS_FOR_S {
            // Unseen for long: the place is used, the velocity is not.
            let moved = self.moved(at);
            self.plane = Plane::new(moved.pose.position, GATE_M, SPEED_SIGMA_M_S);
            self.turning = Turning::new(moved.pose.heading, LOST_HEADING_SIGMA_RAD, RATE_SIGMA_RAD_S);
        } else {
            self.plane.pass(dt, PLACE_FREEDOM);
            self.turning.pass(dt, HEADING_FREEDOM);
        }
        self.plane.see(seen.position, noise.place);
        if let Some(heading) = seen.heading {
            self.turning.see(heading, noise.heading);
        }
        (self.at, self.seen, self.camera) = (at, at, frame.camera);
        if at - self.counted >= TICK_US {
            self.counted = at;
            self.images = self.images.saturating_add(1);
        }
        self.quality += (seen.confidence - self.quality) * QUALITY_SHARE;
    }

    /// Straight on for a while, then at standstill.
    fn moved(&self, at: Captured) -> Moved {
        let dt = seconds(at - self.at).clamp(0.0, COASTS_FOR_S);
        let rests = at - self.at > micros(COASTS_FOR_S);
        let heading = self.turning.heading + Angle::new(self.turning.rate * dt);
        Moved {
            pose: Pose { position: self.plane.position + self.plane.velocity * dt, heading },
            velocity: if rests { Vector::default() } else { self.plane.velocity },
            angular: if rests { 0.0 } else { self.turning.rate },
        }
    }

    fn confidence(&self, at: Captured) -> f32 {
        let freshness = 1.0 - seconds(at - self.seen) * (1.0 / FORGOTTEN_AFTER_S);
        let often = f32::from(self.images.min(FRAMES_FULL)) * (1.0 / FRAMES_FULL as f32);
        (freshness * often * self.quality).clamp(0.0, 1.0)
    }
}

impl Robots {
    /// Takes a camera frame's robots.
    pub(super) fn see(&mut self, frame: &Frame, noise: RobotNoise) {
        let at = frame.at;
        for track in self
            .believed
            .iter_mut()
            .flatten()
            .filter(|track| track.is_some_and(|t| at - t.seen > micros(FORGOTTEN_AFTER_S)))
        {
            *track = None;
        }
        for seen in &frame.robots {
            self.see_one(seen, frame, noise);
        }
    }

    fn see_one(&mut self, seen: &RobotSeen, frame: &Frame, noise: RobotNoise) {
        let at = frame.at;
        // A slow camera shows a robot again after a frame's time.
        let patience = SEEN_LATELY_S.max(frame.gap * GAPS_OF_PATIENCE);
        let (team, id) = (index(seen.who.colour), seen.who.id.index());
        let elsewhere = self.believed[team][id].is_some_and(|track| at - track.seen <= micros(SEEN_LATELY_S));
        if !elsewhere && self.stands_another(seen.who, seen.position, at) {
            // A number that is read there only now and then: the robot confirmed under it was that
            // misreading.
            self.counts.wrong_name += 1;
            return;
        }
        if let Some(track) = &mut self.believed[team][id]
            && track.misses_by(seen.position, at) <= 0.0
        {
            track.see(seen, frame, noise);
            self.counts.taken += 1;
            return;
        }
        let candidate = &mut self.candidates[team][id];
        match candidate {
            Some(track) if at - track.seen > micros(patience) => *track = Track::new(seen, frame, noise),
            Some(track) if track.misses_by(seen.position, at) <= 0.0 => track.see(seen, frame, noise),
            Some(_) if elsewhere => {}
            _ => *candidate = Some(Track::new(seen, frame, noise)),
        }
        let believable = candidate.filter(|track| track.images >= FRAMES_TO_BELIEVE && !elsewhere);
        if let Some(track) = believable {
            self.believed[team][id] = Some(track);
            self.candidates[team][id] = None;
            self.counts.taken += 1;
        } else if elsewhere {
            self.counts.jumped += 1;
        } else {
            self.counts.new += 1;
        }
    }

    /// Whether a confirmed robot of another number was seen at that place just now.
    fn stands_another(&self, who: Who, position: Point<Field>, at: Captured) -> bool {
        self.each().any(|(other, track)| {
            other != who
                && at - track.seen <= micros(SEEN_LATELY_S)
                && track.moved(at).pose.position.distance(position) < SAME_PLACE_WITHIN_M
        })
    }

    fn each(&self) -> impl Iterator<Item = (Who, &Track)> {
        let teams = self.believed.iter().zip([Colour::Yellow, Colour::Blue]);
        teams.flat_map(|(team, colour)| {
            let named = team.iter().zip(RobotId::all());
            named.filter_map(move |(track, id)| track.as_ref().map(|track| (Who { colour, id }, track)))
        })
    }

    /// The camera that saw a robot of a frame just before, where it was another one, and the time by which
    /// the robot is ahead of its path, µs.
    pub(super) fn crossing(&self, seen: &RobotSeen, frame: &Frame) -> Option<(u32, i64)> {
        let track = self.believed[index(seen.who.colour)][seen.who.id.index()].as_ref()?;
        let unseen = frame.at - track.seen;
        let steady = track.camera != frame.camera && track.images >= CROSSING_FRAMES;
        let off = seen.position - track.moved(frame.at).pose.position;
        let speed = track.plane.velocity.norm();
        let fits = steady
            && (0..=CROSSING_US).contains(&unseen)
            && speed >= CROSSING_SPEED_M_S
            && off.norm() <= CROSSING_WITHIN_M;
        fits.then(|| (track.camera, micros(off.dot(track.plane.velocity) / (speed * speed))))
    }

    /// The robot at that moment, if it is confirmed.
    pub(super) fn robot(&self, who: Who, at: Captured) -> Option<Moved> {
        self.believed[index(who.colour)][who.id.index()].as_ref().map(|track| track.moved(at))
    }

    /// The confirmed robot nearest to a point, and its distance, m.
    pub(super) fn nearest(&self, point: Point<Field>, at: Captured) -> Option<(Who, Moved, f32)> {
        let each = self.each().map(|(who, track)| {
            let moved = track.moved(at);
            (who, moved, moved.pose.position.distance(point))
        });
        each.reduce(|best, next| if next.2 < best.2 { next } else { best })
    }

    /// All robots at that moment; `ours` converts moments to our clock.
    pub(super) fn snapshot(
        &self,
        at: Captured,
        ours: impl Fn(Captured) -> Instant,
    ) -> impl Iterator<Item = Robot> {
        self.each().map(move |(who, track)| {
            let Moved { pose, velocity, angular } = track.moved(at);
            Robot { who, pose, velocity, angular, confidence: track.confidence(at), seen: ours(track.seen) }
        })
    }
}

/// Converts µs to s.
pub(super) fn seconds(micros: Captured) -> f32 {
    micros as f32 * 1e-6
}

/// Converts s to µs.
pub(super) const fn micros(seconds: f32) -> Captured {
    (seconds * 1e6) as Captured
}
