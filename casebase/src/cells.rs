//! Is anybody near at all? A coarse picture of what lies around the ball, in one word.
//!
//! The plane around the ball is cut into squares, which repeat every 8 along x and every 4 along y, so that 32 bits
//! name them all. Where the squares an opponent scope reaches into and those that hold opponents have none in common,
//! the scope is empty; where they have, it must be looked at.

use crate::settings::SCOPE_EXPONENT;
use crate::{PointMm, Scope};

/// The square in which a point lies, as a bit.
#[inline]
pub(crate) fn cell_of(from_ball: PointMm) -> u32 {
    cell(from_ball.x >> EDGE_BITS, from_ball.y >> EDGE_BITS)
}

/// The squares into which a scope around `centre` reaches at the paper's threshold, as bits.
pub fn cells_of(centre: PointMm, scope: Scope) -> u32 {
    // Past the border of a scope by more than the rounding of single precision.
    let reach = |radius: i32| (f64::from(radius) * (f64::from(SCOPE_EXPONENT) * 1.001)) as i32 + 1;
    let squares =
        |at: i32, radius: i32| (at - reach(radius)) >> EDGE_BITS..=(at + reach(radius)) >> EDGE_BITS;
    let gap = |at: i32, square: i32, radius: i32| {
        let (low, high) = (square << EDGE_BITS, (square + 1) << EDGE_BITS);
        f64::from((low - at).max(at - high).max(0)) / f64::from(radius)
    };
    let mut cells = 0;
    for row in squares(centre.y, scope.y) {
        for column in squares(centre.x, scope.x) {
            let (dx, dy) = (gap(centre.x, column, scope.x), gap(centre.y, row, scope.y));
            if dx * dx + dy * dy <= f64::from(SCOPE_EXPONENT) * 1.001 {
                cells |= cell(column, row);
            }
        }
    }
    cells
}

#[inline]
fn cell(column: i32, row: i32) -> u32 {
    1 << ((column & 7) | (row & 3) << 3)
}

/// Squares of 2^10 mm: about the size of a scope, and four of them as wide as what opponents matter in.
const EDGE_BITS: u32 = 9;
