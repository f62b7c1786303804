//! `value`: what having the ball at a place is worth: P(goal for) − P(goal against) within 10 s. m, attack
//! frame.
//!
//! Both are fitted on 30 matches of 300 s (division B, nominal world, seeds 101 to 110 against `ours`, `zone`
//! and `reactive`): 7,733 moments half a second apart in which one team had the ball, with the goals of the
//! 10 s after them. By distance from the opponents' goal 0.5, 1.5, … m they are for 0.19, 0.14, 0.09, 0.07,
//! 0.04, 0.02, 0.01, 0, 0 and against 0, 0, 0, 0, 0.02, 0.04, 0.06, 0.08, 0.08.

use geometry::{Attack, Point, math};

use super::stakes::Stakes;

/// P(goal for) at their goal, and the distance over which it falls to 1/e, m.
const FOR_AT_GOAL: f32 = 0.24;
const FOR_FADES_M: f32 = 2.4;
/// P(goal against) of a ball at our goal, and the distance at which it is 0, m.
const AGAINST_AT_GOAL: f32 = 0.1;
const AGAINST_WITHIN_M: f32 = 5.5;

/// Worth of the ball at `at` for the team that has it and attacks towards +x, −1 to 1; `goal_line`: half the
/// field's length, m.
pub fn of_ours(goal_line: f32, at: Point<Attack>) -> f32 {
    Stakes::EVEN.of_ours(goal_line, at)
}

impl Stakes {
    /// The same where goals for and against are worth different amounts.
    pub fn of_ours(self, goal_line: f32, at: Point<Attack>) -> f32 {
        let (scored, conceded) = goals(goal_line, at);
        self.ours * scored - self.theirs * conceded
    }

    /// Worth for us of the ball at `at` where the opponents have it.
    pub fn of_theirs(self, goal_line: f32, at: Point<Attack>) -> f32 {
        let (scored, conceded) = goals(goal_line, Point::new(-at.x(), -at.y()));
        self.ours * conceded - self.theirs * scored
    }
}

/// P(goal) of the team that has the ball at `at` and attacks towards +x, and of the other team.
fn goals(goal_line: f32, at: Point<Attack>) -> (f32, f32) {
    let scored = FOR_AT_GOAL * math::exp(-at.distance(Point::new(goal_line, 0.0)) / FOR_FADES_M);
    let conceded =
        AGAINST_AT_GOAL * (1.0 - at.distance(Point::new(-goal_line, 0.0)) / AGAINST_WITHIN_M).max(0.0);
    (scored, conceded)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_what_was_counted_within_a_fiftieth() {
        // By distance from their goal: goals for less goals against.
        let counted = [0.19, 0.14, 0.085, 0.065, 0.021, -0.02, -0.05, -0.077, -0.082];
        for (i, counted) in counted.into_iter().enumerate() {
            let at = Point::new(4.0 - i as f32, 0.0);
            assert!((of_ours(4.5, at) - counted).abs() < 0.035, "{i}: {}", of_ours(4.5, at));
            let lost = |stakes: Stakes| stakes.of_theirs(4.5, Point::new(-at.x(), 0.0));
            assert_eq!(lost(Stakes::EVEN), -of_ours(4.5, at));
            // A goal against us alone counts: having the ball at our goal is a risk, at theirs none.
            let careful = Stakes { ours: 0.0, theirs: 2.0 };
            assert!(careful.of_ours(4.5, at) <= 0.0 && lost(careful) <= careful.of_ours(4.5, at) + 0.21);
        }
    }
}
