//! `robot`: game events about robots. Units: m, m/s, rad; field frame.

use prost::Message;

use crate::common::{Team, Vector2};

messages! {
    /// A robot was too fast in STOP.
    #[derive(Clone, Copy, PartialEq, Message)]
    pub struct BotTooFastInStop {
        /// Team that the event concerns, [`Team`].
        by_team: i32 [enumeration = "Team", required] = 1;
        /// The robot that did it.
        by_bot: Option<u32> [uint32, optional] = 2;
        /// Position of the robot, m.
        location: Option<Vector2> [message, optional] = 3;
        /// Speed of the robot, m/s.
        speed: Option<f32> [float, optional] = 4;
    }

    /// An opponent was too close to the ball at a free kick.
    #[derive(Clone, Copy, PartialEq, Message)]
    pub struct DefenderTooCloseToKickPoint {
        /// Team that the event concerns, [`Team`].
        by_team: i32 [enumeration = "Team", required] = 1;
        /// The robot that did it.
        by_bot: Option<u32> [uint32, optional] = 2;
        /// Position of the robot, m.
        location: Option<Vector2> [message, optional] = 3;
        /// Robot to ball, without the robot's radius, m.
        distance: Option<f32> [float, optional] = 4;
    }

    /// Two robots crashed; the difference of speeds was small.
    #[derive(Clone, Copy, PartialEq, Message)]
    pub struct BotCrashDrawn {
        /// Shell number of yellow's robot.
        bot_yellow: Option<u32> [uint32, optional] = 1;
        /// Shell number of blue's robot.
        bot_blue: Option<u32> [uint32, optional] = 2;
        /// Middle between the two robots, m.
        location: Option<Vector2> [message, optional] = 3;
        /// Relative speed along the line between them, m/s.
        crash_speed: Option<f32> [float, optional] = 4;
        /// Difference of their speeds, m/s.
        speed_diff: Option<f32> [float, optional] = 5;
        /// Angle between their velocities, rad, 0…π.
        crash_angle: Option<f32> [float, optional] = 6;
    }

    /// Two robots crashed; the faster one is at fault.
    #[derive(Clone, Copy, PartialEq, Message)]
    pub struct BotCrashUnique {
        /// Team that the event concerns, [`Team`].
        by_team: i32 [enumeration = "Team", required] = 1;
        /// The faster one, of `by_team`.
        violator: Option<u32> [uint32, optional] = 2;
        /// The other one, of the other team.
        victim: Option<u32> [uint32, optional] = 3;
        /// Middle between the two robots, m.
        location: Option<Vector2> [message, optional] = 4;
        /// Relative speed along the line between them, m/s.
        crash_speed: Option<f32> [float, optional] = 5;
        /// Difference of their speeds, m/s.
        speed_diff: Option<f32> [float, optional] = 6;
        /// Angle between their velocities, rad, 0…π.
        crash_angle: Option<f32> [float, optional] = 7;
    }

    /// A robot pushed another.
    #[derive(Clone, Copy, PartialEq, Message)]
    pub struct BotPushedBot {
        /// Team that the event concerns, [`Team`].
        by_team: i32 [enumeration = "Team", required] = 1;
        /// Robot of `by_team` that pushed.
        violator: Option<u32> [uint32, optional] = 2;
        /// Robot that was pushed, of the other team.
        victim: Option<u32> [uint32, optional] = 3;
        /// Middle between the two robots, m.
        location: Option<Vector2> [message, optional] = 4;
        /// Distance that it was pushed, m.
        pushed_distance: Option<f32> [float, optional] = 5;
    }

    /// A robot fell over.
    #[derive(Clone, Copy, PartialEq, Message)]
    pub struct BotTippedOver {
        /// Team that the event concerns, [`Team`].
        by_team: i32 [enumeration = "Team", required] = 1;
        /// The robot that did it.
        by_bot: Option<u32> [uint32, optional] = 2;
        /// Position of the robot, m.
        location: Option<Vector2> [message, optional] = 3;
        /// Position of the ball, m.
        ball_location: Option<Vector2> [message, optional] = 4;
    }

    /// A robot lost parts.
    #[derive(Clone, Copy, PartialEq, Message)]
    pub struct BotDroppedParts {
        /// Team that the event concerns, [`Team`].
        by_team: i32 [enumeration = "Team", required] = 1;
        /// The robot that did it.
        by_bot: Option<u32> [uint32, optional] = 2;
        /// Position of the dropped parts, m.
        location: Option<Vector2> [message, optional] = 3;
        /// Position of the ball, m.
        ball_location: Option<Vector2> [message, optional] = 4;
    }

    /// A defender other than the keeper touched the ball, entirely in its own defence area.
    #[derive(Clone, Copy, PartialEq, Message)]
    pub struct DefenderInDefenseArea {
        /// Team that the event concerns, [`Team`].
        by_team: i32 [enumeration = "Team", required] = 1;
        /// The robot that did it.
        by_bot: Option<u32> [uint32, optional] = 2;
        /// Position of the robot, m.
        location: Option<Vector2> [message, optional] = 3;
        /// Robot to the nearest point outside the area, m.
        distance: Option<f32> [float, optional] = 4;
    }

    /// The same, partly in the area (deprecated).
    #[derive(Clone, Copy, PartialEq, Message)]
    pub struct DefenderInDefenseAreaPartially {
        /// Team that the event concerns, [`Team`].
        by_team: i32 [enumeration = "Team", required] = 1;
        /// The robot that did it.
        by_bot: Option<u32> [uint32, optional] = 2;
        /// Position of the robot, m.
        location: Option<Vector2> [message, optional] = 3;
        /// Depth inside the area, m.
        distance: Option<f32> [float, optional] = 4;
        /// Position of the ball, m.
        ball_location: Option<Vector2> [message, optional] = 5;
    }

    /// An attacker touched an opponent in the opponent's defence area (deprecated).
    #[derive(Clone, Copy, PartialEq, Message)]
    pub struct AttackerTouchedOpponentInDefenseArea {
        /// Team that the event concerns, [`Team`].
        by_team: i32 [enumeration = "Team", required] = 1;
        /// The robot that did it.
        by_bot: Option<u32> [uint32, optional] = 2;
        /// Point of contact between the two robots, m.
        location: Option<Vector2> [message, optional] = 3;
        /// Robot that was touched, of the other team.
        victim: Option<u32> [uint32, optional] = 4;
    }

    /// An attacker was too close to the opponent's defence area at a restart.
    #[derive(Clone, Copy, PartialEq, Message)]
    pub struct AttackerTooCloseToDefenseArea {
        /// Team that the event concerns, [`Team`].
        by_team: i32 [enumeration = "Team", required] = 1;
        /// The robot that did it.
        by_bot: Option<u32> [uint32, optional] = 2;
        /// Position of the robot, m.
        location: Option<Vector2> [message, optional] = 3;
        /// Robot to the area, m.
        distance: Option<f32> [float, optional] = 4;
        /// Position of the ball, m.
        ball_location: Option<Vector2> [message, optional] = 5;
    }

    /// A robot was too close to the line between ball and target.
    #[derive(Clone, Copy, PartialEq, Message)]
    pub struct BotInterferedPlacement {
        /// Team that the event concerns, [`Team`].
        by_team: i32 [enumeration = "Team", required] = 1;
        /// The robot that did it.
        by_bot: Option<u32> [uint32, optional] = 2;
        /// Position of the robot, m.
        location: Option<Vector2> [message, optional] = 3;
    }

    /// A team had too many robots on the field.
    #[derive(Clone, Copy, PartialEq, Message)]
    pub struct TooManyRobots {
        /// Team that the event concerns, [`Team`].
        by_team: i32 [enumeration = "Team", required] = 1;
        /// Number of robots that the team may have.
        num_robots_allowed: Option<i32> [int32, optional] = 2;
        /// Number of robots that the team had.
        num_robots_on_field: Option<i32> [int32, optional] = 3;
        /// Position of the ball, m.
        ball_location: Option<Vector2> [message, optional] = 4;
    }
}
