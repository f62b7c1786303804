//! `random:SEED`: every number of the family drawn from its own distribution, independently of all others;
//! the table of [`DRAWS`].
//!
//! The bounds are required ranges of the project or the limits of what teams and simulators publish
//! (`docs/fields.md` has the table and the sources). Each quantity has a random stream of its own, so that an
//! additional one changes nothing else.

use super::WorldModel;
use crate::rng::Stream;
use crate::small_size::Parameters;

geometry::labels! {
    /// Distribution of a quantity between its bounds.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum Law {
        /// Evenly between the bounds.
        Even = "even",
        /// Evenly in its logarithm: as often from 1 to 2 as from 2 to 4.
        Log = "log-even",
        /// Half of all worlds have none of it, the others evenly.
        Half = "half none, half even",
        /// Two draws, sorted: the robots of the world lie evenly between them.
        Pair = "per robot",
    }
}

/// A quantity of the family.
pub struct Quantity {
    /// Key in a profile.
    pub name: &'static str,
    /// Minimum and maximum, in the key's unit.
    pub bounds: [f32; 2],
    /// Distribution between the bounds.
    pub law: Law,
    /// Sets both numbers of a pair; else the same number twice.
    set: fn(&mut WorldModel, [f32; 2]),
}

macro_rules! quantity {
    ($law:ident $name:literal $low:literal $high:literal, |$model:ident, $value:ident| $set:expr) => {
        Quantity { name: $name, bounds: [$low, $high], law: Law::$law, set: |$model, [$value, _]| $set }
    };
    ($law:ident $name:literal $low:literal $high:literal, $($path:ident).+) => {
        quantity!($law $name $low $high, |model, value| model.parameters.$($path).+ = value)
    };
}

/// A quantity of [`super::RobotSpread`].
macro_rules! pair {
    ($name:literal $low:literal $high:literal, $field:ident) => {
        Quantity {
            name: $name,
            bounds: [$low, $high],
            law: Law::Pair,
            set: |model, values| model.robots.$field = values,
        }
    };
}

