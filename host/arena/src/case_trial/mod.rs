//! `case_trial`: self-test of a case. It is played from its own situation, many times, by real brains that
//! must retrieve it themselves.
//!
//! Only the robots of the case are on the field: near their places, the opponents on their scopes
//! ([`situation`]). An attempt ends with the first retrieval's gameplay; then the ball is watched until it
//! stops or is taken. m, s; every attempt attacks +x.
//!
//! **Invariants.** An attempt depends only on its seed, the case's name and the attempt's number: neither on
//! other cases of the library nor on the number of threads.

mod course;
mod four_legged;
mod score;
mod situation;
mod small_size;

pub use score::{Score, markdown};

use casebase::{Case, CaseBase, GoalEnd, RetrievalSettings};
use hil_sim::{Fnv, SimulationError, TrialOutcome};
use rayon::prelude::*;
use rules::League;

use crate::cycles::CycleEnd;
use crate::game::GameError;
use crate::names::CaseNames;
use crate::recording::RecordedSample;

geometry::labels! {
    /// Behaviour of the opponents of a case.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum Opposition {
        /// Opponents hold their places: bodies that obstruct.
        Standing = "standing",
        /// Opponents play: the paper's scripted ones in the four-legged league, a reactive team in the Small
        /// Size League.
        Playing = "playing",
    }
}

/// Result of the first retrieval of an attempt.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Retrieved {
    /// The tested case, in any of its symmetries.
    Own,
    /// Another case, by name `region/name`.
    Other(String),
    /// The coordinator reported that no case fits.
    None,
    /// No decision was received in time.
    Nothing,
}

/// Result of one attempt.
#[derive(Clone, Debug, PartialEq)]
pub struct Attempt {
    /// The first case that the robots retrieved.
    pub retrieved: Retrieved,
    /// End of the gameplay, where the tested case was retrieved.
    pub end: Option<CycleEnd>,
    /// Seconds from the retrieval to that end.
    pub duration: f32,
    /// The outcome that the referee would have given a trial until the ball lay still or was taken; `None`:
    /// it is still in play.
    pub outcome: Option<TrialOutcome>,
    /// Distance that the ball came towards the attacked goal meanwhile, m.
    pub progress: f32,
}

impl Attempt {
    /// The gameplay was retrieved and played to its end.
    pub fn completed(&self) -> bool {
        self.end.is_some_and(|end| end.label() == "finished")
    }
}

/// An attempt as it went.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tape {
    /// Events, a line each.
    pub story: Vec<String>,
    /// Ball and robots, oldest first: those of the case in its order, then the opponents.
    pub samples: Vec<RecordedSample>,
}

/// Settings of a case self-test.
#[derive(Clone, Debug)]
pub struct CaseTrial<'a> {
    /// The league whose field, robots and simulator are used.
    pub league: League,
    /// The case base in every robot.
    pub base: CaseBase<'a>,
    /// Names of its cases.
    pub names: CaseNames,
    /// Settings of case retrieval (docs/case-format.md §3.2).
    pub settings: RetrievalSettings,
    /// Number of attempts for each case.
    pub trials: u32,
    /// Random seed of all attempts; each attempt's own is derived from it.
    pub seed: u64,
}

impl<'a> CaseTrial<'a> {
    /// The stored case that stands for the authored case number `authored`: the copy that attacks +x with its
    /// sides unswapped.
    pub fn case(&self, authored: usize) -> Option<Case<'a>> {
        self.base.cases().find(|case| case.authored() == authored && case.defending() == GoalEnd::Negative)
    }

    /// All attempts of one case, on all threads, in the order of their numbers; `done` is called after each.
    pub fn play(
        &self,
        case: &Case<'a>,
        opposition: Opposition,
        done: &(dyn Fn() + Sync),
    ) -> Result<Vec<Attempt>, AttemptError> {
        let attempt = |number| {
            let attempt = self.attempt(case, opposition, number, None);
            done();
            attempt
        };
        (0..self.trials).into_par_iter().map(attempt).collect()
    }

    /// Plays attempt `number` of a case against `opposition`, and keeps it on `tape`.
    pub fn attempt(
        &self,
        case: &Case<'a>,
        opposition: Opposition,
        number: u32,
        tape: Option<&mut Tape>,
    ) -> Result<Attempt, AttemptError> {
        let mut hash = Fnv::default();
        hash.add(self.names.of(case.id()).as_bytes());
        hash.add(&self.seed.to_le_bytes());
        hash.add(&number.to_le_bytes());
        let seed = hash.value();
        if self.league == League::FourLegged {
            four_legged::attempt(self, case, opposition, seed, tape).map_err(AttemptError::FourLegged)
        } else {
            small_size::attempt(self, case, opposition, seed, tape).map_err(AttemptError::SmallSize)
        }
    }
}

/// Error that keeps an attempt from being played.
#[derive(Debug, thiserror::Error)]
#[error(transparent)]
pub enum AttemptError {
    /// The four-legged league's simulator failed.
    FourLegged(SimulationError),
    /// The Small Size League's simulator failed.
    SmallSize(GameError),
}

#[cfg(test)]
mod tests;
