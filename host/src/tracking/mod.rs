//! `tracking`: merges camera frames into one world model. Input: [`ssl::vision::WrapperPacket`]s with their
//! time of arrival; output: a [`World`], now or extrapolated to any moment.
//!
//! | topic | module |
//! |---|---|
//! | Valid detections of a camera frame | `seen` |
//! | A clock for each camera | `cameras` |
//! | Vision's clock, and its offset from ours | `clock` |
//! | One sender for each camera | [`senders`] |
//! | Order of camera frames, without repetitions | `order` |
//! | Robots and their motion | `robots` |
//! | Choice of the ball, its kicks and flights | `ball` |
//! | Positions of cameras, model of the ball | `scene` |
//! | Tracker packets for other programs | `publish` |
//!
//! **Invariants.** No content of a packet causes a panic; every camera frame is counted in
//! [`TrackingCounts`]. Frames within 0.2 s of the newest count in the order in which they were taken, so
//! copies and shuffled packets change nothing. After [`Tracker::new`] and the first packets nothing is
//! allocated. Same packets, same bits. A packet costs some 20,000 instructions, including the present world
//! (16,200 with grSim's recording, 23,200 with ER-Force's 11 robots; `track --times`).
//!
//! ```
//! use host::tracking::Tracker;
//! use protocol::Instant;
//! use ssl::vision::{DetectionBall, DetectionFrame, WrapperPacket};
//!
//! let mut tracker = Tracker::default();
//! for i in 0..10 {
//!     // A ball that rolls along +x with 1 m/s, 60 times a second; vision sends mm.
//!     let t = f64::from(i) / 60.0;
//!     let ball = DetectionBall { confidence: 1.0, x: (t * 1000.0) as f32, ..DetectionBall::default() };
//!     let image = DetectionFrame { frame_number: i, t_capture: t, balls: vec![ball], ..DetectionFrame::default() };
//!     let packet = WrapperPacket { detection: Some(image), ..WrapperPacket::default() };
//!     tracker.handle(&packet, Instant(5_000_000 + (t * 1e6) as u64));
//! }
//! let ball = tracker.snapshot().ball.unwrap();
//! assert!((ball.velocity.x() - 1.0).abs() < 0.1);
//! // What it will be when our commands arrive.
//! let later = tracker.world(Instant(5_200_000)).ball.unwrap();
//! assert!((later.position.x() - 0.2).abs() < 0.02);
//! ```

mod ball;
mod cameras;
mod clock;
mod filter;
mod order;
mod publish;
mod robots;
mod scene;
mod seen;
pub mod senders;

use motion::ball::BallModel;
use protocol::{Duration, Instant, RobotId, Who};
use serde::Serialize;
use ssl::vision::{DetectionFrame, WrapperPacket};

pub use ball::BallCounts;
pub(crate) use ball::HiddenBall;
pub use cameras::CameraStatus;
pub use publish::Publisher;
pub use robots::{RobotCounts, RobotNoise};

use self::ball::{Around, Balls};
use self::cameras::Cameras;
use self::clock::{Clock, Judgement, plausible};
use self::order::{Placed, Timeline};
use self::robots::Robots;
use self::scene::Scene;
use self::seen::{CAMERAS_MAX, Captured, Frame, captured};
use crate::field_geometry::VisionGeometry;
use crate::world::{BallModels, World, index};

/// Settings of a tracker.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrackingSettings {
    /// Noise of robots' detections.
    pub robots: RobotNoise,
    /// Standard deviation of a ball's coordinate, m.
    pub ball: f32,
    /// Models of the ball until a geometry packet has some.
    pub models: BallModels,
}

impl Default for TrackingSettings {
    /// Noise of the noisiest recording (see [`RobotNoise`]; balls 3.1 mm there, 1.5 mm in ER-Force's).
    fn default() -> Self {
        Self { robots: RobotNoise::default(), ball: 0.003, models: BallModels::default() }
    }
}

/// Result of a packet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VisionVerdict {
    /// A packet without a camera frame.
    NoImage,
    /// The newest camera frame.
    Newest,
    /// A frame inserted before this number of newer ones.
    Reordered(usize),
    /// This camera's frame of that moment was there already.
    Repeated,
    /// A frame taken this long before the newest: too old to count.
    Late(Duration),
    /// A frame whose time or camera number is invalid.
    Nonsense,
    /// A frame of another clock than the one followed.
    ForeignClock,
    /// Vision's clock restarted: the state was reset, and this is the first camera frame.
    Restarted,
}

