//! `index`: index of the cases that can have the ball in their scope. A grid over the ball's position
//! (docs/case-format.md §3).
//!
//! The grid covers the half of the field where y ≥ 0. Each of its cells lists the cases defending the
//! negative goal whose ball scope (at the paper's threshold) overlaps it; cells at the border extend to
//! infinity. Cases near a ball elsewhere, or under the other goal, are found by looking up the mirrored ball,
//! because mirroring a case flips bits of its id. Lists are sorted by number of opponents, then of teammates,
//! both falling: cases that can fulfil most conditions come first.

use crate::settings::SCOPE_EXPONENT;
use crate::symmetry::Symmetry;
use crate::table::CaseBase;
use crate::{FieldMm, PointMm};
use geometry::GoalEnd;
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

/// Shape of the grid.
#[derive(Clone, Copy, Debug, PartialEq, FromBytes, IntoBytes, Immutable, KnownLayout)]
#[repr(C)]
pub struct Grid {
    /// Number of cells along x.
    pub columns: u16,
    /// Number of cells along y.
    pub rows: u16,
    /// Edge of a cell, mm.
    pub cell_mm: f32,
    /// Inverse of `cell_mm`, 1/mm: replaces a division by a multiplication.
    pub cells_per_mm: f32,
    /// The corner of the first cell, mm: the intersection of the middle line and the field's end at −x.
    pub corner: [f32; 2],
}

impl Grid {
    /// The grid over the half of a field.
    pub fn over(field: FieldMm, columns: u16, rows: u16, cell_mm: i32) -> Self {
        let cell_mm = cell_mm.max(1) as f32;
        let corner = PointMm::new(-field.length / 2, 0).to_f32();
        Self { columns, rows, cell_mm, cells_per_mm: 1.0 / cell_mm, corner }
    }

    /// The number of the cell that contains `ball`, row after row. On the border of two cells it may be
    /// either.
    #[inline]
    pub(crate) fn cell(&self, ball: [f32; 2]) -> usize {
        // Coordinates below the corner are cut off at 0 by the conversion.
        let step = |axis: usize, count: u16| {
            let cells = (ball[axis] - self.corner[axis]) * self.cells_per_mm;
            (cells as usize).min(usize::from(count).wrapping_sub(1))
        };
        step(1, self.rows) * usize::from(self.columns) + step(0, self.columns)
    }
}

impl CaseBase<'_> {
    /// Every case under `goal` whose ball scope may contain `ball`: ids, with the bits to flip in them.
    #[inline]
    pub(crate) fn near(&self, [x, y]: [f32; 2], goal: GoalEnd) -> (&[u16], usize) {
        let (x, other_goal) = match goal {
            GoalEnd::Negative => (x, Symmetry::Identity),
            GoalEnd::Positive => (-x, Symmetry::AcrossY),
        };
        let (y, other_side) = if y < 0.0 { (-y, Symmetry::AcrossX) } else { (y, Symmetry::Identity) };
        let cell = self.header.grid.cell([x, y]);
        let bounds = self.cell_starts.get(cell..).and_then(|starts| starts.first_chunk());
        let list = bounds.and_then(|&[from, to]| self.cell_cases.get(from as usize..to as usize));
        (list.unwrap_or(&[]), usize::from(other_goal.bits() | other_side.bits()))
    }

    /// Whether the index was built for scopes that end at this exponent.
    #[inline]
    pub(crate) fn index_serves(limit: f32) -> bool {
        limit <= SCOPE_EXPONENT
    }
}
