//! Which cases does each cell of the index list? (DESIGN §4.3: an index over the ball's position)
//!
//! See `casebase::Grid`: one copy of each authored case, the one that defends the negative goal; a cell lists it
//! where the ball scope reaches into the cell. The cells are as small as the table's budget of bytes allows.

use casebase::settings::SCOPE_EXPONENT;
use casebase::{FieldMm, GoalEnd, Grid, PointMm, Symmetry};

use crate::authored::Authored;

/// A built index.
pub(crate) struct Index {
    pub(crate) grid: Grid,
    /// Where the list of each cell begins in `cases`, and where the last ends.
    pub(crate) starts: Vec<u32>,
    /// Ids of stored cases.
    pub(crate) cases: Vec<u16>,
}

/// The index of cases in the order of their ids, over the finest grid within the budget.
pub(crate) fn build(field: FieldMm, cases: &[Authored]) -> Index {
    let budget = BYTES_PER_STORED_CASE * 4 * cases.len();
    let mut index = None;
    for cell_mm in CELLS_MM {
        let columns = (field.length / cell_mm + 1).min(i32::from(CELLS_MAX)) as u16;
        let rows = (field.width / cell_mm + 1).min(i32::from(CELLS_MAX)) as u16;
        let built = over(Grid::over(field, columns, rows, cell_mm), cases);
        let bytes = 4 * built.starts.len() + 2 * built.cases.len();
        index = Some(built);
        if bytes <= budget {
            break;
        }
    }
    // The coarsest grid of all, should even that be over the budget.
    index.unwrap_or_else(|| over(Grid::over(field, 1, 1, field.length), cases))
}

fn over(grid: Grid, cases: &[Authored]) -> Index {
    let mut lists = vec![Vec::new(); usize::from(grid.columns) * usize::from(grid.rows)];
    for (authored, case) in cases.iter().enumerate() {
        let symmetry = match case.defending {
            GoalEnd::Negative => Symmetry::Identity,
            GoalEnd::Positive => Symmetry::AcrossY,
        };
        let ball = symmetry.point(case.ball);
        let id = 4 * authored as u16 + symmetry.bits();
        for row in 0..grid.rows {
            for column in 0..grid.columns {
                if reaches(case, ball, &grid, column, row) {
                    lists[usize::from(row) * usize::from(grid.columns) + usize::from(column)].push(id);
                }
            }
        }
    }
    let promise = |id: &u16| {
        let case = &cases[usize::from(*id / 4)];
        (std::cmp::Reverse((case.opponents.len(), case.teammates.len())), *id)
    };
    let mut starts = vec![0];
    let mut listed = Vec::new();
    for mut list in lists {
        list.sort_by_key(promise);
        listed.extend(list);
        starts.push(listed.len() as u32);
    }
    Index { grid, starts, cases: listed }
}

/// Does the ball scope reach into the cell? Cells at the border go on to infinity.
fn reaches(case: &Authored, ball: PointMm, grid: &Grid, column: u16, row: u16) -> bool {
    let gap = |at: i32, corner: i32, cell: u16, count: u16| {
        let at = f64::from(at);
        let low = f64::from(corner) + f64::from(cell) * f64::from(grid.cell_mm);
        let high = low + f64::from(grid.cell_mm);
        let below = if cell == 0 { 0.0 } else { (low - at).max(0.0) };
        let above = if cell + 1 == count { 0.0 } else { (at - high).max(0.0) };
        below.max(above)
    };
    let dx = gap(ball.x, grid.corner.x, column, grid.columns) / f64::from(case.ball_scope.x);
    let dy = gap(ball.y, grid.corner.y, row, grid.rows) / f64::from(case.ball_scope.y);
    dx * dx + dy * dy <= f64::from(SCOPE_EXPONENT) * ROUNDING
}

/// What the index may cost, bytes: an eighth of the 96 a stored case may have in all (DESIGN §9).
const BYTES_PER_STORED_CASE: usize = 12;
/// Edges of cells that are tried, finest first, mm. Finer than 150 mm lists hardly get shorter: scopes are larger.
const CELLS_MM: [i32; 9] = [150, 200, 250, 300, 400, 600, 900, 1500, 3000];
/// Most cells along an axis.
const CELLS_MAX: u16 = casebase::table::GRID_MAX;
/// Room for the rounding of the single-precision gate.
const ROUNDING: f64 = 1.0001;
