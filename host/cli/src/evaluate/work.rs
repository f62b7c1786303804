//! `work`: long evaluations on several threads, with a progress bar on a terminal; Ctrl-C keeps what is
//! finished.

use std::error::Error;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::atomic::{AtomicU64, Ordering};

use arena::cases::LibraryHandle;
use arena::{CaseNames, ROBOTS, Setup};
use clap::Args;
use study::evaluation::{Evaluation, EvaluationPlan, Results, TrialRow, summary, verdicts};
use study::store::{EvaluationError, Experiment, RunProgress, Shard, StoredExperiment};

use super::report::{self, ReportArgs};
use crate::Failure;
use crate::args::{VERSION, threads};
use crate::destination::{self, DestinationError, FileKind};
use crate::output;
use crate::picture;
use crate::progress;
use crate::setup::SetupArgs;
use crate::stop::stopped_by_hand;

/// Output directory and number of threads.
#[derive(Debug, Args)]
pub(super) struct WorkArgs {
    /// Threads; the number of cores by default.
    #[arg(short, long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    jobs: Option<u16>,
    /// The directory that everything is written to; the same command continues there after an interrupt.
    #[arg(short, long, value_name = "DIR", default_value = "evaluation")]
    out: PathBuf,
    /// Start again: the trials stored in the directory are removed, of a shard its own.
    #[arg(long)]
    fresh: bool,
}

impl WorkArgs {
    /// The directory, as it was named.
    pub(super) fn out(&self) -> &Path {
        &self.out
    }

    /// Threads to play on.
    pub(super) fn pool(&self) -> Result<rayon::ThreadPool, Failure> {
        threads(self.jobs)
    }

    /// The directory, created if missing; without earlier trials of that shard if `fresh` is set, and without
    /// those of any shard if it is the whole plan.
    pub(super) fn directory(&self, shard: Shard) -> Result<&Path, Failure> {
        check_results(&self.out)?;
        destination::make_directory(&self.out)?;
        if self.fresh {
            let failed = |error| EvaluationError::File(self.out.clone(), error);
            for entry in std::fs::read_dir(&self.out).map_err(failed)? {
                let entry = entry.map_err(failed)?;
                let of_shard = entry.file_name().to_str().and_then(Shard::from_file_name);
                // Other shards may be played by other processes at this moment.
                if of_shard.is_some_and(|other| shard == Shard::WHOLE || other == shard) {
                    forget(&entry.path())?;
                }
            }
        }
        Ok(&self.out)
    }

    /// Removes a file of trials, if it exists and `fresh` is set.
    pub(super) fn freshen(&self, file: &Path) -> Result<(), Failure> {
        if self.fresh && file.exists() { forget(file) } else { Ok(()) }
    }
}

/// Refuses a directory in which a file of results has another content.
pub(super) fn check_results(directory: &Path) -> Result<(), DestinationError> {
    let results = RESULTS.map(|(name, kind)| (directory.join(name), kind));
    destination::check(&results.each_ref().map(|(file, kind)| (file.as_path(), *kind)), &[])
}

/// The files of an evaluation's results, as `study` and `report` write them.
const RESULTS: [(&str, FileKind); 14] = [
    ("trials.csv", FileKind::Csv),
    ("tables.json", FileKind::Json),
    ("tables.csv", FileKind::Csv),
    ("comparisons.json", FileKind::Json),
    ("comparisons.csv", FileKind::Csv),
    ("claims.json", FileKind::Json),
    ("judge.json", FileKind::Json),
    ("cases.csv", FileKind::Csv),
    ("run.json", FileKind::Json),
    ("ablations.json", FileKind::Json),
    ("ablations.csv", FileKind::Csv),
    ("matches.csv", FileKind::Csv),
    ("matches.json", FileKind::Json),
    ("report.html", FileKind::Html),
];

fn forget(file: &Path) -> Result<(), Failure> {
    let gone = std::fs::remove_file(file);
    gone.map_err(|error| EvaluationError::File(file.to_owned(), error).into())
}

/// All settings that the trials of a plan depend on.
pub(super) fn evaluation(
    plan: EvaluationPlan,
    setup: Setup,
    library_handle: &LibraryHandle,
    library: String,
) -> Evaluation<'_> {
    let names = CaseNames::new(library_handle.names());
    Evaluation { plan, base: library_handle.base(), names, library, setup, program: VERSION.to_owned() }
}

/// Plays the trials of a shard that are missing in `file`; with `title` before the bar.
pub(super) fn play(
    evaluation: &Evaluation<'_>,
    shard: Shard,
    file: &Path,
    pool: &rayon::ThreadPool,
    title: &str,
) -> Result<Vec<TrialRow>, Failure> {
    with_bar(pool, title, |on_progress| evaluation.play_shard(shard, file, on_progress))
}

