//! `grid`: cell lists of the index (docs/case-format.md §3: an index over the ball's position).
//!
//! See `casebase::Grid`: the two copies of each authored case that defend the negative goal; a cell lists
//! them where the ball scope overlaps it. The cells are as small as the table's budget of bytes permits.

use std::collections::BTreeMap;

use casebase::settings::SCOPE_EXPONENT;
use casebase::{FieldMm, GoalEnd, Grid, OPPONENTS_MAX, PointMm, Symmetry};

use crate::authored::Authored;
use crate::words::Words;

/// Index of the cases by the ball's position.
pub(crate) struct Index {
    pub(crate) grid: Grid,
    /// Start of the list of each cell in `cases`, and the end of the last.
    pub(crate) starts: Vec<u32>,
    /// Ids of stored cases; numbers of words, where there are words.
    pub(crate) cases: Vec<u16>,
    /// The words of a large library, and the cases of each word in a list.
    pub(crate) words: Words,
    pub(crate) masks: Vec<u32>,
}

impl Index {
    fn bytes(&self) -> usize {
        4 * self.starts.len() + 2 * self.cases.len() + 4 * self.masks.len() + self.words.bytes()
    }
}

/// The index of cases in the order of their ids, over the finest grid within the budget of a table whose
/// other parts take `others` bytes.
pub(crate) fn build(field: FieldMm, cases: &[Authored], others: usize) -> Index {
    let stored = 4 * cases.len();
    let index_bytes = if stored < WORDS_FROM { INDEX_BYTES } else { INDEX_BYTES_OF_WORDS };
    let budget = (TABLE_BYTES * stored).saturating_sub(others).max(index_bytes * stored);
    let mut index = None;
    for cell_mm in CELLS_MM {
        let columns = (field.length / cell_mm + 1).min(i32::from(CELLS_MAX)) as u16;
        let rows = (field.width / 2 / cell_mm + 1).min(i32::from(CELLS_MAX)) as u16;
        let built = over(Grid::over(field, columns, rows, cell_mm), cases);
        let fits = built.bytes() <= budget;
        index = Some(built);
        if fits {
            break;
        }
    }
    // The coarsest grid, should even that be over the budget.
    index.unwrap_or_else(|| over(Grid::over(field, 1, 1, field.length), cases))
}

fn over(grid: Grid, cases: &[Authored]) -> Index {
    let mut lists = vec![Vec::new(); usize::from(grid.columns) * usize::from(grid.rows)];
    for (authored, case) in cases.iter().enumerate() {
        let symmetries = match case.defending {
            GoalEnd::Negative => [Symmetry::Identity, Symmetry::AcrossX],
            GoalEnd::Positive => [Symmetry::AcrossY, Symmetry::Both],
        };
        for symmetry in symmetries {
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
    }
    if 4 * cases.len() >= WORDS_FROM {
        return in_words(grid, &lists, cases);
    }
    let mut starts = vec![0];
    let mut listed = Vec::new();
    for mut list in lists {
        // Cases that can fulfil most conditions come first.
        list.sort_by_key(|id| {
            let case = &cases[usize::from(*id / 4)];
            (std::cmp::Reverse((case.opponents.len(), case.teammates.len())), *id)
        });
        listed.extend(list);
        starts.push(listed.len() as u32);
    }
    Index { grid, starts, cases: listed, words: Words::default(), masks: Vec::new() }
}

/// The index of the same lists with cases in words.
fn in_words(grid: Grid, lists: &[Vec<u16>], cases: &[Authored]) -> Index {
    let words = Words::of(lists.concat(), cases);
    let (mut starts, mut listed, mut masks) = (vec![0], Vec::new(), Vec::new());
    for list in lists {
        let mut masks_of = BTreeMap::new();
        for id in list {
            let (word, bit) = words.place_of(*id);
            *masks_of.entry(word).or_insert(0) |= 1 << bit;
        }
        for opponents in (0..=OPPONENTS_MAX).rev() {
            let of = masks_of.iter().filter(|(word, _)| words.opponents_of(**word) == opponents);
            let (words, cases): (Vec<u16>, Vec<u32>) = of.unzip();
            listed.extend(words);
            masks.extend(cases);
            starts.push(listed.len() as u32);
        }
    }
    Index { grid, starts, cases: listed, words, masks }
}

/// Returns whether the ball scope overlaps the cell. Cells at the border extend to infinity, but not over the
/// middle line.
fn reaches(case: &Authored, ball: PointMm, grid: &Grid, column: u16, row: u16) -> bool {
    let edge = |corner: f32, cells: u16| f64::from(corner) + f64::from(cells) * f64::from(grid.cell_mm);
    let gap = |at: i32, low: f64, high: f64| (low - f64::from(at)).max(f64::from(at) - high).max(0.0);
    let [corner_x, corner_y] = grid.corner;
    let left = if column == 0 { f64::NEG_INFINITY } else { edge(corner_x, column) };
    let right = if column + 1 == grid.columns { f64::INFINITY } else { edge(corner_x, column + 1) };
    let top = if row + 1 == grid.rows { f64::INFINITY } else { edge(corner_y, row + 1) };
    let dx = gap(ball.x, left, right) / f64::from(case.ball_scope.x);
    let dy = gap(ball.y, edge(corner_y, row), top) / f64::from(case.ball_scope.y);
    dx * dx + dy * dy <= f64::from(SCOPE_EXPONENT) * ROUNDING_FACTOR
}

/// Number of stored cases from which on they are put in words. Instructions of a retrieval on played
/// problems (callgrind): 4,590 in words and 3,740 in lists with 1,000 cases, 7,970 and 14,920 with 10,000;
/// straight lines between them meet here.
const WORDS_FROM: usize = 2_000;
/// Budget of a stored case, bytes (docs/architecture.md §9): the index may use what the other records leave
/// of it.
const TABLE_BYTES: usize = 96;
/// Minimum budget of the index, bytes a stored case, where the other records leave less.
const INDEX_BYTES: usize = 12;
/// The same with words, of which bitmaps take the half.
const INDEX_BYTES_OF_WORDS: usize = 14;
/// Edges of cells that are tried, finest first, mm. Below 150 mm lists hardly get shorter: scopes are larger.
const CELLS_MM: [i32; 10] = [150, 200, 250, 300, 350, 400, 600, 900, 1500, 3000];
/// Maximum number of cells along an axis.
const CELLS_MAX: u16 = casebase::table::GRID_MAX;
/// Tolerance for rounding errors of the single-precision record header.
const ROUNDING_FACTOR: f64 = 1.0001;
