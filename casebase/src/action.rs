//! `action`: actions of a case's robots, and kick kinds (Ros et al. 2009, §2.2; docs/case-format.md §1, §4).
//!
//! Points are the case's own coordinates, mm; a caller that plays the case adapts them with `Case::shift`.

use core::fmt;

use serde::{Deserialize, Serialize};

use crate::PointMm;

/// Maximum number of robots in a case.
pub const TEAMMATES_MAX: usize = protocol::team::CASE_ROBOTS_MAX;
/// Maximum number of opponents (scopes) in a case.
pub const OPPONENTS_MAX: usize = 4;
/// Maximum number of kick kinds in a league.
pub const KICKS_MAX: usize = 255;

/// One of the robots of a case; counted from 0 internally, written from 1 (`tm1` … `tm4`).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(transparent)]
pub struct CaseRobot(u8);

impl CaseRobot {
    /// `None` where no case has such a robot.
    pub const fn new(index: usize) -> Option<Self> {
        if index < TEAMMATES_MAX { Some(Self(index as u8)) } else { None }
    }

    /// First robot of a case, `tm1`.
    pub(crate) const FIRST: Self = Self(0);

    /// From 0; always below [`TEAMMATES_MAX`], even where the value came from outside.
    pub const fn index(self) -> usize {
        (self.0 & 3) as usize
    }

    /// From 1, as in case files and reports.
    pub const fn number(self) -> u8 {
        self.index() as u8 + 1
    }

    /// The first `count` robots.
    pub fn first(count: usize) -> impl Iterator<Item = Self> + Clone {
        (0..count.min(TEAMMATES_MAX) as u8).map(Self)
    }
}

impl fmt::Display for CaseRobot {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "tm{}", self.number())
    }
}

/// A kick kind of the league.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(transparent)]
pub struct KickId(pub u8);

geometry::labels! {
    /// One step of a robot's gameplay.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum Action {
        /// Stay in place until the next action may start.
        Wait = "wait",
        /// Walk to a point.
        GoToPoint(PointMm) = "go_to_point",
        /// Face a direction or a point.
        Turn(TurnTarget) = "turn",
        /// Go to the ball and hold it.
        GetBall = "get_ball",
        /// Carry the ball to a point.
        DribbleTo(PointMm) = "dribble_to",
        /// Kick the ball to a teammate that receives it.
        PassBall(CaseRobot) = "pass_ball",
        /// Receive the ball from the teammate that passes it.
        ReceiveBall(CaseRobot) = "receive_ball",
        /// Kick the ball away.
        Kick(KickId) = "kick",
    }
}

impl Action {
    /// Returns whether the ball is involved (docs/case-format.md §3.1: "ball action").
    pub const fn concerns_ball(self) -> bool {
        !matches!(self, Self::Wait | Self::GoToPoint(_) | Self::Turn(_))
    }
}

/// Target of a `turn`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TurnTarget {
    /// A heading relative to the direction of attack, whole degrees, left > 0.
    HeadingDeg(i32),
    /// A point to face, the case's own coordinates, mm.
    Face(PointMm),
}

/// A kick kind: its aim, its scatter and the body's kick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CaseKick {
    /// Direction of the kick: along a heading or at the goal.
    pub aim: KickAim,
    /// Radius of its trajectory at the foot, mm.
    pub r_min: i32,
    /// Radius of its trajectory at the end, mm.
    pub r_max: i32,
    /// The kick primitive that the body executes.
    pub primitive: Primitive,
}

/// Aim of a kick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum KickAim {
    /// Along a heading relative to the direction of attack.
    Heading {
        /// Whole degrees, left > 0.
        degrees: i32,
        /// Rolling distance of the ball, mm.
        length_mm: i32,
    },
    /// Aim at a point of the attacked goal line.
    Goal {
        /// From the goal's centre, mm, left > 0 seen in attack.
        offset_mm: i32,
    },
}

geometry::labels! {
    /// The body's kick primitive, labelled by its key in the league's file; its place is its code in the
    /// table.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
    pub enum Primitive {
        /// The file names none: the body chooses by the kick's aim.
        #[default]
        Unspecified = "",
        /// Forward, over a short distance.
        ForwardSoft = "forward_soft",
        /// Forward, over a long distance.
        ForwardHard = "forward_hard",
        /// Kick to the robot's left side.
        Left = "left",
        /// Kick to the robot's right side.
        Right = "right",
        /// Kick with the strength of a pass.
        Pass = "pass",
    }
}

/// Radii of the trajectory of a pass, mm; its length is the distance to the receiver.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pass {
    /// At the passer's foot.
    pub r_min: i32,
    /// Radius of the path at the receiver, mm.
    pub r_max: i32,
}

/// Dimensions of the league's field, mm.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FieldMm {
    /// Along x, between the goal lines.
    pub length: i32,
    /// Along y, between the touch lines.
    pub width: i32,
    /// Field surface outside the lines.
    pub margin: i32,
    /// Distance between the insides of the goal posts.
    pub goal_width: i32,
    /// Depth of the penalty area, along x.
    pub penalty_depth: i32,
    /// Width of the penalty area, along y.
    pub penalty_width: i32,
}

impl FieldMm {
    /// Inside the lines or on them.
    pub const fn contains(&self, point: PointMm) -> bool {
        2 * (point.x as i64).abs() <= self.length as i64 && 2 * (point.y as i64).abs() <= self.width as i64
    }

    /// The point inside the lines nearest to `point`; halves of odd dimensions round inwards.
    pub fn clamp(&self, point: PointMm) -> PointMm {
        let (x, y) = ((self.length / 2).max(0), (self.width / 2).max(0));
        PointMm { x: point.x.clamp(-x, x), y: point.y.clamp(-y, y) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn robots_are_numbered_from_one_in_files() {
        assert_eq!(CaseRobot::first(9).map(CaseRobot::number).collect::<heapless::Vec<_, 8>>(), [1, 2, 3, 4]);
        assert_eq!(CaseRobot::new(4), None);
    }

    #[test]
    fn a_point_on_the_line_is_inside() {
        let field = FieldMm {
            length: 5400,
            width: 3600,
            margin: 300,
            goal_width: 800,
            penalty_depth: 650,
            penalty_width: 1300,
        };
        assert!(field.contains(PointMm::new(-2700, 1800)));
        assert!(!field.contains(PointMm::new(-2701, 0)) && !field.contains(PointMm::new(i32::MIN, 0)));
        assert_eq!(field.clamp(PointMm::new(9999, -1801)), PointMm::new(2700, -1800));
    }
}
