//! `strategy`: check of a strategy in another program: whether it answers, and whether its answers are used.

use protocol::{Duration, Instant};
use thiserror::Error;

use crate::Host;

/// A strategy that is asked is to answer within this time.
const ANSWERS_WITHIN: Duration = Duration::millis(1_500);

/// A strategy that does not play.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum StrategyFault {
    /// Its answers are refused.
    #[error(
        "{answers} answers of the strategy are refused, the last one because {reason}: robots follow the coach or stand; \
         compare it with docs/strategy-protocol.md"
    )]
    Refused {
        /// Number of refused answers.
        answers: u64,
        /// Why the last one was.
        reason: String,
    },
    /// No answer came though it was asked.
    #[error(
        "no answer {}came from the strategy for {:.0} s: robots stand in open play; does it run, read standard input line by \
         line, and flush its output?",
        if *ever { "" } else { "ever " }, since.as_secs_f32()
    )]
    Silent {
        /// Since the last answer, or since it was asked first.
        since: Duration,
        /// Whether it ever answered.
        ever: bool,
    },
}

/// Answers as they were counted.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Answers {
    refused: u64,
    /// Since when it has been refused, and when last.
    refusals: Option<Instant>,
}

impl Answers {
    pub(super) fn look(&mut self, now: Instant, host: &Host) -> Option<StrategyFault> {
        let (refused, error) = host.refused_answers();
        if refused > self.refused {
            (self.refused, self.refusals) = (refused, Some(now));
        }
        let lately = self.refusals.is_some_and(|at| now.since(at) < ANSWERS_WITHIN);
        if let (true, Some(error)) = (lately, error) {
            return Some(StrategyFault::Refused { answers: refused, reason: error.to_string() });
        }
        let (since, ever) = host.unanswered(now)?;
        (since >= ANSWERS_WITHIN).then_some(StrategyFault::Silent { since, ever })
    }
}
