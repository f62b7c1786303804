//! `model`: one world of the family: its components, and the league's own values.

use protocol::Who;
use rules::{League, RobotSpec};
use serde::{Deserialize, Serialize};

use super::WorldChoice;
use crate::air::AirSettings;
use crate::rng::Stream;
use crate::small_size::Parameters;

/// A world of the family: physics, differences between robots, command link, vision, bystanders.
#[derive(Clone, Debug, PartialEq)]
pub struct WorldModel {
    /// Name, as [`WorldChoice`] writes it.
    pub name: String,
    /// Ball, field, robots, cameras.
    pub parameters: Parameters,
    /// Differences between robots of the same design.
    pub robots: RobotSpread,
    /// Link from a robot's computer to its wheels, and packets to and from the host.
    pub link: LinkModel,
    /// Faults of camera frames.
    pub vision: VisionModel,
    /// Number of bystanders of both teams together, without a computer.
    pub bystanders: u8,
}

/// Differences of robots from the world's parameters, as shares of them.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default, bound(deserialize = "Differences<T>: Default, T: Deserialize<'de>"))]
pub struct Differences<T> {
    /// Share of the ordered speed with which a kick, flat or chip, leaves.
    pub kick_gain: T,
    /// Share of that with which a chip leaves.
    pub chip_ratio: T,
    /// Share of the world's accelerations, brakes included.
    pub acceleration: T,
    /// Share of the world's speeds.
    pub speed: T,
    /// Share of the world's dribbler pull.
    pub pull: T,
    /// Share of the wheels' motion that does not reach the field surface.
    pub slip: T,
}

/// Differences between robots: each draws its own number, uniformly from the first to the second, once per
/// world.
pub type RobotSpread = Differences<[f32; 2]>;

/// Differences of one robot from the nominal one.
pub type Traits = Differences<f32>;

/// Delay of orders to the wheels, and loss of packets.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct LinkModel {
    /// Latency from a robot's computer to its wheels, kicker and dribbler, ms; whole.
    pub latency_ms: u32,
    /// Additional latency, ms, drawn for each order uniformly from 0 to this; orders keep their order.
    pub jitter_ms: u32,
    /// Probability that a packet on the team's radio channel is lost for a receiver.
    pub loss: f32,
}

/// Faults of frames between the cameras and the host, besides rate, delay and noise of [`Parameters`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct VisionModel {
    /// Delay in addition to the cameras', ms, drawn for each frame uniformly from 0 to this; frames keep
    /// their order.
    pub jitter_ms: u32,
    /// Mean time from the end of a gap to the next, s (exponential); 0: no gaps.
    pub gap_every_s: f32,
    /// Duration of a gap, ms, uniformly from the first to the second: all frames taken in it are lost, of all
    /// cameras.
    pub gap_ms: [u32; 2],
    /// Mean time from swap to swap, s (exponential); 0: none.
    pub swap_every_s: f32,
    /// Number of frames of each camera in which two robots of one team have each other's id, uniformly from
    /// the first to the second.
    pub swap_frames: [u32; 2],
}

impl WorldModel {
    /// That world in that league, with robots as this build describes them; `None` for leagues without
    /// wheeled robots.
    pub fn of(league: League, choice: &WorldChoice) -> Option<Self> {
        Self::with_robot(league, choice, &RobotSpec::OURS)
    }

    /// The same with robots of another description.
    pub fn with_robot(league: League, choice: &WorldChoice, robot: &RobotSpec) -> Option<Self> {
        let parameters = Parameters::of_file(league)?;
        let mut model = match choice {
            WorldChoice::Nominal => Self::nominal(parameters.clone()),
            WorldChoice::Named(named) => {
                Self::from_toml(named.label(), named.text(), parameters).expect("a test reads every profile")
            }
            WorldChoice::Random(seed) => Self::random(parameters, *seed),
        };
        model.parameters = model.parameters.for_robot(robot);
        Some(Self { name: choice.to_string(), ..model })
    }

    /// These physics, with equal robots, orders that take effect at once, and every frame on time.
    pub fn nominal(parameters: Parameters) -> Self {
        Self {
            name: WorldChoice::Nominal.to_string(),
            parameters,
            robots: RobotSpread::NONE,
            link: LinkModel::IDEAL,
            vision: VisionModel::IDEAL,
            bystanders: 0,
        }
    }
}

impl RobotSpread {
    /// All robots have the world's parameters.
    pub const NONE: Self = Self {
        kick_gain: [1.0; 2],
        chip_ratio: [1.0; 2],
        acceleration: [1.0; 2],
        speed: [1.0; 2],
        pull: [1.0; 2],
        slip: [0.0; 2],
    };
}

impl LinkModel {
    /// Orders take effect at once and no packet is lost.
    pub const IDEAL: Self = Self { latency_ms: 0, jitter_ms: 0, loss: 0.0 };

    /// A team's radio settings with this link's losses added.
    pub fn over(&self, air: &AirSettings) -> AirSettings {
        if self.loss <= 0.0 {
            return air.clone();
        }
        AirSettings { loss: 1.0 - (1.0 - air.loss) * (1.0 - self.loss), ..air.clone() }
    }
}

impl VisionModel {
    /// Every frame arrives on time, with the right ids.
    pub const IDEAL: Self =
        Self { jitter_ms: 0, gap_every_s: 0.0, gap_ms: [0; 2], swap_every_s: 0.0, swap_frames: [0; 2] };
}

impl Traits {
    /// No difference from the world's parameters.
    pub const NONE: Self =
        Self { kick_gain: 1.0, chip_ratio: 1.0, acceleration: 1.0, speed: 1.0, pull: 1.0, slip: 0.0 };
}

impl RobotSpread {
    /// Those of one robot: its own draw, independent of which others are there.
    pub fn of(&self, seed: u64, who: Who) -> Traits {
        if *self == Self::NONE {
            return Traits::NONE;
        }
        let stream = |name| Stream::new(seed, &format!("robot {name} {}", who.slot()));
        let draw = |name, [low, high]: [f32; 2]| stream(name).between(low, high);
        Traits {
            kick_gain: draw("kick_gain", self.kick_gain),
            chip_ratio: draw("chip_ratio", self.chip_ratio),
            acceleration: draw("acceleration", self.acceleration),
            speed: draw("speed", self.speed),
            pull: draw("pull", self.pull),
            slip: draw("slip", self.slip),
        }
    }
}

impl Default for Traits {
    fn default() -> Self {
        Self::NONE
    }
}

impl Default for RobotSpread {
    fn default() -> Self {
        Self::NONE
    }
}
