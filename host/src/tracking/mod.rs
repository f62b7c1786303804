//! `tracking`: tracking: camera frames to one world model. [`ssl::vision::WrapperPacket`]s with their time of
//! arrival go in, a [`World`] comes out, now or carried forward to any moment.
//!
//! | question | where |
//! |---|---|
//! | What did the camera claim, without nonsense? | `seen` |
//! | Whose clock is that, and how does it lie to ours? | `clock` |
//! | Did we see it before, and where does it belong? | `order` |
//! | Which robots are there and how do they move? | `robots` |
//! | Which blob is the ball, who kicked it, does it fly? | `ball` |
//! | Where do cameras hang, how do balls roll here? | `scene` |
//! | How is it told to others? | `publish` |
//!
//! **Invariants.** Nothing panics on what a packet holds; every image is accounted for in [`Counts`]. Images within 50 ms of
//! the newest count in the order in which they were taken, so copies and shuffled packets change nothing. After
//! [`Tracker::new`] and the first packets nothing is allocated. Same packets, same bits. A packet costs some 20,000
//! instructions, the picture of now included (16,200 with grSim's recording, 23,200 with ER-Force's 11 robots; `track --times`).
//!
//! ```
//! use host::tracking::Tracker;
//! use protocol::Instant;
//! use ssl::vision::{DetectionBall, DetectionFrame, WrapperPacket};
//!
//! let mut tracker = Tracker::default();
//! for i in 0..10 {
//!     // A ball that rolls along +x with 1 m/s, 60 times a second; vision speaks of mm.
//!     let t = f64::from(i) / 60.0;
//!     let ball = DetectionBall { confidence: 1.0, x: (t * 1000.0) as f32, ..DetectionBall::default() };
//!     let image = DetectionFrame { frame_number: i, t_capture: t, balls: vec![ball], ..DetectionFrame::default() };
//!     let packet = WrapperPacket { detection: Some(image), ..WrapperPacket::default() };
//!     tracker.handle(&packet, Instant(5_000_000 + (t * 1e6) as u64));
//! }
//! let ball = tracker.picture().ball.unwrap();
//! assert!((ball.velocity.x() - 1.0).abs() < 0.1);
//! // What it will be when our commands arrive.
//! let later = tracker.world(Instant(5_200_000)).ball.unwrap();
//! assert!((later.position.x() - 0.2).abs() < 0.02);
//! ```

mod ball;
mod clock;
mod filter;
mod order;
mod publish;
mod robots;
mod scene;
mod seen;

use motion::ball::BallModel;
use protocol::{Duration, Instant};
use ssl::vision::{DetectionFrame, WrapperPacket};

pub use ball::BallCounts;
pub(crate) use ball::HiddenBall;
pub use publish::Publisher;
pub use robots::{RobotCounts, RobotNoise};

use self::ball::{Around, Balls};
use self::clock::{Clock, Judgement};
use self::order::{Placed, Timeline};
use self::robots::Robots;
use self::scene::Scene;
use self::seen::{Captured, Frame, captured};
use crate::field_geometry::VisionGeometry;
use crate::world::{BallModels, World};

/// What a tracker may be told.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// How robots' glimpses scatter.
    pub robots: RobotNoise,
    /// Standard deviation of a ball's coordinate, m.
    pub ball: f32,
    /// How balls move until a geometry packet tells.
    pub models: BallModels,
}

impl Default for Settings {
    /// Noise of the noisiest recording (see [`RobotNoise`]; balls 3.1 mm there, 1.5 mm in ER-Force's).
    fn default() -> Self {
        Self { robots: RobotNoise::default(), ball: 0.003, models: BallModels::default() }
    }
}

/// What became of a packet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Heard {
    /// It holds no image.
    NoImage,
    /// It is the newest image.
    Newest,
    /// It was put before this many newer ones.
    Reordered(usize),
    /// This camera's image of that moment was there already.
    Repeated,
    /// It was taken so long before the newest that it counts no more.
    Late(Duration),
    /// Its time or its camera's number is nonsense.
    Nonsense,
    /// It is of another clock than the one followed.
    ForeignClock,
    /// Vision's clock began anew: all was forgotten, and this is the first image.
    Restarted,
}

/// How many packets became what.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Counts {
    /// Packets without an image.
    pub no_image: u64,
    /// Images that were the newest when they came, restarts included.
    pub newest: u64,
    /// Images put before newer ones.
    pub reordered: u64,
    /// Images seen twice.
    pub repeated: u64,
    /// Images that came too late.
    pub late: u64,
    /// Images with a time or camera that cannot be.
    pub nonsense: u64,
    /// Images of another clock.
    pub foreign: u64,
    /// Times that vision's clock began anew.
    pub restarts: u64,
    /// Fields in packets that no field can be like; what was known stood.
    pub geometry_refused: u64,
}

impl Counts {
    /// All packets.
    pub fn packets(&self) -> u64 {
        self.no_image + self.images()
    }

    /// All images.
    pub fn images(&self) -> u64 {
        self.newest + self.reordered + self.repeated + self.late + self.nonsense + self.foreign
    }

    fn count(&mut self, heard: Heard) {
        *match heard {
            Heard::NoImage => &mut self.no_image,
            Heard::Newest => &mut self.newest,
            Heard::Reordered(_) => &mut self.reordered,
            Heard::Repeated => &mut self.repeated,
            Heard::Late(_) => &mut self.late,
            Heard::Nonsense => &mut self.nonsense,
            Heard::ForeignClock => &mut self.foreign,
            Heard::Restarted => {
                self.restarts += 1;
                &mut self.newest
            }
        } += 1;
    }
}