/// Every quantity that a random world draws; all others have the league's value.
pub const DRAWS: &[Quantity] = &[
    quantity!(Even "ball.mass" 0.040 0.047, ball.mass),
    quantity!(Log "ball.slide" 2.5 14.0, ball.slide),
    quantity!(Log "ball.roll" 0.2 0.8, ball.roll),
    quantity!(Even "ball.hop_along" 0.6 0.8, ball.hop_along),
    quantity!(Even "ball.hop_along_later" 0.85 1.0, ball.hop_along_later),
    quantity!(Even "ball.hop_up" 0.42 0.57, ball.hop_up),
    quantity!(Even "bounce.hull" 0.2 0.6, bounce.hull),
    quantity!(Even "bounce.front" 0.1 0.6, bounce.front),
    quantity!(Even "bounce.dribbling" 0.0 0.3, bounce.dribbling),
    quantity!(Even "bounce.wall" 0.3 0.6, bounce.wall),
    quantity!(Even "bounce.friction" 0.1 0.4, bounce.friction),
    quantity!(Even "robot.mass" 1.5 2.9, robot.mass),
    quantity!(Even "robot.mouth" 0.025 0.045, robot.mouth),
    quantity!(Even "drive.forward" 2.5 7.0, drive.forward),
    quantity!(Even "drive.side" 2.0 6.0, drive.side),
    quantity!(Even "drive.brake" 3.0 7.0, drive.brake),
    quantity!(Even "drive.turn" 30.0 60.0, drive.turn),
    quantity!(Even "drive.speed" 2.0 4.0, drive.speed),
    quantity!(Even "drive.turn_speed" 6.0 20.0, drive.turn_speed),
    quantity!(Even "kick.flat" 6.5 10.0, kick.flat),
    quantity!(Even "kick.chip" 4.5 10.0, kick.chip),
    quantity!(Even "kick.chip_deg" 38.0 52.0, kick.chip_deg),
    quantity!(Even "kick.recharge" 0.1 1.0, kick.recharge),
    quantity!(Even "kick.speed_sd" 0.0 0.05, kick.speed_sd),
    quantity!(Even "kick.angle_sd_deg" 0.0 1.5, kick.angle_sd_deg),
    quantity!(Even "dribbler.pull" 0.5 6.0, dribbler.pull),
    quantity!(Even "dribbler.side" 0.5 4.0, dribbler.side),
    quantity!(Half "dribbler.fade" 0.05 0.4, dribbler.fade),
    quantity!(Even "dribbler.center" 0.0 10.0, dribbler.center),
    quantity!(Even "dribbler (none, perfect)" 0.0 1.0, |model, value| {
        let of = &mut model.parameters.dribbler;
        if value < NO_DRIBBLER {
            (of.pull, of.side) = (0.0, 0.0);
        } else if value > 1.0 - PERFECT_DRIBBLER {
            (of.pull, of.side, of.fade) = (PERFECT_PULL, PERFECT_PULL, 0.0);
        }
    }),
    quantity!(Even "camera.rate" 50.0 100.0, camera.rate),
    // What the packet reports of it stays as it is, as far as it fits.
    quantity!(Even "camera.delay" 0.010 0.050, |model, value| {
        let of = &mut model.parameters.camera;
        (of.delay, of.processing) = (value, of.processing.min(value));
    }),
    quantity!(Even "noise.ball" 0.0 0.003, noise.ball),
    quantity!(Even "noise.robot" 0.0 0.003, noise.robot),
    quantity!(Even "noise.heading" 0.0 0.02, noise.heading),
    quantity!(Even "noise.missing_ball" 0.0 0.10, noise.missing_ball),
    quantity!(Even "noise.missing_robot" 0.0 0.05, noise.missing_robot),
    quantity!(Half "noise.ghost_ball" 0.002 0.05, noise.ghost_ball),
    quantity!(Even "noise.hidden_ball" 0.2 0.5, noise.hidden_ball),
    quantity!(Even "noise.odometry" 0.0 0.05, noise.odometry),
    quantity!(Even "noise.gyro" 0.0 0.05, noise.gyro),
    pair!("spread.kick_gain" 0.6 1.1, kick_gain),
    pair!("spread.chip_ratio" 0.8 1.1, chip_ratio),
    pair!("spread.acceleration" 0.8 1.0, acceleration),
    pair!("spread.speed" 0.85 1.0, speed),
    pair!("spread.pull" 0.7 1.2, pull),
    pair!("spread.slip" 0.0 0.1, slip),
    quantity!(Even "link.latency_ms" 5.0 60.0, |model, value| model.link.latency_ms = value as u32),
    quantity!(Even "link.jitter_ms" 0.0 10.0, |model, value| model.link.jitter_ms = value as u32),
    quantity!(Even "link.loss" 0.0 0.10, |model, value| model.link.loss = value),
    quantity!(Even "vision.jitter_ms" 0.0 15.0, |model, value| model.vision.jitter_ms = value as u32),
    quantity!(Half "vision.gap_every_s" 2.0 20.0, |model, value| {
        (model.vision.gap_every_s, model.vision.gap_ms) = (value, GAP_MS);
    }),
    quantity!(Half "vision.swap_every_s" 10.0 60.0, |model, value| {
        (model.vision.swap_every_s, model.vision.swap_frames) = (value, SWAP_FRAMES);
    }),
    quantity!(Half "bystanders" 5.0 11.999, |model, value| model.bystanders = value as u8),
];

/// Share of the worlds whose robots have no dribbler; estimate.
const NO_DRIBBLER: f32 = 0.05;
/// Share of the worlds whose dribblers never lose the ball, as in two of the league's simulators; estimate.
const PERFECT_DRIBBLER: f32 = 0.15;
/// m/s²: the ball follows the robot within a step, however it moves.
pub const PERFECT_PULL: f32 = 1000.0;
/// Duration of gaps, ms: a required range.
pub const GAP_MS: [u32; 2] = [40, 150];
/// Number of frames with swapped numbers; estimate.
const SWAP_FRAMES: [u32; 2] = [1, 5];

impl WorldModel {
    pub(super) fn random(league: &Parameters, seed: u64) -> Self {
        let mut model = Self::nominal(league.clone());
        for quantity in DRAWS {
            let mut chance = Stream::new(seed, &format!("world {}", quantity.name));
            let values = quantity.draw(&mut chance);
            (quantity.set)(&mut model, values);
        }
        model
    }
}

impl Quantity {
    fn draw(&self, chance: &mut Stream) -> [f32; 2] {
        let [low, high] = self.bounds;
        match self.law {
            Law::Even => [chance.between(low, high); 2],
            Law::Log => {
                // Within the bounds in spite of rounding.
                let share = chance.share();
                let log = geometry::math::ln(low) * (1.0 - share) + geometry::math::ln(high) * share;
                [geometry::math::exp(log).clamp(low, high); 2]
            }
            Law::Half => {
                let has = chance.chance(0.5);
                let value = chance.between(low, high);
                [if has { value } else { 0.0 }; 2]
            }
            Law::Pair => {
                let (one, other) = (chance.between(low, high), chance.between(low, high));
                [one.min(other), one.max(other)]
            }
        }
    }
}