/// Numbers of packets by result. Serialized are those that a report of a log file has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize)]
pub struct TrackingCounts {
    /// Packets without a camera frame.
    #[serde(skip)]
    pub no_image: u64,
    /// Camera frames that were the newest when they came, restarts included.
    pub newest: u64,
    /// Camera frames inserted before newer ones.
    pub reordered: u64,
    /// Camera frames received twice.
    pub repeated: u64,
    /// Camera frames that came too late.
    pub late: u64,
    /// Camera frames with an invalid time or camera.
    pub nonsense: u64,
    /// Camera frames of another clock.
    pub foreign: u64,
    /// Number of restarts of vision's clock.
    pub restarts: u64,
    /// Implausible fields in packets; the previous field was kept.
    #[serde(skip)]
    pub geometry_refused: u64,
}

impl TrackingCounts {
    /// Number of all packets.
    pub fn packets(&self) -> u64 {
        self.no_image + self.images()
    }

    /// Number of all camera frames.
    pub fn images(&self) -> u64 {
        self.newest + self.reordered + self.repeated + self.late + self.nonsense + self.foreign
    }

    fn count(&mut self, received: VisionVerdict) {
        *match received {
            VisionVerdict::NoImage => &mut self.no_image,
            VisionVerdict::Newest => &mut self.newest,
            VisionVerdict::Reordered(_) => &mut self.reordered,
            VisionVerdict::Repeated => &mut self.repeated,
            VisionVerdict::Late(_) => &mut self.late,
            VisionVerdict::Nonsense => &mut self.nonsense,
            VisionVerdict::ForeignClock => &mut self.foreign,
            VisionVerdict::Restarted => {
                self.restarts += 1;
                &mut self.newest
            }
        } += 1;
    }
}

/// Counts of the objects in camera frames, by result.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Objects {
    /// Counts of detected robots, by result.
    pub robots: RobotCounts,
    /// Counts of detected balls, by result.
    pub balls: BallCounts,
    /// Objects without a finite place or a shell number, or too many for one camera frame.
    pub nonsense: u64,
}

/// All state that camera frames change; restored and computed again when a frame comes late.
#[derive(Clone, Copy, Debug, Default)]
struct State {
    robots: Robots,
    balls: Balls,
    nonsense: u64,
}

impl State {
    fn see(&mut self, frame: &Frame, scene: &Scene, settings: &TrackingSettings) {
        self.nonsense += u64::from(frame.nonsense);
        self.robots.see(frame, settings.robots);
        let around = Around { robots: &self.robots, scene, sigma: settings.ball };
        self.balls.see(frame, around);
    }
}

/// Turns camera frames into a world model.
#[derive(Clone, Debug)]
pub struct Tracker {
    settings: TrackingSettings,
    scene: Scene,
    clock: Clock,
    cameras: Cameras,
    timeline: Timeline<State>,
    state: State,
    /// The present camera frame, kept to reuse its memory.
    frame: Frame,
    /// When each camera detected each robot last, our clock; by team and number.
    sightings: [[[Option<Instant>; CAMERAS_MAX]; RobotId::COUNT]; 2],
    counts: TrackingCounts,
}

impl Default for Tracker {
    fn default() -> Self {
        Self::new(TrackingSettings::default())
    }
}

impl Tracker {
    /// A tracker without input yet.
    pub fn new(settings: TrackingSettings) -> Self {
        let state = State::default();
        Self {
            settings,
            scene: Scene::new(settings.models),
            clock: Clock::default(),
            cameras: Cameras::default(),
            timeline: Timeline::new(state),
            state,
            frame: Frame::empty(),
            sightings: [[[None; CAMERAS_MAX]; RobotId::COUNT]; 2],
            counts: TrackingCounts::default(),
        }
    }

    /// Takes a packet that came at `arrived`, our clock.
    pub fn handle(&mut self, packet: &WrapperPacket, arrived: Instant) -> VisionVerdict {
        if let Some(geometry) = &packet.geometry {
            self.counts.geometry_refused += u64::from(self.scene.receive(geometry).is_err());
        }
        let received =
            packet.detection.as_ref().map_or(VisionVerdict::NoImage, |image| self.see(image, arrived));
        self.counts.count(received);
        received
    }

    fn see(&mut self, image: &DetectionFrame, arrived: Instant) -> VisionVerdict {
        if !self.frame.read(image) {
            return VisionVerdict::Nonsense;
        }
        let (camera, stamp) = (self.frame.camera, self.frame.at);
        for Who { colour, id } in self.frame.robots.iter().map(|seen| seen.who) {
            self.sightings[index(colour)][id.index()][camera as usize] = Some(arrived);
        }
        let sent = plausible(captured(image.t_sent), stamp);
        let in_time = self.cameras.receive(&mut self.frame, sent, arrived);
        let verdict = self.fuse(sent.map(|sent| sent - stamp), arrived, in_time);
        let newest = self.timeline.newest().unwrap_or(self.frame.at);
        let unused = matches!(verdict, VisionVerdict::Late(_) | VisionVerdict::ForeignClock);
        self.cameras.note(camera, arrived, unused.then_some(self.frame.at - newest));
        verdict
    }

