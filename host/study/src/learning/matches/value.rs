//! `value`: what a scene of a match was worth to us: goals expected from its shots, ours less theirs.
//!
//! Goals themselves are rare and largely chance: every shot counts as the goals that shots of its kind have
//! led to, and a goal that no shot led to counts as one. The value was stated before any change was tried; it
//! chooses and tests changes, and matches are validated by goals.

use super::unit::{Mark, MarkKind, SCENE_MS};

/// Goals for one shot with no line to the goal free, with less than half of them, and with more: 0 of 69, 53
/// of 288 and 85 of 166 in 120 beginnings of matches of the authored library (seeds 900 and 901, both teams).
const GOALS_A_SHOT: [f64; 3] = [0.01, 0.18, 0.51];
/// A goal within this time after a shot of its team is that shot's, ms, as in the ledger.
const SHOT_BEFORE_MS: u32 = 2_000;
/// A value counts as at most this, either way, goals: an open shot, so that one scene decides little.
const VALUE_MAX: f64 = 0.5;
/// Largest difference of two values.
pub(crate) const DIFFERENCE_MAX: f64 = 2.0 * VALUE_MAX;

/// The value of the scene that begins at `from_ms`.
pub(crate) fn value(marks: &[Mark], from_ms: u32) -> f64 {
    let scene = marks.iter().filter(|mark| (from_ms..from_ms + SCENE_MS).contains(&mark.at_ms));
    let goals = scene.map(|mark| {
        let goals = match mark.kind {
            MarkKind::ShotClosed => GOALS_A_SHOT[0],
            MarkKind::ShotPartlyOpen => GOALS_A_SHOT[1],
            MarkKind::ShotOpen => GOALS_A_SHOT[2],
            MarkKind::Goal => f64::from(u8::from(!of_a_shot(marks, *mark))),
        };
        if mark.ours { goals } else { -goals }
    });
    goals.sum::<f64>().clamp(-VALUE_MAX, VALUE_MAX)
}

fn of_a_shot(marks: &[Mark], goal: Mark) -> bool {
    marks.iter().any(|mark| {
        mark.ours == goal.ours
            && mark.kind != MarkKind::Goal
            && mark.at_ms <= goal.at_ms
            && goal.at_ms - mark.at_ms <= SHOT_BEFORE_MS
    })
}
