//! `case_trial`: self-test of a case. It is played from its own situation, many times, by real brains that
//! must retrieve it themselves.
//!
//! Only the robots of the case are on the field: near their places, the opponents on their scopes
//! ([`situation`]). An attempt ends with the first retrieval's gameplay; then the ball is watched until it
//! stops or is taken. m, s; every attempt attacks +x.
//!
//! **Invariants.** An attempt depends only on its seed, the case's name and the attempt's number: neither on
//! other cases of the library nor on the number of threads.

mod score;
mod situation;

pub use score::{Score, markdown};

use brain::Approach;
use casebase::{Case, CaseBase, GoalEnd, RetrievalSettings};
use geometry::Vector;
use hil_sim::four_legged::world::WorldEvent;
use hil_sim::{
    Configuration, Fnv, Layout, NativeBackend, Parameters, Scenario, SimulationError, TrialOutcome,
    TrialVerdict,
};
use rayon::prelude::*;

use crate::cycles::{CycleEnd, CycleSeen};
use crate::names::CaseNames;
use crate::trial::{Game, TrialConfig, Watcher};

hil_sim::labels! {
    /// What the opponents of a case do.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum Opposition {
        /// They hold their places: bodies that obstruct.
        Standing = "standing",
        /// They play as the paper's scripted ones.
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
    /// How the gameplay ended, where the tested case was retrieved.
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

/// Settings of a case self-test.
#[derive(Clone, Debug)]
pub struct CaseTrial<'a> {
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
    ) -> Result<Vec<Attempt>, SimulationError> {
        let attempt = |number| {
            let attempt = self.attempt(case, opposition, number, &mut []);
            done();
            attempt
        };
        (0..self.trials).into_par_iter().map(attempt).collect()
    }

    /// Plays attempt `number` of a case against `opposition`.
    pub fn attempt(
        &self,
        case: &Case<'a>,
        opposition: Opposition,
        number: u32,
        watchers: &mut [&mut dyn Watcher],
    ) -> Result<Attempt, SimulationError> {
        let config = self.trial(case, opposition, number);
        let mut game = Game::new(&config, Box::new(NativeBackend::new(self.base)))?;
        let start = game.moment().world.ball.position;
        let mut course = Course::default();
        while !course.over(&game, case) {
            game.step(watchers)?;
        }
        let moment = game.moment();
        let verdict = moment.referee.verdict();
        let attempt = Attempt {
            retrieved: course.retrieved(moment.cycles.cycles(), case, &self.names),
            end: course.end.map(|(_, end)| end),
            duration: course.end.map_or(0.0, |(at, _)| at - course.began),
            outcome: verdict.map(|verdict| verdict.outcome),
            progress: moment.world.ball.position.x() - start.x(),
        };
        let last = TrialVerdict { outcome: TrialOutcome::Timeout, time: moment.tick.time };
        game.end(verdict.unwrap_or(last), watchers);
        Ok(attempt)
    }

    fn trial(&self, case: &Case<'a>, opposition: Opposition, number: u32) -> TrialConfig<'a> {
        let mut hash = Fnv::default();
        hash.add(self.names.of(case.id()).as_bytes());
        hash.add(&self.seed.to_le_bytes());
        hash.add(&number.to_le_bytes());
        let seed = hash.value();
        let parameters = Parameters::four_legged();
        let layout: Layout = situation::draw(case, opposition, parameters, seed);
        TrialConfig {
            layout: Some(layout),
            robots: case.teammates(),
            retrievers: case.teammates(),
            settings: self.settings.clone(),
            // The referee detects goals at the goal line and catches by the goalie.
            ..TrialConfig::new(Scenario::Random, Configuration::DefenderGoalie, Approach::Cases, seed)
        }
        .with_library(self.base, self.names.clone())
    }
}

/// Progress of an attempt.
#[derive(Clone, Debug, Default)]
struct Course {
    /// The first decision's place in the list of cycles.
    first: Option<usize>,
    began: f32,
    end: Option<(f32, CycleEnd)>,
}

impl Course {
    /// Evaluates the last tick; true if the attempt is over.
    fn over(&mut self, game: &Game<'_, '_>, case: &Case<'_>) -> bool {
        let moment = game.moment();
        let (now, cycles) = (moment.tick.time, moment.cycles.cycles());
        let verdict = moment.referee.verdict();
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
            let trial_over = verdict.is_some_and(|verdict| now > verdict.time + LAST_DESCRIPTION);
            let given_up = now > self.began + GIVEN_UP_AFTER;
            self.end = cycle.end.or((trial_over || given_up).then_some((now, CycleEnd::TrialOver)));
        }
        let Some((ended, _)) = self.end else { return false };
        let taken = moment.tick.events.iter().any(|(_, event)| matches!(event, WorldEvent::Grabbed { .. }));
        let still = moment.world.ball.velocity == Vector::default();
        verdict.is_some() || taken || still || now > ended + WATCHED_FOR
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

#[cfg(test)]
mod tests;
