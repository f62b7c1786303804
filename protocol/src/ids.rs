//! `ids`: identifiers of robots, teams, cycles and cases, as distinct types.

use core::fmt;

use rules::Colour;
use serde::{Deserialize, Serialize};

/// Robots of a team that can take part in one case (paper §2: n ≤ 4).
pub const CASE_ROBOTS_MAX: usize = 4;

/// A robot of one team, 0–15; fixed permanently (paper §4.1: "each robot has a unique fixed Id").
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(try_from = "u8", into = "u8")]
pub struct RobotId(u8);

impl RobotId {
    /// The lowest valid number, 0.
    pub const ZERO: Self = Self(0);
    /// Number of valid ids.
    pub const COUNT: usize = 16;

    /// The id of that number, 0–15; `None` above 15.
    pub const fn new(id: u8) -> Option<Self> {
        if (id as usize) < Self::COUNT { Some(Self(id)) } else { None }
    }

    /// The number on its shell, 0–15.
    pub const fn number(self) -> u8 {
        self.0
    }

    /// Index for arrays with one entry per id.
    pub const fn index(self) -> usize {
        (self.0 & 0x0f) as usize
    }

    /// Every id, lowest first.
    pub fn all() -> impl Iterator<Item = Self> {
        (0..Self::COUNT as u8).map(Self)
    }
}

/// Error of an id above 15.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("robot ids are 0 to 15, not {0}")]
pub struct NoSuchRobot(pub u8);

impl TryFrom<u8> for RobotId {
    type Error = NoSuchRobot;
    fn try_from(id: u8) -> Result<Self, NoSuchRobot> {
        Self::new(id).ok_or(NoSuchRobot(id))
    }
}

impl From<RobotId> for u8 {
    fn from(id: RobotId) -> Self {
        id.0
    }
}

impl fmt::Display for RobotId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

/// A team in the radio network; two teams share no cycle and no key.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(transparent)]
pub struct TeamId(pub u8);

impl TeamId {
    /// The team of that colour, numbered as the referee does: 1 yellow, 2 blue.
    pub const fn of(colour: Colour) -> Self {
        match colour {
            Colour::Yellow => Self(1),
            Colour::Blue => Self(2),
        }
    }
}

/// Identity of a robot: team colour and number; yellow sorts first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct Who {
    /// Colour of its team.
    pub colour: Colour,
    /// Shell number of the robot, 0–15.
    pub id: RobotId,
}

impl Who {
    /// Yellow's robot of that number.
    pub const fn yellow(id: RobotId) -> Self {
        Self { colour: Colour::Yellow, id }
    }

    /// Blue's robot of that number.
    pub const fn blue(id: RobotId) -> Self {
        Self { colour: Colour::Blue, id }
    }

    /// Index for both teams: 0–15 yellow, 16–31 blue.
    pub const fn slot(self) -> usize {
        let team = match self.colour {
            Colour::Yellow => 0,
            Colour::Blue => RobotId::COUNT,
        };
        team + self.id.index()
    }
}

/// A stored case: 4 × authored index + symmetry (docs/case-format.md §2).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(transparent)]
pub struct CaseId(pub u16);

impl fmt::Display for CaseId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

/// One retrieve–reuse cycle of a team. Totally ordered: the counter first, then the proposer, so that two
/// proposals made at once still have one winner, and a message with an older id is known to be stale.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct CycleId {
    /// Rises with every proposal.
    #[serde(with = "postcard::fixint::le")]
    pub counter: u32,
    /// The elector that proposed the cycle.
    pub proposer: RobotId,
}

impl fmt::Display for CycleId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}.{}", self.counter, self.proposer)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cycle_is_newer_by_its_counter_and_then_by_its_proposer() {
        let id = |counter, proposer| CycleId { counter, proposer: RobotId(proposer) };
        assert!(id(2, 0) > id(1, 9));
        assert!(id(2, 3) > id(2, 1));
    }

    #[test]
    fn there_are_sixteen_ids() {
        assert_eq!(RobotId::new(16), None);
        assert_eq!(RobotId::all().count(), RobotId::COUNT);
    }
}