/// What became of the objects in images.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Objects {
    /// Robots.
    pub robots: RobotCounts,
    /// Balls.
    pub balls: BallCounts,
    /// Objects that are no place, have no shell number, or are too many for one image.
    pub nonsense: u64,
}

/// All that images change; taken back and worked out again when an image comes late.
#[derive(Clone, Copy, Debug, Default)]
struct State {
    robots: Robots,
    balls: Balls,
    nonsense: u64,
}

impl State {
    fn see(&mut self, frame: &Frame, scene: &Scene, settings: &Settings) {
        self.nonsense += u64::from(frame.nonsense);
        self.robots.see(&frame.robots, frame.at, settings.robots);
        let around = Around { robots: &self.robots, scene, sigma: settings.ball };
        self.balls.see(frame, around);
    }
}

/// Turns images into a picture.
#[derive(Clone, Debug)]
pub struct Tracker {
    settings: Settings,
    scene: Scene,
    clock: Clock,
    timeline: Timeline<State>,
    state: State,
    /// The image at hand, kept to be read into again.
    frame: Frame,
    counts: Counts,
}

impl Default for Tracker {
    fn default() -> Self {
        Self::new(Settings::default())
    }
}

impl Tracker {
    /// Knows nothing yet.
    pub fn new(settings: Settings) -> Self {
        let state = State::default();
        Self {
            settings,
            scene: Scene::new(settings.models),
            clock: Clock::default(),
            timeline: Timeline::new(state),
            state,
            frame: Frame::empty(),
            counts: Counts::default(),
        }
    }

    /// Takes a packet in that came at `arrived`, our clock.
    pub fn handle(&mut self, packet: &WrapperPacket, arrived: Instant) -> Heard {
        if let Some(geometry) = &packet.geometry {
            self.counts.geometry_refused += u64::from(self.scene.hear(geometry).is_err());
        }
        let heard = packet.detection.as_ref().map_or(Heard::NoImage, |image| self.see(image, arrived));
        self.counts.count(heard);
        heard
    }

    fn see(&mut self, image: &DetectionFrame, arrived: Instant) -> Heard {
        if !self.frame.read(image) {
            return Heard::Nonsense;
        }
        let at = self.frame.at;
        let mut restarted = match self.clock.judge(at, arrived) {
            Judgement::Ours => false,
            Judgement::Foreign => return Heard::ForeignClock,
            Judgement::Restart => true,
        };
        let mut placed = self.place(restarted);
        if let Placed::Late(_) = placed
            && self.clock.late(at, arrived) == Judgement::Restart
        {
            restarted = true;
            placed = self.place(restarted);
        }
        match placed {
            Placed::Repeated => return Heard::Repeated,
            Placed::Late(by) => return Heard::Late(Duration(by.unsigned_abs())),
            Placed::Newest | Placed::Before(_) => self.clock.hear(at, captured(image.t_sent), arrived),
        }
        match placed {
            _ if restarted => Heard::Restarted,
            Placed::Before(newer) => Heard::Reordered(newer),
            _ => Heard::Newest,
        }
    }

    fn place(&mut self, anew: bool) -> Placed {
        if anew {
            self.timeline.clear();
            self.state = State::default();
        }
        let (scene, settings) = (&self.scene, &self.settings);
        self.timeline.put(&self.frame, &mut self.state, |state, frame| state.see(frame, scene, settings))
    }

    /// Balls roll with that deceleration, m/s², whatever vision says; gives how they move along the ground then.
    pub fn set_roll(&mut self, roll: f32) -> BallModel {
        self.scene.set_roll(roll)
    }

    /// The field when the newest image was taken; empty before the first.
    pub fn picture(&self) -> World {
        let at = self.timeline.newest().unwrap_or(0);
        let ours = |captured: Captured| self.clock.ours(captured);
        let mut world = World::empty(ours(at), self.scene.models);
        let around = Around { robots: &self.state.robots, scene: &self.scene, sigma: self.settings.ball };
        world.ball = self.state.balls.picture(at, around, ours);
        for robot in self.state.robots.picture(at, ours) {
            world.put(robot);
        }
        world
    }

    /// The field as it is, or will be, at `time` of our clock: the picture carried forward.
    pub fn world(&self, time: Instant) -> World {
        self.picture().at(time)
    }

    /// When the newest image was taken, s on vision's clock; `None` before the first.
    pub fn captured(&self) -> Option<f64> {
        self.timeline.newest().map(|micros| micros as f64 * 1e-6)
    }

    /// How long ago the newest image was taken when its packet came: what vision needed, and the network beyond its best.
    pub fn delay(&self) -> Duration {
        self.clock.delay()
    }

    /// What vision said of field, cameras and ball.
    pub fn geometry(&self) -> &VisionGeometry {
        &self.scene.geometry
    }

    /// What became of packets so far.
    pub fn counts(&self) -> &Counts {
        &self.counts
    }

    /// What became of the objects in images since vision's clock began.
    pub fn objects(&self) -> Objects {
        Objects {
            robots: self.state.robots.counts,
            balls: self.state.balls.counts,
            nonsense: self.state.nonsense,
        }
    }
}
