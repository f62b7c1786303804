//! `word`: cases of a large table in words of 32, so that retrieval tests 32 cases at a time: which cases a
//! word has, and where their opponent scopes lie, one bit a case.
//!
//! A word's cases have the same number of robots and of opponents, and their balls lie near each other.

use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

use crate::action::OPPONENTS_MAX;

/// Up to 32 cases.
#[derive(Clone, Copy, Debug, PartialEq, Eq, FromBytes, IntoBytes, Immutable, KnownLayout)]
#[repr(C)]
pub struct Word {
    /// Ids of the cases, which defend the negative goal; 0 behind the last.
    pub cases: [u16; 32],
    /// Index of the first 32-bit unit of its bitmaps: for each strip across x
    /// ([`strips_of`](crate::strips_of)), then for each across y, one unit for each opponent, whose bits are
    /// the cases in which that opponent's scope overlaps the strip.
    pub bitmaps_at: u32,
    /// Number of robots of each of the cases.
    pub teammates: u8,
    /// Number of opponents of each of the cases.
    pub opponents: u8,
    /// Always 0; keeps the record free of padding.
    pub reserved: [u8; 2],
}

/// Lengths of the sections that only a table with words has. They follow the header: these lengths, words,
/// bitmaps, and a mask for each entry of the cells' lists: the cases of its word.
#[derive(Clone, Copy, Debug, PartialEq, Eq, FromBytes, IntoBytes, Immutable, KnownLayout)]
#[repr(C)]
pub struct WordSections {
    /// Number of words, sorted by number of opponents, then of robots, both falling.
    pub words: u32,
    /// Number of 32-bit units of the bitmaps.
    pub bitmaps: u32,
}

/// Number of strips that a scope's place is stored for: 32 across x, then 32 across y.
pub const STRIPS: usize = 64;
/// Number of lists of a cell in a table with words, one for each number of opponents, falling.
pub const LISTS_OF_CELL: usize = OPPONENTS_MAX + 1;

/// Words with cases near a ball.
pub(crate) struct NearWords<'a> {
    pub(crate) bounds: &'a [u32; LISTS_OF_CELL + 1],
    pub(crate) words: &'a [u16],
    pub(crate) masks: &'a [u32],
}

impl<'a> NearWords<'a> {
    /// Numbers of the words whose cases have so many opponents, with the cases of each.
    #[inline]
    pub(crate) fn with_opponents(&self, opponents: usize) -> impl Iterator<Item = (u16, u32)> + 'a {
        let list = OPPONENTS_MAX.saturating_sub(opponents);
        let bounds = self.bounds.get(list..).and_then(|bounds| bounds.first_chunk());
        let bounds = bounds.map_or(0..0, |&[from, to]| from as usize..to as usize);
        let words = self.words.get(bounds.clone()).unwrap_or(&[]);
        words.iter().copied().zip(self.masks.get(bounds).unwrap_or(&[]).iter().copied())
    }
}
