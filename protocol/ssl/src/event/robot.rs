//! `robot`: game events about robots. Units: m, m/s, rad; field frame.

use prost::Message;

use crate::common::{Team, Vector2};

events! {
    /// A robot was faster than 1.5 m/s in STOP.
    robot BotTooFastInStop {
        /// Position of the robot, m.
        location: Option<Vector2> [message, optional] = 3;
        /// Speed of the robot, m/s.
        speed: Option<f32> [float, optional] = 4;
    }

    /// An opponent was within 0.5 m of the ball at a free kick.
    robot DefenderTooCloseToKickPoint {
        /// Position of the robot, m.
        location: Option<Vector2> [message, optional] = 3;
        /// Robot to ball, without the robot's radius, m.
        distance: Option<f32> [float, optional] = 4;
    }

    /// Two robots crashed; the faster one is at fault.
    team BotCrashUnique {
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
    team BotPushedBot {
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
    robot BotTippedOver {
        /// Position of the robot, m.
        location: Option<Vector2> [message, optional] = 3;
        /// Position of the ball, m.
        ball_location: Option<Vector2> [message, optional] = 4;
    }

    /// A robot lost parts.
    robot BotDroppedParts {
        /// Position of the dropped parts, m.
        location: Option<Vector2> [message, optional] = 3;
        /// Position of the ball, m.
        ball_location: Option<Vector2> [message, optional] = 4;
    }

    /// A defender other than the keeper touched the ball, entirely in its own defence area.
    robot DefenderInDefenseArea {
        /// Position of the robot, m.
        location: Option<Vector2> [message, optional] = 3;
        /// Robot to the nearest point outside the area, m.
        distance: Option<f32> [float, optional] = 4;
    }

    /// The same, partly in the area (deprecated).
    robot DefenderInDefenseAreaPartially {
        /// Position of the robot, m.
        location: Option<Vector2> [message, optional] = 3;
        /// Depth inside the area, m.
        distance: Option<f32> [float, optional] = 4;
        /// Position of the ball, m.
        ball_location: Option<Vector2> [message, optional] = 5;
    }

    /// An attacker touched an opponent in the opponent's defence area (deprecated).
    robot AttackerTouchedOpponentInDefenseArea {
        /// Point of contact between the two robots, m.
        location: Option<Vector2> [message, optional] = 3;
        /// Robot that was touched, of the other team.
        victim: Option<u32> [uint32, optional] = 4;
    }

    /// An attacker was within 0.2 m of the opponent's defence area at a restart.
    robot AttackerTooCloseToDefenseArea {
        /// Position of the robot, m.
        location: Option<Vector2> [message, optional] = 3;
        /// Robot to the area, m.
        distance: Option<f32> [float, optional] = 4;
        /// Position of the ball, m.
        ball_location: Option<Vector2> [message, optional] = 5;
    }

    /// A robot was too close to the line between ball and target.
    robot BotInterferedPlacement {
        /// Position of the robot, m.
        location: Option<Vector2> [message, optional] = 3;
    }

    /// A team had too many robots on the field.
    team TooManyRobots {
        /// Number of robots that the team may have.
        num_robots_allowed: Option<i32> [int32, optional] = 2;
        /// Number of robots that the team had.
        num_robots_on_field: Option<i32> [int32, optional] = 3;
        /// Position of the ball, m.
        ball_location: Option<Vector2> [message, optional] = 4;
    }
}

messages! {
    /// Two robots crashed, both at fault: the difference of their speeds was small.
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
}
