//! `presence`: what an opponent scope demands of a situation: nothing beyond rank, an opponent inside it, or
//! none (docs/case-format.md §3).

use serde::{Deserialize, Serialize};

geometry::labels! {
    /// Demand of a case on one of its opponent scopes.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum Presence {
        /// An opponent inside it counts as a condition of the ranking (Ros et al. 2009, §3.4).
        #[default]
        Preferred = "preferred",
        /// An opponent must be inside it for the case to be a candidate; with one it counts as above.
        Required = "required",
        /// No opponent may be inside it for the case to be a candidate.
        Excluded = "excluded",
    }
}

/// The demands of a case's opponent scopes, in one byte of its record header: from bit 0 on those that are
/// required, from bit 4 on those that are excluded.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Demands(u8);

impl Demands {
    /// The demands of the case's opponents, in their order.
    pub fn of(opponents: impl IntoIterator<Item = Presence>) -> Self {
        let mut bits = 0;
        for (number, presence) in (0..4).zip(opponents) {
            bits |= match presence {
                Presence::Preferred => 0,
                Presence::Required => 1_u8 << number,
                Presence::Excluded => 16_u8 << number,
            };
        }
        Self(bits)
    }

    /// From a table's byte.
    #[inline]
    pub(crate) const fn from_bits(bits: u8) -> Self {
        Self(bits)
    }

    /// Byte of a table.
    pub const fn bits(self) -> u8 {
        self.0
    }

    /// Returns whether no scope demands anything.
    #[inline]
    pub(crate) const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Demand on the opponent of that number, from 0.
    pub(crate) const fn get(self, number: usize) -> Presence {
        // Four numbers exist.
        let bits = self.0 >> (number & 3);
        if bits & 1 != 0 {
            Presence::Required
        } else if bits & 16 != 0 {
            Presence::Excluded
        } else {
            Presence::Preferred
        }
    }

    /// Returns whether a case with this number of opponents can have the demands: none of an opponent that it
    /// lacks, and never both for one.
    pub(crate) const fn fits(self, opponents: u8) -> bool {
        let (required, excluded) = (self.0 & 15, self.0 >> 4);
        required & excluded == 0 && (required | excluded) as u32 >> opponents == 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn demands_are_read_as_they_were_written() {
        for number in 0..81_usize {
            let listed = [0, 1, 2, 3].map(|digit| Presence::ALL[number / 3_usize.pow(digit) % 3]);
            let demands = Demands::of(listed);
            assert_eq!([0, 1, 2, 3].map(|opponent| demands.get(opponent)), listed);
            let last = listed.iter().rposition(|one| *one != Presence::Preferred).map_or(0, |last| last + 1);
            for opponents in 0..=4 {
                assert_eq!(demands.fits(opponents), usize::from(opponents) >= last, "{listed:?}");
            }
        }
        assert!(!Demands::from_bits(0x11).fits(4), "required and excluded");
    }
}
