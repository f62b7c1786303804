//! `word_search`: retrieval in a table with words: 32 cases at a time, those that may fulfil most conditions
//! first.

use heapless::Vec;
use protocol::CaseId;

use crate::Symmetry;
use crate::action::OPPONENTS_MAX;
use crate::best_search::{BestSearch, Class};
use crate::query::{Query, Strips};
use crate::stored::Stored;
use crate::table::{CaseBase, STRIPS, Word};

/// Passes every case under the problem's goal whose scope may contain the ball to a callback.
#[inline]
pub(crate) fn each_in_words<'q, 'a>(
    base: &'q CaseBase<'a>,
    query: &Query<'_>,
    mut visit: impl FnMut(Stored<'q, 'a>),
) {
    let (near, symmetry) = base.words_near(query.key.ball, query.problem.defending);
    for opponents in 0..=OPPONENTS_MAX {
        for (number, cases) in near.with_opponents(opponents) {
            let Some(word) = base.words.get(usize::from(number)) else { continue };
            for bit in bits(cases) {
                if let Some(case) = Stored::new(base, CaseId(word.cases[bit & 31] ^ symmetry.bits())) {
                    visit(case);
                }
            }
        }
    }
}

/// Searches a table with words for the best case: cases that may fulfil so many conditions, from the most
/// that are possible downwards, until a candidate fulfils as many.
#[inline(never)]
pub(crate) fn search_words(search: &mut BestSearch<'_, '_>) {
    let (base, query) = (search.base, search.query);
    let (near, symmetry) = base.words_near(query.key.ball, query.problem.defending);
    let strips = query.strips(symmetry);
    let mut counted: Vec<Counted<'_>, COUNTED_MAX> = Vec::new();
    for conditions in (0..=OPPONENTS_MAX).rev() {
        for counted in &counted {
            let cases = counted.with_exactly(conditions);
            if cases != 0 {
                test(search, counted.word, cases, conditions, symmetry);
            }
        }
        for (number, cases) in near.with_opponents(conditions) {
            let Some(word) = base.words.get(usize::from(number)) else { continue };
            if usize::from(word.teammates) > query.key.robots {
                continue;
            }
            let at_least = count(base.bitmaps, word, cases, &strips);
            let some = at_least.get(conditions).copied().unwrap_or(cases);
            let cases = if counted.is_full() { cases } else { some };
            if cases != 0 {
                test(search, word, cases, conditions, symmetry);
            }
            // Where there is no room left, all cases were tested.
            let _ = counted.push(Counted { word, at_least });
        }
        if usize::from(search.class.conditions()) >= conditions {
            break;
        }
    }
}

/// A word's cases by the number of their scopes that may hold an opponent.
struct Counted<'a> {
    word: &'a Word,
    at_least: AtLeast,
}

impl Counted<'_> {
    /// The cases with so many scopes that may hold an opponent, fewer than their opponents.
    #[inline(always)]
    fn with_exactly(&self, conditions: usize) -> u32 {
        match self.at_least.get(conditions..).and_then(|counts| counts.first_chunk()) {
            Some([at_least, more]) => at_least & !more,
            None => 0,
        }
    }
}

/// Cases with at least 0, 1, … scopes that may hold an opponent.
type AtLeast = [u32; OPPONENTS_MAX + 1];

/// Counts for `cases` of a word the scopes that may hold an opponent.
#[inline(always)]
fn count(bitmaps: &[u32], word: &Word, cases: u32, strips: &Strips) -> AtLeast {
    let bitmaps = bitmaps.get(word.bitmaps_at as usize..).unwrap_or(&[]);
    let counts = match word.opponents {
        1 => count_scopes::<1>(bitmaps, cases, strips),
        2 => count_scopes::<2>(bitmaps, cases, strips),
        3 => count_scopes::<3>(bitmaps, cases, strips),
        4 => count_scopes::<4>(bitmaps, cases, strips),
        _ => None,
    };
    counts.unwrap_or([cases, 0, 0, 0, 0])
}

/// The same for words of `N` opponents, whose bitmaps come first.
#[inline(always)]
fn count_scopes<const N: usize>(bitmaps: &[u32], cases: u32, strips: &Strips) -> Option<AtLeast> {
    let (bitmaps, _) = bitmaps.get(..STRIPS * N)?.as_chunks::<N>();
    let bitmaps: &[[u32; N]; STRIPS] = bitmaps.first_chunk()?;
    let mut held = [0; N];
    for [x, y] in strips {
        let (x, y) = (bitmaps[x % STRIPS], bitmaps[y % STRIPS]);
        for scope in 0..N {
            held[scope] |= x[scope] & y[scope];
        }
    }
    let none = [cases, 0, 0, 0, 0];
    Some(held.into_iter().fold(none, |[all, one, two, three, four], held| {
        [all, one | all & held, two | one & held, three | two & held, four | three & held]
    }))
}

/// Tests cases of a word, unless they cannot be better than the best candidate so far with `conditions`.
#[inline(never)]
fn test(search: &mut BestSearch<'_, '_>, word: &Word, cases: u32, conditions: usize, symmetry: Symmetry) {
    let bound = Class::bound(conditions as u8, word.teammates);
    if bound < search.class {
        return;
    }
    for bit in bits(cases) {
        let id = word.cases[bit & 31] ^ symmetry.bits();
        let Some(record_header) = search.base.record_headers.get(usize::from(id)) else { continue };
        if let Some(exponent) = search.query.key.exponent_in_scope(record_header)
            && bound.in_interval_of(exponent) >= search.class
        {
            let allowed = Class::promise(record_header).in_interval_of(exponent);
            search.test_scopes(CaseId(id), record_header, exponent, allowed);
        }
    }
}

/// The numbers of the bits that are set.
#[inline(always)]
fn bits(mut set: u32) -> impl Iterator<Item = usize> {
    core::iter::from_fn(move || {
        let bit = set.trailing_zeros();
        set &= set.wrapping_sub(1);
        (bit < u32::BITS).then_some(bit as usize)
    })
}

/// Number of words that are counted once: with 10,000 cases, those near a ball have room.
const COUNTED_MAX: usize = 48;
