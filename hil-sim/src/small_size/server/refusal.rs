//! `refusal`: error codes of the simulator, with their fixes. Every error code of this simulator, one variant
//! each.
//!
//! The protocol leaves codes to each simulator: ours are `ONETWO_…`. In another simulator's profile the codes
//! are that one's, and errors for which it has no code are not reported, as it does not report them. The
//! messages are ours.

use std::fmt;

use ssl::simulation::SimulatorError;

use crate::four_legged::parameters::ParameterError;
use crate::small_size::compatibility::Profile;

/// Why a part of a message was refused. All other parts of the message were carried out.
#[derive(Clone, Debug, PartialEq)]
pub enum Refusal {
    /// The datagram is no message of this port.
    Undecodable,
    /// A robot's number is missing or above 15.
    NoSuchId(Option<u32>),
    /// A robot's team is missing or neither yellow nor blue.
    NoTeam,
    /// No robot of that number is on the field.
    UnknownRobot(u32),
    /// Two commands for one robot in one message; the later one takes effect.
    Twice(u32),
    /// A command without a motion; the robot brakes.
    MissingMove(u32),
    /// An empty `move_command`; the robot keeps its motion.
    EmptyMove(u32),
    /// A robot's velocity in a form that the simulator does not accept; it brakes.
    VelocityForm(u32),
    /// A NaN or infinite number; its setting was left out.
    NotANumber(&'static str),
    /// A kick faster than the robot's maximum; it will kick at its maximum.
    KickTooFast {
        /// Number of the robot.
        id: u32,
        /// Speed of the order, m/s.
        asked: f32,
        /// Maximum speed of the robot's kicker, m/s.
        most: f32,
    },
    /// A kick's speed below zero; no kick.
    KickBackwards(u32),
    /// A kick's angle outside 0–90°; no kick.
    KickAngle {
        /// Number of the robot.
        id: u32,
        /// Angle of the order, degrees.
        asked: f32,
    },
    /// A dribbler's speed below zero; the dribbler stops.
    DribblerBackwards(u32),
    /// A position outside the walls of the room.
    OutsideServerLoop(&'static str),
    /// A teleport with a speed above the maximum; it got the maximum speed.
    TooFast {
        /// Name of the object.
        what: &'static str,
        /// Requested speed, m/s or rad/s.
        asked: f32,
        /// Maximum speed, m/s or rad/s.
        most: f32,
    },
    /// One coordinate of two is missing; nothing was moved.
    Partial(&'static str),
    /// A safe teleport of the ball without both coordinates; nothing was moved.
    PartialSafely,
    /// A velocity with a pull by force; nothing was moved.
    VelocityForce(&'static str),
    /// A robot that is to be placed on the field has never been specified.
    Unspecified(u32),
    /// A robot that is to be placed on the field has no position given.
    NoPlace(u32),
    /// A robot's specification lacks a value that this simulator needs.
    SpecsLack(&'static str),
    /// A simulation speed that is negative or beyond [`super::SPEED_MAX`].
    Pace(f32),
    /// A robot's specification outside the limits of the physics.
    Specs(ParameterError),
    /// A field with impossible dimensions.
    Geometry(rules::FieldFault),
    /// An impossible ball model, or one that is not of a solid ball.
    BallModel(String),
    /// The share of a kick's speed below which the ball rolls is not a solid ball's; the other parameters
    /// take effect.
    BallSwitch(f64),
    /// Noise, delays or losses out of their range.
    Realism(ParameterError),
    /// A custom setting of an unknown type.
    UnknownCustom(String),
    /// A custom setting of a known type whose bytes cannot be decoded.
    BrokenCustom(String),
    /// A setting that exists in the protocol but is not supported here; it was left out.
    Unsupported(&'static str),
    /// A vision port outside 1–65535; the old one stays.
    VisionPort(u32),
    /// A step that is not a positive duration, or is longer than [`super::SYNC_MAX`].
    SyncStep(f32),
    /// The active profile has no such setting.
    ModesConfig(&'static str),
    /// The active profile has no safe teleport.
    ModesSafely,
    /// The active profile cannot make a ball roll.
    ModesRoll,
}

impl Refusal {
    /// The machine-readable code, without the simulator's prefix.
    pub fn code(&self) -> &'static str {
        match self {
            Self::Undecodable => "UNDECODABLE",
            Self::NoSuchId(_) => "NO_SUCH_ID",
            Self::NoTeam => "NO_TEAM",
            Self::UnknownRobot(_) => "UNKNOWN_ROBOT",
            Self::Twice(_) => "COMMANDED_TWICE",
            Self::MissingMove(_) => "MISSING_MOVE_COMMAND",
            Self::EmptyMove(_) => "EMPTY_MOVE_COMMAND",
            Self::VelocityForm(_) => "VELOCITY_FORM",
            Self::NotANumber(_) => "NOT_A_NUMBER",
            Self::TooFast { .. } => "TOO_FAST",
            Self::Partial(_) => "PARTIAL",
            Self::PartialSafely => "PARTIAL_SAFELY",
            Self::VelocityForce(_) => "VELOCITY_FORCE",
            Self::Unspecified(_) => "UNSPECIFIED",
            Self::NoPlace(_) => "NO_PLACE",
            Self::SpecsLack(_) => "SPECS_LACK",
            Self::BallSwitch(_) => "BALL_SWITCH",
            Self::KickTooFast { .. } => "KICK_TOO_FAST",
            Self::KickBackwards(_) => "KICK_BACKWARDS",
            Self::KickAngle { .. } => "KICK_ANGLE",
            Self::DribblerBackwards(_) => "DRIBBLER_BACKWARDS",
            Self::OutsideServerLoop(_) => "OUTSIDE_HALL",
            Self::Pace(_) => "SIMULATION_SPEED",
            Self::Specs(_) => "ROBOT_SPECS",
            Self::Geometry(_) => "GEOMETRY",
            Self::BallModel(_) => "BALL_MODEL",
            Self::Realism(_) => "REALISM",
            Self::UnknownCustom(_) => "UNKNOWN_CUSTOM",
            Self::BrokenCustom(_) => "BROKEN_CUSTOM",
            Self::Unsupported(_) => "UNSUPPORTED",
            Self::VisionPort(_) => "VISION_PORT",
            Self::SyncStep(_) => "SYNC_STEP",
            Self::ModesConfig(_) => "UNSUPPORTED_CONFIG",
            Self::ModesSafely => "UNSUPPORTED_TELEPORT_SAFELY",
            Self::ModesRoll => "UNSUPPORTED_ROLL_BALL",
        }
    }

    /// The complete code in that profile; `None` where it reports nothing.
    pub fn code_of(&self, profile: Profile) -> Option<String> {
        match profile {
            Profile::Ours => Some(format!("ONETWO_{}", self.code())),
            Profile::Grsim => {
                let known = matches!(
                    self,
                    Self::ModesConfig(_) | Self::ModesSafely | Self::ModesRoll | Self::EmptyMove(_)
                );
                let code =
                    if matches!(self, Self::EmptyMove(_)) { "UNSUPPORTED_MOVE_COMMAND" } else { self.code() };
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

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Undecodable => f.write_str(
                "this datagram is no message of this port; 10300 takes SimulatorCommand, 10301 (blue) and 10302 (yellow) take \
                 RobotControl",
            ),
            Self::NoSuchId(Some(id)) => write!(f, "robot {id}: numbers are 0 to 15"),
            Self::NoSuchId(None) => f.write_str("a robot without a number; set id.id, 0 to 15"),
            Self::NoTeam => f.write_str("a robot without a team; set id.team to YELLOW or BLUE"),
            Self::UnknownRobot(id) => write!(
                f,
                "robot {id} of this team is not on the field; put it there with a TeleportRobot with present = true"
            ),
            Self::Twice(id) => write!(f, "robot {id} is commanded twice in one message; the later command holds"),
            Self::MissingMove(id) => {
                write!(f, "robot {id}: no move_command, so it brakes; set wheel, local or global velocity")
            }
            Self::EmptyMove(id) => {
                write!(f, "robot {id}: move_command without a velocity, so it goes on as it did; set one of the three")
            }
            Self::VelocityForm(id) => {
                write!(f, "robot {id}: this simulator takes local_velocity alone; the robot brakes")
            }
            Self::TooFast { what, asked, most } => {
                write!(f, "{what}: {asked} is more than the {most} that there can be; it got that")
            }
            Self::Partial(what) => {
                write!(f, "{what}: one coordinate of two, which this simulator does not take; give x and y (and a robot's orientation), v_x and v_y")
            }
            Self::PartialSafely => f.write_str("teleport_ball.teleport_safely needs x and y"),
            Self::VelocityForce(what) => {
                write!(f, "{what}: a velocity makes no sense with by_force; leave one of them out")
            }
            Self::Unspecified(id) => {
                write!(f, "robot {id} has no specification; send its robot_specs before it is put on the field")
            }
            Self::NoPlace(id) => write!(f, "robot {id} is to be put on the field; say where, x and y"),
            Self::SpecsLack(what) => {
                write!(f, "robot_specs without {what}, which this simulator needs; this robot stays as it was")
            }
            Self::BallSwitch(asked) => write!(
                f,
                "geometry.models.straight_two_phase.k_switch {asked}: the ball is solid here and rolls from 5/7 of a kick's speed on; the rest of the model was taken"
            ),
            Self::NotANumber(what) => write!(f, "{what} is not a finite number; this part was left out"),
            Self::KickTooFast { id, asked, most } => {
                write!(f, "robot {id}: kick_speed {asked} m/s; it can do {most} m/s and will (robot_specs change that)")
            }
            Self::KickBackwards(id) => write!(f, "robot {id}: kick_speed is negative; kick with 0 m/s or more"),
            Self::KickAngle { id, asked } => {
                write!(f, "robot {id}: kick_angle {asked}; it is in degrees, 0 to 90")
            }
            Self::DribblerBackwards(id) => {
                write!(f, "robot {id}: dribbler_speed is negative; this dribbler turns one way, in rpm from 0")
            }
            Self::OutsideServerLoop(what) => {
                write!(f, "{what} lies outside the hall; places are in metres, not millimetres")
            }
            Self::Pace(asked) => {
                write!(f, "simulation_speed {asked}: 0 stands still, 1 is real time, {} is most", super::SPEED_MAX)
            }
            Self::Specs(error) => write!(f, "robot_specs: {error}; this robot stays as it was"),
            Self::Geometry(error) => write!(f, "geometry: {error}; the field stays as it was (lengths are in mm)"),
            Self::BallModel(why) => write!(f, "geometry.models: {why}; the ball stays as it was"),
            Self::Realism(error) => write!(f, "realism_config: {error}; noise and delays stay as they were"),
            Self::UnknownCustom(url) => {
                write!(f, "custom of type `{url}` is not known; RealismConfigErForce and RobotSpecErForce are")
            }
            Self::BrokenCustom(url) => write!(f, "custom of type `{url}` cannot be read as that"),
            Self::Unsupported(what) => write!(f, "{what} is not simulated here; it was left out"),
            Self::VisionPort(port) => write!(f, "vision_port {port}: ports are 1 to 65535"),
            Self::SyncStep(asked) => {
                write!(f, "sim_step {asked} s: more than 0 and at most {} s", super::SYNC_MAX)
            }
            Self::ModesConfig(what) => write!(f, "{what} cannot be set in this simulator; start it otherwise"),
            Self::ModesSafely => f.write_str("teleport_safely is not known to this simulator; the rest of the teleport was done"),
            Self::ModesRoll => f.write_str("roll is not known to this simulator; the rest of the teleport was done"),
        }
    }
}

impl std::error::Error for Refusal {}
