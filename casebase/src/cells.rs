//! `cells`: squares and strips around the ball; those that a scope overlaps reject empty opponent scopes
//! cheaply.
//!
//! The plane around the ball is cut into squares, which repeat every 8 along x and every 4 along y, so that
//! 32 bits name them all. Where the squares that an opponent scope overlaps and those that contain opponents
//! have none in common, the scope is empty; otherwise it must be tested. Words of cases
//! ([`crate::table::Word`]) have strips across x and y in place of squares.

use core::ops::RangeInclusive;

use crate::settings::SCOPE_EXPONENT;
use crate::{PointMm, Scope};

/// The square in which a point lies, as a bit.
#[inline]
pub(crate) fn cell_of(from_ball: PointMm) -> u32 {
    cell(from_ball.x >> EDGE_BITS, from_ball.y >> EDGE_BITS)
}

/// The squares that a scope around `centre` overlaps at the paper's threshold, as bits.
pub fn cells_of(centre: PointMm, scope: Scope) -> u32 {
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

/// The strip across one axis in which a coordinate relative to the ball lies, mm: its number, 0–31. The
/// first and the last reach to infinity.
#[inline]
pub(crate) fn strip_of(at: i32) -> usize {
    ((at >> STRIP_BITS) + STRIPS / 2).clamp(0, STRIPS - 1) as usize
}

/// The strips across one axis that a scope of `radius` around `at` overlaps at the paper's threshold, as
/// bits.
pub fn strips_of(at: i32, radius: i32) -> u32 {
    let reach = reach(radius);
    (strip_of(at - reach)..=strip_of(at + reach)).fold(0, |strips, strip| strips | 1 << strip)
}

/// Squares along one axis that may overlap a scope of `radius` around `at`.
fn squares(at: i32, radius: i32) -> RangeInclusive<i32> {
    let reach = reach(radius);
    (at - reach) >> EDGE_BITS..=(at + reach) >> EDGE_BITS
}

/// Half the width of a scope, mm: beyond its border by more than the rounding error of single precision.
fn reach(radius: i32) -> i32 {
    (f64::from(radius) * (f64::from(SCOPE_EXPONENT) * 1.001)) as i32 + 1
}

/// Distance along one axis from `at` to a square, in radii; 0 inside.
fn gap(at: i32, square: i32, radius: i32) -> f64 {
    let (low, high) = (square << EDGE_BITS, (square + 1) << EDGE_BITS);
    f64::from((low - at).max(at - high).max(0)) / f64::from(radius)
}

#[inline]
fn cell(column: i32, row: i32) -> u32 {
    1 << ((column & 7) | (row & 3) << 3)
}

/// Squares of 2^9 = 512 mm, about the radius of a scope: they reject more scopes than squares of 1024 mm.
const EDGE_BITS: u32 = 9;
/// Strips of 2^7 = 128 mm.
const STRIP_BITS: u32 = 7;
/// Number of strips across an axis: 2 m to both sides of the ball.
const STRIPS: i32 = 32;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::Stream;

    #[test]
    fn a_point_in_a_scope_lies_in_one_of_its_squares_and_in_its_strips() {
        let mut stream = Stream::new(9);
        let mut below = |end: i32| stream.below(end as u64) as i32;
        let (mut inside, mut apart) = (0, 0);
        for _ in 0..20_000 {
            let centre = PointMm::new(below(9000) - 4500, below(6000) - 3000);
            let scope = Scope { x: 1 + below(1000), y: 1 + below(1000) };
            let point = PointMm::new(centre.x + below(2400) - 1200, centre.y + below(2400) - 1200);
            let shares = cells_of(centre, scope) & cell_of(point) != 0;
            let in_strips = strips_of(centre.x, scope.x) >> strip_of(point.x)
                & strips_of(centre.y, scope.y) >> strip_of(point.y)
                & 1
                != 0;
            if scope.exponent(point.minus(centre)) < SCOPE_EXPONENT {
                inside += 1;
                assert!(shares && in_strips, "{point:?} in {scope:?} around {centre:?}");
            }
            apart += u32::from(!shares && !in_strips);
        }
        assert!(inside > 2_000 && apart > 5_000, "{inside} inside, {apart} apart");
    }

    #[test]
    fn the_border_of_a_scope_at_the_edge_of_a_square_is_in_the_next_one() {
        // exp(−1) = 0.36788 > 0.367: 1.001196 τ is still inside.
        let reached = cells_of(PointMm::new(12, 100), Scope { x: 500, y: 50 });
        assert_eq!(
            reached,
            cell_of(PointMm::new(0, 0)) | cell_of(PointMm::new(-1, 0)) | cell_of(PointMm::new(512, 0))
        );
    }
}
