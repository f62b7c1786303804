//! `simulation`: simulation control. [`SimulatorCommand`] to port 10300, [`RobotControl`] to 10301 (blue) and
//! 10302 (yellow).
//!
//! Units: m, m/s, m/s², rad, rad/s, kg in the field frame; `kick_angle` in degrees, `dribbler_speed` in rpm.
//! Absent fields stay as they are. A simulator answers requests that it cannot fulfil with a
//! [`SimulatorError`].

mod custom;
mod grsim;
mod robot;

use prost::Message;

use crate::common::{Any, RobotId};
use crate::vision::{DetectionFrame, GeometryData};

pub use custom::{RealismConfigErForce, RobotSpecErForce};
pub use grsim::{
    GrsimBallReplacement, GrsimCommands, GrsimPacket, GrsimReplacement, GrsimRobotCommand,
    GrsimRobotReplacement, RobotStatus, RobotsStatus,
};
pub use robot::{
    MoveCommand, MoveGlobalVelocity, MoveLocalVelocity, MoveWheelVelocity, RobotCommand, RobotControl,
    RobotControlResponse, RobotFeedback, RobotMoveCommand,
};

messages! {
    /// Command that a simulator could not execute.
    #[derive(Clone, PartialEq, Message)]
    pub struct SimulatorError {
        /// For programs, of the simulator's own choice.
        code: Option<String> [string, optional] = 1;
        /// Text for the operator of the sender.
        message: Option<String> [string, optional] = 2;
    }

    /// Datagram to port 10300: move things, or change settings.
    #[derive(Clone, PartialEq, Message)]
    pub struct SimulatorCommand {
        /// Move ball and robots, or change the speed.
        control: Option<SimulatorControl> [message, optional] = 1;
        /// Change settings of the simulator.
        config: Option<SimulatorConfig> [message, optional] = 2;
    }

    /// Answer of port 10300.
    #[derive(Clone, PartialEq, Message)]
    pub struct SimulatorResponse {
        /// Commands that were not executed; empty when all were.
        errors: Vec<SimulatorError> [message, repeated] = 1;
    }

    /// Move ball and robots, change the pace.
    #[derive(Clone, PartialEq, Message)]
    pub struct SimulatorControl {
        /// Move the ball; absent: it stays.
        teleport_ball: Option<TeleportBall> [message, optional] = 1;
        /// Move these robots; all others stay.
        teleport_robot: Vec<TeleportRobot> [message, repeated] = 2;
        /// Simulated seconds a second: 1 is real time, 0 stands still.
        simulation_speed: Option<f32> [float, optional] = 3;
    }

    /// Move the ball; missing coordinates stay.
    #[derive(Clone, Copy, PartialEq, Message)]
    pub struct TeleportBall {
        /// Along the field's length, m.
        x: Option<f32> [float, optional] = 1;
        /// Coordinate to the left of +x, m.
        y: Option<f32> [float, optional] = 2;
        /// Height above the ground, m.
        z: Option<f32> [float, optional] = 3;
        /// Velocity along x, m/s.
        vx: Option<f32> [float, optional] = 4;
        /// Velocity along y, m/s.
        vy: Option<f32> [float, optional] = 5;
        /// Velocity upwards, m/s; negative: downwards.
        vz: Option<f32> [float, optional] = 6;
        /// Push robots aside instead of putting the ball inside one.
        teleport_safely: Option<bool> [bool, optional] = 7;
        /// Start as a rolling ball, without a sliding phase.
        roll: Option<bool> [bool, optional] = 8;
        /// Move it by forces, through what stands between, instead of at once.
        by_force: Option<bool> [bool, optional] = 9;
    }

    /// Move a robot, or take it away.
    #[derive(Clone, Copy, PartialEq, Message)]
    pub struct TeleportRobot {
        /// Robot by shell number and team.
        id: RobotId [message, required] = 1;
        /// Along the field's length, m.
        x: Option<f32> [float, optional] = 2;
        /// Coordinate to the left of +x, m.
        y: Option<f32> [float, optional] = 3;
        /// Heading, rad, counter-clockwise from +x.
        orientation: Option<f32> [float, optional] = 4;
        /// Velocity along x, m/s, field frame.
        v_x: Option<f32> [float, optional, default = "0"] = 5;
        /// Velocity along y, m/s, field frame.
        v_y: Option<f32> [float, optional, default = "0"] = 6;
        /// Rate of turn, rad/s, counter-clockwise.
        v_angular: Option<f32> [float, optional, default = "0"] = 7;
        /// False takes the robot away, true puts it there.
        present: Option<bool> [bool, optional] = 8;
        /// Move it by forces instead of at once.
        by_force: Option<bool> [bool, optional] = 9;
    }

    /// Settings that change a running simulator; missing ones stay.
    #[derive(Clone, PartialEq, Message)]
    pub struct SimulatorConfig {
        /// The field, in vision's units (mm).
        geometry: Option<GeometryData> [message, optional] = 1;
        /// Properties of the robots in it.
        robot_specs: Vec<RobotSpecs> [message, repeated] = 2;
        /// Noise, delay and losses, in a form of the simulator's own.
        realism_config: Option<RealismConfig> [message, optional] = 3;
        /// Destination port of vision packets.
        vision_port: Option<u32> [uint32, optional] = 4;
    }

    /// Noise, delay and losses.
    #[derive(Clone, PartialEq, Message)]
    pub struct RealismConfig {
        /// For ER-Force's simulator a [`RealismConfigErForce`].
        custom: Vec<Any> [message, repeated] = 1;
    }

    /// Properties of a robot.
    #[derive(Clone, PartialEq, Message)]
    pub struct RobotSpecs {
        /// Robot by shell number and team.
        id: RobotId [message, required] = 1;
        /// Radius of its hull, m.
        radius: Option<f32> [float, optional, default = "0.09"] = 2;
        /// Height of its hull, m.
        height: Option<f32> [float, optional, default = "0.15"] = 3;
        /// Mass of the whole robot, kg.
        mass: Option<f32> [float, optional] = 4;
        /// Fastest flat kick, m/s.
        max_linear_kick_speed: Option<f32> [float, optional] = 7;
        /// Fastest chip kick, m/s, in space.
        max_chip_kick_speed: Option<f32> [float, optional] = 8;
        /// Centre to the flat front, m.
        center_to_dribbler: Option<f32> [float, optional] = 9;
        /// Bounds of its motion.
        limits: Option<RobotLimits> [message, optional] = 10;
        /// Positions of its wheels.
        wheel_angles: Option<RobotWheelAngles> [message, optional] = 13;
        /// For ER-Force's simulator a [`RobotSpecErForce`].
        custom: Vec<Any> [message, repeated] = 14;
    }

    /// Bounds of a robot's motion.
    #[derive(Clone, Copy, PartialEq, Message)]
    pub struct RobotLimits {
        /// Acceleration when speeding up, m/s².
        acc_speedup_absolute_max: Option<f32> [float, optional] = 1;
        /// Angular acceleration of a faster turn, rad/s².
        acc_speedup_angular_max: Option<f32> [float, optional] = 2;
        /// Deceleration when braking, m/s².
        acc_brake_absolute_max: Option<f32> [float, optional] = 3;
        /// Braking a turn, rad/s².
        acc_brake_angular_max: Option<f32> [float, optional] = 4;
        /// Speed in any direction, m/s.
        vel_absolute_max: Option<f32> [float, optional] = 5;
        /// Rate of turn, rad/s.
        vel_angular_max: Option<f32> [float, optional] = 6;
    }

    /// Directions of the wheels' axles, rad, counter-clockwise from the robot's front.
    #[derive(Clone, Copy, PartialEq, Message)]
    pub struct RobotWheelAngles {
        /// Front right wheel, rad.
        front_right: f32 [float, required] = 1;
        /// Back right wheel, rad.
        back_right: f32 [float, required] = 2;
        /// Back left wheel, rad.
        back_left: f32 [float, required] = 3;
        /// Front left wheel, rad.
        front_left: f32 [float, required] = 4;
    }

    /// One step of a simulator whose clock the sender drives.
    #[derive(Clone, PartialEq, Message)]
    pub struct SimulationSyncRequest {
        /// Length of the step, s.
        sim_step: Option<f32> [float, optional] = 1;
        /// Command as for port 10300.
        simulator_command: Option<SimulatorCommand> [message, optional] = 2;
        /// Orders as for ports 10301 and 10302.
        robot_control: Option<RobotControl> [message, optional] = 3;
    }

    /// Result of the step.
    #[derive(Clone, PartialEq, Message)]
    pub struct SimulationSyncResponse {
        /// Detections of each camera.
        detection: Vec<DetectionFrame> [message, repeated] = 1;
        /// Answer as of ports 10301 and 10302.
        robot_control_response: Option<RobotControlResponse> [message, optional] = 2;
    }
}
