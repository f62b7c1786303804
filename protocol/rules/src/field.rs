//! Where are lines, goals and penalty areas? All lengths in metres, points in the field frame.

use geometry::{Field, Point};

/// The lines of a field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FieldSpec {
    /// From goal line to goal line.
    pub length: f32,
    /// From side line to side line.
    pub width: f32,
    /// Carpet beyond the lines, on every side.
    pub margin: f32,
    /// Between the goalposts.
    pub goal_width: f32,
    /// From the goal line to the goal's back.
    pub goal_depth: f32,
    /// Penalty (defence) area: from the goal line into the field.
    pub penalty_depth: f32,
    /// Penalty (defence) area: along the goal line.
    pub penalty_width: f32,
    /// Radius of the centre circle.
    pub center_radius: f32,
}

/// One of the two ends of the field, named by the sign of x.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GoalSide {
    /// At −x.
    Negative,
    /// At +x.
    Positive,
}

impl GoalSide {
    /// −1 or +1.
    pub fn sign(self) -> f32 {
        match self {
            Self::Negative => -1.0,
            Self::Positive => 1.0,
        }
    }

    /// The other end.
    pub fn opposite(self) -> Self {
        match self {
            Self::Negative => Self::Positive,
            Self::Positive => Self::Negative,
        }
    }
}

impl FieldSpec {
    /// Middle of the goal mouth at that end.
    pub fn goal_center(&self, side: GoalSide) -> Point<Field> {
        Point::new(side.sign() * self.length * 0.5, 0.0)
    }

    /// On the field or on its lines.
    pub fn contains(&self, p: Point<Field>) -> bool {
        p.x().abs() <= self.length * 0.5 && p.y().abs() <= self.width * 0.5
    }

    /// In the penalty area at that end, lines included.
    pub fn in_penalty_area(&self, side: GoalSide, p: Point<Field>) -> bool {
        let depth = self.length * 0.5 - p.x() * side.sign();
        (0.0..=self.penalty_depth).contains(&depth) && p.y().abs() <= self.penalty_width * 0.5
    }

    /// The nearest point at least `inside` within the lines (or beyond them by −`inside`).
    pub fn clamp(&self, p: Point<Field>, inside: f32) -> Point<Field> {
        let (x, y) = (self.length * 0.5 - inside, self.width * 0.5 - inside);
        Point::new(p.x().clamp(-x, x), p.y().clamp(-y, y))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::League;

    #[test]
    fn the_penalty_area_is_at_its_own_end() {
        let field = League::FourLegged.field();
        assert!(field.in_penalty_area(GoalSide::Positive, Point::new(2.1, 0.6)));
        assert!(!field.in_penalty_area(GoalSide::Positive, Point::new(2.0, 0.0)));
        assert!(!field.in_penalty_area(GoalSide::Positive, Point::new(2.1, 0.7)));
        assert!(field.in_penalty_area(GoalSide::Negative, Point::new(-2.7, 0.0)));
        assert!(!field.in_penalty_area(GoalSide::Positive, Point::new(2.71, 0.0)));
    }

    #[test]
    fn the_line_belongs_to_the_field() {
        let field = League::FourLegged.field();
        assert!(field.contains(Point::new(2.7, -1.8)));
        assert!(!field.contains(Point::new(2.701, 0.0)));
        assert_eq!(field.clamp(Point::new(9.0, -9.0), 0.1), Point::new(2.6000001, -1.6999999));
    }
}
