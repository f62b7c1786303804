//! Events of the ball: it left, went in, was kicked wrongly, was held or placed. Units: m, m/s, s; field
//! frame.

use prost::Message;

use crate::common::{Team, Vector2};

events! {
    /// The ball left the field.
    robot BallLeftField {
        /// Point at which the ball crossed the line, m.
        location: Option<Vector2> [message, optional] = 3;
    }

    /// The ball was kicked over the opponent's goal line from the own half (division B).
    robot AimlessKick {
        /// Point at which the ball crossed the line, m.
        location: Option<Vector2> [message, optional] = 3;
        /// Point of the kick, m.
        kick_location: Option<Vector2> [message, optional] = 4;
    }

    /// A goal straight from an indirect free kick (deprecated).
    robot IndirectGoal {
        /// Point at which the ball crossed the line, m.
        location: Option<Vector2> [message, optional] = 3;
        /// Point of the kick, m.
        kick_location: Option<Vector2> [message, optional] = 4;
    }

    /// A goal by a ball that was too high (deprecated).
    robot ChippedGoal {
        /// Point at which the ball crossed the line, m.
        location: Option<Vector2> [message, optional] = 3;
        /// Point of the kick, m.
        kick_location: Option<Vector2> [message, optional] = 4;
        /// Greatest height of the ball, m.
        max_ball_height: Option<f32> [float, optional] = 5;
    }

    /// A kick faster than 6.5 m/s.
    robot BotKickedBallTooFast {
        /// Point of the kick, m.
        location: Option<Vector2> [message, optional] = 3;
        /// The ball's speed after the kick, in space, m/s.
        initial_ball_speed: Option<f32> [float, optional] = 4;
        /// True if the ball flew after the kick.
        chipped: Option<bool> [bool, optional] = 5;
    }

    /// A robot dribbled more than a metre.
    robot BotDribbledBallTooFar {
        /// Start of the contact, m.
        start: Option<Vector2> [message, optional] = 3;
        /// Point at which the distance was over the limit, m.
        end: Option<Vector2> [message, optional] = 4;
    }

    /// An attacker touched the ball in the opponent's defence area.
    robot AttackerTouchedBallInDefenseArea {
        /// Position of the robot, m.
        location: Option<Vector2> [message, optional] = 3;
        /// Depth inside the area, m.
        distance: Option<f32> [float, optional] = 4;
    }

    /// The kicker touched the ball again before another robot did.
    robot AttackerDoubleTouchedBall {
        /// Position of the ball when it was first touched, m.
        location: Option<Vector2> [message, optional] = 3;
    }

    /// A robot held the ball so that no other robot could reach it.
    robot BotHeldBallDeliberately {
        /// Position of the ball, m.
        location: Option<Vector2> [message, optional] = 3;
        /// Time that the robot held the ball, s.
        duration: Option<f32> [float, optional] = 4;
    }

    /// The keeper held the ball in its defence area too long.
    team KeeperHeldBall {
        /// Position of the ball, m.
        location: Option<Vector2> [message, optional] = 2;
        /// Time that the keeper held the ball, s.
        duration: Option<f32> [float, optional] = 3;
    }

    /// The kick was not taken in time (deprecated).
    team KickTimeout {
        /// Position of the ball, m.
        location: Option<Vector2> [message, optional] = 2;
        /// Time that was waited, s.
        time: Option<f32> [float, optional] = 3;
    }

    /// The ball was not placed in time.
    team PlacementFailed {
        /// Ball to its target, m.
        remaining_distance: Option<f32> [float, optional] = 2;
        /// The nearest robot of the placing team to the ball, m.
        nearest_own_bot_distance: Option<f32> [float, optional] = 3;
    }

    /// The ball was placed.
    team PlacementSucceeded {
        /// Time that it took, s.
        time_taken: Option<f32> [float, optional] = 2;
        /// Ball to its target, m.
        precision: Option<f32> [float, optional] = 3;
        /// From where it was to the target, m.
        distance: Option<f32> [float, optional] = 4;
    }

    /// A ball flew over the boundary's wall.
    team BoundaryCrossing {
        /// Point of the crossing, m.
        location: Option<Vector2> [message, optional] = 2;
    }
}

messages! {
    /// The ball is in a goal.
    #[derive(Clone, PartialEq, Message)]
    pub struct Goal {
        /// The team that scores.
        by_team: i32 [enumeration = "Team", required] = 1;
        /// Shell number of the robot that kicked.
        kicking_bot: Option<u32> [uint32, optional] = 2;
        /// Point at which the ball crossed the line, m.
        location: Option<Vector2> [message, optional] = 3;
        /// Point of the kick, m.
        kick_location: Option<Vector2> [message, optional] = 4;
        /// Greatest height of the ball between kick and goal, m.
        max_ball_height: Option<f32> [float, optional] = 5;
        /// The team that kicked: not `by_team` where it is an own goal, [`Team`].
        kicking_team: Option<i32> [enumeration = "Team", optional] = 6;
        /// Robots `by_team` had on the field.
        num_robots_by_team: Option<u32> [uint32, optional] = 7;
        /// Time of the last touch by `by_team`, µs, Unix time.
        last_touch_by_team: Option<u64> [uint64, optional] = 8;
        /// Reason why it counts or does not.
        message: Option<String> [string, optional] = 9;
    }

    /// Play in which neither team got the ball going.
    #[derive(Clone, Copy, PartialEq, Message)]
    pub struct NoProgressInGame {
        /// Position of the ball, m.
        location: Option<Vector2> [message, optional] = 1;
        /// Time that was waited, s.
        time: Option<f32> [float, optional] = 2;
    }

    /// Both teams were ready for the restart (deprecated).
    #[derive(Clone, Copy, PartialEq, Message)]
    pub struct Prepared {
        /// Time that it took, s.
        time_taken: Option<f32> [float, optional] = 1;
    }

    /// The penalty kick brought no goal.
    #[derive(Clone, PartialEq, Message)]
    pub struct PenaltyKickFailed {
        /// Team that the event concerns, [`Team`].
        by_team: i32 [enumeration = "Team", required] = 1;
        /// Position of the ball, m.
        location: Option<Vector2> [message, optional] = 2;
        /// Reason of the failure, as text.
        reason: Option<String> [string, optional] = 3;
    }
}
