//! `shot`: probability that a shot scores. The paper's c1', c2' and c4' without a pass before (Biswas et al.
//! 2014 §3.1), so that shots and passes are compared on one scale. Attack frame, SI units.

use geometry::{Attack, Point};
use rules::limits::{BALL_RADIUS, ROBOT_RADIUS};

use super::super::view::View;
use super::conditions as given;
use super::kicks::Kicks;
use super::open::GoalOpening;

/// A shot that could be taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shot {
    /// At this point of the goal line.
    pub aim: Point<Attack>,
    /// The open angle around it, rad.
    pub angle: f32,
    /// Time until it is there, s.
    pub time: f32,
    /// Factors P(c1'), P(c2'), P(c4').
    pub factors: [f32; 3],
}

impl Shot {
    /// P(goal), the product of the factors.
    pub fn value(&self) -> f32 {
        self.factors.iter().product()
    }
}

/// From `from`, against all opponents of the view.
pub fn shot(view: &View, kicks: &Kicks, from: Point<Attack>) -> Shot {
    let c = kicks.constants();
    let opening = GoalOpening {
        x: view.their_goal().x(),
        half: view.field.goal_width * 0.5 - BALL_RADIUS,
        body: ROBOT_RADIUS + BALL_RADIUS,
    };
    let open = opening.open_from(from, view.theirs.iter().map(|robot| robot.position));
    let time = kicks.shot().at(from.distance(open.aim)).0;
    let factors = [
        given::beats_the_keeper(time, c),
        given::open_goal(open.angle, c),
        given::not_stolen(!c.their_area_forbidden && view.in_their_area(from, 0.0), c),
    ];
    Shot { aim: open.aim, angle: open.angle, time, factors }
}

#[cfg(test)]
mod tests {
    use super::super::super::view::tests::view;
    use super::*;
    use rules::League;

    fn shot_from(from: (f32, f32), theirs: &[(f32, f32)]) -> Shot {
        let kicks = Kicks::of(League::DivisionB);
        shot(&view(from, &[], theirs), &kicks, Point::new(from.0, from.1))
    }

    #[test]
    fn an_open_goal_two_metres_off_by_hand() {
        let found = shot_from((2.5, 0.0), &[]);
        // 2 atan(0.4785 / 2) = 0.4697 rad: wide enough. The ball slides from 6.24 m/s with 3.9 m/s²: 2 m =
        // 6.24 t − 1.95 t², t = 0.3613 s; c1' = 1 / (1 + exp(−0.387)) = 0.5956; c4' = 0.7.
        assert!((found.angle - 0.4697).abs() < 1e-3 && found.aim.y().abs() < 1e-6, "{found:?}");
        assert!((found.time - 0.3613).abs() < 2e-3, "{found:?}");
        assert!((found.factors[0] - 0.5956).abs() < 5e-3 && found.factors[1..] == [1.0, 0.7], "{found:?}");
        assert!((found.value() - 0.417).abs() < 5e-3);
    }

    #[test]
    fn a_closed_goal_keeps_a_tenth_and_a_far_one_hardly_anything() {
        let closed = shot_from((2.5, 0.0), &[(2.7, 0.0)]);
        assert_eq!((closed.angle, closed.factors[1]), (0.0, 0.1));
        // 0.86 s for 5 m: probability e^−4.6 that it is there before the keeper.
        assert!(shot_from((-0.5, 0.0), &[]).value() < 0.02);
    }
}
