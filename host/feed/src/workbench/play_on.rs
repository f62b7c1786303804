//! `play_on`: a moment played on several times with different seeds, as `onetwo play --from FILE --at SECONDS
//! --tries N` does.

use std::sync::Arc;

use arena::game::{GameConfig, TryOutcome, tries};
use serde_json::{Value, json};

use super::asked::PlayOnPlan;
use super::course::{Course, Finished};
use crate::MomentSource;

/// Length of a try, simulated s: an attack, and the counter-attack after it.
const TRY_S: f64 = 20.0;

/// Tries that are being played, or were.
pub(super) struct PlayOn {
    plan: PlayOnPlan,
    pub(super) course: Arc<Course<TryOutcome>>,
}

impl PlayOn {
    pub(super) fn begin(source: MomentSource, plan: PlayOnPlan) -> Result<Self, String> {
        // The match that runs goes on: its moment is taken now. A recording may be long: on the thread.
        let config =
            matches!(source, MomentSource::Match(_)).then(|| source.config(plan.at, TRY_S)).transpose()?;
        let course = Course::start("play on", move |course| {
            let config = config.map_or_else(|| source.config(plan.at, TRY_S), Ok)?;
            play(course, plan, &config)
        });
        Ok(Self { plan, course: course? })
    }

    pub(super) fn report(&self) -> Value {
        let Finished { results, error, over } = &*self.course.finished();
        let PlayOnPlan { at, tries, .. } = self.plan;
        json!({ "at": at, "tries": tries, "seconds": TRY_S, "over": over, "error": error, "outcomes": results })
    }
}

fn play(course: &Course<TryOutcome>, plan: PlayOnPlan, config: &GameConfig) -> Result<(), String> {
    for number in 0..u64::from(plan.tries) {
        let config = GameConfig { seed: plan.seed.wrapping_add(number), ..config.clone() };
        let outcomes =
            tries(&config, 1, || course.is_stopped(), |_| {}).map_err(|error| error.to_string())?;
        if outcomes.is_empty() {
            break;
        }
        course.finished().results.extend(outcomes);
    }
    Ok(())
}
