//! `area`: the strategic area of the field in which the ball lies. The six names of the paper's case base
//! (Ros et al. 2009, §5.1.1), which gives no borders: these are ours. Attack frame: +x towards the goal
//! attacked.
//!
//! Along x, from the own goal line (−1) to the opponents' (+1); across, from the middle (0) to a touch line
//! (1): the outer 40 % of each half (|y| > 0.6) are `corner` beyond |x| > 0.8, `front-side` where x > 1/3,
//! else `side`; the middle is `back` where x < −1/3, `front` where x > 1/3, else `center`.

use casebase::{FieldMm, GoalEnd, PointMm};

geometry::labels! {
    /// A strategic area of the field, attack frame.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
    pub enum Area {
        /// Area in front of the own goal.
        Back = "back",
        /// Around the centre of the field.
        Center = "center",
        /// Area in front of the opponents' goal.
        Front = "front",
        /// Along a touch line, up to the opponents' third.
        Side = "side",
        /// Along a touch line in the opponents' third.
        FrontSide = "front-side",
        /// Any of the four corners.
        Corner = "corner",
    }
}

impl Area {
    /// The area of a ball at `ball` (field frame) for a team that defends `defending`; outside the lines,
    /// that of the nearest part of the field.
    pub fn of(field: FieldMm, ball: PointMm, defending: GoalEnd) -> Self {
        let x = f64::from(defending.attack_sign()) * f64::from(ball.x) / (f64::from(field.length) / 2.0);
        let y = f64::from(ball.y).abs() / (f64::from(field.width) / 2.0);
        if y > SIDE_STRIP_FROM {
            return match x {
                x if x.abs() > CORNER_FROM => Self::Corner,
                x if x > THIRD => Self::FrontSide,
                _ => Self::Side,
            };
        }
        match x {
            x if x < -THIRD => Self::Back,
            x if x > THIRD => Self::Front,
            _ => Self::Center,
        }
    }
}

/// Start of the strips along the touch lines, share of half the width: 0.72 m of 1.8 m, twice what a legged
/// robot needs to turn around the ball.
const SIDE_STRIP_FROM: f64 = 0.6;
/// Start of the corners, share of half the length: 0.54 m deep, as the penalty area of 2007.
const CORNER_FROM: f64 = 0.8;
/// Thirds of the field, share of half the length.
const THIRD: f64 = 1.0 / 3.0;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::coverage::TEST_FIELD as FIELD;

    #[test]
    fn each_area_is_where_its_word_says_for_both_teams() {
        let table = [
            ([0, 0], Area::Center),
            ([-2000, 300], Area::Back),
            ([2000, -300], Area::Front),
            ([0, 1500], Area::Side),
            ([-1500, -1500], Area::Side),
            ([1500, -1500], Area::FrontSide),
            ([2500, 1700], Area::Corner),
            ([-2500, 1700], Area::Corner),
            ([9000, 9000], Area::Corner),
        ];
        for ([x, y], area) in table {
            assert_eq!(Area::of(FIELD, PointMm::new(x, y), GoalEnd::Negative), area, "{x}, {y}");
            assert_eq!(Area::of(FIELD, PointMm::new(-x, y), GoalEnd::Positive), area, "{x}, {y} mirrored");
        }
    }

    #[test]
    fn areas_stand_in_the_order_of_their_numbers() {
        for (index, area) in Area::ALL.into_iter().enumerate() {
            assert_eq!(area as usize, index);
        }
    }
}
