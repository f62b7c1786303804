//! `point`: points on the field, and depth inside an elliptic scope (Ros et al. 2009, §2.1, §2.3).
//!
//! Whole millimetres in the field frame, as the paper has them. Differences saturate, so that no input
//! overflows.

use geometry::{Field, Point};
use protocol::quantized::{self, WirePoint};
use serde::{Deserialize, Serialize};

/// A position on the field, mm, field frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Default, Serialize, Deserialize)]
#[serde(from = "(i32, i32)", into = "(i32, i32)")]
pub struct PointMm {
    /// Coordinate along +x, mm, field frame.
    pub x: i32,
    /// Coordinate along +y, mm, field frame.
    pub y: i32,
}

impl PointMm {
    /// From its two coordinates.
    pub const fn new(x: i32, y: i32) -> Self {
        Self { x, y }
    }

    /// The displacement from `other` to here.
    pub const fn minus(self, other: Self) -> Self {
        Self { x: self.x.saturating_sub(other.x), y: self.y.saturating_sub(other.y) }
    }

    /// The point moved by `shift`, mm; saturates.
    pub const fn plus(self, shift: Self) -> Self {
        Self { x: self.x.saturating_add(shift.x), y: self.y.saturating_add(shift.y) }
    }

    /// Both coordinates as `f32`.
    #[inline]
    pub const fn to_f32(self) -> [f32; 2] {
        [self.x as f32, self.y as f32]
    }
}

impl From<(i32, i32)> for PointMm {
    fn from((x, y): (i32, i32)) -> Self {
        Self { x, y }
    }
}
impl From<PointMm> for (i32, i32) {
    fn from(point: PointMm) -> Self {
        (point.x, point.y)
    }
}
impl From<Point<Field>> for PointMm {
    /// Rounds to the nearest millimetre.
    fn from(point: Point<Field>) -> Self {
        Self { x: quantized::whole_mm(point.x()), y: quantized::whole_mm(point.y()) }
    }
}
impl From<PointMm> for Point<Field> {
    fn from(point: PointMm) -> Self {
        Self::new(quantized::from_mm(point.x), quantized::from_mm(point.y))
    }
}
impl From<WirePoint> for PointMm {
    fn from(point: WirePoint) -> Self {
        Self { x: i32::from(point.x), y: i32::from(point.y) }
    }
}
impl From<PointMm> for WirePoint {
    /// A position farther than 32 m away saturates.
    fn from(point: PointMm) -> Self {
        Self { x: quantized::saturate(point.x), y: quantized::saturate(point.y) }
    }
}

/// The radii τx, τy of a scope: an axis-parallel ellipse around the ball or an opponent, mm, both above 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Scope {
    /// τx: radius along x, mm.
    pub x: i32,
    /// τy: radius along y, mm.
    pub y: i32,
}

impl Scope {
    /// (Δx/τx)² + (Δy/τy)² of a displacement from the centre: the negated exponent of the paper's Gaussian.
    #[inline]
    pub fn exponent(self, from_centre: PointMm) -> f32 {
        let [dx, dy] = from_centre.to_f32();
        gauss_exponent(dx, dy, 1.0 / self.x as f32, 1.0 / self.y as f32)
    }
}

/// The same from displacements (mm) and the inverses of the radii (1/mm), as the table stores them.
#[inline]
pub(crate) fn gauss_exponent(dx: f32, dy: f32, inverse_x: f32, inverse_y: f32) -> f32 {
    let (a, b) = (dx * inverse_x, dy * inverse_y);
    a * a + b * b
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn on_the_ellipse_the_exponent_is_one() {
        let scope = Scope { x: 450, y: 250 };
        assert!((scope.exponent(PointMm::new(450, 0)) - 1.0).abs() < 1e-6);
        assert!((scope.exponent(PointMm::new(0, -250)) - 1.0).abs() < 1e-6);
    }

    #[test]
    fn differences_of_extreme_points_saturate() {
        let (low, high) = (PointMm::new(i32::MIN, i32::MIN), PointMm::new(i32::MAX, i32::MAX));
        assert_eq!(high.minus(low), high);
        assert_eq!(low.plus(low), low);
    }
}
