//! `course`: progress of an attempt: the first retrieval, its gameplay, and the ball until it lies still or
//! is taken.

use casebase::Case;
use hil_sim::TrialOutcome;

use super::{Attempt, Retrieved};
use crate::cycles::{CycleEnd, CycleSeen};
use crate::names::CaseNames;

/// A moment of an attempt, of either simulator.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moment<'m> {
    /// Since the robots may play, s.
    pub(super) time: f32,
    /// The cycles of the attackers so far.
    pub(super) cycles: &'m [CycleSeen],
    /// The referee's verdict and its time, s.
    pub(super) verdict: Option<(TrialOutcome, f32)>,
    /// A robot has just taken the ball.
    pub(super) taken: bool,
    /// The ball lies still.
    pub(super) still: bool,
}

/// Progress of an attempt.
#[derive(Clone, Debug, Default)]
pub(super) struct Course {
    /// The first decision's place in the list of cycles.
    first: Option<usize>,
    began: f32,
    end: Option<(f32, CycleEnd)>,
}

impl Course {
    /// Evaluates the last tick; true if the attempt is over.
    pub(super) fn over(&mut self, moment: &Moment<'_>, case: &Case<'_>) -> bool {
        let Moment { time: now, cycles, verdict, .. } = *moment;
        if self.first.is_none() {
            self.first = cycles.iter().position(|cycle| cycle.play.is_some() || cycle.no_case);
            self.began = now;
        }
        let Some(cycle) = self.first.and_then(|first| cycles.get(first)) else {
            return verdict.is_some() || now > DECIDED_WITHIN;
        };
        if !is_of(cycle, case) {
            return true;
        }
        if self.end.is_none() {
            let trial_over = verdict.is_some_and(|(_, at)| now > at + LAST_DESCRIPTION);
            let given_up = now > self.began + GIVEN_UP_AFTER;
            self.end = cycle.end.or((trial_over || given_up).then_some((now, CycleEnd::TrialOver)));
        }
        let Some((ended, _)) = self.end else { return false };
        verdict.is_some() || moment.taken || moment.still || now > ended + WATCHED_FOR
    }

    /// The result, with the distance that the ball came nearer to the attacked goal line, m.
    pub(super) fn attempt(
        &self,
        moment: &Moment<'_>,
        case: &Case<'_>,
        names: &CaseNames,
        progress: f32,
    ) -> Attempt {
        Attempt {
            retrieved: self.retrieved(moment.cycles, case, names),
            end: self.end.map(|(_, end)| end),
            duration: self.end.map_or(0.0, |(at, _)| at - self.began),
            outcome: moment.verdict.map(|(outcome, _)| outcome),
            progress,
        }
    }

    fn retrieved(&self, cycles: &[CycleSeen], case: &Case<'_>, names: &CaseNames) -> Retrieved {
        let Some(cycle) = self.first.and_then(|first| cycles.get(first)) else { return Retrieved::Nothing };
        match &cycle.play {
            None => Retrieved::None,
            Some(_) if is_of(cycle, case) => Retrieved::Own,
            Some(play) => Retrieved::Other(names.of(play.case)),
        }
    }
}

/// Whether this cycle plays `case`, in any symmetry.
fn is_of(cycle: &CycleSeen, case: &Case<'_>) -> bool {
    cycle.play.as_ref().is_some_and(|play| usize::from(play.case.0 / 4) == case.authored())
}

/// A decision comes within this time of kick-off, s: a lease of receiving, an election and a retrieval are
/// half a second.
const DECIDED_WITHIN: f32 = 3.0;
/// Time for which robots may still report after the referee's verdict, s: two beacons and an answer.
const LAST_DESCRIPTION: f32 = 0.4;
/// Longest gameplay, s: its own limit is 1.5 times the expected duration and 2 s.
const GIVEN_UP_AFTER: f32 = 120.0;
/// Time for which the ball is watched after the gameplay, s: a hard kick rolls for 3.5 s.
const WATCHED_FOR: f32 = 4.0;
