//! `grsim`: grSim's own messages, older than the league's protocol and still spoken by many teams. Commands go to UDP 20011, robots'
//! states come back to 30011 (blue) and 30012 (yellow). Units: m, m/s, rad/s; **degrees** for a robot's heading.

use prost::Message;

/// To port 20011: commands for one team, and things to be moved.
#[derive(Clone, PartialEq, Message)]
pub struct GrsimPacket {
    /// What robots shall do.
    #[prost(message, optional, tag = "1")]
    pub commands: Option<GrsimCommands>,
    /// What is to be put somewhere else.
    #[prost(message, optional, tag = "2")]
    pub replacement: Option<GrsimReplacement>,
}

/// Commands for one team.
#[derive(Clone, PartialEq, Message)]
pub struct GrsimCommands {
    /// The sender's time, s; nobody reads it.
    #[prost(double, required, tag = "1")]
    pub timestamp: f64,
    /// True: for yellow.
    #[prost(bool, required, tag = "2")]
    pub isteamyellow: bool,
    /// One a robot.
    #[prost(message, repeated, tag = "3")]
    pub robot_commands: Vec<GrsimRobotCommand>,
}

/// What one robot shall do until the next command.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct GrsimRobotCommand {
    /// Shell number, 0–15.
    #[prost(uint32, required, tag = "1")]
    pub id: u32,
    /// Kick along the ground, m/s; 0: none.
    #[prost(float, required, tag = "2")]
    pub kickspeedx: f32,
    /// Kick upwards, m/s; with the above it makes a chip.
    #[prost(float, required, tag = "3")]
    pub kickspeedz: f32,
    /// Forward, m/s.
    #[prost(float, required, tag = "4")]
    pub veltangent: f32,
    /// To the left, m/s.
    #[prost(float, required, tag = "5")]
    pub velnormal: f32,
    /// Counter-clockwise, rad/s.
    #[prost(float, required, tag = "6")]
    pub velangular: f32,
    /// The dribbler turns.
    #[prost(bool, required, tag = "7")]
    pub spinner: bool,
    /// The wheels' speeds below hold instead of the velocities above.
    #[prost(bool, required, tag = "8")]
    pub wheelsspeed: bool,
    /// Front left, rad/s.
    #[prost(float, optional, tag = "9")]
    pub wheel1: Option<f32>,
    /// Back left, rad/s.
    #[prost(float, optional, tag = "10")]
    pub wheel2: Option<f32>,
    /// Back right, rad/s.
    #[prost(float, optional, tag = "11")]
    pub wheel3: Option<f32>,
    /// Front right, rad/s.
    #[prost(float, optional, tag = "12")]
    pub wheel4: Option<f32>,
}

/// What is to be put somewhere else.
#[derive(Clone, PartialEq, Message)]
pub struct GrsimReplacement {
    /// The ball.
    #[prost(message, optional, tag = "1")]
    pub ball: Option<GrsimBallReplacement>,
    /// Robots.
    #[prost(message, repeated, tag = "2")]
    pub robots: Vec<GrsimRobotReplacement>,
}

/// Where the ball shall be; what is left out stays as it is.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct GrsimBallReplacement {
    /// Along the field's length, m.
    #[prost(double, optional, tag = "1")]
    pub x: Option<f64>,
    /// To the left of +x, m.
    #[prost(double, optional, tag = "2")]
    pub y: Option<f64>,
    /// m/s.
    #[prost(double, optional, tag = "3")]
    pub vx: Option<f64>,
    /// m/s.
    #[prost(double, optional, tag = "4")]
    pub vy: Option<f64>,
}

/// Where a robot shall stand.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct GrsimRobotReplacement {
    /// Along the field's length, m.
    #[prost(double, required, tag = "1")]
    pub x: f64,
    /// To the left of +x, m.
    #[prost(double, required, tag = "2")]
    pub y: f64,
    /// Heading, **degrees**, counter-clockwise from +x.
    #[prost(double, required, tag = "3")]
    pub dir: f64,
    /// Shell number, 0–15.
    #[prost(uint32, required, tag = "4")]
    pub id: u32,
    /// True: yellow's.
    #[prost(bool, required, tag = "5")]
    pub yellowteam: bool,
    /// False: it is switched off, and vision does not see it. Absent: on.
    #[prost(bool, optional, tag = "6")]
    pub turnon: Option<bool>,
}

/// To port 30011 (blue) or 30012 (yellow) of whoever commanded last: robots whose state changed.
#[derive(Clone, PartialEq, Message)]
pub struct RobotsStatus {
    /// One a robot.
    #[prost(message, repeated, tag = "1")]
    pub robots_status: Vec<RobotStatus>,
}

/// One robot's state.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct RobotStatus {
    /// Shell number, 0–15.
    #[prost(int32, required, tag = "1")]
    pub robot_id: i32,
    /// The ball is at the dribbler.
    #[prost(bool, required, tag = "2")]
    pub infrared: bool,
    /// It kicks along the ground now.
    #[prost(bool, required, tag = "3")]
    pub flat_kick: bool,
    /// It chips now.
    #[prost(bool, required, tag = "4")]
    pub chip_kick: bool,
}
