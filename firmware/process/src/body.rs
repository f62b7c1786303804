//! `body`: robot body in another simulator. Orders become `RobotControl`, `RobotControlResponse` becomes
//! sensor frames.
//!
//! Simulators differ (reference: the header of ER-Force's simulator, grSim's code, recordings of both), so
//! this keeps to what all of them do:
//! - **Motion.** Velocity in the robot's frame; ER-Force takes no wheel speeds. Wheel rims go through
//!   `motion::omni` back to the body's motion.
//! - **Every 10 ms, everything.** ER-Force puts a robot to standby after 0.1 s without a command and resets a
//!   dribbler whose speed is missing, so each command holds motion and dribbler, also where nothing changed.
//! - **Kick.** grSim kicks once per command that has a speed, ER-Force and ours whenever ball and charge are
//!   there while the last command has one. So the speed is in a command only while a kick is wanted; absent
//!   is no kick everywhere. ER-Force knows 0° and 45° only: flat and chip.
//! - **Ball contact.** Responses list other robots too, also ones that are off the field; ER-Force's
//!   "realistic" leaves robots out at random. Ours counts alone, and the last response holds for
//!   [`CONTACT_HOLDS`].

use geometry::{Body, Twist, Vector};
use motion::omni::Omni;
use protocol::robot_io::{ActuatorFrame, Health, OmniKick, SensorFrame, WHEELED_STEP};
use protocol::{Duration, Instant, RobotId};
use rules::RobotSpec;
use ssl::simulation::{
    MoveCommand, MoveLocalVelocity, RobotCommand, RobotControl, RobotControlResponse, RobotMoveCommand,
};

/// Between two commands, and between two sensor frames.
pub const TICK: Duration = WHEELED_STEP;
/// Validity of the last report of ball contact: five responses in a row are lost once in 100,000 at the 10 %
/// loss of ER-Force's "realistic".
const CONTACT_HOLDS: Duration = Duration::millis(50);
/// Full speed of a dribbler, rpm.
const DRIBBLER_FULL: f32 = RobotSpec::OURS.dribbler.full_rpm;
/// Angle of a chip kick, degrees above the ground.
const CHIP_ANGLE: f32 = RobotSpec::OURS.kicker.chip_degrees;
/// No simulated kicker and no robot is faster: what is beyond is a mistake, m/s.
const SPEED_MAX: f32 = 10.0;
/// Largest turning rate, rad/s.
const TURN_MAX: f32 = 30.0;

/// A robot's body in the simulation protocol.
#[derive(Clone, Debug)]
pub struct SimulatedBody {
    id: RobotId,
    wheels: Omni,
    motion: Twist<Body>,
    dribbler: f32,
    kick: OmniKick,
    contact: Option<(Instant, bool)>,
    errors: u32,
    last_error: Option<String>,
}

impl SimulatedBody {
    /// The body of robot `id`, standing.
    pub fn new(id: RobotId) -> Self {
        Self {
            id,
            wheels: Omni::default(),
            motion: Twist::default(),
            dribbler: 0.0,
            kick: OmniKick::None,
            contact: None,
            errors: 0,
            last_error: None,
        }
    }

    /// Sets the brain's orders. Orders that wheels cannot execute (NaN, a walking body's order) are standing
    /// still.
    pub fn obey(&mut self, order: ActuatorFrame) {
        let ActuatorFrame::Omni { wheels, dribbler, kick } = order else {
            (self.motion, self.dribbler, self.kick) = (Twist::default(), 0.0, OmniKick::None);
            if order == ActuatorFrame::Released {
                self.kick = OmniKick::Discharge;
            }
            return;
        };
        let Twist { linear, angular } = self.wheels.twist(wheels);
        let sane = linear.x().is_finite() && linear.y().is_finite() && angular.is_finite();
        self.motion = if sane {
            let (x, y) = (linear.x().clamp(-SPEED_MAX, SPEED_MAX), linear.y().clamp(-SPEED_MAX, SPEED_MAX));
            Twist { linear: Vector::new(x, y), angular: angular.clamp(-TURN_MAX, TURN_MAX) }
        } else {
            Twist::default()
        };
        self.dribbler = if dribbler.is_finite() { dribbler.clamp(0.0, 1.0) } else { 0.0 };
        self.kick = kick;
    }

    /// The command for the simulator.
    pub fn control(&self) -> RobotControl {
        let Twist { linear, angular } = self.motion;
        let velocity = MoveLocalVelocity { forward: linear.x(), left: linear.y(), angular };
        let (kick_speed, kick_angle) = match self.kick {
            OmniKick::Flat(speed) if speed > 0.0 => (Some(speed.min(SPEED_MAX)), Some(0.0)),
            OmniKick::Chip(speed) if speed > 0.0 => (Some(speed.min(SPEED_MAX)), Some(CHIP_ANGLE)),
            // A simulated kicker has no dangerous charge.
            OmniKick::None | OmniKick::Discharge | OmniKick::Flat(_) | OmniKick::Chip(_) => (None, None),
        };
        let command = RobotCommand {
            id: u32::from(self.id.number()),
            move_command: Some(RobotMoveCommand { command: Some(MoveCommand::LocalVelocity(velocity)) }),
            kick_speed,
            kick_angle,
            dribbler_speed: Some(self.dribbler * DRIBBLER_FULL),
        };
        RobotControl { robot_commands: vec![command] }
    }

    /// Handles the simulator's answer.
    pub fn handle_response(&mut self, now: Instant, response: &RobotControlResponse) {
        // A late answer may hold several of one robot: the last is the newest.
        let ours = response.feedback.iter().rfind(|robot| robot.id == u32::from(self.id.number()));
        if let Some(contact) = ours.and_then(|robot| robot.dribbler_ball_contact) {
            self.contact = Some((now, contact));
        }
        self.errors = self.errors.saturating_add(response.errors.len() as u32);
        if let Some(error) = response.errors.last() {
            self.last_error = Some(format!("{}: {}", error.code(), error.message()));
        }
    }

    /// The robot's sensor frame.
    pub fn sensors(&self, now: Instant) -> SensorFrame {
        SensorFrame {
            ball_contact: self.contact.is_some_and(|(at, contact)| contact && now.since(at) <= CONTACT_HOLDS),
            // The protocol does not report its motion, so the commanded one is used.
            odometry: self.motion,
            health: Health { battery: None, tipped: false, kicker_ready: true },
            ..SensorFrame::default()
        }
    }

    /// Number of errors that the simulator has answered with, and the text of the last one.
    pub fn errors(&self) -> (u32, Option<&str>) {
        (self.errors, self.last_error.as_deref())
    }
}

#[cfg(test)]
mod tests;
