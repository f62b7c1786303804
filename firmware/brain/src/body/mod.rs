//! `body`: interface between brain and body, the same for all bodies: intents, and a table of numbers. What a
//! body can do is in [`abilities`](crate::abilities); [`actuation`](crate::actuation) turns intents into
//! actuator orders.

pub mod kind;
pub mod legged;
pub mod omni;

use geometry::{Angle, Field, Point};
use protocol::Duration;
use protocol::robot_io::{LeggedKick, OmniKick};
use rules::League;

pub use kind::BodyKind;

/// Motion or primitive wanted for the coming step. Points and angles of the field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Intent {
    /// Stay, turning to this heading if one is given.
    Stand {
        /// Heading to turn to; `None`: no turn.
        face: Option<Angle>,
    },
    /// Go to a place, around robots, and end facing `face`.
    Walk {
        /// Target position, m, field frame.
        to: Point<Field>,
        /// Heading at the end.
        face: Angle,
        /// Go around the ball too.
        avoid_ball: bool,
    },
    /// Turn on the spot, with the ball or without.
    Turn {
        /// Heading to turn to.
        heading: Angle,
    },
    /// On legs: walk with the ball held.
    Carry {
        /// Target position, m, field frame.
        to: Point<Field>,
    },
    /// On legs: take the ball.
    Grab,
    /// On legs: kick the ball held.
    Kick(LeggedKick),
    /// On wheels: a target to drive to, with dribbler and kicker.
    Drive(omni::Drive),
    /// On wheels: reuse of the previous step's path.
    KeepPath,
}

impl Intent {
    /// Whether the ball is released by this intent.
    pub fn lets_go(&self) -> bool {
        match self {
            Self::Kick(_) => true,
            Self::Drive(drive) => drive.armed && matches!(drive.kick, OmniKick::Flat(_) | OmniKick::Chip(_)),
            // The previous intent was reported in its own step.
            Self::KeepPath => false,
            Self::Stand { .. } | Self::Walk { .. } | Self::Turn { .. } | Self::Carry { .. } | Self::Grab => {
                false
            }
        }
    }
}

/// Properties of a body that planning depends on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodySpec {
    /// Average speed from place to place, m/s.
    pub speed: f32,
    /// Average speed with the ball, m/s.
    pub carry_speed: f32,
    /// Duration of a quarter turn with the ball, s.
    pub turn: f32,
    /// Duration of the last steps to a ball and of taking it, s.
    pub grab: f32,
    /// Duration of a kick, s.
    pub kick: f32,
    /// No fetch is expected to take longer, s.
    pub longest_fetch: f32,
    /// It has arrived within this distance, m (docs/case-format.md §4).
    pub arrived_within: f32,
    /// "Next to the ball" of the robot that gets it (paper §4.2), centre to ball, m.
    pub next_to_ball: f32,
    /// Share of the distance a receiver could cover while the ball rolls that plans count on.
    pub receiver_haste: f32,
    /// A receiver this near its place counts as arrived for the passer, m.
    pub receiver_near: f32,
    /// How long a robot looks for a gap before it shoots at the goal even without one.
    pub shot_patience: Duration,
    /// An opponent whose centre is this near the ball touches it, m.
    pub opponent_holds_within: f32,
    /// A teammate or this robot this near the ball disputes it, m.
    pub disputed_within: f32,
    /// Steps for which a doubt about the case must last to abort it: a fifth of a second.
    pub doubt_steps: u8,
    /// It meets a rolling ball on its way, and does not wait where it stops.
    pub meets_rolling_balls: bool,
}

/// Properties of that league's robots.
pub fn spec(league: League) -> &'static BodySpec {
    match BodyKind::of(league) {
        BodyKind::Legged(_) => &legged::SPEC,
        BodyKind::Wheeled(_) => &omni::SPEC,
    }
}
