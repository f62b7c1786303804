//! `effect`: what a part of the play is worth in scenes: differences of pairs, their intervals and tests, and
//! the smallest effect that as many pairs could have shown.

use serde::Serialize;

use super::{SceneKind, SceneOutcome, ScenePlan, SceneRow};
use crate::matches::MatchTeam;
use crate::statistics::{Count, PairedMeans, PairedShares, detectable, student};

geometry::labels! {
    /// Measure that is compared.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum SceneMeasure {
        /// Share of scenes with a shot of ours.
        Shot = "shot",
        /// Share of scenes with a goal of ours.
        Goal = "goal",
        /// Goals for less goals against, a scene.
        NetGoals = "goals for − against",
    }
}

impl SceneMeasure {
    fn of(self, outcome: SceneOutcome) -> f64 {
        let one = |happened: bool| f64::from(u8::from(happened));
        match self {
            Self::Shot => one(outcome.shot),
            Self::Goal => one(outcome.goal),
            Self::NetGoals => one(outcome.goal) - one(outcome.goal_against),
        }
    }
}

/// Effect of a part on one measure, in scenes of one kind against one opponent, or against all.
#[derive(Clone, Debug, Serialize)]
pub struct SceneEffect {
    /// Kind of start.
    pub kind: SceneKind,
    /// The opponent; `None`: all together.
    pub opponent: Option<MatchTeam>,
    /// Name of the part; several with a `+` between.
    pub part: String,
    /// Measure that is compared.
    pub measure: SceneMeasure,
    /// Number of pairs in which both sides of the pair came into play.
    pub pairs: u32,
    /// Mean with the part.
    pub with: f64,
    /// Mean without it.
    pub without: f64,
    /// Student's 95 % interval of the difference; `None` of a single pair.
    pub interval: Option<[f64; 2]>,
    /// p: McNemar's exact test of a share, the paired t of goals.
    pub p: Option<f64>,
    /// Smallest difference that a test at 0.05 finds in 8 of 10 such samples: the differences of pairs spread
    /// as these did.
    pub detectable: Option<f64>,
    /// Scenes in which the planner's pass left, and those of them with a shot.
    pub planned: [u32; 2],
}

/// Effects of all parts, against each opponent and all together.
pub fn scene_effects(plan: &ScenePlan, rows: &[SceneRow]) -> Vec<SceneEffect> {
    let mut effects = Vec::new();
    for kind in [SceneKind::FreeKick, SceneKind::OpenPlay] {
        for variant in &plan.variants {
            let Some((part, has)) = variant.part_beside(plan.team) else { continue };
            let (with, without) = if has { (*variant, plan.team) } else { (plan.team, *variant) };
            for opponent in plan.opponents.iter().copied().map(Some).chain([None]) {
                let [with, without] = [with, without].map(|team| outcomes(rows, kind, opponent, team));
                let pairs: Vec<_> = with.zip(without).filter(|(a, b)| a.played && b.played).collect();
                let all = SceneMeasure::ALL.into_iter();
                effects.extend(all.filter_map(|measure| effect(measure, &pairs, (kind, opponent, &part))));
            }
        }
    }
    effects
}

/// Outcomes of a team's scenes of one kind against one opponent, or against all, in the plan's order.
fn outcomes(
    rows: &[SceneRow],
    kind: SceneKind,
    opponent: Option<MatchTeam>,
    team: MatchTeam,
) -> impl Iterator<Item = SceneOutcome> {
    let of_team = rows.iter().filter(move |row| {
        row.kind == kind && row.team == team && opponent.is_none_or(|opponent| row.opponent == opponent)
    });
    of_team.map(|row| row.outcome)
}

fn effect(
    measure: SceneMeasure,
    pairs: &[(SceneOutcome, SceneOutcome)],
    (kind, opponent, part): (SceneKind, Option<MatchTeam>, &str),
) -> Option<SceneEffect> {
    let values = pairs.iter().map(|&(with, without)| (measure.of(with), measure.of(without)));
    let means = PairedMeans::of(values.clone())?;
    let test = match measure {
        SceneMeasure::NetGoals => means.test(),
        SceneMeasure::Shot | SceneMeasure::Goal => {
            PairedShares::of(values.map(|(with, without)| (with > 0.0, without > 0.0))).test()
        }
    };
    let planned = pairs.iter().filter(|(with, _)| with.planned);
    Some(SceneEffect {
        kind,
        opponent,
        part: part.to_owned(),
        measure,
        pairs: means.differences.n,
        with: means.with.mean,
        without: means.without.mean,
        interval: student(means.differences, CONFIDENCE).map(|interval| [interval.low, interval.high]),
        p: test.map(|test| test.p),
        detectable: detectable(means.differences),
        planned: [planned.clone().count() as u32, planned.filter(|(with, _)| with.shot).count() as u32],
    })
}

impl SceneEffect {
    /// Scenes in which the planner's pass left, and those of them with a shot.
    pub fn planned_with_shot(&self) -> Count {
        Count { hits: self.planned[1], of: self.planned[0] }
    }
}

const CONFIDENCE: f64 = 0.95;

#[cfg(test)]
mod tests {
    use super::*;

    fn outcome(shot: bool, goal: bool, against: bool) -> SceneOutcome {
        SceneOutcome { played: true, shot, goal, goal_against: against, ..SceneOutcome::default() }
    }

    #[test]
    fn effects_of_pairs_are_those_computed_by_hand() {
        // Ten pairs: six with a shot on one side alone, five of them with the part; McNemar's exact p is
        // 2 · (1 + 6) / 2⁶ = 0.21875.
        let mut pairs = vec![(outcome(true, false, false), outcome(false, false, false)); 5];
        pairs.push((outcome(false, false, false), outcome(true, false, false)));
        pairs.extend(vec![(outcome(true, true, false), outcome(true, false, true)); 4]);
        let of = |measure| effect(measure, &pairs, (SceneKind::FreeKick, None, "coerce")).unwrap();
        let shot = of(SceneMeasure::Shot);
        assert_eq!((shot.pairs, shot.with, shot.without), (10, 0.9, 0.5));
        assert!((shot.p.unwrap() - 0.21875).abs() < 1e-12, "{shot:?}");
        // Differences: five times 1, once −1, four times 0: mean 0.4, variance (6 − 1.6) / 9.
        let sd = (4.4_f64 / 9.0).sqrt();
        assert!((shot.detectable.unwrap() - 2.802 * sd / 10.0_f64.sqrt()).abs() < 1e-12);
        let [low, high] = shot.interval.unwrap();
        // t(0.975, 9) = 2.2622.
        assert!((high - 0.4 - 2.2622 * sd / 10.0_f64.sqrt()).abs() < 1e-4 && (low + high - 0.8).abs() < 1e-9);
        let net = of(SceneMeasure::NetGoals);
        assert!((net.with - 0.4).abs() < 1e-12 && (net.without + 0.4).abs() < 1e-12, "{net:?}");
    }
}
