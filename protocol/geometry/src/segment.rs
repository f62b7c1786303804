//! `segment`: distance between a point and a segment, for obstacles, goal lines and ball legs.

use crate::{Point, Vector};

/// The straight stretch from `from` to `to`, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment<F> {
    /// Start of the stretch, m.
    pub from: Point<F>,
    /// End of the stretch, m.
    pub to: Point<F>,
}

impl<F: Copy> Segment<F> {
    /// Segment between its two ends.
    pub fn new(from: Point<F>, to: Point<F>) -> Self {
        Self { from, to }
    }

    /// Vector from `from` to `to`.
    pub fn vector(self) -> Vector<F> {
        self.to - self.from
    }

    /// Position of the foot of `point` along the segment, as a share: 0 at `from`, 1 at `to`, not clamped.
    pub fn share_of(self, point: Point<F>) -> f32 {
        let v = self.vector();
        let squared = v.dot(v);
        if squared > 0.0 { (point - self.from).dot(v) / squared } else { 0.0 }
    }

    /// The point of the segment nearest to `point`.
    pub fn closest_to(self, point: Point<F>) -> Point<F> {
        self.from + self.vector() * self.share_of(point).clamp(0.0, 1.0)
    }

    /// Distance of `point` from the segment, m.
    pub fn distance_to(self, point: Point<F>) -> f32 {
        self.closest_to(point).distance(point)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Field;

    #[test]
    fn the_nearest_point_is_the_foot_or_an_end() {
        let s = Segment::<Field>::new(Point::new(0.0, 0.0), Point::new(2.0, 0.0));
        assert_eq!(s.closest_to(Point::new(0.5, 3.0)), Point::new(0.5, 0.0));
        assert_eq!(s.distance_to(Point::new(5.0, 4.0)), 5.0);
        let dot = Segment::<Field>::new(Point::new(1.0, 1.0), Point::new(1.0, 1.0));
        assert_eq!(dot.distance_to(Point::new(1.0, 3.0)), 2.0);
    }
}
