//! `stakes`: what a goal for us and a goal against us are worth by score and time left: a team that is behind
//! takes risks, one that leads avoids them.
//!
//! A result is worth 1 (won), ½ (drawn) or 0. In the time left both teams score by chance, as often as teams
//! did on average, each goal independent of the others; so goal difference and time give the expected result,
//! and a goal is worth what it adds to that. Both worths are relative to their mean: at a level score, or
//! where nothing is known, both are 1.

use geometry::math;
use rules::limits;
use rules::state::Stage;

/// Goals of a team a second: 3.1 and 3.4 in 600 s, our team against itself in 40 matches (docs/strategy.md).
const GOALS_PER_S: f32 = (3.1 + 3.4) / (2.0 * 600.0);
/// Numbers of goals that are told apart, from 0: in 600 s more than 15 come with P < 10⁻⁶.
const GOAL_COUNTS: usize = 16;
/// A goal of either team moves the result by less than this together: the match is decided.
const DECIDED_BELOW: f32 = 0.02;
/// Least worth of a goal, so that neither kind is ever given away.
const WORTH_MIN: f32 = 0.2;

/// Relative worths of a goal for us and a goal against us; their mean is 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stakes {
    /// Worth of a goal for us.
    pub ours: f32,
    /// Worth of a goal against us.
    pub theirs: f32,
}

impl Default for Stakes {
    fn default() -> Self {
        Self::EVEN
    }
}

impl Stakes {
    /// Worths of a level score: both the same.
    pub const EVEN: Self = Self { ours: 1.0, theirs: 1.0 };

    /// With `ahead` goals more than the opponents (negative: fewer) and `left` s to play.
    pub fn of(ahead: i32, left: f32) -> Self {
        if ahead == 0 || !left.is_finite() {
            return Self::EVEN;
        }
        let results = Results::within(left.max(0.0));
        let (now, more, less) = (results.of(ahead), results.of(ahead + 1), results.of(ahead - 1));
        let (gained, lost) = (more - now, now - less);
        let both = gained + lost;
        if both < DECIDED_BELOW {
            return Self::EVEN;
        }
        let ours = (2.0 * gained / both).clamp(WORTH_MIN, 2.0 - WORTH_MIN);
        Self { ours, theirs: 2.0 - ours }
    }
}

/// Time left in a match, s, from that in its stage; `None` where the stage is not played.
pub fn time_left(stage: Stage, stage_time_left: Option<f32>) -> Option<f32> {
    match stage {
        Stage::FirstHalf => stage_time_left.map(|left| left + limits::HALF_TIME),
        Stage::ExtraFirstHalf => stage_time_left.map(|left| left + limits::OVERTIME_HALF_TIME),
        Stage::SecondHalf | Stage::ExtraSecondHalf => stage_time_left,
        _ => None,
    }
}

/// Probabilities of the numbers of goals that a team scores in the time left.
struct Results([f32; GOAL_COUNTS]);

impl Results {
    fn within(left: f32) -> Self {
        let mean = left * GOALS_PER_S;
        let mut goals = [0.0; GOAL_COUNTS];
        let mut one = math::exp(-mean);
        for (number, probability) in (1_u8..).zip(&mut goals) {
            *probability = one;
            one *= mean / f32::from(number);
        }
        Self(goals)
    }

    /// P(won) + P(drawn) / 2 with `ahead` goals more now.
    fn of(&self, ahead: i32) -> f32 {
        let mut result = 0.0;
        for (ours, p) in (0_i32..).zip(self.0) {
            for (theirs, q) in (0_i32..).zip(self.0) {
                let share = match (ahead + ours - theirs).signum() {
                    1 => 1.0,
                    0 => 0.5,
                    _ => 0.0,
                };
                result += share * p * q;
            }
        }
        result
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_expected_result_is_that_of_the_difference_of_two_poisson_numbers() {
        // Means of ½ each: by the modified Bessel functions I₀(1), I₁(1) and I₂(1) over e, the difference is
        // 0, 1 and 2 with P = 0.46576, 0.20791 and 0.04994.
        let results = Results::within(0.5 / GOALS_PER_S);
        for (ahead, expected) in [(0, 0.5), (1, 0.83684), (2, 0.96576), (-1, 0.16316)] {
            assert!((results.of(ahead) - expected).abs() < 1e-4, "{ahead}: {}", results.of(ahead));
        }
        let stakes = Stakes::of(1, 0.5 / GOALS_PER_S);
        // 0.12892 is gained by one more, 0.33684 lost by one less.
        assert!((stakes.ours - 0.5536).abs() < 1e-3 && (stakes.theirs - 1.4464).abs() < 1e-3, "{stakes:?}");
    }

    #[test]
    fn a_team_behind_late_values_a_goal_and_a_leading_one_a_goal_against() {
        let behind = |left| Stakes::of(-1, left).ours;
        assert!(behind(600.0) < behind(120.0) && behind(120.0) < behind(10.0));
        assert!(behind(10.0) > 1.7 && behind(600.0) > 1.0);
        for left in [5.0, 60.0, 600.0] {
            let (ahead, after) = (Stakes::of(2, left), Stakes::of(-2, left));
            assert!((ahead.ours - after.theirs).abs() < 1e-3 && (ahead.theirs - after.ours).abs() < 1e-3);
        }
        assert_eq!(Stakes::of(0, 30.0), Stakes::EVEN);
        assert_eq!(Stakes::of(5, 30.0), Stakes::EVEN, "decided");
        assert_eq!(Stakes::of(1, f32::NAN), Stakes::EVEN);
    }

    #[test]
    fn time_left_counts_the_half_that_is_to_come() {
        assert_eq!(time_left(Stage::FirstHalf, Some(20.0)), Some(320.0));
        assert_eq!(time_left(Stage::SecondHalf, Some(20.0)), Some(20.0));
        assert_eq!(time_left(Stage::ShootOut, Some(20.0)), None);
        assert_eq!(time_left(Stage::SecondHalf, None), None);
    }
}
