//! `actuation`: turns an intent into actuator orders; legs directly, wheels through drivetrain, governor and
//! kinematics.

mod bodies;
mod drivetrain;
pub mod surroundings;
mod walk;

use geometry::Twist;
use motion::omni::Omni;
use protocol::Instant;
use protocol::robot_io::{ActuatorFrame, SensorFrame};
use rules::{League, RobotSpec};

use crate::belief::Belief;
use crate::body::Intent;
use crate::body::kind::{self, BodyKind};
use crate::governor::{Circumstances, Governor, LimitReason, Reasons, Ruling};
use crate::hosted::Hosted;
use crate::teammates::Teammates;
pub use drivetrain::Drivetrain;

/// Actuation of one body, with its state.
#[allow(clippy::large_enum_variant, reason = "one value a robot, and no heap to box it on")]
#[derive(Clone, Debug)]
pub enum Actuation {
    /// Actuation of four legs.
    Legs(kind::Legs),
    /// Actuation of four wheels.
    Wheels(kind::WheeledKind, WheelControl),
}

/// Drivetrain of the wheels with the governor that limits it.
#[derive(Clone, Debug)]
pub struct WheelControl {
    drivetrain: Drivetrain,
    governor: Governor,
    kinematics: Omni,
    ruling: Ruling,
}

impl Actuation {
    /// Actuation for that league's robots.
    pub fn of(league: League) -> Self {
        match BodyKind::of(league) {
            BodyKind::Legged(built) => Self::Legs(built),
            BodyKind::Wheeled(built) => {
                let wheels = WheelControl {
                    drivetrain: Drivetrain::default(),
                    governor: Governor::new(league),
                    kinematics: Omni::default(),
                    ruling: Ruling::Allowed,
                };
                Self::Wheels(built, wheels)
            }
        }
    }

    /// Counts a frame of the host as received at `received`.
    pub fn receive_host(&mut self, received: Instant) {
        if let Self::Wheels(_, wheels) = self {
            wheels.governor.receive_host(received);
        }
    }

    /// Whether its steps are short (10 ms, docs/architecture.md §2.3), so that work is spread over several.
    pub fn has_short_steps(&self) -> bool {
        matches!(self, Self::Wheels(..))
    }

    /// Whether the next plan of its path needs more time than the last ones had.
    pub fn needs_time(&self) -> bool {
        match self {
            Self::Legs(_) => false,
            Self::Wheels(_, wheels) => wheels.drivetrain.needs_time(),
        }
    }

    /// Accounts for more instructions of this step.
    pub fn spend(&mut self, instructions: u32) {
        if let Self::Wheels(_, wheels) = self {
            wheels.drivetrain.spend(instructions);
        }
    }

    /// Sets how many instructions the inputs of this step took.
    pub fn set_spent(&mut self, instructions: u32) {
        if let Self::Wheels(_, wheels) = self {
            wheels.drivetrain.set_spent(instructions);
        }
    }

    /// Number of steps between two beacons of this body's robots (docs/architecture.md §5.1).
    pub fn beacon_steps(&self) -> u8 {
        match self {
            Self::Legs(_) => 1,
            Self::Wheels(..) => BEACON_STEPS,
        }
    }

    /// The governor's decision on the motion wanted in the last step.
    pub fn ruling(&self) -> Ruling {
        match self {
            Self::Legs(_) => Ruling::Allowed,
            Self::Wheels(_, wheels) => wheels.ruling,
        }
    }

    /// Why it brakes or is limited.
    pub fn reasons(&self) -> Reasons {
        match self.ruling() {
            Ruling::Allowed => Reasons::default(),
            Ruling::Limited(reasons) | Ruling::Braking(reasons) => reasons,
        }
    }

    /// Whether the battery is too low to play.
    pub fn is_battery_low(&self) -> bool {
        self.reasons().has(LimitReason::Battery)
    }

    /// The order that makes the body do `intent`, within its limits.
    pub fn act(
        &mut self,
        now: Instant,
        belief: &Belief,
        teammates: &Teammates,
        host: Option<&Hosted>,
        sensors: &SensorFrame,
        intent: Intent,
    ) -> ActuatorFrame {
        let wheels = match self {
            Self::Legs(_) => return walk::actuate(now, belief, teammates, intent),
            Self::Wheels(_, wheels) => wheels,
        };
        let wanted = wheels.drivetrain.actuate(now, belief, intent);
        let circumstances = Circumstances {
            now,
            host: host.map(Hosted::hearing),
            phase: host.and_then(Hosted::phase),
            placed: host.map_or(sensors.pose.is_some(), |host| host.shows_me(now)),
            health: &sensors.health,
            odometry: sensors.odometry,
        };
        let (mut given, ruling) = wheels.governor.rule(&circumstances, &wanted);
        wheels.ruling = ruling;
        if wheels.governor.has_let_go() {
            wheels.drivetrain.set_speed_order(belief, Twist::default());
            return ActuatorFrame::Released;
        }
        given.twist = wheels.kinematics.saturated(given.twist, RIM_MAX).0;
        wheels.drivetrain.set_speed_order(belief, given.twist);
        ActuatorFrame::Omni {
            wheels: wheels.kinematics.rims(given.twist),
            dribbler: given.dribbler,
            kick: given.kick,
        }
    }
}

/// 20 beacons a second, in steps of 10 ms (docs/architecture.md §2.3, §5.1).
const BEACON_STEPS: u8 = 5;
/// Largest rim speed ordered, m/s: below what wheels run free.
const RIM_MAX: f32 = RobotSpec::OURS.wheels.rim_max;
