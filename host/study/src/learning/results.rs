//! `results`: what a run of learning has found.

use arena::Profile;
use hil_sim::Scenario;
use serde::Serialize;

use crate::learning::betting::Wager;
use crate::learning::diff::diff;
use crate::learning::evidence::Evidence;
use crate::learning::paired::{Pairs, WorldPairs};
use crate::learning::plays::PlayToWatch;
use crate::learning::proposals::{Proposal, TRIED_MAX, Tried, text_hash};
use crate::learning::settings::LearnSettings;
use crate::learning::starts::{KINDS, StartKind, kind_of};
use crate::learning::trial::LearningTrial;
use crate::learning::variant::Variant;

geometry::labels! {
    /// Verdict on a proposal; the label is that of the report.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum Verdict {
        /// Proposed in a run that changes nothing.
        Proposed = "proposed",
        /// Play changes in hardly any situation.
        Rare = "rarely played",
        /// Others were better in the first situations.
        ScreenedOut = "screened out",
        /// The sequential test did not reach its threshold.
        Unconfirmed = "not confirmed",
        /// No longer applicable to the library after the changes before it.
        Superseded = "superseded",
        /// `cases check` would warn.
        Warned = "warned",
        /// The result is lower in a kind of validation starts, or in all of a world together.
        Lowers = "lowers",
        /// On validation starts of a world the opponents touch the ball more often with it, and its gain
        /// there may be chance.
        Touches = "more touches",
        /// Taken over into the learned library.
        Accepted = "accepted",
    }
}

/// Pairs on validation starts, or of whole matches.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Validation {
    /// All of them.
    pub all: Wager,
    /// Pairs by kind of start or by opponent, with its name.
    pub kinds: Vec<(String, Wager)>,
    /// Pairs of trials as in the paper's simulator and as by its robots; empty for matches.
    pub worlds: Vec<WorldPairs>,
}

impl From<&Pairs> for Validation {
    fn from(pairs: &Pairs) -> Self {
        let kinds = KINDS.iter().zip(pairs.kinds).map(|(kind, wager)| (kind.label(), wager));
        Self { all: pairs.all, kinds: kinds.collect(), worlds: pairs.worlds.to_vec() }
    }
}

/// A proposal and its evidence.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ChangeRecord {
    /// The round, from 1.
    pub round: u32,
    /// The change.
    pub proposal: Proposal,
    /// Pairs: whole trials of the test, or situations that it changes what is played in where it was
    /// screened alone.
    pub wager: Wager,
    /// The share of such situations among those of play.
    pub share: f64,
    /// The e-value that the test needed; none where it was not tested.
    pub needed: Option<f64>,
    /// Verdict on it.
    pub verdict: Verdict,
    /// Pairs on validation starts.
    pub validation: Option<Validation>,
}

/// The library after a round, on held-out starts.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CurvePoint {
    /// The round, 0 before the first.
    pub round: u32,
    /// Trials so far.
    pub spent: u64,
    /// Held-out starts.
    pub starts: u32,
    /// Share of these with the ball in or close to the goal, percent.
    pub to_goal: f64,
    /// Share to goal of random starts alone, percent.
    pub to_goal_random: f64,
    /// Share to goal of the starts that are played as by the paper's robots; none where a run has no such.
    pub to_goal_robots: Option<f64>,
    /// Touches of the opponents, a trial.
    pub touches: f64,
}

impl CurvePoint {
    /// The measures of trials on held-out starts with these indices.
    pub(crate) fn of(round: u32, spent: u64, indices: &[u32], trials: &[LearningTrial]) -> Self {
        let to_goal = |of: &dyn Fn(StartKind) -> bool| {
            let own = indices.iter().zip(trials).filter(|(index, _)| of(KINDS[kind_of(**index).0]));
            let own: Vec<bool> = own.map(|(_, trial)| trial.to_goal()).collect();
            let goals = own.iter().filter(|to_goal| **to_goal).count();
            (!own.is_empty()).then(|| 100.0 * goals as f64 / own.len() as f64)
        };
        let touches: u64 = trials.iter().map(|trial| u64::from(trial.touches)).sum();
        Self {
            round,
            spent,
            starts: trials.len() as u32,
            to_goal: to_goal(&|_| true).unwrap_or_default(),
            to_goal_random: to_goal(&|kind| kind.scenario == Scenario::Random).unwrap_or_default(),
            to_goal_robots: to_goal(&|kind| kind.profile == Profile::Robots),
            touches: touches as f64 / trials.len().max(1) as f64,
        }
    }
}

/// Notes what became of the changes of a round. A test or the lack of situations is final; screening may have
/// been bad luck.
pub(crate) fn note_tried(tried: &mut Tried, current: &Variant, changes: &[ChangeRecord]) {
    for ChangeRecord { proposal: Proposal { edit, .. }, verdict, .. } in changes {
        let times = tried.entry((text_hash(current, &edit.case), edit.clone())).or_default();
        *times = if *verdict == Verdict::ScreenedOut { *times + 1 } else { TRIED_MAX };
    }
}

/// Result of a run.
#[derive(Clone, Debug)]
pub struct Learned {
    /// Settings of the run.
    pub settings: LearnSettings,
    /// The library before.
    pub start: Variant,
    /// The library after.
    pub end: Variant,
    /// The evidence, that of earlier play included.
    pub evidence: Evidence,
    /// Every proposal, in the order of decisions.
    pub changes: Vec<ChangeRecord>,
    /// The learning curve.
    pub curve: Vec<CurvePoint>,
    /// Held-out starts that only the learned library brings to goal.
    pub plays: Vec<PlayToWatch>,
    /// Trials that it took.
    pub spent: u64,
    /// Sequential tests among them.
    pub tests: u32,
    /// The opponents of matches; empty where trials were played.
    pub opponents: Vec<String>,
}

impl Learned {
    /// The changes that are in the learned library.
    pub fn accepted(&self) -> impl Iterator<Item = &ChangeRecord> {
        self.changes.iter().filter(|change| change.verdict == Verdict::Accepted)
    }

    /// Name of the units that were played, which a budget counts.
    pub fn played(&self) -> &'static str {
        if self.opponents.is_empty() { "trials" } else { "scenes" }
    }

    /// Differences of the learned library in files and lines, as a unified diff.
    pub fn diff(&self) -> String {
        diff(&self.start.files, &self.end.files)
    }
}
