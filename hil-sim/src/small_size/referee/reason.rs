//! `reason`: conditions that keep the game from continuing, with what was measured, as label and as text. m,
//! m/s.

use thiserror::Error;

geometry::labels! {
    /// Condition of the game controller that is not met; distances in m.
    #[derive(Clone, Copy, Debug, PartialEq, Error)]
    pub enum Reason {
        /// The team has more robots than allowed outside its goal substitution area.
        #[error("{on_field} robots, {allowed} allowed")]
        TooManyRobots {
            /// Number of robots allowed on the field.
            allowed: u32,
            /// Number of robots on the field.
            on_field: u32,
        } = "too_many_robots",
        /// The robot is too near to the ball.
        #[error("{distance:.2} m from the ball")]
        NearBall {
            /// From the robot's nearest side to the ball's centre.
            distance: f32,
        } = "robot_near_ball",
        /// The ball is far from the position of the restart.
        #[error("the ball is {distance:.2} m from its place")]
        BallOffPlace {
            /// From that position to the ball, m.
            distance: f32,
        } = "ball_off_place",
        /// The ball is outside the lines.
        #[error("the ball is outside the field")]
        BallOut = "ball_out",
        /// The ball is too near to a defence area.
        #[error("the ball is {distance:.2} m from a defence area")]
        BallNearArea {
            /// From the area to the ball, m.
            distance: f32,
        } = "ball_near_area",
        /// The ball moves faster than the controller allows.
        #[error("the ball moves at {speed:.2} m/s")]
        BallMoves {
            /// Speed of the ball, m/s.
            speed: f32,
        } = "ball_moves",
        /// The ball has to be placed by hand, and was not.
        #[error("the ball has to be put down by hand, {distance:.2} m away")]
        BallNotPut {
            /// From the target position to the ball.
            distance: f32,
        } = "ball_not_put",
        /// The robot is not entirely in its own half at a kick-off.
        #[error("{inside:.2} m inside its own half")]
        OtherHalf {
            /// Distance of the robot's centre within its own half; negative in the other.
            inside: f32,
        } = "robot_in_other_half",
        /// The robot is in the centre circle at a kick-off and is not the only one of the kicking team.
        #[error("in the centre circle, {distance:.2} m from its centre")]
        CentreCircle {
            /// From the centre of the field, m.
            distance: f32,
        } = "robot_in_centre_circle",
        /// The penalty's keeper is not on the field.
        #[error("no keeper on the field")]
        NoKeeper = "no_keeper",
        /// The penalty's keeper is not on its line between the posts.
        #[error("keeper {from_line:.2} m off its line, {across:.2} m from the middle")]
        KeeperOffLine {
            /// From the keeper's centre to the goal line.
            from_line: f32,
            /// From the keeper's centre to the goal's middle, along the line.
            across: f32,
        } = "keeper_off_line",
        /// The robot is not far enough behind the ball at a penalty.
        #[error("{behind:.2} m behind the ball")]
        NotBehindBall {
            /// Distance behind the ball.
            behind: f32,
        } = "robot_not_behind_ball",
    }
}

impl Reason {
    /// Only the ball's position is wrong: the human referee may place it by hand at any time (rules: ball
    /// placement).
    pub const fn is_balls(self) -> bool {
        matches!(
            self,
            Self::BallOffPlace { .. } | Self::BallOut | Self::BallNearArea { .. } | Self::BallNotPut { .. }
        )
    }
}
