//! `grsim`: grSim's own messages, older than the league's protocol and still used by many teams. Commands go
//! to UDP 20011, robots' states come back to 30011 (blue) and 30012 (yellow). Units: m, m/s, rad/s;
//! **degrees** for a robot's heading.

use prost::Message;

/// To port 20011: commands for one team, and replacements.
#[derive(Clone, PartialEq, Message)]
pub struct GrsimPacket {
    /// Commands to robots.
    #[prost(message, optional, tag = "1")]
    pub commands: Option<GrsimCommands>,
    /// Objects to be moved.
    #[prost(message, optional, tag = "2")]
    pub replacement: Option<GrsimReplacement>,
}

/// Commands for one team.
#[derive(Clone, PartialEq, Message)]
pub struct GrsimCommands {
    /// The sender's time, s; read by no known program.
    #[prost(double, required, tag = "1")]
    pub timestamp: f64,
    /// True: for yellow.
    #[prost(bool, required, tag = "2")]
    pub isteamyellow: bool,
    /// Commands, one per robot.
    #[prost(message, repeated, tag = "3")]
    pub robot_commands: Vec<GrsimRobotCommand>,
}

/// Command to one robot, valid until the next.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct GrsimRobotCommand {
    /// Shell number, 0–15.
    #[prost(uint32, required, tag = "1")]
    pub id: u32,
    /// Speed of a kick along the ground, m/s; 0: none.
    #[prost(float, required, tag = "2")]
    pub kickspeedx: f32,
    /// Speed of a kick upwards, m/s; with the above it makes a chip.
    #[prost(float, required, tag = "3")]
    pub kickspeedz: f32,
    /// Velocity forward, m/s.
    #[prost(float, required, tag = "4")]
    pub veltangent: f32,
    /// Velocity to the left, m/s.
    #[prost(float, required, tag = "5")]
    pub velnormal: f32,
    /// Turning rate, counter-clockwise, rad/s.
    #[prost(float, required, tag = "6")]
    pub velangular: f32,
    /// Whether the dribbler turns.
    #[prost(bool, required, tag = "7")]
    pub spinner: bool,
    /// The wheels' speeds below hold instead of the velocities above.
    #[prost(bool, required, tag = "8")]
    pub wheelsspeed: bool,
    /// Speed of the front left wheel, rad/s.
    #[prost(float, optional, tag = "9")]
    pub wheel1: Option<f32>,
    /// Speed of the back left wheel, rad/s.
    #[prost(float, optional, tag = "10")]
    pub wheel2: Option<f32>,
    /// Speed of the back right wheel, rad/s.
    #[prost(float, optional, tag = "11")]
    pub wheel3: Option<f32>,
    /// Speed of the front right wheel, rad/s.
    #[prost(float, optional, tag = "12")]
    pub wheel4: Option<f32>,
}

/// Objects to be moved.
#[derive(Clone, PartialEq, Message)]
pub struct GrsimReplacement {
    /// The ball's new state.
    #[prost(message, optional, tag = "1")]
    pub ball: Option<GrsimBallReplacement>,
    /// The robots' new states.
    #[prost(message, repeated, tag = "2")]
    pub robots: Vec<GrsimRobotReplacement>,
}

/// New state of the ball; absent fields stay as they are.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct GrsimBallReplacement {
    /// Along the field's length, m.
    #[prost(double, optional, tag = "1")]
    pub x: Option<f64>,
    /// Coordinate to the left of +x, m.
    #[prost(double, optional, tag = "2")]
    pub y: Option<f64>,
    /// Velocity along +x, m/s.
    #[prost(double, optional, tag = "3")]
    pub vx: Option<f64>,
    /// Velocity to the left of +x, m/s.
    #[prost(double, optional, tag = "4")]
    pub vy: Option<f64>,
}

/// New state of a robot.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct GrsimRobotReplacement {
    /// Along the field's length, m.
    #[prost(double, required, tag = "1")]
    pub x: f64,
    /// Coordinate to the left of +x, m.
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
    /// False: it is switched off, and invisible to vision. Absent: on.
    #[prost(bool, optional, tag = "6")]
    pub turnon: Option<bool>,
}

