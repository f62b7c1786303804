//! `runs`: an evaluation as an experiment: its trials, its identity and how a trial is played.

use casebase::CaseBase;
use hil_sim::{NativeBackend, Parameters};

use super::identity::Identity;
use super::plan::{EvaluationPlan, Planned};
use super::row::TrialRow;
use crate::store::{EvaluationError, Experiment, Shard, StoredExperiment};
use arena::{CaseNames, Setup, TrialConfig, positioning_label, run};

/// All settings that the trials of an evaluation depend on.
#[derive(Clone, Debug)]
pub struct Evaluation<'a> {
    /// The trials to be played.
    pub plan: EvaluationPlan,
    /// The case base in every robot.
    pub base: CaseBase<'a>,
    /// Names of its cases.
    pub names: CaseNames,
    /// The case library: a league's name, or a directory.
    pub library: String,
    /// Set-up of the attackers, for all trials.
    pub setup: Setup,
    /// Version and commit of the program: trials of two programs are never mixed.
    pub program: String,
}

impl<'a> Evaluation<'a> {
    /// A trial of the plan, ready to be played.
    pub fn config(&self, planned: &Planned) -> TrialConfig<'a> {
        let cell = &planned.cell;
        let config = TrialConfig::new(cell.scenario, cell.configuration, cell.approach, planned.seed);
        cell.profile.apply(self.setup.apply(config)).with_library(self.base, self.names.clone())
    }
}

impl Experiment for Evaluation<'_> {
    type Job = Planned;
    type Row = TrialRow;
    type Error = EvaluationError;

    fn jobs(&self) -> Result<Vec<Planned>, EvaluationError> {
        Ok(self.plan.shard(Shard::WHOLE).collect())
    }

    fn play(&self, planned: &Planned) -> Result<TrialRow, EvaluationError> {
        let report = run(&self.config(planned), Box::new(NativeBackend::new(self.base)), &mut [])
            .map_err(|error| EvaluationError::Trial(planned.number, error))?;
        Ok(TrialRow::new(planned, &report))
    }
}

impl StoredExperiment for Evaluation<'_> {
    fn identity(&self) -> Identity {
        let setup = &self.setup;
        let settings = setup.settings.describe();
        Identity {
            program: self.program.clone(),
            library: self.library.clone(),
            case_base: format!("{:08x}", self.base.hash()),
            cases: self.names.all().to_vec(),
            symmetry: setup.symmetry,
            case_opponents: setup.opponents,
            settings: settings.map(|(name, value)| (name.to_owned(), value.to_string())).collect(),
            positioning: positioning_label(setup.positioning).to_owned(),
            retrievers: setup.retrievers,
            loss: setup.loss,
            opponents_pause: setup.opponents_pause,
            world: hil_sim::world_hash(),
            parameters: Parameters::four_legged().clone(),
            plan: self.plan.clone(),
        }
    }
}

#[cfg(test)]
mod tests;
