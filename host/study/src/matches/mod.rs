//! `matches`: match evaluation against other teams. Many matches, and the second paper's Table 2 of them
//! (Biswas et al. 2014 §6): offence ratio, attack ratio, goals, with intervals beside the paper's numbers.
//!
//! ```text
//! Plan ─► Matches::play_shard ─► trials-1-of-3.csv … ─► merge ─► rows ─► outcomes, effects ─► matches.json, text tables, plots
//! ```
//! Shards, files, resuming and merging are [`crate::store`]'s: equal plans give equal bytes for any number of
//! threads, shards and interrupts.

mod calibration;
mod case_table;
mod comparison;
mod description;
mod effect;
mod match_team;
mod outcome;
mod paper;
mod passes;
mod plan;
mod plot;
mod refusals;
mod row;

use casebase::{CaseBase, RetrievalSettings};
use hil_sim::NativeBackend;
use hil_sim::small_size::worlds::WorldPlan;
use host::shell::StrategyProcess;
use rules::Colour;
use serde::{Deserialize, Serialize};

pub use calibration::calibration_plot;
pub use case_table::case_table;
pub use comparison::{MatchComparison, check_same_matches, compare_matches};
pub use description::{AttackRow, attack_table, comparison_table, markdown, summary};
pub use effect::{Change, Effect, effects};
pub use match_team::MatchTeam;
pub use outcome::{Estimate, Outcome, our_passes, outcomes};
pub use paper::{PAPER, PAPER_PASSES, PaperGame, PaperPasses};
pub use passes::{Kicked, Passes, Share, Tenth};
pub use plan::{MatchPlan, Pairing, Planned};
pub use plot::plot;
pub use refusals::{Refusal, RefusalFile, RefusedAnswers};
pub use row::{MatchRow, MatchSide};

use crate::store::{Difference, EvaluationError, Experiment, StoredExperiment};
use arena::CaseNames;
use arena::game::{GameConfig, GameError, NoWatcher, play};
use hil_sim::small_size::network::ControllerChoice;

/// All settings that the matches of a plan depend on.
#[derive(Clone, Debug)]
pub struct Matches {
    /// The matches to be played.
    pub plan: MatchPlan,
    /// The case base in every robot, and in the hosts.
    pub base: CaseBase<'static>,
    /// Settings of case retrieval (docs/case-format.md §3.2).
    pub settings: RetrievalSettings,
    /// Version and commit of the program: matches of two programs are never mixed.
    pub program: String,
    /// Names of the cases.
    pub names: CaseNames,
    /// Where answers of a strategy that are refused are kept.
    pub refusals: Option<RefusalFile>,
}

/// Identity of the evaluation of a file of matches.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MatchIdentity {
    /// Version and commit of the program.
    pub program: String,
    /// Hash of the case base, 8 hexadecimal digits.
    pub case_base: String,
    /// Settings of retrieval that are not at their defaults, name and value.
    pub settings: Vec<(String, String)>,
    /// All matches of the evaluation, of all shards.
    pub plan: MatchPlan,
}

impl MatchIdentity {
    /// The settings in which the other differs; empty between equals.
    pub fn differences(&self, other: &Self) -> Vec<Difference> {
        let (own, theirs) = (&self.plan, &other.plan);
        let shown = |value: &str| value.to_owned();
        let differences = [
            Difference::of("program", (self.program.as_str(), other.program.as_str()), shown),
            Difference::of("cases", (self.case_base.as_str(), other.case_base.as_str()), shown),
            Difference::of("settings", (&self.settings, &other.settings), |settings| {
                let pairs: Vec<_> = settings.iter().map(|(name, value)| format!("{name}={value}")).collect();
                pairs.join(" ")
            }),
            Difference::of("seed", (&own.seed, &theirs.seed), u64::to_string),
            Difference::of("league", (own.league.as_str(), theirs.league.as_str()), shown),
            Difference::of("world", (&own.world, &theirs.world), WorldPlan::to_string),
            Difference::of("length of a match", (&own.duration_s, &theirs.duration_s), |s| format!("{s} s")),
            Difference::of("teams", (&own.pairings, &theirs.pairings), |pairings| {
                let pairs = pairings.iter().map(|Pairing { own, opponent }| format!("{own}:{opponent}"));
                pairs.collect::<Vec<_>>().join(" ")
            }),
            Difference::of("number of matches", (&own.matches, &theirs.matches), u32::to_string),
            Difference::of("strategy's command", (&own.strategy, &theirs.strategy), |command| {
                command.clone().unwrap_or_else(|| "none".to_owned())
            }),
            Difference::of("game controller", (&own.controller, &theirs.controller), |controller| {
                controller.clone().unwrap_or_else(|| "none".to_owned())
            }),
        ];
        differences.into_iter().flatten().collect()
    }
}

impl Matches {
    /// A match of the plan, ready to be played.
    pub fn config(&self, planned: &Planned) -> Result<GameConfig, EvaluationError> {
        let league = self.plan.league().ok_or(EvaluationError::Nothing)?;
        let (blue, yellow) = planned.sides();
        let config = GameConfig::new(league, planned.seed, self.plan.duration_s);
        let mut config = config.between(blue.team, yellow.team);
        config.world = self.plan.world.of_match(planned.seed);
        config.names = self.names.clone();
        config.controller = self.plan.controller.as_deref().map(ControllerChoice::from);
        config.cases = Some(self.base);
        for team in &mut config.teams {
            team.settings = self.settings.clone();
            let match_team = if team.colour == Colour::Blue { blue } else { yellow };
            (team.tactics, team.approach) = (match_team.host_tactics(), match_team.approach());
            if match_team.strategy {
                let command = self.plan.strategy.as_deref().ok_or(EvaluationError::NoStrategy)?;
                team.strategy = Some(StrategyProcess::starter(command));
            }
        }
        Ok(config)
    }
}

impl Experiment for Matches {
    type Job = Planned;
    type Row = MatchRow;
    type Error = EvaluationError;

    fn jobs(&self) -> Result<Vec<Planned>, EvaluationError> {
        Ok((0..self.plan.len()).filter_map(|number| self.plan.get(number)).collect())
    }

    fn play(&self, planned: &Planned) -> Result<MatchRow, EvaluationError> {
        let report = play(&self.config(planned)?, &mut NativeBackend::new(self.base), &mut NoWatcher)
            .map_err(|error| EvaluationError::Match(planned.number, error))?;
        let number = planned.number;
        for (is_blue, metrics) in [(true, &report.metrics.blue), (false, &report.metrics.yellow)] {
            let Some(answers) = &metrics.strategy else { continue };
            let Some(warning) = answers.warning() else { continue };
            if answers.never_played() {
                return Err(EvaluationError::Match(number, GameError::StrategyFailed(warning)));
            }
            if let Some(file) = &self.refusals {
                file.append(&Refusal { number, is_blue, answers: answers.clone() })?;
            }
        }
        Ok(MatchRow::new(planned, &report))
    }
}

impl StoredExperiment for Matches {
    fn identity(&self) -> MatchIdentity {
        let settings = self.settings.describe();
        MatchIdentity {
            program: self.program.clone(),
            case_base: format!("{:08x}", self.base.hash()),
            settings: settings.map(|(name, value)| (name.to_owned(), value.to_string())).collect(),
            plan: self.plan.clone(),
        }
    }
}

#[cfg(test)]
mod tests;
