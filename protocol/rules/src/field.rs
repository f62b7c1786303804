//! Where are lines, goals and penalty areas? All lengths in metres, points in the field frame.

use geometry::{Field, GoalEnd, Point};

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

impl FieldSpec {
    /// Middle of the goal mouth at that end.
    pub fn goal_center(&self, goal: GoalEnd) -> Point<Field> {
        Point::new(goal.sign() as f32 * self.length * 0.5, 0.0)
    }

    /// On the field or on its lines.
    pub fn contains(&self, p: Point<Field>) -> bool {
        p.x().abs() <= self.length * 0.5 && p.y().abs() <= self.width * 0.5
    }

    /// In the penalty area at that end, lines included.
    pub fn in_penalty_area(&self, goal: GoalEnd, p: Point<Field>) -> bool {
        let depth = self.length * 0.5 - p.x() * goal.sign() as f32;
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
        assert!(field.in_penalty_area(GoalEnd::Positive, Point::new(2.1, 0.6)));
        assert!(!field.in_penalty_area(GoalEnd::Positive, Point::new(2.0, 0.0)));
        assert!(!field.in_penalty_area(GoalEnd::Positive, Point::new(2.1, 0.7)));
        assert!(field.in_penalty_area(GoalEnd::Negative, Point::new(-2.7, 0.0)));
        assert!(!field.in_penalty_area(GoalEnd::Positive, Point::new(2.71, 0.0)));
    }

    #[test]
    fn the_line_belongs_to_the_field() {
        let field = League::FourLegged.field();
        assert!(field.contains(Point::new(2.7, -1.8)));
        assert!(!field.contains(Point::new(2.701, 0.0)));
        assert_eq!(field.clamp(Point::new(9.0, -9.0), 0.1), Point::new(2.6000001, -1.6999999));
    }
}
