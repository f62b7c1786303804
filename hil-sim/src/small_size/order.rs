//! `order`: orders of a wheeled robot: wheels, kicker, dribbler. m, m/s, rad, rad/s.

use geometry::{Body, Field, Twist, math};
use protocol::robot_io::{ActuatorFrame, OmniKick};
use serde::{Deserialize, Serialize};

use super::parameters::Parameters;

/// Order to a robot's wheels.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
pub enum Drive {
    /// Brake all wheels and stand.
    #[default]
    Brake,
    /// Rim speeds, m/s: front right, back right, back left, front left; positive turns the robot
    /// counter-clockwise.
    Rims([f32; 4]),
    /// A velocity in the robot's own frame.
    Local(Twist<Body>),
    /// A velocity in the field frame, held while the robot turns.
    Global(Twist<Field>),
}

/// A kick that fires as soon as the ball lies in the dribbler opening and the kicker is charged.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct KickCommand {
    /// Speed of the ball in 3-D, m/s.
    pub speed: f32,
    /// Elevation above the field surface, rad; 0 is a flat kick.
    pub angle: f32,
}

/// The last order to a robot.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
pub struct Order {
    /// Order to the wheels.
    pub drive: Drive,
    /// Order to the kicker.
    pub kick: Option<KickCommand>,
    /// Share of the dribbler's full strength, 0–1.
    pub dribbler: f32,
    /// Discharge the kicker's capacitor; it recharges afterwards.
    pub discharge: bool,
}

impl Order {
    /// The order in a brain's actuator frame; a robot on wheels ignores orders for legs. Released wheels are
    /// modelled as braked ones: they are released only where the robot stands.
    pub fn from_actuators(frame: &ActuatorFrame, parameters: &Parameters) -> Self {
        if *frame == ActuatorFrame::Released {
            return Self { discharge: true, ..Self::default() };
        }
        let ActuatorFrame::Omni { wheels, dribbler, kick } = frame else { return Self::default() };
        let kick = match *kick {
            OmniKick::None | OmniKick::Discharge => None,
            OmniKick::Flat(speed) => Some(KickCommand { speed, angle: 0.0 }),
            OmniKick::Chip(speed) => {
                Some(KickCommand { speed, angle: parameters.kick.chip_deg * (math::PI / 180.0) })
            }
        };
        let discharge = matches!(frame, ActuatorFrame::Omni { kick: OmniKick::Discharge, .. });
        Self { drive: Drive::Rims(*wheels), kick, dribbler: *dribbler, discharge }
    }

    /// The same with NaN removed: it counts as no order.
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
