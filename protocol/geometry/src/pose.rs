//! `pose`: pose, velocity, and transformations between field and body.

use serde::{Deserialize, Serialize};

use crate::{Angle, Body, Field, Point, Vector};

/// Place and heading of a robot in frame `F`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct Pose<F> {
    /// The robot's centre, m.
    pub position: Point<F>,
    /// Direction that its front faces.
    pub heading: Angle,
}

/// Velocity and turning rate in frame `F`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct Twist<F> {
    /// Linear velocity of the centre, m/s.
    pub linear: Vector<F>,
    /// Turning rate, rad/s, counter-clockwise.
    pub angular: f32,
}

impl<F> Default for Pose<F> {
    fn default() -> Self {
        Self { position: Point::default(), heading: Angle::ZERO }
    }
}

impl<F> Default for Twist<F> {
    fn default() -> Self {
        Self { linear: Vector::default(), angular: 0.0 }
    }
}

impl Pose<Field> {
    /// Pose from millimetres and degrees, the units of case files.
    pub fn from_mm_deg(x: f32, y: f32, heading: f32) -> Self {
        Self { position: Point::new(x * 0.001, y * 0.001), heading: Angle::degrees(heading) }
    }

    /// A point of the field in this robot's frame.
    pub fn to_body(self, point: Point<Field>) -> Point<Body> {
        let v = self.vector_to_body(point - self.position);
        Point::new(v.x(), v.y())
    }

    /// A point of the body, in the field frame.
    pub fn to_field(self, point: Point<Body>) -> Point<Field> {
        self.position + self.vector_to_field(Vector::new(point.x(), point.y()))
    }

    /// A displacement or velocity of the field in this robot's frame.
    pub fn vector_to_body(self, v: Vector<Field>) -> Vector<Body> {
        v.rotated(-self.heading).reframed()
    }

    /// A displacement or velocity of the body, in the field frame.
    pub fn vector_to_field(self, v: Vector<Body>) -> Vector<Field> {
        v.reframed::<Field>().rotated(self.heading)
    }

    /// The turn that would make the robot face `point`.
    pub fn turn_to(self, point: Point<Field>) -> Angle {
        self.position.direction_to(point) - self.heading
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn body_and_field_are_inverse() {
        let pose = Pose::from_mm_deg(1000.0, -500.0, 90.0);
        let ahead = pose.to_field(Point::new(0.2, 0.0));
        assert!(ahead.distance(Point::new(1.0, -0.3)) < 1e-6);
        assert!(pose.to_body(ahead).distance(Point::new(0.2, 0.0)) < 1e-6);
    }

    #[test]
    fn a_point_to_the_left_needs_a_left_turn() {
        let pose = Pose::from_mm_deg(0.0, 0.0, 0.0);
        assert!((pose.turn_to(Point::new(0.0, 1.0)).to_degrees() - 90.0).abs() < 1e-3);
    }
}
