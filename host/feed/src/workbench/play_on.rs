//! `play_on`: a moment played on several times with different seeds, one after the other on a thread of its
//! own, as `onetwo play --from FILE --at SECONDS --tries N` does.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;

use arena::game::{GameConfig, TryOutcome, tries};
use serde_json::{Value, json};

use super::asked::PlayOnPlan;
use crate::MomentSource;

/// Length of a try, simulated s: an attack, and the counter-attack after it.
const TRY_S: f64 = 20.0;

/// Tries that are being played, or were.
pub(super) struct PlayOn {
    plan: PlayOnPlan,
    stopped: AtomicBool,
    course: Mutex<Course>,
}

#[derive(Default)]
struct Course {
    outcomes: Vec<TryOutcome>,
    error: Option<String>,
    over: bool,
}

/// Ends the tries, however their thread ends.
struct End<'t>(&'t PlayOn);

impl Drop for End<'_> {
    fn drop(&mut self) {
        self.0.course().over = true;
    }
}

impl PlayOn {
    pub(super) fn begin(source: MomentSource, plan: PlayOnPlan) -> Result<Arc<Self>, String> {
        let (stopped, course) = (AtomicBool::new(false), Mutex::default());
        // The match that runs goes on: its moment is taken now. A recording may be long: on the thread.
        let config =
            matches!(source, MomentSource::Match(_)).then(|| source.config(plan.at, TRY_S)).transpose()?;
        let play_on = Arc::new(Self { plan, stopped, course });
        let played = play_on.clone();
        let worker = thread::Builder::new().name("play on".to_owned());
        let spawned = worker.spawn(move || {
            let _end = End(&played);
            let config = config.map_or_else(|| source.config(played.plan.at, TRY_S), Ok);
            if let Err(error) = config.and_then(|config| played.play(&config)) {
                played.course().error = Some(error);
            }
        });
        spawned.map_err(|error| format!("no thread for the tries: {error}"))?;
        Ok(play_on)
    }

    fn play(&self, config: &GameConfig) -> Result<(), String> {
        for number in 0..u64::from(self.plan.tries) {
            let config = GameConfig { seed: self.plan.seed.wrapping_add(number), ..config.clone() };
            let played = tries(&config, 1, || self.stopped.load(Ordering::Relaxed), |_| {});
            let outcomes = played.map_err(|error| error.to_string())?;
            if outcomes.is_empty() {
                break;
            }
            self.course().outcomes.extend(outcomes);
        }
        Ok(())
    }

    fn course(&self) -> MutexGuard<'_, Course> {
        self.course.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub(super) fn stop(&self) {
        self.stopped.store(true, Ordering::Relaxed);
    }

    pub(super) fn report(&self) -> Value {
        let Course { outcomes, error, over } = &*self.course();
        let PlayOnPlan { at, tries, .. } = self.plan;
        json!({ "at": at, "tries": tries, "seconds": TRY_S, "over": over, "error": error, "outcomes": outcomes })
    }
}
