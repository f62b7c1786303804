//! `occasion`: a decision of recorded play as a place to try changes in. mm.

use arena::evaluation::Profile;

use crate::trial::Situation;

/// A situation of a trial.
#[derive(Clone, Debug)]
pub(crate) struct Occasion {
    /// Where everything stood.
    pub(crate) situation: Situation,
    /// The world that it was played in.
    pub(crate) profile: Profile,
    /// Whether the opponents were two defenders.
    pub(crate) two_defenders: bool,
    /// Whether no case was played.
    pub(crate) without_case: bool,
}

/// Both robots and both opponents are known, the goal at -x is defended, and the ball is in play.
pub(crate) fn usable(situation: &Situation) -> bool {
    let [x, y] = situation.ball;
    !situation.defending_positive
        && situation.teammates.len() == 2
        && situation.opponents.len() == 2
        && x.abs() < BALL_INSIDE[0]
        && y.abs() < BALL_INSIDE[1]
}

/// Where the ball is in play, mm: inside the lines of 2700 and 1800 mm.
const BALL_INSIDE: [i32; 2] = [2650, 1750];
