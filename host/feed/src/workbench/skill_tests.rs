//! `skill_tests`: tries of a single skill, as `onetwo evaluate skills` plays them.

use std::sync::Arc;

use hil_sim::small_size::worlds::WorldChoice;
use serde_json::{Value, json};
use study::skills::{Skill, SkillPlan, TryResult, rows};

use super::course::Course;

/// Failed tries that are told.
const FAILURES_MAX: usize = 10;

/// Tries that are being played, or were.
pub(super) struct SkillTests {
    plan: SkillPlan,
    pub(super) course: Arc<Course<TryResult>>,
}

impl SkillTests {
    /// Skills that can be tried, and the worlds to try them in.
    pub(super) fn choices() -> Value {
        json!({ "skills": Skill::ALL.map(Skill::label), "worlds": WorldChoice::names().collect::<Vec<_>>() })
    }

    pub(super) fn begin(plan: SkillPlan) -> Result<Self, String> {
        let tries = plan.tries();
        let course = Course::start("skill tests", move |course| {
            for tried in tries {
                if course.is_stopped() {
                    break;
                }
                let result = tried.play(&mut Vec::new()).map_err(|error| error.to_string())?;
                course.finished().results.push(result);
            }
            Ok(())
        });
        Ok(Self { plan, course: course? })
    }

    pub(super) fn report(&self) -> Value {
        let course = self.course.finished();
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
