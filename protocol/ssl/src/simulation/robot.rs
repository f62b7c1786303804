//! `robot`: robot commands and feedback of simulators. Units: m/s, rad/s; robot frame: forward, left,
//! counter-clockwise.

use prost::{Message, Oneof};

use super::SimulatorError;
use crate::common::Any;

messages! {
    /// Datagram to ports 10301 (blue) and 10302 (yellow): one command a robot.
    #[derive(Clone, PartialEq, Message)]
    pub struct RobotControl {
        /// Commands, at most one for each robot.
        robot_commands: Vec<RobotCommand> [message, repeated] = 1;
    }

    /// Order for one robot until the next command.
    #[derive(Clone, Copy, PartialEq, Message)]
    pub struct RobotCommand {
        /// Shell number of the robot, 0–15.
        id: u32 [uint32, required] = 1;
        /// Motion command; if absent, some simulators brake, others keep the last one.
        move_command: Option<RobotMoveCommand> [message, optional] = 2;
        /// Kick as soon as the ball is there, at this speed in space, m/s; 0 or absent: no kick.
        kick_speed: Option<f32> [float, optional] = 3;
        /// Angle of the kick, **degrees** above the ground: 0 flat, 45 a chip.
        kick_angle: Option<f32> [float, optional, default = "0"] = 4;
        /// Speed of the dribbler, rpm.
        dribbler_speed: Option<f32> [float, optional] = 5;
    }
}

/// Motion command, in one of three forms.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct RobotMoveCommand {
    /// The form, with its speeds.
    #[prost(oneof = "MoveCommand", tags = "1, 2, 3")]
    pub command: Option<MoveCommand>,
}

one_of! {
    /// Motion command of a robot.
    #[derive(Clone, Copy, PartialEq, Oneof)]
    pub enum MoveCommand {
        /// Speed of each wheel.
        WheelVelocity(MoveWheelVelocity) [message] = 1;
        /// Velocity in the robot's frame.
        LocalVelocity(MoveLocalVelocity) [message] = 2;
        /// Velocity in the field frame.
        GlobalVelocity(MoveGlobalVelocity) [message] = 3;
    }
}

messages! {
    /// Speed of each wheel at its rim.
    #[derive(Clone, Copy, PartialEq, Message)]
    pub struct MoveWheelVelocity {
        /// Front right wheel, m/s.
        front_right: f32 [float, required] = 1;
        /// Back right wheel, m/s.
        back_right: f32 [float, required] = 2;
        /// Back left wheel, m/s.
        back_left: f32 [float, required] = 3;
        /// Front left wheel, m/s.
        front_left: f32 [float, required] = 4;
    }

    /// Velocity in the robot's frame.
    #[derive(Clone, Copy, PartialEq, Message)]
    pub struct MoveLocalVelocity {
        /// Velocity forward, m/s, robot frame.
        forward: f32 [float, required] = 1;
        /// Velocity to the left, m/s.
        left: f32 [float, required] = 2;
        /// Turning rate, rad/s, counter-clockwise.
        angular: f32 [float, required] = 3;
    }

    /// Velocity in the field frame.
    #[derive(Clone, Copy, PartialEq, Message)]
    pub struct MoveGlobalVelocity {
        /// Along the field's length, m/s.
        x: f32 [float, required] = 1;
        /// Velocity to the left of +x, m/s.
        y: f32 [float, required] = 2;
        /// Turning rate, rad/s, counter-clockwise.
        angular: f32 [float, required] = 3;
    }

    /// Answer of ports 10301 and 10302.
    #[derive(Clone, PartialEq, Message)]
    pub struct RobotControlResponse {
        /// Orders that were not executed.
        errors: Vec<SimulatorError> [message, repeated] = 1;
        /// Feedback of robots: every one on the field, or those that were commanded, or also those taken away
        /// (README, trap 9).
        feedback: Vec<RobotFeedback> [message, repeated] = 2;
    }

    /// Feedback of one robot.
    #[derive(Clone, PartialEq, Message)]
    pub struct RobotFeedback {
        /// Shell number of the robot, 0–15.
        id: u32 [uint32, required] = 1;
        /// Is the ball at the dribbler?
        dribbler_ball_contact: Option<bool> [bool, optional] = 2;
        /// Additions of this simulator.
        custom: Option<Any> [message, optional] = 3;
    }
}
