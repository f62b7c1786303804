//! Which leagues are there, and how large are field, robots and ball in each?
//!
//! Four-legged 2007: field and robot from the measures that ThinkingCapSim gives for the rules of 2007; carpet 6 × 4 m
//! as in Ros et al. 2009 §6.1.

use serde::{Deserialize, Serialize};

use crate::FieldSpec;

/// A league's world.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum League {
    /// RoboCup Four-Legged League, 2007: AIBO ERS-7 on 5.4 × 3.6 m.
    FourLegged,
}

/// A robot's footprint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RobotSpec {
    /// Radius of the disc that stands for it, m.
    pub radius: f32,
}

/// The ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BallSpec {
    /// m.
    pub radius: f32,
    /// How fast a rolling ball slows down, m/s².
    pub rolling_deceleration: f32,
}

impl League {
    /// The name used in folders, files and options.
    pub const fn name(self) -> &'static str {
        match self {
            Self::FourLegged => "four-legged",
        }
    }

    /// Its field.
    pub const fn field(self) -> FieldSpec {
        match self {
            Self::FourLegged => FieldSpec {
                length: 5.4,
                width: 3.6,
                margin: 0.3,
                goal_width: 0.8,
                goal_depth: 0.3,
                penalty_depth: 0.65,
                penalty_width: 1.3,
                center_radius: 0.18,
            },
        }
    }

    /// Its robots.
    pub const fn robot(self) -> RobotSpec {
        match self {
            Self::FourLegged => RobotSpec { radius: 0.12 },
        }
    }

    /// Its ball. Deceleration: middle of the 0.30–0.35 m/s² of SimRobot's 2-D model for such balls on carpet, rounded up;
    /// radius: the league's orange ball of about 85 mm across, from memory, no source found.
    pub const fn ball(self) -> BallSpec {
        match self {
            Self::FourLegged => BallSpec { radius: 0.0425, rolling_deceleration: 0.35 },
        }
    }
}
