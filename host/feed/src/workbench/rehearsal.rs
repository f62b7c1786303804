//! `rehearsal`: many attempts of a draft in its league's simulator.

use std::sync::Arc;

use arena::cases::league_of;
use arena::{Attempt, CaseNames, CaseTrial, Opposition, Retrieved, Score, Tape};
use case_tools::Library;
use casebase::RetrievalSettings;
use page::milli;
use serde_json::{Value, json};

use super::course::Course;

/// Attempts that are offered to be watched.
const SAMPLES_MAX: usize = 3;

/// The case that is rehearsed, and how often.
pub(super) struct RehearsalOrder {
    pub(super) name: String,
    pub(super) trials: u32,
    pub(super) opponents: Opposition,
    pub(super) seed: u64,
    pub(super) settings: RetrievalSettings,
}

/// Attempts that are being played, or were.
pub(super) struct Rehearsal {
    order: RehearsalOrder,
    /// Number of robots of the case.
    ours: usize,
    pub(super) course: Arc<Course<(Attempt, Tape)>>,
}

impl Rehearsal {
    pub(super) fn begin(library: Library, order: RehearsalOrder) -> Result<Self, String> {
        let authored = library.names.iter().position(|name| *name == order.name);
        let authored = authored.ok_or("the library does not hold the case")?;
        let base = library.base();
        let league =
            league_of(base.field(), &library.league).ok_or("no simulator has the field of this library")?;
        let ours = base.case(protocol::CaseId(4 * authored as u16)).map_or(0, |case| case.teammates());
        let RehearsalOrder { trials, opponents, seed, .. } = order;
        let settings = order.settings.clone();
        let course = Course::start("rehearsal", move |course| {
            let names = CaseNames::new(library.names.clone());
            let case_trial = CaseTrial { league, base: library.base(), names, settings, trials, seed };
            let Some(case) = case_trial.case(authored) else { return Ok(()) };
            for number in 0..trials {
                if course.is_stopped() {
                    break;
                }
                let mut tape = Tape::default();
                let attempt = case_trial.attempt(&case, opponents, number, Some(&mut tape));
                course.finished().results.push((attempt.map_err(|error| error.to_string())?, tape));
            }
            Ok(())
        });
        Ok(Self { order, ours, course: course? })
    }

    pub(super) fn report(&self) -> Value {
        let course = self.course.finished();
        let attempts: Vec<_> = course.results.iter().map(|(attempt, _)| attempt.clone()).collect();
        let score = Score::of(self.order.name.clone(), self.order.opponents.label(), &attempts);
        json!({
            "name": self.order.name,
            "trials": self.order.trials,
            "done": attempts.len(),
            "seed": self.order.seed,
            "over": course.over,
            "error": course.error,
            "score": score,
            "samples": samples(&attempts),
        })
    }

    /// One attempt, to be watched: m, rad, s; attacked is +x.
    pub(super) fn sample(&self, number: u32) -> Option<Value> {
        let course = self.course.finished();
        let (attempt, tape) = course.results.get(number as usize)?;
        let begun = tape.samples.first()?.time;
        let moments: Vec<Value> = tape
            .samples
            .iter()
            .map(|sample| {
                let robot = |pose: &geometry::Pose<geometry::Field>| {
                    let (at, heading) = (pose.position, pose.heading.radians());
                    [at.x(), at.y(), heading].map(milli)
                };
                let robots: Vec<_> = sample.robots.iter().map(robot).collect();
                json!({
                    "t": milli(sample.time - begun),
                    "ball": [milli(sample.ball.x()), milli(sample.ball.y())],
                    "robots": robots,
                })
            })
            .collect();
        let (result, story) = (result_of(attempt), &tape.story);
        Some(
            json!({ "number": number, "result": result, "ours": self.ours, "moments": moments, "story": story }),
        )
    }
}

/// Attempts to be watched: as different results as there are, the first of each.
fn samples(attempts: &[Attempt]) -> Vec<Value> {
    let results: Vec<_> = attempts.iter().map(result_of).collect();
    let first = |number: &usize| !results[..*number].contains(&results[*number]);
    let (mut chosen, others): (Vec<usize>, Vec<usize>) = (0..attempts.len()).partition(first);
    chosen.extend(others);
    chosen.truncate(SAMPLES_MAX);
    chosen.sort_unstable();
    chosen.into_iter().map(|number| json!({ "number": number, "result": results[number] })).collect()
}

fn result_of(attempt: &Attempt) -> String {
    match (&attempt.retrieved, attempt.end) {
        (Retrieved::Own, _) if attempt.completed() => {
            let outcome = attempt.outcome.map_or("in play", hil_sim::TrialOutcome::label);
            format!("completed, then {outcome}")
        }
        (Retrieved::Own, Some(end)) => format!("broken off: {}", end.label()),
        (Retrieved::Own, None) => "still played".to_owned(),
        (Retrieved::Other(name), _) => format!("{name} was retrieved instead"),
        (Retrieved::None, _) => "no case was retrieved".to_owned(),
        (Retrieved::Nothing, _) => "nothing was decided".to_owned(),
    }
}
