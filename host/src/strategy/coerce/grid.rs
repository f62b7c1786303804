//! `grid`: positions that the planner considers. The middles of a grid of 6 × 4 cells over the whole field
//! (Biswas et al. 2014 §4.2). Attack frame, m.

use geometry::{Attack, Point, Vector};
use rules::FieldSpec;

/// Columns along the length, rows across (§4.2).
pub const COLUMNS: usize = 6;
/// Rows across the field (§4.2).
pub const ROWS: usize = 4;
/// Number of cells on the field.
pub const CELLS: usize = COLUMNS * ROWS;

/// A cell, from our right corner along the length, row by row.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Cell(u8);

impl Cell {
    /// All cells in order.
    pub fn all() -> impl Iterator<Item = Self> {
        (0..CELLS as u8).map(Self)
    }

    /// Number of the cell, 0 to 23.
    pub fn index(self) -> usize {
        usize::from(self.0)
    }

    /// Column and row of the cell, from 0.
    pub fn column_and_row(self) -> (usize, usize) {
        (self.index() % COLUMNS, self.index() / COLUMNS)
    }

    /// The middle of the cell.
    pub fn middle(self, field: &FieldSpec) -> Point<Attack> {
        let (column, row) = self.column_and_row();
        let at = |k: usize, n: usize, side: f32| ((k as f32 + 0.5) / n as f32 - 0.5) * side;
        Point::new(at(column, COLUMNS, field.length), at(row, ROWS, field.width))
    }

    /// Size of a cell, along and across, m.
    pub fn size(field: &FieldSpec) -> Vector<Attack> {
        Vector::new(field.length / COLUMNS as f32, field.width / ROWS as f32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rules::League;

    #[test]
    fn on_6_by_4_metres_cells_are_metres_and_their_middles_half_metres() {
        let field = League::Ssl2013.field();
        assert_eq!(Cell::size(&field), Vector::new(1.0, 1.0));
        let middles: Vec<_> = Cell::all().map(|cell| cell.middle(&field)).collect();
        assert_eq!(middles.len(), 24);
        assert!(middles[0].distance(Point::new(-2.5, -1.5)) < 1e-6);
        assert!(middles[5].distance(Point::new(2.5, -1.5)) < 1e-6);
        assert!(middles[23].distance(Point::new(2.5, 1.5)) < 1e-6);
    }
}
