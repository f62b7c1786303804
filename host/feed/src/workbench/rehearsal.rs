//! `rehearsal`: many attempts of a draft in its league's simulator, one after the other on a thread of their
//! own, beside the match.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;

use arena::cases::league_of;
use arena::{Attempt, CaseNames, CaseTrial, Opposition, Retrieved, Score, Tape};
use case_tools::Library;
use casebase::RetrievalSettings;
use page::milli;
use serde_json::{Value, json};

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
    stopped: AtomicBool,
    course: Mutex<Course>,
}

/// Ends a rehearsal, however its thread ends.
struct End<'r>(&'r Rehearsal);

impl Drop for End<'_> {
    fn drop(&mut self) {
        self.0.course().over = true;
    }
}

#[derive(Default)]
struct Course {
    attempts: Vec<(Attempt, Tape)>,
    error: Option<String>,
    over: bool,
}

impl Rehearsal {
    pub(super) fn begin(library: Library, order: RehearsalOrder) -> Result<Arc<Self>, String> {
        let authored = library.names.iter().position(|name| *name == order.name);
        let authored = authored.ok_or("the library does not hold the case")?;
        let base = library.base();
        let league =
            league_of(base.field(), &library.league).ok_or("no simulator has the field of this library")?;
        let ours = base.case(protocol::CaseId(4 * authored as u16)).map_or(0, |case| case.teammates());
        let (stopped, course) = (AtomicBool::new(false), Mutex::default());
        let rehearsal = Arc::new(Self { order, ours, stopped, course });
        let played = rehearsal.clone();
        let worker = thread::Builder::new().name("rehearsal".to_owned());
        let work = move || {
            let _end = End(&played);
            let order = &played.order;
            let case_trial = CaseTrial {
                league,
                base: library.base(),
                names: CaseNames::new(library.names.clone()),
                settings: order.settings.clone(),
                trials: order.trials,
                seed: order.seed,
            };
            if let Some(case) = case_trial.case(authored) {
                for number in 0..order.trials {
                    if played.stopped.load(Ordering::Relaxed) {
                        break;
                    }
                    let mut tape = Tape::default();
                    match case_trial.attempt(&case, order.opponents, number, Some(&mut tape)) {
                        Ok(attempt) => played.course().attempts.push((attempt, tape)),
                        Err(error) => {
                            played.course().error = Some(error.to_string());
                            break;
                        }
                    }
                }
            }
        };
        worker.spawn(work).map_err(|error| format!("no thread for the rehearsal: {error}"))?;
        Ok(rehearsal)
    }

    fn course(&self) -> std::sync::MutexGuard<'_, Course> {
        self.course.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub(super) fn stop(&self) {
        self.stopped.store(true, Ordering::Relaxed);
    }

    pub(super) fn report(&self) -> Value {
        let course = self.course();
        let attempts: Vec<_> = course.attempts.iter().map(|(attempt, _)| attempt.clone()).collect();
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
        let course = self.course();
        let (attempt, tape) = course.attempts.get(number as usize)?;
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
