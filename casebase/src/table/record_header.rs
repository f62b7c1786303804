//! `record_header`: positions of the records that retrieval reads. Each stored case has a
//! [`RecordHeader`], and behind it, in one run of the table's places, its opponents, its legs and its robots'
//! positions. Lengths in mm.

use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

use crate::point::gauss_exponent;
use crate::presence::Demands;

/// Record header of a stored case: its ball scope, the numbers of its records and the start of its records.
#[derive(Clone, Copy, Debug, PartialEq, FromBytes, IntoBytes, Immutable, KnownLayout)]
#[repr(C)]
pub struct RecordHeader {
    /// B_c: ball position, whole mm, field frame.
    pub ball: [f32; 2],
    /// 1/τx and 1/τy of the ball's scope, 1/mm.
    pub inverse_scope: [f32; 2],
    /// Index of the 32-bit unit of the places at which its records start.
    pub places_at: u32,
    /// Number of robots of the case.
    pub teammates: u8,
    /// Number of opponents of the case.
    pub opponents: u8,
    /// Number of legs of the ball path.
    pub legs: u8,
    /// Demands of the opponent scopes: bits of [`Demands`].
    pub demands: u8,
}

/// An opponent's scope, with its centre relative to the ball.
#[derive(Clone, Copy, Debug, PartialEq, FromBytes, IntoBytes, Immutable, KnownLayout)]
#[repr(C)]
pub struct OpponentRecord {
    /// The squares around the ball that it overlaps: [`cells_of`](crate::cells_of).
    pub cells: u32,
    /// Relative to the case's ball, mm.
    pub at: [i16; 2],
    /// 1/τx and 1/τy of the opponent's scope, 1/mm.
    pub inverse_scope: [f32; 2],
}

impl OpponentRecord {
    /// Returns whether the scope, displaced by `moved`, contains a point relative to the ball, mm.
    #[inline(always)]
    pub(crate) fn holds(&self, moved: [f32; 2], point: [f32; 2], limit: f32) -> bool {
        self.holds_any(moved, &[point], limit)
    }

    /// Returns whether it contains any of several points.
    #[inline(always)]
    pub(crate) fn holds_any(&self, moved: [f32; 2], points: &[[f32; 2]], limit: f32) -> bool {
        let centre = [f32::from(self.at[0]) + moved[0], f32::from(self.at[1]) + moved[1]];
        let [inverse_x, inverse_y] = self.inverse_scope;
        points.iter().any(|point| {
            let (dx, dy) = (point[0] - centre[0], point[1] - centre[1]);
            gauss_exponent(dx, dy, inverse_x, inverse_y) < limit
        })
    }
}

/// A leg of the ball path. It starts where the ball lies: at the ball's start position or the end of the leg
/// before, unless it was carried since.
#[derive(Clone, Copy, Debug, PartialEq, FromBytes, IntoBytes, Immutable, KnownLayout)]
#[repr(C)]
pub struct RawLeg {
    /// End of the leg, mm: relative to the case's ball, or a point of the field where [`RawLeg::TO_FIELD`] is
    /// set.
    pub to: [f32; 2],
    /// r_min and r_max, mm.
    pub radii: [f32; 2],
    /// Number of the case robot that passes or kicks, from 0.
    pub robot: u8,
    /// Number of that action in its gameplay.
    pub action: u8,
    /// [`RawLeg::NOT_CARRIED`], or the case's point to which the ball was dribbled before.
    pub carried_to: u8,
    /// [`RawLeg::TO_FIELD`] or 0; no other bits.
    pub flags: u8,
}

impl RawLeg {
    /// The ball was not carried since the leg before.
    pub const NOT_CARRIED: u8 = 255;
    /// The end is a point of the field, not moved with the ball.
    pub const TO_FIELD: u8 = 1;
}

impl RecordHeader {
    /// (Δx/τx)² + (Δy/τy)² of a ball at `ball`.
    #[inline]
    pub(crate) fn exponent(&self, ball: [f32; 2]) -> f32 {
        let [inverse_x, inverse_y] = self.inverse_scope;
        gauss_exponent(ball[0] - self.ball[0], ball[1] - self.ball[1], inverse_x, inverse_y)
    }

    #[inline]
    pub(crate) const fn demands(&self) -> Demands {
        Demands::from_bits(self.demands)
    }

    /// The case's opponents among the table's places; `None` where those end before (never in a validated
    /// table).
    #[inline]
    pub(crate) fn opponents<'a>(&self, places: &'a [u32]) -> Option<&'a [OpponentRecord]> {
        records(places, self.places_at as usize, self.opponents)
    }

    /// Legs of the ball path; each starts where the one before ends.
    #[inline]
    pub(crate) fn legs<'a>(&self, places: &'a [u32]) -> Option<&'a [RawLeg]> {
        records(places, self.legs_at(), self.legs)
    }

    /// Positions of its robots relative to the case's ball.
    #[inline]
    pub(crate) fn positions<'a>(&self, places: &'a [u32]) -> Option<&'a [[i16; 2]]> {
        let at = self.legs_at().wrapping_add(usize::from(self.legs) * (size_of::<RawLeg>() / WORD_LEN));
        records(places, at, self.teammates)
    }

    #[inline]
    fn legs_at(&self) -> usize {
        (self.places_at as usize)
            .wrapping_add(usize::from(self.opponents) * (size_of::<OpponentRecord>() / WORD_LEN))
    }
}

/// The `count` records that start at index `at`.
#[inline]
fn records<T: FromBytes + Immutable + KnownLayout>(places: &[u32], at: usize, count: u8) -> Option<&[T]> {
    let count = usize::from(count);
    let words = places.get(at..)?.get(..count * (size_of::<T>() / WORD_LEN))?;
    <[T]>::ref_from_bytes_with_elems(words.as_bytes(), count).ok()
}

/// Size of a unit of the places, bytes.
const WORD_LEN: usize = size_of::<u32>();
