//! `successful_plays`: successful plays of recordings: who had the ball from where to where, until a shot or
//! a goal. mm, seen in attack towards +x.
//!
//! [`PlayFinder`] finds them in matches of the Small Size League, as a host sees them and
//! [`attack`](crate::attack) judges them; [`LeggedPlay`] finds that of a trial, in the true world.

mod finder;
mod legged;
#[cfg(test)]
mod tests;

use casebase::FieldMm;
use geometry::{Field, Point};
use serde::{Deserialize, Serialize};

pub use finder::PlayFinder;
pub use legged::LeggedPlay;

/// A successful play.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct SuccessfulPlay {
    /// Length and width of the field it was played on, mm.
    pub field: [i32; 2],
    /// The team's robots when it began, by id, all that were seen, mm.
    pub teammates: Vec<(u8, [i32; 2])>,
    /// The opponents' positions then, mm.
    pub opponents: Vec<[i32; 2]>,
    /// The robots that had the ball, in this order: each passed it to the next one. Never empty.
    pub holdings: Vec<Holding>,
    /// Kick that ended it.
    pub end: PlayEnd,
    /// Whether a goal followed: in trials one that counts as to goal.
    pub goal: bool,
}

/// The time in which a robot had the ball.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Holding {
    /// Id of the robot.
    pub robot: u8,
    /// The ball's place when it got it, mm.
    pub got: [i32; 2],
    /// The ball's place when it kicked, or when the play ended, mm.
    pub left: [i32; 2],
}

/// The end of a successful play.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PlayEnd {
    /// A kick whose line crosses the goal line at this y, mm.
    Shot(i32),
    /// The ball was carried to where it counts.
    Carried,
}

impl SuccessfulPlay {
    /// Whether it was played on this field, to 50 mm.
    pub fn fits(&self, field: &FieldMm) -> bool {
        let [length, width] = self.field;
        (length - field.length).abs() <= FIELD_TOLERANCE && (width - field.width).abs() <= FIELD_TOLERANCE
    }

    /// Whether its numbers can be of a play: positions within twice the field, robots that are known.
    pub fn is_sane(&self) -> bool {
        let [length, width] = self.field;
        let inside = |[x, y]: &[i32; 2]| (-length..=length).contains(x) && (-width..=width).contains(y);
        let places = self.holdings.iter().flat_map(|holding| [&holding.got, &holding.left]);
        let places = places.chain(self.teammates.iter().map(|(_, at)| at)).chain(&self.opponents);
        let known = |holding: &Holding| self.teammates.iter().any(|(id, _)| *id == holding.robot);
        (1000..=30_000).contains(&length)
            && (1000..=30_000).contains(&width)
            && (1..=HOLDINGS_MAX).contains(&self.holdings.len())
            && self.holdings.iter().all(known)
            && self.teammates.len() <= ROBOTS_MAX
            && self.opponents.len() <= ROBOTS_MAX
            && places.into_iter().all(inside)
            && !matches!(self.end, PlayEnd::Shot(y) if !(-width..=width).contains(&y))
    }
}

/// A point in mm, turned by half a turn where the team attacks towards -x.
fn seen(at: Point<Field>, sign: f32) -> [i32; 2] {
    [at.x(), at.y()].map(|m| (m * sign * 1000.0).round() as i32)
}

/// Most robots that have the ball in a play, one after the other: the last three passes.
const HOLDINGS_MAX: usize = 4;
/// Most robots of a team that a play knows of.
const ROBOTS_MAX: usize = 16;
/// Fields whose sides differ by less are the same, mm.
const FIELD_TOLERANCE: i32 = 50;
