//! `occasion`: a decision of recorded play as a place to try changes in. mm.

use arena::Profile;

use crate::learning::trial::Situation;

/// A situation of a trial.
#[derive(Clone, Debug)]
pub(crate) struct Occasion {
    /// Places of ball and robots.
    pub(crate) situation: Situation,
    /// The world that it was played in.
    pub(crate) profile: Profile,
    /// Whether the opponents were two defenders.
    pub(crate) two_defenders: bool,
    /// Whether no case was played.
    pub(crate) without_case: bool,
}
