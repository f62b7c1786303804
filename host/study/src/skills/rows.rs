//! `rows`: tries of each skill as a table, its JSON keys the command line's contract.

use serde::Serialize;

use super::{SkillPlan, TryResult};

/// Success rate and times of a skill.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SkillRow {
    /// The skill's name, as `--skill` takes it.
    pub skill: &'static str,
    /// League, by name: field and robots.
    pub league: String,
    /// Worlds, as they were asked for.
    pub world: String,
    /// Number of worlds in which it was tried.
    pub worlds: usize,
    /// Number of tries in all worlds.
    pub tries: usize,
    /// Number of tries that succeeded.
    pub succeeded: usize,
    /// Half of those that succeeded took no longer, simulated s; none where none did.
    pub time_median_s: Option<f64>,
    /// Nineteen in twenty of those that succeeded took no longer, simulated s.
    pub time_p95_s: Option<f64>,
}

/// A row a skill, over all worlds of the plan.
pub fn rows(plan: &SkillPlan, results: &[TryResult]) -> Vec<SkillRow> {
    let row = |skill: super::Skill| {
        let of: Vec<_> = results.iter().filter(|result| result.tried.skill == skill).collect();
        let mut times: Vec<f32> = of.iter().filter_map(|result| result.end.as_ref().ok().copied()).collect();
        times.sort_by(f32::total_cmp);
        SkillRow {
            skill: skill.label(),
            league: plan.league.name().to_owned(),
            world: plan.world.clone(),
            worlds: plan.worlds.len(),
            tries: of.len(),
            succeeded: times.len(),
            time_median_s: quantile(&times, 0.5),
            time_p95_s: quantile(&times, 0.95),
        }
    };
    plan.skills.iter().copied().map(row).collect()
}

/// The least of sorted times that this share does not exceed, in whole hundredths of a second.
fn quantile(sorted: &[f32], share: f64) -> Option<f64> {
    let place = (share * sorted.len() as f64).ceil() as usize;
    let time = sorted.get(place.max(1) - 1)?;
    Some((f64::from(*time) * 100.0).round() / 100.0)
}

#[cfg(test)]
mod tests {
    use super::quantile;

    #[test]
    fn a_quantile_is_a_time_that_occurred() {
        let times = [1.0, 2.0, 3.0, 4.0];
        assert_eq!(quantile(&times, 0.5), Some(2.0));
        assert_eq!(quantile(&times, 0.95), Some(4.0));
        assert_eq!(quantile(&[], 0.5), None);
    }
}
