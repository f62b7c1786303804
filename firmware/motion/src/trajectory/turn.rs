//! `turn`: time-optimal turn to a heading. One axis with a wrap; rad, rad/s, rad/s².

use geometry::{Angle, math};
use rules::{RobotSpec, TurnSpec};

use super::FreeLimits;
use super::axis::{AxisLimits, Phases};

/// Limits of a robot's turning.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TurnLimits {
    /// Turning rate, rad/s, > 0.
    pub rate: f32,
    /// Acceleration and braking, rad/s², > 0.
    pub acceleration: f32,
}

impl Default for TurnLimits {
    /// What is assumed of any robot of the league (`RobotSpec::OURS.assumed.turn`).
    fn default() -> Self {
        Self::of(&RobotSpec::OURS.assumed.turn)
    }
}

impl TurnLimits {
    /// The limits that a robot's specification gives.
    pub const fn of(turn: &TurnSpec) -> Self {
        Self { rate: turn.rate, acceleration: turn.acceleration }
    }

    /// From `from`, turning with `rate` rad/s, to rest at `to`: in the direction that arrives sooner.
    pub fn plan(&self, from: Angle, rate: f32, to: Angle) -> Turn {
        let (speed, braking) = (self.rate, self.acceleration);
        // False for NaN.
        let usable = speed > 0.0 && braking > 0.0 && rate.abs() <= RATE_MAX;
        if !usable {
            return Turn { from, phases: Phases::default() };
        }
        let limits = AxisLimits::new(&FreeLimits { speed, acceleration: braking, braking });
        let short = (to - from).radians();
        let long = if short > 0.0 { short - math::TAU } else { short + math::TAU };
        let turn = if limits.time(long, rate) < limits.time(short, rate) { long } else { short };
        Turn { from, phases: limits.phases(turn, rate, 1.0) }
    }
}

/// A planned turn, from now to rest at the target heading.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turn {
    from: Angle,
    phases: Phases,
}

impl Turn {
    /// Time until it stands, s.
    pub fn duration(&self) -> f32 {
        self.phases.duration
    }

    /// Heading, rate (rad/s) and acceleration (rad/s²) `time` seconds after the start.
    pub fn at(&self, time: f32) -> (Angle, f32, f32) {
        let (turned, rate, acceleration) = self.phases.at(time);
        (self.from + Angle::new(turned), rate, acceleration)
    }
}

/// Above this rate a gyroscope is broken, rad/s.
const RATE_MAX: f32 = 1_000.0;
