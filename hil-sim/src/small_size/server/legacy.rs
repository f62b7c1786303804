//! `legacy`: grSim's older protocol, port 20011, as that simulator implements it; m, m/s, rad/s, degrees for
//! a replaced robot's heading.
//!
//! Robots' states go to the sender's machine, ports 30011 (blue) and 30012 (yellow), after each message and
//! only for robots whose state has changed since.

use std::collections::BTreeMap;
use std::net::SocketAddr;

use geometry::{Twist, Vector, math};
use protocol::{RobotId, Who};
use rules::Colour;
use ssl::Message;
use ssl::net::addresses;
use ssl::simulation::{
    GrsimPacket, GrsimReplacement, GrsimRobotCommand, RobotStatus, RobotsStatus, TeleportBall, TeleportRobot,
};

use super::{Destination, Server, Transmit};
use crate::small_size::{Drive, KickCommand, Order};

/// The last reported state of each robot.
pub(super) type ReportedStates = BTreeMap<Who, RobotStatus>;

impl Server {
    /// A datagram for port 20011. It is never answered with an error: the protocol has none.
    pub(super) fn legacy(&mut self, from: SocketAddr, bytes: &[u8]) {
        let Ok(packet) = GrsimPacket::decode(bytes) else {
            self.counts.undecodable += 1;
            return;
        };
        self.counts.control += 1;
        if let Some(commands) = &packet.commands {
            let colour = colour_of(commands.isteamyellow);
            for command in &commands.robot_commands {
                self.obey(colour, command);
            }
        }
        if let Some(replacement) = &packet.replacement {
            self.replace(replacement);
        }
        for (colour, port) in [
            (Colour::Blue, addresses::GRSIM_BLUE_STATUS_PORT),
            (Colour::Yellow, addresses::GRSIM_YELLOW_STATUS_PORT),
        ] {
            let robots_status = self.changes(colour);
            if robots_status.is_empty() {
                continue;
            }
            let to = Destination::Status(SocketAddr::new(from.ip(), port));
            self.out.push_back(Transmit { to, bytes: RobotsStatus { robots_status }.encode_to_vec() });
        }
    }

    fn obey(&mut self, colour: Colour, command: &GrsimRobotCommand) {
        let Some(id) = u8::try_from(command.id).ok().and_then(RobotId::new) else { return };
        let who = Who { colour, id };
        let Some(robot) = self.world.robot(who).filter(|robot| robot.present) else { return };
        let before = match robot.order().drive {
            Drive::Rims(rims) => rims,
            _ => [0.0; 4],
        };
        let drive = if command.wheelsspeed {
            // Numbered counter-clockwise from the front left; omitted wheels keep their speed.
            let wheels = [command.wheel4, command.wheel3, command.wheel2, command.wheel1];
            let mut rims = before;
            for (rim, wheel) in rims.iter_mut().zip(wheels) {
                *rim = wheel.map_or(*rim, |speed| speed * WHEEL_RADIUS);
            }
            Drive::Rims(rims)
        } else {
            let linear = Vector::new(command.veltangent, command.velnormal);
            Drive::Local(Twist { linear, angular: command.velangular })
        };
        let (flat, up) = (command.kickspeedx, command.kickspeedz);
        let kick = (flat > KICK_SPEED_MIN || up > KICK_SPEED_MIN).then(|| {
            let (flat, up) = (flat.max(0.0), up.max(0.0));
            let most = robot.kick_limits[usize::from(up > 0.0)];
            KickCommand { speed: math::sqrt(flat * flat + up * up).min(most), angle: math::atan2(up, flat) }
        });
        let dribbler = f32::from(u8::from(command.spinner));
        self.send_order(who, Order { drive, kick, dribbler, discharge: false });
    }

    /// Teleports, with the same code as the league's protocol.
    fn replace(&mut self, replacement: &GrsimReplacement) {
        let mut refused = Vec::new();
        for robot in &replacement.robots {
            let team = if robot.yellowteam { ssl::common::Team::Yellow } else { ssl::common::Team::Blue };
            let teleport = TeleportRobot {
                id: ssl::common::RobotId { id: Some(robot.id), team: Some(team as i32) },
                x: Some(robot.x as f32),
                y: Some(robot.y as f32),
                orientation: Some((robot.dir as f32).to_radians()),
                present: Some(robot.turnon.unwrap_or(true)),
                ..TeleportRobot::default()
            };
            if let Err(refusal) = self.teleport_robot(&teleport, &mut refused) {
                refused.push(refusal);
            }
        }
        if let Some(ball) = &replacement.ball {
            let number = |value: Option<f64>| value.map(|value| value as f32);
            let teleport = TeleportBall {
                x: number(ball.x),
                y: number(ball.y),
                // It is always placed on the field surface.
                z: Some(0.0),
                vx: number(ball.vx),
                vy: number(ball.vy),
                vz: Some(0.0),
                ..TeleportBall::default()
            };
            self.teleport_ball(&teleport, &mut refused);
        }
        self.counts.refused += refused.len() as u64;
    }

    /// The robots of the team whose state differs from the last reported one.
    fn changes(&mut self, colour: Colour) -> Vec<RobotStatus> {
        let now = self.world.now();
        let mut changed = Vec::new();
        for robot in self.world.robots().iter().filter(|robot| robot.who.colour == colour) {
            let kicked = robot.kicked().filter(|(at, _)| now - at < KICK_REPORTED_STEPS);
            let status = RobotStatus {
                robot_id: i32::from(robot.who.id.number()),
                infrared: robot.ball_contact,
                flat_kick: kicked.is_some_and(|(_, chip)| !chip),
                chip_kick: kicked.is_some_and(|(_, chip)| chip),
            };
            let before = self.reported.insert(robot.who, status);
            let initial = RobotStatus { robot_id: status.robot_id, ..RobotStatus::default() };
            if before.unwrap_or(initial) != status {
                changed.push(status);
            }
        }
        changed
    }
}

const fn colour_of(yellow: bool) -> Colour {
    if yellow { Colour::Yellow } else { Colour::Blue }
}

/// Radius of the wheels of grSim's first robot, m; wheels are commanded by their angular rate there.
const WHEEL_RADIUS: f32 = 0.027;
/// Minimum speed of a kick, m/s.
const KICK_SPEED_MIN: f32 = 0.0001;
/// Steps for which a kick is reported: ten of grSim's at 60 Hz.
const KICK_REPORTED_STEPS: u64 = 167;
