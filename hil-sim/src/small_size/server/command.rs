//! `command`: robot commands and feedback. Ports 10301 and 10302; m/s, rad/s, kick angles in degrees,
//! dribbler in rpm.

use geometry::{Twist, Vector, math};
use protocol::{RobotId, Who};
use rules::Colour;
use ssl::simulation::{MoveCommand, RobotCommand, RobotControl, RobotControlResponse, RobotFeedback};

use super::{Refusal, Server};
use crate::small_size::compatibility::Feedback;
use crate::small_size::{Drive, KickCommand, Order};

impl Server {
    /// Gives a team's robots their commands; returns the answer.
    pub(super) fn lead(&mut self, colour: Colour, control: &RobotControl) -> RobotControlResponse {
        let mut refused = Vec::new();
        let mut commanded = [false; RobotId::COUNT];
        for command in &control.robot_commands {
            let id = u8::try_from(command.id).ok().and_then(RobotId::new);
            let Some(id) = id else {
                refused.push(Refusal::NoSuchId(Some(command.id)));
                continue;
            };
            if std::mem::replace(&mut commanded[id.index()], true) {
                refused.push(Refusal::Twice(command.id));
            }
            self.command(Who { colour, id }, command, &mut refused);
        }
        RobotControlResponse { errors: self.reported(&refused), feedback: self.feedback(colour, &commanded) }
    }

    fn command(&mut self, who: Who, command: &RobotCommand, refused: &mut Vec<Refusal>) {
        let compatibility = self.cameras.settings().compatibility;
        let form = command.move_command.and_then(|wanted| wanted.command);
        let unknown_form = compatibility.local_velocity_only
            && matches!(form, Some(MoveCommand::WheelVelocity(_) | MoveCommand::GlobalVelocity(_)));
        if unknown_form {
            refused.push(Refusal::VelocityForm(command.id));
        }
        let Some(robot) = self.world.robot(who).filter(|robot| robot.present) else {
            refused.push(Refusal::UnknownRobot(command.id));
            return;
        };
        let before = *robot.order();
        let kick = kick(command, robot.kick_limits, refused);
        let dribbler = match command.dribbler_speed {
            None if compatibility.dribbler_resets => 0.0,
            None => before.dribbler,
            Some(rpm) if !rpm.is_finite() => {
                refused.push(Refusal::NotANumber("dribbler_speed"));
                0.0
            }
            Some(rpm) if rpm < 0.0 => {
                refused.push(Refusal::DribblerBackwards(command.id));
                0.0
            }
            Some(rpm) if compatibility.dribbler_switches => f32::from(u8::from(rpm > 0.0)),
            Some(rpm) => (rpm / self.world.parameters().dribbler.full_rpm).min(1.0),
        };
        let drive = match command.move_command.map(|wanted| wanted.command) {
            None if compatibility.keeps_moving => before.drive,
            Some(None) if compatibility.keeps_moving => {
                refused.push(Refusal::EmptyMove(command.id));
                before.drive
            }
            _ if unknown_form => Drive::Brake,
            _ => drive(command, refused),
        };
        self.send_order(who, Order { drive, kick, dribbler, discharge: false });
    }

    /// Sends an order to a robot with the link's delay, or loses it.
    pub(super) fn send_order(&mut self, who: Who, order: Order) {
        if self.chance.chance(self.radio.command_loss) {
            self.counts.lost += 1;
        } else {
            self.coming.push_back((self.world.now() + self.radio.delay, who, order));
        }
    }

    /// States of the team's robots, after a message that commanded these.
    pub(super) fn feedback(
        &mut self,
        colour: Colour,
        commanded: &[bool; RobotId::COUNT],
    ) -> Vec<RobotFeedback> {
        let whose = self.cameras.settings().compatibility.feedback;
        let loss = self.radio.answer_loss;
        let mut feedback = Vec::new();
        for robot in self.world.robots().iter().filter(|robot| robot.who.colour == colour) {
            let asked = commanded[robot.who.id.index()];
            let answers = match whose {
                Feedback::Present => robot.present,
                Feedback::Commanded => asked,
                Feedback::CommandedPresent => asked && robot.present,
            };
            if !answers || self.chance.chance(loss) {
                continue;
            }
            feedback.push(RobotFeedback {
                id: u32::from(robot.who.id.number()),
                dribbler_ball_contact: Some(robot.ball_contact),
                custom: None,
            });
        }
        feedback
    }
}

fn drive(command: &RobotCommand, refused: &mut Vec<Refusal>) -> Drive {
    let Some(wanted) = command.move_command.and_then(|wanted| wanted.command) else {
        refused.push(Refusal::MissingMove(command.id));
        return Drive::Brake;
    };
    let (drive, numbers, what) = match wanted {
        MoveCommand::WheelVelocity(v) => {
            let rims = [v.front_right, v.back_right, v.back_left, v.front_left];
            (Drive::Rims(rims), rims, "wheel_velocity")
        }
        MoveCommand::LocalVelocity(v) => (
            Drive::Local(Twist { linear: Vector::new(v.forward, v.left), angular: v.angular }),
            [v.forward, v.left, v.angular, 0.0],
            "local_velocity",
        ),
        MoveCommand::GlobalVelocity(v) => (
            Drive::Global(Twist { linear: Vector::new(v.x, v.y), angular: v.angular }),
            [v.x, v.y, v.angular, 0.0],
            "global_velocity",
        ),
    };
    if numbers.iter().all(|number| number.is_finite()) {
        drive
    } else {
        refused.push(Refusal::NotANumber(what));
        Drive::Brake
    }
}

fn kick(command: &RobotCommand, limits: [f32; 2], refused: &mut Vec<Refusal>) -> Option<KickCommand> {
    let (speed, degrees) = (command.kick_speed.unwrap_or(0.0), command.kick_angle.unwrap_or(0.0));
    if !speed.is_finite() || !degrees.is_finite() {
        refused.push(Refusal::NotANumber(if speed.is_finite() { "kick_angle" } else { "kick_speed" }));
        return None;
    }
    if speed < 0.0 {
        refused.push(Refusal::KickBackwards(command.id));
        return None;
    }
    if speed == 0.0 {
        return None;
    }
    if !(0.0..=90.0).contains(&degrees) {
        refused.push(Refusal::KickAngle { id: command.id, asked: degrees });
        return None;
    }
    let most = limits[usize::from(degrees > 0.0)];
    if speed > most {
        refused.push(Refusal::KickTooFast { id: command.id, asked: speed, most });
    }
    Some(KickCommand { speed: speed.min(most), angle: degrees * (math::PI / 180.0) })
}
