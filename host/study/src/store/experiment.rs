//! `experiment`: a plan, its numbered jobs and their rows: played on all threads, stored, resumed, merged.
//!
//! ```text
//! plan ─► jobs ─► rows                                        one process
//! plan ─► play_shard ─► trials-1-of-3.csv … ─► merge ─► rows  any number of processes
//! ```
//! A job depends only on its place in the plan, and rows stand in the plan's order: the same experiment gives
//! the same bytes for any number of threads, shards and interrupts.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use rayon::prelude::*;

use super::error::{EvaluationError, LackingShard};
use super::row_file::{Kept, Row, RowFile};
use super::shard::Shard;

/// A plan whose jobs are played one by one.
pub trait Experiment: Sync {
    /// One trial, match, scene or try, ready to be played.
    type Job: Sync;
    /// Record of a job that was played.
    type Row: Send;
    /// Error that kept a job from being played.
    type Error: Send;

    /// All jobs, in the plan's order.
    fn jobs(&self) -> Result<Vec<Self::Job>, Self::Error>;

    /// Plays a job.
    fn play(&self, job: &Self::Job) -> Result<Self::Row, Self::Error>;

    /// Plays all jobs on the current rayon pool; rows in the plan's order. Calls `on_played` after each job.
    fn play_all(&self, on_played: &(dyn Fn() + Sync)) -> Result<Vec<Self::Row>, Self::Error> {
        self.jobs()?.par_iter().map(|job| self.play(job).inspect(|_| on_played())).collect()
    }
}

/// Seed of the job of that number among those of a kind: 32 bits, exact for every reader of JSON.
pub(crate) fn job_seed(seed: u64, kind: &str, number: u32) -> u64 {
    let mut hash = hil_sim::Fnv::default();
    hash.add(kind.as_bytes());
    hash.add(&seed.to_le_bytes());
    hash.add(&number.to_le_bytes());
    hash.value() & 0xffff_ffff
}

/// Progress of a shard.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RunProgress {
    /// Finished trials, those of earlier runs included.
    pub done: usize,
    /// Trials of the shard.
    pub of: usize,
}

/// An experiment whose rows are stored, by shards.
pub trait StoredExperiment: Experiment<Row: Row, Error = EvaluationError> {
    /// The identity that its files carry: all settings that rows depend on.
    fn identity(&self) -> <Self::Row as Row>::Identity;

    /// Plays the jobs of a shard that are missing in `file`, on all threads of the current rayon pool;
    /// returns its rows in the plan's order.
    ///
    /// `progress` is called at the start and after every job, and may stop the run: finished jobs are kept,
    /// and the next run of the same shard into the same file continues from there.
    fn play_shard(
        &self,
        shard: Shard,
        file: &Path,
        progress: &(dyn Fn(RunProgress) -> ControlFlow<()> + Sync),
    ) -> Result<Vec<Self::Row>, EvaluationError> {
        let (row_file, kept) = RowFile::open::<Self::Row>(file, &self.identity())?;
        let mut rows = BTreeMap::new();
        for row in kept {
            insert(&mut rows, row)?;
        }
        let mut jobs: Vec<_> = (0..).zip(self.jobs()?).filter(|(number, _)| shard.has(*number)).collect();
        let of = jobs.len();
        jobs.retain(|(number, _)| !rows.contains_key(number));
        let report = |done| {
            let goes_on = progress(RunProgress { done, of }).is_continue();
            goes_on.then_some(()).ok_or(EvaluationError::Stopped)
        };
        let before = of - jobs.len();
        report(before)?;
        let keeper = Mutex::new((row_file, rows, before));
        jobs.par_iter().try_for_each(|(number, job)| {
            let row = self.play(job)?;
            // A thread that panicked while it stored a row stops the run anyway.
            let mut keeper = keeper.lock().unwrap_or_else(PoisonError::into_inner);
            let (row_file, rows, done) = &mut *keeper;
            row_file.keep(&row)?;
            rows.insert(*number, row);
            *done += 1;
            report(*done)
        })?;
        let (_, rows, _) = keeper.into_inner().unwrap_or_else(PoisonError::into_inner);
        Ok(rows.into_iter().filter(|(number, _)| shard.has(*number)).map(|(_, row)| row).collect())
    }
}

/// All rows of an experiment from the files of its shards, in the plan's order.
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
        Entry::Occupied(_) => Err(EvaluationError::Unlike(trial)),
    }
}