/// Plays all `of` jobs of a plan whose rows are not stored.
pub(super) fn play_all<E: Experiment<Error: Error + Send + Sync + 'static>>(
    plan: &E,
    of: u64,
    jobs: Option<u16>,
) -> Result<Vec<E::Row>, Failure> {
    let (line, done) = (progress::Progress::open(), AtomicU64::new(0));
    line.set_text("playing");
    let rows = threads(jobs)?
        .install(|| plan.play_all(&|| line.set(done.fetch_add(1, Ordering::Relaxed) + 1, of)))?;
    drop(line);
    Ok(rows)
}

/// Plays on a pool of threads, with `title` before a bar; Ctrl-C ends it in order.
pub(super) fn with_bar<R: Send>(
    pool: &rayon::ThreadPool,
    title: &str,
    play: impl FnOnce(&(dyn Fn(RunProgress) -> ControlFlow<()> + Sync)) -> Result<R, EvaluationError> + Send,
) -> Result<R, Failure> {
    // The running trials are still finished and stored.
    let stopped = stopped_by_hand();
    // Drawn on a terminal's stderr, and nowhere else.
    let line = progress::Progress::open();
    line.set_text(title);
    let on_progress = |progress: RunProgress| {
        line.set(progress.done as u64, progress.of as u64);
        if stopped.load(Ordering::Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    let played = pool.install(|| play(&on_progress));
    drop(line);
    Ok(played?)
}

/// Plays a shard of a plan and, if it is the whole plan, writes and prints the results.
pub(super) fn run(
    plan: EvaluationPlan,
    shard: Shard,
    setup_args: &SetupArgs,
    work: &WorkArgs,
    reported: &ReportArgs,
) -> Result<ExitCode, Failure> {
    let setup = setup_args.choose(ROBOTS)?;
    let library_handle = setup_args.open(&setup)?;
    let evaluation = evaluation(plan, setup, &library_handle, setup_args.library_label());
    let directory = work.directory(shard)?;
    let file = directory.join(shard.file_name());
    let pool = work.pool()?;
    let rows = play(&evaluation, shard, &file, &pool, "playing")?;
    if shard == Shard::WHOLE {
        let results = Results::new(evaluation.identity(), rows)?;
        finish(&results, directory)?;
        pool.install(|| report::write(&results, directory, reported))?;
        return Ok(ExitCode::SUCCESS);
    }
    let (kept, out) = (file.display(), directory.display());
    print_text(&format!(
        "{} trials in {kept}; when all shards are played: onetwo evaluate merge {out} --out {out}\n",
        rows.len()
    ))?;
    Ok(ExitCode::SUCCESS)
}

/// Writes everything, and prints the tables, the verdicts and their paths.
pub(super) fn finish(results: &Results, directory: &Path) -> Result<(), Failure> {
    write_all(directory, results.files()?)?;
    let (trials, seed, hash) = (results.rows.len(), results.identity.plan.seed, &results.hash);
    let (tables, verdicts) = (summary(results), verdicts(results));
    let fewest = results.tables.iter().map(|row| row.trials).min().unwrap_or_default();
    let advice = if fewest < TRIALS_TO_JUDGE {
        let points = 98.0 / f64::from(fewest.max(1)).sqrt();
        format!(
            "{fewest} trials a row are few: a share of one half is known to ±{points:.0} points, so lines are missed and claims undecided by chance; judge by {TRIALS_TO_JUDGE} or more (--trials)\n"
        )
    } else {
        String::new()
    };
    print_text(&format!(
        "{tables}{verdicts}{advice}{trials} trials, seed {seed}, csv hash {hash}, in {}\n",
        directory.display()
    ))
}

/// Trials of a row by which approaches are judged: a share is then known to ±5 points.
const TRIALS_TO_JUDGE: u32 = 400;

/// Writes files of results into an existing directory.
pub(super) fn write_all(directory: &Path, files: Vec<(&str, Vec<u8>)>) -> Result<(), Failure> {
    files.into_iter().try_for_each(|(name, bytes)| {
        let file = directory.join(name);
        let kind = if picture::has_extension(&file, "csv") { FileKind::Csv } else { FileKind::Json };
        write(&file, kind, &bytes)
    })
}

pub(super) fn write(file: &Path, kind: FileKind, bytes: &[u8]) -> Result<(), Failure> {
    Ok(destination::write(file, kind, bytes)?)
}

/// Prints on stdout.
pub(super) fn print_text(description: &str) -> Result<(), Failure> {
    output::print_text(description)
}
