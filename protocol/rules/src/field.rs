//! `field`: dimensions of the field. All lengths in metres, points in the field frame.
//!
//! Distances are measured between the lines' centres (rules 2026, playing environment), so a line's outer
//! edge lies half a line's width further out.

use geometry::{Field, GoalEnd, Point, Shape, math};
use heapless::Vec;
use serde::{Deserialize, Serialize};

use crate::limits::ROBOT_RADIUS;

/// Most shapes of one defence area.
pub const AREA_SHAPES_MAX: usize = 3;

/// Dimensions of a field.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FieldSpec {
    /// Distance from goal line to goal line.
    pub length: f32,
    /// Distance from touch line to touch line.
    pub width: f32,
    /// Field surface beyond the touch lines, up to the wall.
    pub margin: f32,
    /// Field surface beyond the goal lines, up to the wall.
    pub goal_line_margin: f32,
    /// Goal substitution area: from the wall behind the own goal line towards the field; 0 where there is
    /// none.
    pub goal_substitution: f32,
    /// Distance between the insides of the goalposts.
    pub goal_width: f32,
    /// Distance from the goal line to the goal's back.
    pub goal_depth: f32,
    /// Height of the goal's upper edge above the field surface.
    pub goal_height: f32,
    /// Thickness of the goal's walls.
    pub goal_wall: f32,
    /// Penalty (defence) area: from the goal line into the field.
    pub penalty_depth: f32,
    /// Penalty (defence) area: along the goal line.
    pub penalty_width: f32,
    /// Penalty (defence) area: form of its border.
    pub penalty_form: AreaForm,
    /// Distance from the attacked goal's centre to the penalty mark.
    pub penalty_mark: f32,
    /// Radius of the centre circle.
    pub center_radius: f32,
    /// Width of every line.
    pub line_width: f32,
}

/// Landmarks by which walking robots locate themselves, m: the "two colored goals" and "four colored markers"
/// of the four-legged league's field (Ros et al. 2009 §1, Fig. 1). Markers where the league's rules of 2005
/// put four of them: 1.35 m from the halfway line, on the edge of the field surface's lines (1.9 m from the
/// axis); goals by their centres.
pub const LANDMARKS: [Point<Field>; 6] = [
    Point::new(1.35, 1.9),
    Point::new(-1.35, 1.9),
    Point::new(-1.35, -1.9),
    Point::new(1.35, -1.9),
    Point::new(2.7, 0.0),
    Point::new(-2.7, 0.0),
];

/// The border of a defence area.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum AreaForm {
    /// A rectangle, as since 2018.
    Box,
    /// Two quarter circles with the area's depth as radius, joined by a straight line, as until 2017.
    QuarterCircles,
}

/// An invalid dimension of a field.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("{field}: {value} m is not within {least} to {most} m")]
pub struct FieldFault {
    /// Name of the number's field in [`FieldSpec`].
    pub field: &'static str,
    /// Value of that number, m.
    pub value: f32,
    /// Smallest valid value, m.
    pub least: f32,
    /// Largest valid value, m; some limits follow from other numbers of the same field.
    pub most: f32,
}

/// Shortest and longest valid field, m: a table top, and twice division A's length.
const LENGTH: [f32; 2] = [1.0, 24.0];
/// The widest margin that is accepted, m: more than any venue leaves around a field.
const MARGIN_MAX: f32 = 3.0;
/// The deepest valid goal and the thickest valid line, m.
const GOAL_DEPTH_MAX: f32 = 1.0;
const LINE_WIDTH_MAX: f32 = 0.1;

impl FieldSpec {
    /// The same field, if its numbers are valid; for numbers from outside.
    pub fn checked(self) -> Result<Self, FieldFault> {
        let half = self.length * 0.5;
        let checks = [
            ("length", self.length, LENGTH[0], LENGTH[1]),
            ("width", self.width, LENGTH[0], LENGTH[1]),
            ("margin", self.margin, 0.0, MARGIN_MAX),
            ("goal_line_margin", self.goal_line_margin, 0.0, MARGIN_MAX),
            ("goal_substitution", self.goal_substitution, 0.0, MARGIN_MAX),
            ("goal_width", self.goal_width, 0.1, self.width),
            ("goal_depth", self.goal_depth, 0.0, GOAL_DEPTH_MAX),
            ("goal_height", self.goal_height, 0.0, GOAL_DEPTH_MAX),
            ("goal_wall", self.goal_wall, 0.0, LINE_WIDTH_MAX),
            ("penalty_depth", self.penalty_depth, 0.0, half),
            ("penalty_width", self.penalty_width, 0.0, self.width),
            ("penalty_mark", self.penalty_mark, 0.0, self.length),
            ("center_radius", self.center_radius, 0.0, self.width * 0.5),
            ("line_width", self.line_width, 0.0, LINE_WIDTH_MAX),
        ];
        for (field, value, least, most) in checks {
            // A NaN is in no range.
            if !(least..=most).contains(&value) {
                return Err(FieldFault { field, value, least, most });
            }
        }
        let round = self.penalty_form == AreaForm::QuarterCircles;
        if round && self.penalty_width < 2.0 * self.penalty_depth {
            let (value, least) = (self.penalty_width, 2.0 * self.penalty_depth);
            return Err(FieldFault { field: "penalty_width", value, least, most: self.width });
        }
        Ok(self)
    }

