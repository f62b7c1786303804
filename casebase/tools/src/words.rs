//! `words`: cases of a large library in words of 32, for retrieval that tests 32 cases at a time
//! (`casebase::table::Word`).

use std::cmp::Reverse;
use std::collections::BTreeMap;

use casebase::table::{STRIPS, Word};
use casebase::{PointMm, Symmetry, strips_of};
use zerocopy::IntoBytes;

use crate::authored::Authored;

/// The words of a library and the bitmaps of its opponent scopes.
#[derive(Default)]
pub(crate) struct Words {
    pub(crate) list: Vec<Word>,
    /// Their bitmaps.
    pub(crate) bitmaps: Vec<u32>,
    /// Word and bit of each stored case.
    places: BTreeMap<u16, (u16, u32)>,
}

impl Words {
    /// The words of stored cases; `ids` may repeat.
    pub(crate) fn of(mut ids: Vec<u16>, cases: &[Authored]) -> Self {
        ids.sort_unstable();
        ids.dedup();
        let mut alike: BTreeMap<_, Vec<u16>> = BTreeMap::new();
        for id in ids {
            let case = &cases[usize::from(id / 4)];
            alike.entry(Reverse((case.opponents.len(), case.teammates.len()))).or_default().push(id);
        }
        let mut words = Self::default();
        for mut ids in alike.into_values() {
            words.split(&mut ids, cases);
        }
        words
    }

    /// Bytes in a table.
    pub(crate) fn bytes(&self) -> usize {
        self.list.as_bytes().len() + self.bitmaps.as_bytes().len()
    }

    /// The word of a stored case, and its bit there.
    pub(crate) fn place_of(&self, id: u16) -> (u16, u32) {
        self.places.get(&id).copied().unwrap_or_default()
    }

    /// Puts cases of equal numbers of robots and opponents into words: halves them along the axis along which
    /// their balls are spread farther, until they fit.
    fn split(&mut self, ids: &mut [u16], cases: &[Authored]) {
        if ids.len() <= CASES_OF_WORD {
            self.push(ids, cases);
            return;
        }
        let x = spread(ids, cases, |at| at.x) > spread(ids, cases, |at| at.y);
        ids.sort_by_key(|id| {
            let at = ball(*id, cases);
            (if x { at.x } else { at.y }, *id)
        });
        let half = ids.len().div_ceil(CASES_OF_WORD) / 2 * CASES_OF_WORD;
        let (low, high) = ids.split_at_mut(half);
        self.split(low, cases);
        self.split(high, cases);
    }

    fn push(&mut self, ids: &[u16], cases: &[Authored]) {
        let Some(first) = ids.first() else { return };
        let (number, bitmaps_at) = (self.list.len() as u16, self.bitmaps.len());
        let first = &cases[usize::from(first / 4)];
        let opponents = first.opponents.len();
        self.bitmaps.resize(bitmaps_at + STRIPS * opponents, 0);
        let mut word = Word {
            cases: [0; CASES_OF_WORD],
            bitmaps_at: bitmaps_at as u32,
            teammates: first.teammates.len() as u8,
            opponents: opponents as u8,
            reserved: [0; 2],
        };
        for (bit, (place, id)) in word.cases.iter_mut().zip(ids).enumerate() {
            *place = *id;
            self.places.insert(*id, (number, bit as u32));
            let symmetry = Symmetry::from_bits(*id);
            for (scope, opponent) in cases[usize::from(*id / 4)].opponents.iter().enumerate() {
                let PointMm { x, y } = symmetry.point(opponent.at).minus(ball(*id, cases));
                let (x, y) = (strips_of(x, opponent.scope.x), strips_of(y, opponent.scope.y));
                let strips = u64::from(y) << (STRIPS / 2) | u64::from(x);
                for strip in (0..STRIPS).filter(|strip| strips >> strip & 1 != 0) {
                    self.bitmaps[bitmaps_at + opponents * strip + scope] |= 1 << bit;
                }
            }
        }
        self.list.push(word);
    }

    /// Number of opponents of a word's cases.
    pub(crate) fn opponents_of(&self, word: u16) -> usize {
        self.list.get(usize::from(word)).map_or(0, |word| usize::from(word.opponents))
    }
}

/// Difference of the largest and the smallest coordinate of the cases' balls along an axis, mm.
fn spread(ids: &[u16], cases: &[Authored], axis: fn(PointMm) -> i32) -> i32 {
    let along = ids.iter().map(|id| axis(ball(*id, cases)));
    along.clone().max().unwrap_or(0) - along.min().unwrap_or(0)
}

/// Where the ball lies in a stored case.
fn ball(id: u16, cases: &[Authored]) -> PointMm {
    Symmetry::from_bits(id).point(cases[usize::from(id / 4)].ball)
}

/// A bit each.
const CASES_OF_WORD: usize = 32;
