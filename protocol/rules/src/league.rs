//! `league`: the leagues: field, robots and ball.
//!
//! Four-legged 2007: field and robot from the measures that ThinkingCapSim gives for the rules of 2007; field
//! surface 6 × 4 m as in Ros et al. 2009 §6.1; lines 25 mm wide, as the league's teams described their
//! fields; goals 0.3 m high and the penalty mark are estimates that nothing depends on.
//!
//! SSL 2013: 6 × 4 m as Biswas et al. 2014 play; the markings are those of the league's programs for the
//! single-size field of 2013 and 2014: defence area of radius 0.8 m and stretch 0.35 m, penalty mark at 0.75
//! m, 0.25 m of margin within the referee's walk.
//!
//! Divisions: rules of 2026, chapter on the playing environment. Division A has 0.6 m behind its goal lines
//! since 2026, of which the 0.3 m at the wall are the goal substitution area; division B has none (chapter on
//! substitution); the goal walls are 0.02 m thick, all lines 0.01 m.

use serde::{Deserialize, Serialize};

use crate::limits::{BALL_RADIUS, ROBOT_RADIUS};
use crate::{AreaForm, FieldSpec};

/// A league that robots, simulator and arena can play.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum League {
    /// RoboCup Four-Legged League, 2007: AIBO ERS-7 on 5.4 × 3.6 m.
    FourLegged,
    /// Small Size League of 2013, the second paper's world: six robots on 6 × 4 m.
    Ssl2013,
    /// Small Size League, division B of 2026: six robots on 9 × 6 m.
    DivisionB,
    /// Small Size League, division A of 2026: eleven robots on 12 × 9 m.
    DivisionA,
}

/// A robot's extent on the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Footprint {
    /// Radius of the disc that stands for it, m.
    pub radius: f32,
}

/// Properties of the ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BallSpec {
    /// Radius of the ball, m.
    pub radius: f32,
    /// Deceleration of a rolling ball, m/s².
    pub rolling_deceleration: f32,
}

impl League {
    /// All leagues, in the order of their numbers on the wire.
    pub const ALL: [Self; 4] = [Self::FourLegged, Self::Ssl2013, Self::DivisionB, Self::DivisionA];

    /// The leagues whose robots run on wheels: those of the Small Size League.
    pub const ON_WHEELS: [Self; 3] = [Self::Ssl2013, Self::DivisionB, Self::DivisionA];

    /// The name used in directories, files and options.
    pub const fn name(self) -> &'static str {
        match self {
            Self::FourLegged => "four-legged",
            Self::Ssl2013 => "ssl-2013",
            Self::DivisionB => "division-b",
            Self::DivisionA => "division-a",
        }
    }

    /// Field of the league.
    pub const fn field(self) -> FieldSpec {
        match self {
            Self::FourLegged => FieldSpec {
                length: 5.4,
                width: 3.6,
                margin: 0.3,
                goal_line_margin: 0.3,
                goal_substitution: 0.0,
                goal_width: 0.8,
                goal_depth: 0.3,
                goal_height: 0.3,
                goal_wall: 0.02,
                penalty_depth: 0.65,
                penalty_width: 1.3,
                penalty_form: AreaForm::Box,
                penalty_mark: 3.6,
                center_radius: 0.18,
                line_width: 0.025,
            },
            Self::Ssl2013 => FieldSpec {
                length: 6.0,
                width: 4.0,
                margin: 0.25,
                goal_line_margin: 0.25,
                goal_width: 0.7,
                penalty_depth: 0.8,
                penalty_width: 1.95,
                penalty_form: AreaForm::QuarterCircles,
                penalty_mark: 0.75,
                ..Self::DivisionB.field()
            },
            Self::DivisionB => FieldSpec {
                length: 9.0,
                width: 6.0,
                margin: 0.3,
                goal_line_margin: 0.3,
                goal_substitution: 0.0,
                goal_width: 1.0,
                goal_depth: 0.18,
                goal_height: 0.16,
                goal_wall: 0.02,
                penalty_depth: 1.0,
                penalty_width: 2.0,
                penalty_form: AreaForm::Box,
                penalty_mark: 6.0,
                center_radius: 0.5,
                line_width: 0.01,
            },
            Self::DivisionA => FieldSpec {
                length: 12.0,
                width: 9.0,
                goal_line_margin: 0.6,
                goal_substitution: 0.3,
                goal_width: 1.8,
                penalty_depth: 1.8,
                penalty_width: 3.6,
                penalty_mark: 8.0,
                ..Self::DivisionB.field()
            },
        }
    }

    /// Footprint of the league's robots; with legs, a disc around the body.
    pub const fn robot(self) -> Footprint {
        match self {
            Self::FourLegged => Footprint { radius: 0.12 },
            Self::Ssl2013 | Self::DivisionB | Self::DivisionA => Footprint { radius: ROBOT_RADIUS },
        }
    }

    /// The league's ball. Deceleration: middle of the 0.30–0.35 m/s² of SimRobot's 2-D model for such balls
    /// on the field surface, rounded up; radius: the league's orange ball of about 85 mm across, from memory,
    /// no source found.
    pub const fn ball(self) -> BallSpec {
        match self {
            Self::FourLegged => BallSpec { radius: 0.0425, rolling_deceleration: 0.35 },
            // A golf ball, 43 mm across; ER-Force's rolling deceleration, the middle of what teams measured
            // (0.26–0.5).
            Self::Ssl2013 | Self::DivisionB | Self::DivisionA => {
                BallSpec { radius: BALL_RADIUS, rolling_deceleration: 0.35 }
            }
        }
    }
}
