//! `shape`: discs, boxes along the axes and capsules, used as keep-out regions. Metres.

use crate::{Point, Segment, Vector, math};

/// A closed region of the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape<F> {
    /// All points within `radius` of `center`.
    Disc {
        /// Centre of the disc.
        center: Point<F>,
        /// Radius, m, ≥ 0.
        radius: f32,
    },
    /// All points between two corners, sides along the axes.
    Box {
        /// The corner with the least x and y.
        low: Point<F>,
        /// The corner with the largest x and y.
        high: Point<F>,
    },
    /// All points within `radius` of a segment (the rules' "stadium").
    Capsule {
        /// Centre line of the capsule, m.
        spine: Segment<F>,
        /// Radius, m, ≥ 0.
        radius: f32,
    },
}

impl<F: Copy> Shape<F> {
    /// Distance from `point` to the region's border, m: negative inside.
    pub fn distance_to(&self, point: Point<F>) -> f32 {
        match *self {
            Self::Disc { center, radius } => center.distance(point) - radius,
            Self::Capsule { spine, radius } => spine.distance_to(point) - radius,
            Self::Box { low, high } => {
                let (x, y) = (beyond(point.x(), low.x(), high.x()), beyond(point.y(), low.y(), high.y()));
                if x > 0.0 && y > 0.0 { Vector::<F>::new(x, y).norm() } else { math::max(x, y) }
            }
        }
    }

    /// Returns whether `point` is in the region or on its border.
    pub fn contains(&self, point: Point<F>) -> bool {
        self.distance_to(point) <= 0.0
    }

    /// The region and everything within `by` of it, m (corners of a box stay corners).
    pub fn grown(self, by: f32) -> Self {
        match self {
            Self::Disc { center, radius } => Self::Disc { center, radius: radius + by },
            Self::Capsule { spine, radius } => Self::Capsule { spine, radius: radius + by },
            Self::Box { low, high } => Self::Box {
                low: Point::new(low.x() - by, low.y() - by),
                high: Point::new(high.x() + by, high.y() + by),
            },
        }
    }
}

/// Distance of a coordinate beyond the nearer of two limits; negative between them.
#[inline]
fn beyond(at: f32, low: f32, high: f32) -> f32 {
    if low - at > at - high { low - at } else { at - high }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Field;

    #[test]
    fn distances_are_negative_inside_and_measured_to_corners_outside() {
        let area = Shape::<Field>::Box { low: Point::new(0.0, 0.0), high: Point::new(2.0, 1.0) };
        assert_eq!(area.distance_to(Point::new(1.0, 0.4)), -0.4);
        assert_eq!(area.distance_to(Point::new(1.0, -3.0)), 3.0);
        assert_eq!(area.distance_to(Point::new(5.0, 5.0)), 5.0);
        assert!(area.contains(Point::new(2.0, 1.0)) && area.grown(0.5).contains(Point::new(2.5, 0.0)));
        let spine = Segment::new(Point::new(0.0, 0.0), Point::new(2.0, 0.0));
        assert_eq!(Shape::<Field>::Capsule { spine, radius: 0.5 }.distance_to(Point::new(1.0, 2.0)), 1.5);
        let disc = Shape::<Field>::Disc { center: Point::new(1.0, 1.0), radius: 1.0 };
        assert_eq!(disc.distance_to(Point::new(1.0, 1.0)), -1.0);
    }
}
