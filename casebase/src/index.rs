//! `index`: index of the cases that can have the ball in their scope. A grid over the ball's position
//! (docs/case-format.md §3).
//!
//! The grid covers the half of the field where y ≥ 0. Each of its cells lists the cases defending the
//! negative goal whose ball scope (at the paper's threshold) overlaps it; cells at the border extend to
//! infinity. Cases near a ball elsewhere, or under the other goal, are found by looking up the mirrored ball,
//! because mirroring a case flips bits of its id. Lists are sorted by number of opponents, then of teammates,
//! both falling: cases that can fulfil most conditions come first.

use crate::{FieldMm, PointMm};
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
        self.step(ball, 1, self.rows) * usize::from(self.columns) + self.step(ball, 0, self.columns)
    }

    /// Number of the row or column, of `count`, along an axis.
    #[inline]
    fn step(&self, ball: [f32; 2], axis: usize, count: u16) -> usize {
        // Coordinates below the corner are cut off at 0 by the conversion.
        let cells = (ball[axis] - self.corner[axis]) * self.cells_per_mm;
        (cells as usize).min(usize::from(count).wrapping_sub(1))
    }
}
