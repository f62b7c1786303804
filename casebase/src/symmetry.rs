//! `symmetry`: the symmetric copies of a case (Ros et al. 2009, §2.4; docs/case-format.md §2).
//!
//! Positions and points are mirrored, scopes and radii are kept. Headings and offsets of kicks are relative
//! to the direction of attack: a single reflection negates them, the double one (a turn by 180°) keeps them.

use core::fmt;

use geometry::GoalEnd;
use serde::{Deserialize, Serialize};

use crate::PointMm;

geometry::labels! {
    /// The symmetry of a stored case; the number is the case id modulo 4.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
    pub enum Symmetry {
        /// (x, y), same goal: as authored.
        Identity = "identity",
        /// (x, −y), same goal.
        AcrossX = "across-x",
        /// (−x, y), other goal.
        AcrossY = "across-y",
        /// (−x, −y), other goal.
        Both = "both",
    }
}

impl Symmetry {
    /// From the lowest two bits of a case id.
    pub const fn from_bits(bits: u16) -> Self {
        match bits & 3 {
            0 => Self::Identity,
            1 => Self::AcrossX,
            2 => Self::AcrossY,
            _ => Self::Both,
        }
    }

    /// The lowest two bits of the ids of such cases.
    pub const fn bits(self) -> u16 {
        self as u16
    }

    /// The image of a point or position.
    pub const fn point(self, point: PointMm) -> PointMm {
        let flipped = PointMm { x: point.x.saturating_neg(), y: point.y.saturating_neg() };
        match self {
            Self::Identity => point,
            Self::AcrossX => PointMm { x: point.x, y: flipped.y },
            Self::AcrossY => PointMm { x: flipped.x, y: point.y },
            Self::Both => flipped,
        }
    }

    /// The goal defended after it.
    pub const fn goal(self, goal: GoalEnd) -> GoalEnd {
        match self {
            Self::Identity | Self::AcrossX => goal,
            Self::AcrossY | Self::Both => goal.opposite(),
        }
    }

    /// Returns whether left becomes right: true for the single reflections.
    pub const fn swaps_sides(self) -> bool {
        matches!(self, Self::AcrossX | Self::AcrossY)
    }
}

impl fmt::Display for Symmetry {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.label())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_four_situations_of_the_papers_figure_3() {
        let p = PointMm::new(1000, 500);
        let of = |s: Symmetry| (s.point(p), s.goal(GoalEnd::Negative).label());
        assert_eq!(of(Symmetry::Identity), (PointMm::new(1000, 500), "yellow"));
        assert_eq!(of(Symmetry::AcrossX), (PointMm::new(1000, -500), "yellow"));
        assert_eq!(of(Symmetry::AcrossY), (PointMm::new(-1000, 500), "cyan"));
        assert_eq!(of(Symmetry::Both), (PointMm::new(-1000, -500), "cyan"));
    }

    #[test]
    fn every_symmetry_undoes_itself_and_two_make_the_third() {
        let p = PointMm::new(-321, 77);
        for a in Symmetry::ALL {
            assert_eq!(a.point(a.point(p)), p);
            for b in Symmetry::ALL {
                let both = Symmetry::from_bits(a.bits() ^ b.bits());
                assert_eq!(a.point(b.point(p)), both.point(p));
                assert_eq!(a.swaps_sides() ^ b.swaps_sides(), both.swaps_sides());
            }
        }
    }

    #[test]
    fn words_lead_back_to_their_goals() {
        for goal in [GoalEnd::Negative, GoalEnd::Positive] {
            assert_eq!(GoalEnd::from_label(goal.label()), Some(goal));
        }
        assert_eq!(GoalEnd::from_label("blue"), None);
    }
}