    /// x of the goal line at that end.
    pub fn goal_line(&self, goal: GoalEnd) -> f32 {
        goal.sign() as f32 * self.length * 0.5
    }

    /// Middle of the goal opening at that end.
    pub fn goal_center(&self, goal: GoalEnd) -> Point<Field> {
        Point::new(self.goal_line(goal), 0.0)
    }

    /// On the field or on its lines.
    pub fn contains(&self, p: Point<Field>) -> bool {
        p.x().abs() <= self.length * 0.5 && p.y().abs() <= self.width * 0.5
    }

    /// The whole field surface within the walls.
    pub fn surface(&self) -> Shape<Field> {
        let (x, y) = (self.length * 0.5 + self.goal_line_margin, self.width * 0.5 + self.margin);
        Shape::Box { low: Point::new(-x, -y), high: Point::new(x, y) }
    }

    /// Region of the centre of a robot that defends `goal` and does not count as being on the field: the
    /// whole robot in the goal substitution area. `None` where that area is narrower than a robot.
    ///
    /// The league's game controller counts every robot outside this box (its
    /// `NumTeamRobotsExcludingSubstitutionZone`), in both divisions; the centre substitution area does not
    /// stop it from counting.
    pub fn goal_substitution_area(&self, goal: GoalEnd) -> Option<Shape<Field>> {
        let (x, y) = (self.length * 0.5 + self.goal_line_margin, self.width * 0.5 + self.margin);
        let edge = x - self.goal_substitution + ROBOT_RADIUS;
        if edge > x - ROBOT_RADIUS {
            return None;
        }
        let (low, high) = if goal.sign() < 0 { (-x, -edge) } else { (edge, x) };
        Some(Shape::Box { low: Point::new(low, -y), high: Point::new(high, y) })
    }

    /// Returns whether a robot with its centre at `p` counts for the team that defends `goal`.
    pub fn counts(&self, goal: GoalEnd, p: Point<Field>) -> bool {
        self.goal_substitution_area(goal).is_none_or(|area| !area.contains(p))
    }

    /// The defence area at that end; together the shapes cover it. Behind the goal line they may cover more.
    pub fn defence_area(&self, goal: GoalEnd) -> Vec<Shape<Field>, AREA_SHAPES_MAX> {
        let (line, sign) = (self.goal_line(goal), goal.sign() as f32);
        let front = line - sign * self.penalty_depth;
        let radius = self.penalty_depth;
        let half_width = match self.penalty_form {
            AreaForm::Box => self.penalty_width * 0.5,
            AreaForm::QuarterCircles => self.penalty_width * 0.5 - radius,
        };
        let middle = Shape::Box {
            low: Point::new(line.min(front), -half_width),
            high: Point::new(line.max(front), half_width),
        };
        match self.penalty_form {
            AreaForm::Box => Vec::from_iter([middle]),
            AreaForm::QuarterCircles => {
                let [right, left] = [-half_width, half_width].map(|y| Point::new(line, y));
                Vec::from_iter([
                    middle,
                    Shape::Disc { center: right, radius },
                    Shape::Disc { center: left, radius },
                ])
            }
        }
    }

    /// Distance from the border of the defence area at that end, m: negative inside.
    pub fn distance_to_area(&self, goal: GoalEnd, p: Point<Field>) -> f32 {
        self.defence_area(goal).iter().map(|shape| shape.distance_to(p)).fold(f32::INFINITY, f32::min)
    }

    /// Returns whether the point is in the penalty area at that end, lines included.
    pub fn in_penalty_area(&self, goal: GoalEnd, p: Point<Field>) -> bool {
        let depth = self.length * 0.5 - p.x() * goal.sign() as f32;
        depth >= 0.0 && self.defence_area(goal).iter().any(|shape| shape.contains(p))
    }

    /// Penalty mark for that goal.
    pub fn penalty_spot(&self, attacked: GoalEnd) -> Point<Field> {
        Point::new(self.goal_line(attacked) - attacked.sign() as f32 * self.penalty_mark, 0.0)
    }

