//! `runs`: parallel execution of trials. On all threads of the pool, each stored when it is over, resumed
//! after an interrupt, merged.
//!
//! A trial depends only on its place in the plan, and merged rows stand in the plan's order: the same
//! evaluation gives the same bytes for any number of threads, shards and interrupts.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use casebase::CaseBase;
use hil_sim::{NativeBackend, Parameters};
use rayon::prelude::*;

use super::error::{EvaluationError, LackingShard};
use super::identity::Identity;
use super::plan::{EvaluationPlan, Planned, Shard};
use super::row::TrialRow;
use super::trial_store::{Entry as Row, Kept, TrialStore};
use arena::CaseNames;
use arena::Setup;
use arena::{TrialConfig, positioning_label, run};

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

/// Progress of a shard.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RunProgress {
    /// Finished trials, those of earlier runs included.
    pub done: usize,
    /// Trials of the shard.
    pub of: usize,
}

impl<'a> Evaluation<'a> {
    /// The identity that its files carry.
    pub fn identity(&self) -> Identity {
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

    /// A trial of the plan, ready to be played.
    pub fn config(&self, planned: &Planned) -> TrialConfig<'a> {
        let cell = &planned.cell;
        let config = TrialConfig::new(cell.scenario, cell.configuration, cell.approach, planned.seed);
        cell.profile.apply(self.setup.apply(config)).with_library(self.base, self.names.clone())
    }

    /// Plays the trial; fails where the simulator cannot go on.
    pub fn play(&self, planned: &Planned) -> Result<TrialRow, EvaluationError> {
        let report = run(&self.config(planned), Box::new(NativeBackend::new(self.base)), &mut [])
            .map_err(|error| EvaluationError::Trial { trial: planned.number, error })?;
        Ok(TrialRow::new(planned, &report))
    }

    /// Plays the trials of a shard that are missing in `file`, on all threads of the current rayon pool;
    /// returns its rows in the plan's order.
    ///
    /// `progress` is called at the start and after every trial, and may stop the run: finished trials are
    /// kept, and the next run of the same shard into the same file continues from there.
    pub fn play_shard(
        &self,
        shard: Shard,
        file: &Path,
        progress: &(dyn Fn(RunProgress) -> ControlFlow<()> + Sync),
    ) -> Result<Vec<TrialRow>, EvaluationError> {
        let play = |number| match self.plan.get(number) {
            Some(planned) => self.play(&planned),
            None => unreachable!("a shard is of its plan"),
        };
        play_open(&self.identity(), shard, file, progress, play)
    }
}

/// Plays the trials of a shard that are missing in `file`, as [`Evaluation::play_shard`] does, each by its
/// number.
pub(crate) fn play_open<R: Row>(
    identity: &R::Identity,
    shard: Shard,
    file: &Path,
    progress: &(dyn Fn(RunProgress) -> ControlFlow<()> + Sync),
    play: impl Fn(usize) -> Result<R, EvaluationError> + Sync,
) -> Result<Vec<R>, EvaluationError> {
    let (trial_store, kept) = TrialStore::open::<R>(file, identity)?;
    let mut rows: BTreeMap<usize, R> = BTreeMap::new();
    for row in kept {
        insert(&mut rows, row)?;
    }
    let numbers = || (0..R::planned(identity)).filter(|number| shard.has(*number));
    let open: Vec<_> = numbers().filter(|number| !rows.contains_key(number)).collect();
    let of = numbers().count();
    let on_progress = |done: usize| match progress(RunProgress { done, of }) {
        ControlFlow::Continue(()) => Ok(()),
        ControlFlow::Break(()) => Err(EvaluationError::Stopped),
    };
    let before = of - open.len();
    on_progress(before)?;
    let keeper = Mutex::new((trial_store, rows, before));
    open.par_iter().try_for_each(|number| {
        let row = play(*number)?;
        // A thread that panicked while it stored a trial stops the run anyway.
        let mut keeper = keeper.lock().unwrap_or_else(PoisonError::into_inner);
        let (trial_store, rows, done) = &mut *keeper;
        trial_store.keep(&row)?;
        rows.insert(row.number(), row);
        *done += 1;
        on_progress(*done)
    })?;
    let (_, rows, _) = keeper.into_inner().unwrap_or_else(PoisonError::into_inner);
    Ok(rows.into_values().filter(|row| shard.has(row.number())).collect())
}

/// All trials of an evaluation from the files of its shards, in the plan's order.
pub fn merge<R: Row>(files: Vec<Kept<R>>) -> Result<(R::Identity, Vec<R>), EvaluationError> {
    let mut files = files.into_iter();
    let first = files.next().ok_or(EvaluationError::Nothing)?;
    let mut names = vec![first.file.clone()];
    let mut rows = BTreeMap::new();
    for row in first.rows {
        insert(&mut rows, row)?;
    }
    for file in files {
        let differences = R::differences(&file.identity, &first.identity);
        if !differences.is_empty() {
            return Err(EvaluationError::Another { file: file.file, merged: Some(first.file), differences });
        }
        names.push(file.file);
        for row in file.rows {
            insert(&mut rows, row)?;
        }
    }
    let of = R::planned(&first.identity);
    let missing: Vec<_> = (0..of).filter(|number| !rows.contains_key(number)).collect();
    match missing.first() {
        Some(&first) => {
            let shards = lacking(&names, of, &missing);
            Err(EvaluationError::Missing { trials: missing.len(), of, first, shards })
        }
        None => Ok((first.identity, rows.into_values().collect())),
    }
}

/// The shards of a plan of `of` trials that lack some. Where the files are of several partitions, the one
/// with most files counts.
fn lacking(files: &[PathBuf], of: usize, missing: &[usize]) -> Vec<LackingShard> {
    let mut partitions: BTreeMap<usize, usize> = BTreeMap::new();
    let names = files.iter().filter_map(|file| file.file_name().and_then(|name| name.to_str()));
    for shard in names.filter_map(Shard::from_file_name) {
        *partitions.entry(shard.parts()).or_default() += 1;
    }
    let Some((&parts, _)) = partitions.iter().max_by_key(|(_, files)| **files) else { return Vec::new() };
    // No more shards than trials can lack some.
    let shards = (1..=parts.min(of)).filter_map(|index| Shard::new(index, parts));
    let lacking = shards.map(|shard| LackingShard {
        shard,
        trials: missing.iter().filter(|number| shard.has(**number)).count(),
        of: (0..of).filter(|number| shard.has(*number)).count(),
    });
    lacking.filter(|lacking| lacking.trials > 0).collect()
}

fn insert<R: Row>(rows: &mut BTreeMap<usize, R>, row: R) -> Result<(), EvaluationError> {
    let trial = row.number();
    match rows.entry(trial) {
        Entry::Vacant(place) => {
            place.insert(row);
            Ok(())
        }
        Entry::Occupied(known) if *known.get() == row => Ok(()),
        Entry::Occupied(_) => Err(EvaluationError::Unlike { trial }),
    }
}

#[cfg(test)]
mod tests;