/// To port 30011 (blue) or 30012 (yellow) of the last commander: robots whose state changed.
#[derive(Clone, PartialEq, Message)]
pub struct RobotsStatus {
    /// States, one per robot.
    #[prost(message, repeated, tag = "1")]
    pub robots_status: Vec<RobotStatus>,
}

/// One robot's state.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct RobotStatus {
    /// Shell number, 0–15.
    #[prost(int32, required, tag = "1")]
    pub robot_id: i32,
    /// Whether the ball is at the dribbler.
    #[prost(bool, required, tag = "2")]
    pub infrared: bool,
    /// Whether it kicks along the ground now.
    #[prost(bool, required, tag = "3")]
    pub flat_kick: bool,
    /// Whether it chips now.
    #[prost(bool, required, tag = "4")]
    pub chip_kick: bool,
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Written by hand from grSim's field numbers and types: yellow's robot 3 ahead at 1 m/s, turning,
    /// kicking, with its dribbler and two wheels given; blue's robot 15 put somewhere and switched off.
    const BYTES: [u8; 93] = [
        0x0a, 54, // commands, bytes
        0x09, 0, 0, 0, 0, 0, 0, 0xe0, 0x3f, // timestamp 0.5
        0x10, 1, // isteamyellow
        0x1a, 41, // robot_commands, bytes
        0x08, 3, // id
        0x15, 0, 0, 0x40, 0x40, // kickspeedx 3.0
        0x1d, 0, 0, 0, 0, // kickspeedz
        0x25, 0, 0, 0x80, 0x3f, // veltangent 1.0
        0x2d, 0, 0, 0, 0, // velnormal
        0x35, 0, 0, 0x80, 0xbf, // velangular -1.0
        0x38, 1, // spinner
        0x40, 0, // wheelsspeed
        0x4d, 0, 0, 0x20, 0x41, // wheel1 10.0
        0x65, 0, 0, 0x20, 0xc1, // wheel4 -10.0
        0x12, 35, // replacement, bytes
        0x12, 33, // robots, bytes
        0x09, 0, 0, 0, 0, 0, 0, 0xf0, 0x3f, // x 1.0
        0x11, 0, 0, 0, 0, 0, 0, 0, 0xc0, // y -2.0
        0x19, 0, 0, 0, 0, 0, 0x80, 0x56, 0x40, // dir 90.0
        0x20, 15, // id
        0x28, 0, // yellowteam
        0x30, 0, // turnon
    ];

    #[test]
    fn a_packet_written_by_hand_is_read_and_written_the_same() {
        let packet = GrsimPacket::decode(&BYTES[..]).expect("decodes");
        let commands = packet.commands.as_ref().expect("commands");
        assert!(commands.isteamyellow && commands.timestamp == 0.5);
        let robot = GrsimRobotCommand {
            id: 3,
            kickspeedx: 3.0,
            veltangent: 1.0,
            velangular: -1.0,
            spinner: true,
            wheel1: Some(10.0),
            wheel4: Some(-10.0),
            ..GrsimRobotCommand::default()
        };
        assert_eq!(commands.robot_commands, [robot]);
        let put = GrsimRobotReplacement {
            x: 1.0,
            y: -2.0,
            dir: 90.0,
            id: 15,
            yellowteam: false,
            turnon: Some(false),
        };
        assert_eq!(packet.replacement.as_ref().expect("a replacement").robots, [put]);
        assert_eq!(packet.encode_to_vec(), BYTES);
        let status = RobotStatus { robot_id: 7, infrared: true, flat_kick: false, chip_kick: true };
        let status = RobotsStatus { robots_status: vec![status] };
        assert_eq!(status.encode_to_vec(), [0x0a, 8, 0x08, 7, 0x10, 1, 0x18, 0, 0x20, 1]);
    }
}