    /// The nearest point at least `inside` within the lines (or beyond them by −`inside`).
    pub fn clamp(&self, p: Point<Field>, inside: f32) -> Point<Field> {
        let (x, y) = (self.length * 0.5 - inside, self.width * 0.5 - inside);
        Point::new(math::clamp(p.x(), -x, x), math::clamp(p.y(), -y, y))
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

    #[test]
    fn the_round_area_of_2013_has_no_corners() {
        let field = League::Ssl2013.field();
        let goal = GoalEnd::Negative;
        // The middle of the front, the start of the curve, 45° along it (0.8 / √2 = 0.566), and the square's
        // corner.
        assert!(field.in_penalty_area(goal, Point::new(-2.201, 0.0)));
        assert!(field.in_penalty_area(goal, Point::new(-2.201, 0.175)));
        assert!(field.in_penalty_area(goal, Point::new(-3.0 + 0.565, 0.175 + 0.565)));
        assert!(!field.in_penalty_area(goal, Point::new(-3.0 + 0.567, 0.175 + 0.567)));
        assert!(!field.in_penalty_area(goal, Point::new(-2.25, 0.95)));
        assert!(!field.in_penalty_area(goal, Point::new(-3.01, 0.0)));
        // Straight from the front; along its radius beside the curve.
        assert!((field.distance_to_area(goal, Point::new(-1.2, 0.0)) - 1.0).abs() < 1e-6);
        assert!((field.distance_to_area(goal, Point::new(-3.0, 1.475)) - 0.5).abs() < 1e-6);
    }

    #[test]
    fn a_robot_behind_its_own_goal_line_does_not_count_where_the_area_takes_all_of_it() {
        // The game controller's own numbers: 6 + 0.6 − 0.3 + 0.09 = 6.39 m, up to the wall at 6.6 m, across
        // the whole field surface.
        let field = League::DivisionA.field();
        for (x, counts) in [(6.385, true), (6.395, false), (6.595, false), (6.605, true)] {
            assert_eq!(field.counts(GoalEnd::Positive, Point::new(x, 4.75)), counts, "{x}");
            assert_eq!(field.counts(GoalEnd::Negative, Point::new(-x, -4.75)), counts, "−{x}");
            assert!(field.counts(GoalEnd::Negative, Point::new(x, 0.0)), "behind their goal it counts");
        }
        assert!(field.counts(GoalEnd::Positive, Point::new(6.45, 4.85)), "beyond the wall");
        // Division B has no such area by the rules; where vision reports one all the same, the controller
        // uses it.
        let field = League::DivisionB.field();
        assert!(field.counts(GoalEnd::Positive, Point::new(4.65, 1.5)));
        let field = FieldSpec { goal_substitution: 0.3, ..field };
        assert!(!field.counts(GoalEnd::Positive, Point::new(4.65, 1.5)));
        let narrow = FieldSpec { goal_substitution: 0.17, ..field };
        assert!(narrow.goal_substitution_area(GoalEnd::Positive).is_none());
    }

    #[test]
    fn a_goal_inside_is_18_cm_deep_16_high_and_1_8_or_1_m_wide() {
        for (league, width) in [(League::DivisionA, 1.8), (League::DivisionB, 1.0)] {
            let field = league.field();
            assert_eq!((field.goal_width, field.goal_depth, field.goal_height), (width, 0.18, 0.16));
        }
    }

    #[test]
    fn a_penalty_of_division_b_is_taken_6_m_from_the_goal() {
        let field = League::DivisionB.field();
        assert_eq!(field.penalty_spot(GoalEnd::Positive), Point::new(-1.5, 0.0));
        assert_eq!(League::DivisionA.field().penalty_spot(GoalEnd::Negative), Point::new(2.0, 0.0));
        assert_eq!(League::Ssl2013.field().penalty_spot(GoalEnd::Positive), Point::new(2.25, 0.0));
    }

    #[test]
    fn a_field_that_cannot_be_is_refused_by_the_name_of_its_number() {
        let good = League::DivisionB.field();
        assert_eq!(good.checked(), Ok(good));
        let fault = |field: FieldSpec| field.checked().unwrap_err().field;
        assert_eq!(fault(FieldSpec { length: f32::NAN, ..good }), "length");
        assert_eq!(fault(FieldSpec { width: -6.0, ..good }), "width");
        assert_eq!(fault(FieldSpec { goal_width: 6.1, ..good }), "goal_width");
        assert_eq!(fault(FieldSpec { penalty_depth: 4.6, ..good }), "penalty_depth");
        assert_eq!(fault(FieldSpec { margin: f32::INFINITY, ..good }), "margin");
        let round = AreaForm::QuarterCircles;
        assert_eq!(fault(FieldSpec { penalty_form: round, penalty_width: 1.9, ..good }), "penalty_width");
    }

    #[test]
    fn every_leagues_field_passes_its_own_check() {
        for league in League::ALL {
            assert!(league.field().checked().is_ok(), "{}", league.name());
        }
    }
}
