//! `refusal`: error codes of the simulator, with their fixes. Every error code of this simulator, one variant
//! each.
//!
//! The protocol leaves codes to each simulator: ours are `ONETWO_…`. In another simulator's profile the codes
//! are that one's, and errors for which it has no code are not reported, as it does not report them. The
//! messages are ours.

use ssl::simulation::SimulatorError;
use thiserror::Error;

use crate::parameters::ParameterError;
use crate::small_size::compatibility::Profile;

geometry::labels! {
    /// Part of a message that was refused. All other parts of the message were carried out. Labels are
    /// machine-readable codes without the simulator's prefix.
    #[derive(Clone, Debug, PartialEq, Error)]
    pub enum Refusal {
        /// The datagram is no message of this port.
        #[error(
            "this datagram is no message of this port; 10300 takes SimulatorCommand, 10301 (blue) and 10302 (yellow) take \
             RobotControl"
        )]
        Undecodable = "UNDECODABLE",
        /// A robot's number is missing or above 15.
        #[error("{}", no_such_id(*.0))]
        NoSuchId(Option<u32>) = "NO_SUCH_ID",
        /// A robot's team is missing or neither yellow nor blue.
        #[error("a robot without a team; set id.team to YELLOW or BLUE")]
        NoTeam = "NO_TEAM",
        /// No robot of that number is on the field.
        #[error(
            "robot {0} of this team is not on the field; put it there with a TeleportRobot with present = true"
        )]
        UnknownRobot(u32) = "UNKNOWN_ROBOT",
        /// Two commands for one robot in one message; the later one takes effect.
        #[error("robot {0} is commanded twice in one message; the later command holds")]
        Twice(u32) = "COMMANDED_TWICE",
        /// A command without a motion; the robot brakes.
        #[error("robot {0}: no move_command, so it brakes; set wheel, local or global velocity")]
        MissingMove(u32) = "MISSING_MOVE_COMMAND",
        /// An empty `move_command`; the robot keeps its motion.
        #[error("robot {0}: move_command without a velocity, so it goes on as it did; set one of the three")]
        EmptyMove(u32) = "EMPTY_MOVE_COMMAND",
        /// A robot's velocity in a form that the simulator does not accept; it brakes.
        #[error("robot {0}: this simulator takes local_velocity alone; the robot brakes")]
        VelocityForm(u32) = "VELOCITY_FORM",
        /// A NaN or infinite number; its setting was left out.
        #[error("{0} is not a finite number; this part was left out")]
        NotANumber(&'static str) = "NOT_A_NUMBER",
        /// A kick faster than the robot's maximum; it will kick at its maximum.
        #[error("robot {id}: kick_speed {asked} m/s; it can do {most} m/s and will (robot_specs change that)")]
        KickTooFast {
            /// Number of the robot.
            id: u32,
            /// Speed of the order, m/s.
            asked: f32,
            /// Maximum speed of the robot's kicker, m/s.
            most: f32,
        } = "KICK_TOO_FAST",
        /// A kick's speed below zero; no kick.
        #[error("robot {0}: kick_speed is negative; kick with 0 m/s or more")]
        KickBackwards(u32) = "KICK_BACKWARDS",
        /// A kick's angle outside 0–90°; no kick.
        #[error("robot {id}: kick_angle {asked}; it is in degrees, 0 to 90")]
        KickAngle {
            /// Number of the robot.
            id: u32,
            /// Angle of the order, degrees.
            asked: f32,
        } = "KICK_ANGLE",
        /// A dribbler's speed below zero; the dribbler stops.
        #[error("robot {0}: dribbler_speed is negative; this dribbler turns one way, in rpm from 0")]
        DribblerBackwards(u32) = "DRIBBLER_BACKWARDS",
        /// A position outside the walls of the venue.
        #[error("{0} lies outside the venue; places are in metres, not millimetres")]
        OutsideHall(&'static str) = "OUTSIDE_HALL",
        /// A teleport with a speed above the maximum; it got the maximum speed.
        #[error("{what}: {asked} is more than the {most} that there can be; it got that")]
        TooFast {
            /// Name of the object.
            what: &'static str,
            /// Requested speed, m/s or rad/s.
            asked: f32,
            /// Maximum speed, m/s or rad/s.
            most: f32,
        } = "TOO_FAST",
        /// One coordinate of two is missing; nothing was moved.
        #[error(
            "{0}: one coordinate of two, which this simulator does not take; give x and y (and a robot's orientation), v_x and v_y"
        )]
        Partial(&'static str) = "PARTIAL",
        /// A safe teleport of the ball without both coordinates; nothing was moved.
        #[error("teleport_ball.teleport_safely needs x and y")]
        PartialSafely = "PARTIAL_SAFELY",
        /// A velocity with a pull by force; nothing was moved.
        #[error("{0}: a velocity makes no sense with by_force; leave one of them out")]
        VelocityForce(&'static str) = "VELOCITY_FORCE",
        /// A robot that is to be placed on the field has never been specified.
        #[error("robot {0} has no specification; send its robot_specs before it is put on the field")]
        Unspecified(u32) = "UNSPECIFIED",
        /// A robot that is to be placed on the field has no position given.
        #[error("robot {0} is to be put on the field; say where, x and y")]
        NoPlace(u32) = "NO_PLACE",
        /// A robot's specification lacks a value that this simulator needs.
        #[error("robot_specs without {0}, which this simulator needs; this robot stays as it was")]
        SpecsLack(&'static str) = "SPECS_LACK",
        /// A simulation speed that is negative or beyond [`super::SPEED_MAX`].
        #[error("simulation_speed {0}: 0 stands still, 1 is real time, {most} is most", most = super::SPEED_MAX)]
        Pace(f32) = "SIMULATION_SPEED",
        /// A robot's specification outside the limits of the physics.
        #[error("robot_specs: {0}; this robot stays as it was")]
        Specs(ParameterError) = "ROBOT_SPECS",
        /// A field with impossible dimensions.
        #[error("geometry: {0}; the field stays as it was (lengths are in mm)")]
        Geometry(rules::FieldFault) = "GEOMETRY",
        /// An impossible ball model, or one that is not of a solid ball.
        #[error("geometry.models: {0}; the ball stays as it was")]
        BallModel(String) = "BALL_MODEL",
        /// The share of a kick's speed below which the ball rolls is not a solid ball's; the other parameters
        /// take effect.
        #[error(
            "geometry.models.straight_two_phase.k_switch {0}: the ball is solid here and rolls from 5/7 of a kick's speed on; the rest of the model was taken"
        )]
        BallSwitch(f64) = "BALL_SWITCH",
        /// Noise, delays or losses out of their range.
        #[error("realism_config: {0}; noise and delays stay as they were")]
        Realism(ParameterError) = "REALISM",
        /// A custom setting of an unknown type.
        #[error("custom of type `{0}` is not known; RealismConfigErForce and RobotSpecErForce are")]
        UnknownCustom(String) = "UNKNOWN_CUSTOM",
        /// A custom setting of a known type whose bytes cannot be decoded.
        #[error("custom of type `{0}` cannot be read as that")]
        BrokenCustom(String) = "BROKEN_CUSTOM",
        /// A setting that exists in the protocol but is not supported here; it was left out.
        #[error("{0} is not simulated here; it was left out")]
        Unsupported(&'static str) = "UNSUPPORTED",
        /// A vision port outside 1–65535; the old one stays.
        #[error("vision_port {0}: ports are 1 to 65535")]
        VisionPort(u32) = "VISION_PORT",
        /// A step that is not a positive duration, or is longer than [`super::SYNC_MAX`].
        #[error("sim_step {0} s: more than 0 and at most {most} s", most = super::SYNC_MAX)]
        SyncStep(f32) = "SYNC_STEP",
        /// The active profile has no such setting.
        #[error("{0} cannot be set in this simulator; start it otherwise")]
        ModesConfig(&'static str) = "UNSUPPORTED_CONFIG",
        /// The active profile has no safe teleport.
        #[error("teleport_safely is not known to this simulator; the rest of the teleport was done")]
        ModesSafely = "UNSUPPORTED_TELEPORT_SAFELY",
        /// The active profile cannot make a ball roll.
        #[error("roll is not known to this simulator; the rest of the teleport was done")]
        ModesRoll = "UNSUPPORTED_ROLL_BALL",
    }
}

impl Refusal {
    /// The complete code in that profile; `None` where it reports nothing.
    pub fn code_of(&self, profile: Profile) -> Option<String> {
        match profile {
            Profile::Ours => Some(format!("ONETWO_{}", self.label())),
            Profile::Grsim => {
                let known = matches!(
                    self,
                    Self::ModesConfig(_) | Self::ModesSafely | Self::ModesRoll | Self::EmptyMove(_)
                );
                let code = if matches!(self, Self::EmptyMove(_)) {
                    "UNSUPPORTED_MOVE_COMMAND"
                } else {
                    self.label()
                };
                known.then(|| format!("GRSIM_{code}"))
            }
            Profile::ErForce => Some(
                match self {
                    Self::Undecodable => "UNREADABLE",
                    Self::VelocityForm(_) => "VELOCITY_TYPE",
                    Self::Partial(_) => "PARTIAL_COORD",
                    Self::PartialSafely => "TELEPORT_SAFELY_PARTIAL",
                    Self::VelocityForce(_) => "VELOCITY_FORCE",
                    Self::Unspecified(_) => "CREATE_UNSPEC_ROBOT",
                    Self::NoPlace(_) => "CREATE_NOPOS_ROBOT",
                    Self::SpecsLack(_) | Self::Specs(_) => "INVALID_SPEC",
                    _ => return None,
                }
                .to_owned(),
            ),
        }
    }

    /// The error message of the protocol, where it is reported.
    pub fn reported(&self, profile: Profile) -> Option<SimulatorError> {
        Some(SimulatorError { code: Some(self.code_of(profile)?), message: Some(self.to_string()) })
    }
}

fn no_such_id(id: Option<u32>) -> String {
    id.map_or_else(
        || "a robot without a number; set id.id, 0 to 15".into(),
        |id| format!("robot {id}: numbers are 0 to 15"),
    )
}
