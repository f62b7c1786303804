//! `reason`: conditions that keep the game from continuing, with what was measured, as label and as text. m,
//! m/s.

use std::fmt;

/// Condition of the game controller that is not met; distances in m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reason {
    /// The team has more robots than allowed outside its goal substitution area.
    TooManyRobots {
        /// Number of robots allowed on the field.
        allowed: u32,
        /// Number of robots on the field.
        on_field: u32,
    },
    /// The robot is too near to the ball.
    NearBall {
        /// From the robot's nearest side to the ball's centre.
        distance: f32,
    },
    /// The ball is far from the position of the restart.
    BallOffPlace {
        /// From that position to the ball, m.
        distance: f32,
    },
    /// The ball is outside the lines.
    BallOut,
    /// The ball is too near to a defence area.
    BallNearArea {
        /// From the area to the ball, m.
        distance: f32,
    },
    /// The ball moves faster than the controller allows.
    BallMoves {
        /// Speed of the ball, m/s.
        speed: f32,
    },
    /// The ball has to be placed by hand, and was not.
    BallNotPut {
        /// From the target position to the ball.
        distance: f32,
    },
    /// The robot is not entirely in its own half at a kick-off.
    OtherHalf {
        /// Distance of the robot's centre within its own half; negative in the other.
        inside: f32,
    },
    /// The robot is in the centre circle at a kick-off and is not the only one of the kicking team.
    CentreCircle {
        /// From the centre of the field, m.
        distance: f32,
    },
    /// The penalty's keeper is not on the field.
    NoKeeper,
    /// The penalty's keeper is not on its line between the posts.
    KeeperOffLine {
        /// From the keeper's centre to the goal line.
        from_line: f32,
        /// From the keeper's centre to the goal's middle, along the line.
        across: f32,
    },
    /// The robot is not far enough behind the ball at a penalty.
    NotBehindBall {
        /// Distance behind the ball.
        behind: f32,
    },
}

impl Reason {
    /// Label in reports, without the numbers.
    pub const fn label(self) -> &'static str {
        match self {
            Self::TooManyRobots { .. } => "too_many_robots",
            Self::NearBall { .. } => "robot_near_ball",
            Self::BallOffPlace { .. } => "ball_off_place",
            Self::BallOut => "ball_out",
            Self::BallNearArea { .. } => "ball_near_area",
            Self::BallMoves { .. } => "ball_moves",
            Self::BallNotPut { .. } => "ball_not_put",
            Self::OtherHalf { .. } => "robot_in_other_half",
            Self::CentreCircle { .. } => "robot_in_centre_circle",
            Self::NoKeeper => "no_keeper",
            Self::KeeperOffLine { .. } => "keeper_off_line",
            Self::NotBehindBall { .. } => "robot_not_behind_ball",
        }
    }

    /// Only the ball's position is wrong: the human referee may place it by hand at any time (rules: ball
    /// placement).
    pub const fn is_balls(self) -> bool {
        matches!(
            self,
            Self::BallOffPlace { .. } | Self::BallOut | Self::BallNearArea { .. } | Self::BallNotPut { .. }
        )
    }
}

impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooManyRobots { allowed, on_field } => write!(f, "{on_field} robots, {allowed} allowed"),
            Self::NearBall { distance } => write!(f, "{distance:.2} m from the ball"),
            Self::BallOffPlace { distance } => write!(f, "the ball is {distance:.2} m from its place"),
            Self::BallOut => f.write_str("the ball is outside the field"),
            Self::BallNearArea { distance } => {
                write!(f, "the ball is {distance:.2} m from a defence area")
            }
            Self::BallMoves { speed } => write!(f, "the ball moves at {speed:.2} m/s"),
            Self::BallNotPut { distance } => {
                write!(f, "the ball has to be put down by hand, {distance:.2} m away")
            }
            Self::OtherHalf { inside } => write!(f, "{inside:.2} m inside its own half"),
            Self::CentreCircle { distance } => {
                write!(f, "in the centre circle, {distance:.2} m from its centre")
            }
            Self::NoKeeper => f.write_str("no keeper on the field"),
            Self::KeeperOffLine { from_line, across } => {
                write!(f, "keeper {from_line:.2} m off its line, {across:.2} m from the middle")
            }
            Self::NotBehindBall { behind } => write!(f, "{behind:.2} m behind the ball"),
        }
    }
}