    /// Takes the frame into the state; `processing`: vision's time from frame to packet.
    fn fuse(&mut self, processing: Option<i64>, arrived: Instant, in_time: bool) -> VisionVerdict {
        let at = self.frame.at;
        let mut restarted = match self.clock.judge(at, arrived) {
            Judgement::Ours if in_time => false,
            Judgement::Ours | Judgement::Foreign => return VisionVerdict::ForeignClock,
            Judgement::Restart => true,
        };
        self.cameras.compare(&self.frame, &self.timeline.before(at, &self.state).robots);
        let mut placed = self.place(restarted);
        if let Placed::Late(_) = placed
            && self.clock.late(at, arrived) == Judgement::Restart
        {
            restarted = true;
            placed = self.place(restarted);
        }
        match placed {
            Placed::Repeated => return VisionVerdict::Repeated,
            Placed::Late(by) => return VisionVerdict::Late(Duration(by.unsigned_abs())),
            Placed::Newest | Placed::Before(_) => {
                self.clock.receive(at, processing.map(|time| at + time), arrived);
            }
        }
        match placed {
            _ if restarted => VisionVerdict::Restarted,
            Placed::Before(newer) => VisionVerdict::Reordered(newer),
            _ => VisionVerdict::Newest,
        }
    }

    fn place(&mut self, restart: bool) -> Placed {
        if restart {
            self.timeline.clear();
            self.state = State::default();
        }
        let (scene, settings) = (&self.scene, &self.settings);
        self.timeline.put(&self.frame, &mut self.state, |state, frame| state.see(frame, scene, settings))
    }

    /// Sets the deceleration of a rolling ball, m/s², overriding vision's; returns the resulting model of the
    /// ground.
    pub fn set_roll(&mut self, roll: f32) -> BallModel {
        self.scene.set_roll(roll)
    }

    /// Takes vision's deceleration again; returns the resulting model of the ground.
    pub fn clear_roll(&mut self) -> BallModel {
        self.scene.clear_roll()
    }

    /// The field when the newest camera frame was taken; empty before the first.
    pub fn snapshot(&self) -> World {
        let at = self.timeline.newest().unwrap_or(0);
        let ours = |captured: Captured| self.clock.ours(captured);
        let mut world = World::empty(ours(at), self.scene.models);
        let around = Around { robots: &self.state.robots, scene: &self.scene, sigma: self.settings.ball };
        world.ball = self.state.balls.snapshot(at, around, ours);
        for robot in self.state.robots.snapshot(at, ours) {
            world.put(robot);
        }
        world
    }

    /// The field at `time` of our clock: the newest world extrapolated.
    pub fn world(&self, time: Instant) -> World {
        self.snapshot().at(time)
    }

    /// When the newest camera frame was taken, s on vision's clock; `None` before the first.
    pub fn captured(&self) -> Option<f64> {
        self.timeline.newest().map(|micros| micros as f64 * 1e-6)
    }

    /// Age of the newest camera frame when its packet came: vision's delay, and the network's beyond its
    /// least.
    pub fn delay(&self) -> Duration {
        self.clock.delay()
    }

    /// Geometry of field, cameras and ball from vision.
    pub fn geometry(&self) -> &VisionGeometry {
        &self.scene.geometry
    }

    /// The cameras heard lately: their clocks, delays and rates.
    pub fn cameras(&self, now: Instant) -> impl Iterator<Item = CameraStatus> {
        self.cameras.status(now)
    }

    /// The cameras that have detected a robot of that number, whether it is tracked or not, and when last.
    pub fn sightings(&self, who: Who) -> impl Iterator<Item = (u32, Instant)> {
        let cameras = (0..).zip(&self.sightings[index(who.colour)][who.id.index()]);
        cameras.filter_map(|(camera, at)| Some((camera, (*at)?)))
    }

    /// Counts of packets so far.
    pub fn counts(&self) -> &TrackingCounts {
        &self.counts
    }

    /// Counts of the objects in camera frames since vision's clock started.
    pub fn objects(&self) -> Objects {
        Objects {
            robots: self.state.robots.counts,
            balls: self.state.balls.counts,
            nonsense: self.state.nonsense,
        }
    }
}
