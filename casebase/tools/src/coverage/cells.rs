//! `cells`: heat-map cell of a ball position. A grid over the field, attack frame (+x towards the goal
//! attacked): a ball of the team that attacks towards −x is turned by 180°, as the `both` copies of cases
//! are. mm.

use casebase::{FieldMm, GoalEnd, PointMm};

/// A grid over the field. The field's middle is the grid's; the outermost cells may extend beyond the lines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cells {
    /// Number of cells along x.
    pub columns: usize,
    /// Number of cells along y.
    pub rows: usize,
    /// Edge of a cell, mm.
    pub edge_mm: i32,
}

/// Reason why a grid cannot be made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum CellsError {
    /// Cells have no size.
    #[error("cells need an edge of at least 1 mm")]
    NoSize,
    /// More cells than [`Cells::MAX`].
    #[error("{cells} cells, at most {} can be distinguished; take a larger edge", Cells::MAX)]
    TooMany {
        /// Number of cells that the grid would have.
        cells: u64,
    },
}

impl Cells {
    /// Maximum number of cells of a grid.
    pub const MAX: u64 = 40_000;

    /// Cells of this edge over a field.
    pub fn new(field: FieldMm, edge_mm: i32) -> Result<Self, CellsError> {
        if edge_mm <= 0 {
            return Err(CellsError::NoSize);
        }
        let count =
            |side: i32| u64::from(side.max(1).unsigned_abs()).div_ceil(u64::from(edge_mm.unsigned_abs()));
        let (columns, rows) = (count(field.length), count(field.width));
        if columns * rows > Self::MAX {
            return Err(CellsError::TooMany { cells: columns * rows });
        }
        Ok(Self { columns: columns as usize, rows: rows as usize, edge_mm })
    }

    /// A suitable edge for the field: 18 cells along its length, to whole 50 mm.
    pub fn suitable_edge_mm(field: FieldMm) -> i32 {
        (field.length / 18 / 50 * 50).max(50)
    }

    /// Number of cells: `columns * rows`.
    pub const fn len(&self) -> usize {
        self.columns * self.rows
    }

    /// Never true of a grid that [`Cells::new`] made.
    pub const fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The cell of a ball (field frame), row after row from −y, from −x within a row; the nearest one for a
    /// ball outside.
    pub fn cell(&self, ball: PointMm, defending: GoalEnd) -> usize {
        let sign = i64::from(defending.attack_sign());
        let (x, y) = (sign * i64::from(ball.x), sign * i64::from(ball.y));
        self.step(y, self.rows) * self.columns + self.step(x, self.columns)
    }

    /// Number of the row or column, of `count`, at this coordinate.
    fn step(&self, at: i64, count: usize) -> usize {
        let edge = i64::from(self.edge_mm);
        let from_corner = 2 * at + count as i64 * edge;
        from_corner.div_euclid(2 * edge).clamp(0, count as i64 - 1) as usize
    }

    /// The middle of a cell, mm, attack frame.
    pub fn middle(&self, cell: usize) -> PointMm {
        let at = |index: usize, count: usize| (2 * index as i32 + 1 - count as i32) * self.edge_mm / 2;
        PointMm::new(at(cell % self.columns, self.columns), at(cell / self.columns, self.rows))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::coverage::TEST_FIELD as FIELD;

    #[test]
    fn the_middle_of_a_cell_lies_in_it_for_both_teams() {
        for edge in [300, 500, 777] {
            let cells = Cells::new(FIELD, edge).unwrap();
            for cell in 0..cells.len() {
                let PointMm { x, y } = cells.middle(cell);
                assert_eq!(cells.cell(PointMm::new(x, y), GoalEnd::Negative), cell);
                assert_eq!(cells.cell(PointMm::new(-x, -y), GoalEnd::Positive), cell);
            }
        }
    }

    #[test]
    fn the_paper_s_field_has_18_by_12_cells_and_balls_outside_go_to_the_border() {
        let cells = Cells::new(FIELD, Cells::suitable_edge_mm(FIELD)).unwrap();
        assert_eq!((cells.columns, cells.rows, cells.edge_mm), (18, 12, 300));
        assert_eq!(cells.cell(PointMm::new(-2700, -1800), GoalEnd::Negative), 0);
        assert_eq!(cells.cell(PointMm::new(i32::MAX, i32::MAX), GoalEnd::Negative), 18 * 12 - 1);
        assert_eq!(cells.cell(PointMm::new(i32::MIN, i32::MIN), GoalEnd::Positive), 18 * 12 - 1);
    }

    #[test]
    fn cells_without_size_or_without_number_are_refused() {
        assert_eq!(Cells::new(FIELD, 0), Err(CellsError::NoSize));
        assert_eq!(Cells::new(FIELD, -300), Err(CellsError::NoSize));
        assert_eq!(Cells::new(FIELD, 1), Err(CellsError::TooMany { cells: 5400 * 3600 }));
    }
}
