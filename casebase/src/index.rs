//! Which stored cases can have the ball in their scope? A grid over the ball's position (DESIGN §4.3).
//!
//! Each cell of the grid lists the cases defending the negative goal whose ball scope (at the paper's threshold)
//! reaches into it, one copy of each authored case; cells at the border reach to infinity. The other copies are
//! found by looking up the mirrored ball, because mirroring a case flips one bit of its id. Lists are sorted by
//! number of opponents, then of teammates, both falling: what can fulfil most conditions comes first.

use crate::settings::SCOPE_EXPONENT;
use crate::symmetry::Symmetry;
use crate::table::CaseBase;
use crate::{FieldMm, PointMm};
use geometry::GoalEnd;

/// The shape of the grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Grid {
    /// Cells along x.
    pub columns: u16,
    /// Cells along y.
    pub rows: u16,
    /// Edge of a cell, mm.
    pub cell_mm: i32,
    /// The corner of the first cell, mm: the field's corner at (−x, −y).
    pub corner: PointMm,
}

impl Grid {
    /// The grid over a field.
    pub fn over(field: FieldMm, columns: u16, rows: u16, cell_mm: i32) -> Self {
        Self {
            columns,
            rows,
            cell_mm: cell_mm.max(1),
            corner: PointMm::new(-field.length / 2, -field.width / 2),
        }
    }

    /// The number of the cell that holds `ball`, row after row.
    #[inline]
    pub fn cell(&self, ball: PointMm) -> usize {
        let step = |at: i32, from: i32, count: u16| {
            (at.saturating_sub(from) / self.cell_mm).clamp(0, i32::from(count.max(1)) - 1) as usize
        };
        step(ball.y, self.corner.y, self.rows) * usize::from(self.columns)
            + step(ball.x, self.corner.x, self.columns)
    }
}

impl CaseBase<'_> {
    /// The two lists of the index that together name every case under `goal` whose ball scope may hold `ball`; each
    /// with the bits to flip in the ids it lists.
    #[inline]
    pub(crate) fn near(&self, ball: PointMm, goal: GoalEnd) -> [(&[u16], u16); 2] {
        let [columns, rows] = self.header.grid;
        let grid = Grid::over(self.field(), columns, rows, self.header.cell_mm);
        let symmetries = match goal {
            GoalEnd::Negative => [Symmetry::Identity, Symmetry::AcrossX],
            GoalEnd::Positive => [Symmetry::AcrossY, Symmetry::Both],
        };
        symmetries.map(|symmetry| {
            let cell = grid.cell(symmetry.point(ball));
            let bound = |cell: usize| self.cell_starts.get(cell).map_or(0, |start| *start as usize);
            (self.cell_cases.get(bound(cell)..bound(cell + 1)).unwrap_or(&[]), symmetry.bits())
        })
    }

    /// Is the index made for scopes that end at this exponent?
    #[inline]
    pub(crate) fn index_serves(limit: f32) -> bool {
        limit <= SCOPE_EXPONENT
    }
}
