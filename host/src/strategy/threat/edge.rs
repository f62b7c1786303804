//! `edge`: places along the edge of our defence area (Biswas et al. 2014 §5: primary defenders "always move
//! along the edge of the defense area"). Attack frame, m.
//!
//! The edge is the line that bodies' centres may stand on: the area's border, moved outwards. For the box of
//! today that is a box with round corners, for the quarter circles of 2013 two larger quarter circles: the
//! same shape with other dimensions.

use geometry::{Attack, Point, Vector, math};
use rules::{AreaForm, FieldSpec};

/// A distance beyond any field, m.
const BEYOND_FIELD_M: f32 = 32.0;
/// 32 m halved this often: down to 1 µm.
const HALVINGS: u32 = 25;

/// The edge of our area, from our goal line at −y around to our goal line at +y.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Edge {
    /// Middle of our goal.
    goal: Point<Attack>,
    /// From the goal line to the centres of the round corners.
    ahead: f32,
    /// From the axis to the centres of the round corners.
    beside: f32,
    /// Radius of the corners, m.
    radius: f32,
}

impl Edge {
    /// The border of our area on this field, moved out by `by` m.
    pub fn of(field: &FieldSpec, by: f32) -> Self {
        let (depth, half) = (field.penalty_depth, field.penalty_width * 0.5);
        let (ahead, beside, radius) = match field.penalty_form {
            AreaForm::Box => (depth, half, by),
            AreaForm::QuarterCircles => (0.0, half - depth, depth + by),
        };
        Self { goal: Point::new(-field.length * 0.5, 0.0), ahead, beside, radius }
    }

    /// Length of the whole edge, from goal line to goal line, m.
    pub fn length(&self) -> f32 {
        2.0 * (self.ahead + self.beside + self.arc())
    }

    /// Length of one corner, m.
    fn arc(&self) -> f32 {
        math::FRAC_PI_2 * self.radius
    }

    /// Distance of a place outside the edge, m; negative within. A place behind the goal line counts as
    /// within.
    pub fn distance_to(&self, place: Point<Attack>) -> f32 {
        let (x, y) = self.corner(place);
        if x > 0.0 && y > 0.0 { math::hypot(x, y) - self.radius } else { x.max(y) - self.radius }
    }

    /// The point at distance `along` on the edge, m.
    pub fn point(&self, along: f32) -> Point<Attack> {
        let along = along.clamp(0.0, self.length());
        let middle = 0.5 * self.length();
        // From the middle of the front, the same to either side.
        let (side, from_middle) = if along < middle { (-1.0, middle - along) } else { (1.0, along - middle) };
        let (out, y) = if from_middle <= self.beside {
            (self.ahead + self.radius, from_middle)
        } else if from_middle <= self.beside + self.arc() {
            let (s, c) = math::sin_cos((from_middle - self.beside) / self.radius);
            (self.ahead + self.radius * c, self.beside + self.radius * s)
        } else {
            (self.ahead - (from_middle - self.beside - self.arc()), self.beside + self.radius)
        };
        Point::new(self.goal.x() + out, side * y)
    }

    /// Distance along the edge of its point nearest to a place, m.
    pub fn along(&self, place: Point<Attack>) -> f32 {
        let (x, y) = self.corner(place);
        let from_middle = if x > 0.0 && y > 0.0 {
            self.beside + self.radius * math::atan2(y, x)
        } else if x >= y {
            (self.beside + y).max(0.0)
        } else {
            self.beside + self.arc() + (-x).min(self.ahead)
        };
        let side = if place.y() < 0.0 { -1.0 } else { 1.0 };
        0.5 * self.length() + side * from_middle
    }

    /// Point of the edge nearest to a place.
    pub fn nearest(&self, place: Point<Attack>) -> Point<Attack> {
        self.point(self.along(place))
    }

    /// Crossing of the edge and the ray from a point of our goal line in this direction.
    pub fn crossing(&self, from: Point<Attack>, direction: Vector<Attack>) -> Point<Attack> {
        let along = direction.unit().unwrap_or(Vector::new(1.0, 0.0));
        // Within at the goal line, outside at BEYOND_FIELD_M, and the region is convex.
        let (mut inside, mut outside) = (0.0, BEYOND_FIELD_M);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (inside + outside);
            if self.distance_to(from + along * middle) < 0.0 { inside = middle } else { outside = middle }
        }
        from + along * outside
    }

    /// A place from the centre of the corner on its side: (ahead of it, beside it).
    fn corner(&self, place: Point<Attack>) -> (f32, f32) {
        (place.x() - self.goal.x() - self.ahead, place.y().abs() - self.beside)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::{Field, GoalEnd};
    use rules::League;

    const LEAGUES: [League; 3] = [League::Ssl2013, League::DivisionB, League::DivisionA];

    #[test]
    fn every_point_of_the_edge_is_that_far_from_the_rules_area() {
        for league in LEAGUES {
            let field = league.field();
            let edge = Edge::of(&field, 0.13);
            for i in 0..=300_u16 {
                let point = edge.point(edge.length() * f32::from(i) / 300.0);
                let place = Point::<Field>::new(point.x(), point.y());
                // At the goal line itself the rules' area continues behind it, and boxes' corners are
                // measured as corners.
                let off = field.distance_to_area(GoalEnd::Negative, place);
                assert!((off - 0.13).abs() < 1e-4, "{league:?} {i}: {point:?} is {off} off");
                assert!(edge.distance_to(point).abs() < 1e-4);
            }
        }
    }

    #[test]
    fn division_bs_edge_is_as_long_as_its_sides_and_two_quarter_circles() {
        // 2 × 1 m beside, 2 m ahead, π × 0.13 m around the corners.
        let edge = Edge::of(&League::DivisionB.field(), 0.13);
        assert!((edge.length() - (4.0 + 0.13 * math::PI)).abs() < 1e-5);
        assert!(edge.point(0.0).distance(Point::new(-4.5, -1.13)) < 1e-5);
        assert!(edge.point(0.5 * edge.length()).distance(Point::new(-3.37, 0.0)) < 1e-5);
        assert!(edge.point(edge.length()).distance(Point::new(-4.5, 1.13)) < 1e-5);
    }

    #[test]
    fn a_point_of_the_edge_is_found_again_by_its_length() {
        for league in LEAGUES {
            let edge = Edge::of(&league.field(), 0.13);
            for i in 0..=200 {
                let along = edge.length() * i as f32 / 200.0;
                let point = edge.point(along);
                assert!((edge.along(point) - along).abs() < 1e-3, "{league:?} {along}");
            }
        }
    }

    #[test]
    fn a_ray_from_the_goal_leaves_by_the_edge() {
        // From the middle of division B's goal at 45° the corner's arc, about (1, 1), radius 0.13, is crossed
        // on its diagonal: √2 × 1 + 0.13 = 1.5442 m away.
        let edge = Edge::of(&League::DivisionB.field(), 0.13);
        let out = edge.crossing(Point::new(-4.5, 0.0), Vector::new(1.0, 1.0));
        assert!((out.distance(Point::new(-4.5, 0.0)) - 1.5442).abs() < 1e-4, "{out:?}");
        // 2013, straight: 0.8 + 0.13 m.
        let edge = Edge::of(&League::Ssl2013.field(), 0.13);
        assert!((edge.crossing(Point::new(-3.0, 0.1), Vector::new(2.0, 0.0)).x() + 2.07).abs() < 1e-5);
    }
}
