//! `grsim`: grSim's own messages, older than the league's protocol and still used by many teams. Commands go
//! to UDP 20011, robots' states come back to 30011 (blue) and 30012 (yellow). Units: m, m/s, rad/s;
//! **degrees** for a robot's heading.

use prost::Message;

messages! {
    /// Datagram to port 20011: commands for one team, and things to be moved.
    #[derive(Clone, PartialEq, Message)]
    pub struct GrsimPacket {
        /// Orders for one or more robots.
        commands: Option<GrsimCommands> [message, optional] = 1;
        /// Objects to be put somewhere else.
        replacement: Option<GrsimReplacement> [message, optional] = 2;
    }

    /// Commands for one team.
    #[derive(Clone, PartialEq, Message)]
    pub struct GrsimCommands {
        /// The sender's time, s; not read by simulators.
        timestamp: f64 [double, required] = 1;
        /// True: the commands are for yellow's robots.
        isteamyellow: bool [bool, required] = 2;
        /// One command for each robot.
        robot_commands: Vec<GrsimRobotCommand> [message, repeated] = 3;
    }

    /// Order for one robot until the next command.
    #[derive(Clone, Copy, PartialEq, Message)]
    pub struct GrsimRobotCommand {
        /// Shell number of the robot, 0–15.
        id: u32 [uint32, required] = 1;
        /// Kick along the ground, m/s; 0: none.
        kickspeedx: f32 [float, required] = 2;
        /// Kick upwards, m/s; with the above it makes a chip.
        kickspeedz: f32 [float, required] = 3;
        /// Velocity forward, m/s, robot frame.
        veltangent: f32 [float, required] = 4;
        /// Velocity to the left, m/s.
        velnormal: f32 [float, required] = 5;
        /// Turning rate, rad/s, counter-clockwise.
        velangular: f32 [float, required] = 6;
        /// True if the dribbler turns, at full speed.
        spinner: bool [bool, required] = 7;
        /// The wheels' speeds below hold instead of the velocities above.
        wheelsspeed: bool [bool, required] = 8;
        /// Front left wheel, rad/s.
        wheel1: Option<f32> [float, optional] = 9;
        /// Back left wheel, rad/s.
        wheel2: Option<f32> [float, optional] = 10;
        /// Back right wheel, rad/s.
        wheel3: Option<f32> [float, optional] = 11;
        /// Front right wheel, rad/s.
        wheel4: Option<f32> [float, optional] = 12;
    }

    /// Objects to be put somewhere else.
    #[derive(Clone, PartialEq, Message)]
    pub struct GrsimReplacement {
        /// New place of the ball; absent: it stays.
        ball: Option<GrsimBallReplacement> [message, optional] = 1;
        /// New places of robots; all others stay.
        robots: Vec<GrsimRobotReplacement> [message, repeated] = 2;
    }

    /// New state of the ball; fields that are left out stay as they are.
    #[derive(Clone, Copy, PartialEq, Message)]
    pub struct GrsimBallReplacement {
        /// Along the field's length, m.
        x: Option<f64> [double, optional] = 1;
        /// Coordinate to the left of +x, m.
        y: Option<f64> [double, optional] = 2;
        /// Velocity along +x, m/s.
        vx: Option<f64> [double, optional] = 3;
        /// Velocity along +y, m/s.
        vy: Option<f64> [double, optional] = 4;
    }

    /// New place of a robot.
    #[derive(Clone, Copy, PartialEq, Message)]
    pub struct GrsimRobotReplacement {
        /// Along the field's length, m.
        x: f64 [double, required] = 1;
        /// Coordinate to the left of +x, m.
        y: f64 [double, required] = 2;
        /// Heading, **degrees**, counter-clockwise from +x.
        dir: f64 [double, required] = 3;
        /// Shell number of the robot, 0–15.
        id: u32 [uint32, required] = 4;
        /// True: a robot of yellow.
        yellowteam: bool [bool, required] = 5;
        /// False: it is switched off, and vision does not see it. Absent: on.
        turnon: Option<bool> [bool, optional] = 6;
    }

    /// Datagram to port 30011 (blue) or 30012 (yellow) of the sender that commanded last: robots whose state
    /// changed.
    #[derive(Clone, PartialEq, Message)]
    pub struct RobotsStatus {
        /// One state for each robot.
        robots_status: Vec<RobotStatus> [message, repeated] = 1;
    }

    /// State of one robot: contact with the ball, kicks.
    #[derive(Clone, Copy, PartialEq, Message)]
    pub struct RobotStatus {
        /// Shell number of the robot, 0–15.
        robot_id: i32 [int32, required] = 1;
        /// The ball is at the dribbler.
        infrared: bool [bool, required] = 2;
        /// True while it kicks along the ground.
        flat_kick: bool [bool, required] = 3;
        /// True while it kicks a chip.
        chip_kick: bool [bool, required] = 4;
    }
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
