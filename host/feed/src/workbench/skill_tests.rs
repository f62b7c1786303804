//! `skill_tests`: tries of a single skill beside the match, one after the other on a thread of their own, as
//! `onetwo evaluate skills` plays them.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;

use hil_sim::small_size::worlds::WorldChoice;
use serde_json::{Value, json};
use study::skills::{Skill, SkillPlan, TryResult, rows};

/// Failed tries that are told.
const FAILURES_MAX: usize = 10;

/// Tries that are being played, or were.
pub(super) struct SkillTests {
    plan: SkillPlan,
    stopped: AtomicBool,
    course: Mutex<Course>,
}

#[derive(Default)]
struct Course {
    results: Vec<TryResult>,
    error: Option<String>,
    over: bool,
}

/// Ends the tries, however their thread ends.
struct End<'t>(&'t SkillTests);

impl Drop for End<'_> {
    fn drop(&mut self) {
        self.0.course().over = true;
    }
}

impl SkillTests {
    /// Skills that can be tried, and the worlds to try them in.
    pub(super) fn choices() -> Value {
        json!({ "skills": Skill::ALL.map(Skill::label), "worlds": WorldChoice::names().collect::<Vec<_>>() })
    }

    pub(super) fn begin(plan: SkillPlan) -> Result<Arc<Self>, String> {
        let (stopped, course) = (AtomicBool::new(false), Mutex::default());
        let tests = Arc::new(Self { plan, stopped, course });
        let played = tests.clone();
        let work = move || {
            let _end = End(&played);
            for tried in played.plan.tries() {
                if played.stopped.load(Ordering::Relaxed) {
                    break;
                }
                match tried.play(&mut Vec::new()) {
                    Ok(result) => played.course().results.push(result),
                    Err(error) => {
                        played.course().error = Some(error.to_string());
                        break;
                    }
                }
            }
        };
        let worker = thread::Builder::new().name("skill tests".to_owned());
        worker.spawn(work).map_err(|error| format!("no thread for the tries: {error}"))?;
        Ok(tests)
    }

    fn course(&self) -> MutexGuard<'_, Course> {
        self.course.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub(super) fn stop(&self) {
        self.stopped.store(true, Ordering::Relaxed);
    }

    pub(super) fn report(&self) -> Value {
        let course = self.course();
        let failed = course.results.iter().filter_map(|result| {
            let what = result.end.as_ref().err()?;
            Some(json!({ "number": result.tried.number, "start": result.start, "what": what, "command": result.tried.command() }))
        });
        json!({
            "tries": self.plan.tries,
            "over": course.over,
            "error": course.error,
            "row": rows(&self.plan, &course.results).first(),
            "failed": failed.take(FAILURES_MAX).collect::<Vec<_>>(),
        })
    }
}
