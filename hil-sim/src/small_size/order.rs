//! `order`: orders of a wheeled robot: wheels, kicker, dribbler. m, m/s, rad, rad/s.

use geometry::{Body, Field, Twist, math};
use protocol::robot_io::{ActuatorFrame, OmniKick};

use super::parameters::Parameters;

/// What a robot's wheels shall do.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub enum Drive {
    /// Brake and stand.
    #[default]
    Brake,
    /// Rim speeds, m/s: front right, back right, back left, front left; positive turns the robot counter-clockwise.
    Rims([f32; 4]),
    /// A velocity in the robot's own frame.
    Local(Twist<Body>),
    /// A velocity in the field frame, held while the robot turns.
    Global(Twist<Field>),
}

/// A kick that leaves as soon as the ball lies in the mouth and the kicker is charged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kick {
    /// Speed of the ball in 3-D, m/s.
    pub speed: f32,
    /// Upwards from the carpet, rad; 0 is a flat kick.
    pub angle: f32,
}

/// What a robot was told last.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Order {
    /// Wheels.
    pub drive: Drive,
    /// Kicker.
    pub kick: Option<Kick>,
    /// Share of the dribbler's full strength, 0–1.
    pub dribbler: f32,
    /// Empty the kicker's store: it charges anew afterwards.
    pub discharge: bool,
}

impl Order {
    /// What a brain wants; a robot on wheels has nothing to do for legs. Released wheels are modelled as standing ones: they
    /// are released only where the robot stands.
    pub fn from_actuators(frame: &ActuatorFrame, parameters: &Parameters) -> Self {
        if *frame == ActuatorFrame::Released {
            return Self { discharge: true, ..Self::default() };
        }
        let ActuatorFrame::Omni { wheels, dribbler, kick } = frame else { return Self::default() };
        let kick = match *kick {
            OmniKick::None | OmniKick::Discharge => None,
            OmniKick::Flat(speed) => Some(Kick { speed, angle: 0.0 }),
            OmniKick::Chip(speed) => {
                Some(Kick { speed, angle: parameters.kick.chip_deg * (math::PI / 180.0) })
            }
        };
        let discharge = matches!(frame, ActuatorFrame::Omni { kick: OmniKick::Discharge, .. });
        Self { drive: Drive::Rims(*wheels), kick, dribbler: *dribbler, discharge }
    }

    /// The same without numbers that are none: they mean "nothing".
    pub(super) fn sane(mut self) -> Self {
        let finite = match self.drive {
            Drive::Brake => true,
            Drive::Rims(rims) => rims.iter().all(|rim| rim.is_finite()),
            Drive::Local(Twist { linear, angular }) => linear.is_finite() && angular.is_finite(),
            Drive::Global(Twist { linear, angular }) => linear.is_finite() && angular.is_finite(),
        };
        if !finite {
            self.drive = Drive::Brake;
        }
        self.kick =
            self.kick.filter(|kick| kick.speed > 0.0 && kick.speed.is_finite() && kick.angle.is_finite());
        self.dribbler = if self.dribbler > 0.0 { self.dribbler.min(1.0) } else { 0.0 };
        self
    }
}
