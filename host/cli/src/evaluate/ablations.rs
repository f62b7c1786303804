//! `onetwo evaluate ablations`: what each part of the approach is worth. One thing changed at a time, on the
//! same seeds.
//!
//! Every arm's trials are stored in a file of its own, `arms/NAME.csv`: the same command continues where it
//! was stopped, and arms that were played elsewhere are copied there.

use std::process::ExitCode;

use ::report::{Ablation, Facts};
use clap::Args;
use study::evaluation::{ARMS, Arm, EvaluationPlan, ablation_table, effect_files, effects};
use study::store::{EvaluationError, Shard, StoredExperiment, csv_hash, to_csv};

use super::report::{self, PageArgs};
use super::work::{self, WorkArgs};
use crate::Failure;
use crate::args::LibraryArgs;
use crate::destination;
use crate::setup::reduction;

/// Which arms, and how many trials.
#[derive(Debug, Args)]
pub(super) struct AblationsArgs {
    /// Trials a cell of scenario and opponents, and arm.
    #[arg(short, long, default_value_t = 200, value_parser = clap::value_parser!(u32).range(1..=10_000_000))]
    trials: u32,
    /// Random seed.
    #[arg(short, long, default_value_t = 1)]
    seed: u64,
    /// Only these arms, by name; may be repeated. The unchanged team is always played.
    #[arg(long, value_name = "NAME", value_parser = arm)]
    arm: Vec<Arm>,
    #[command(flatten)]
    work: WorkArgs,
    #[command(flatten)]
    page: PageArgs,
    #[command(flatten)]
    library: LibraryArgs,
}

pub(super) fn run(args: &AblationsArgs) -> Result<ExitCode, Failure> {
    let plan = EvaluationPlan::ablation(args.seed).with_trials(args.trials);
    let wanted = |arm: &&Arm| args.arm.is_empty() || arm.is_default() || args.arm.contains(arm);
    let arms: Vec<Arm> = ARMS.iter().filter(wanted).copied().collect();
    let (directory, pool) = (args.work.directory(Shard::WHOLE)?, args.work.pool()?);
    let kept = directory.join("arms");
    destination::make_directory(&kept)?;
    let library = args.library.directory.library.as_ref();
    let library =
        library.map_or_else(|| args.library.league.clone(), |directory| directory.display().to_string());
    let (mut played, mut identity) = (Vec::new(), None);
    for (place, arm) in arms.iter().enumerate() {
        let setup = arm.setup();
        let library_handle = crate::library::open_reduced(&args.library, reduction(&setup))?;
        library_handle.check_field_of_trials()?;
        let evaluation = work::evaluation(plan.clone(), setup, &library_handle, library.clone());
        let title = format!("{} of {}: {}", place + 1, arms.len(), arm.name);
        let file = kept.join(format!("{}.csv", arm.name));
        args.work.freshen(&file)?;
        // The unchanged team's comes first; what the others change stands in their lines.
        identity.get_or_insert_with(|| evaluation.identity());
        played.push((*arm, work::play(&evaluation, Shard::WHOLE, &file, &pool, &title)?));
    }
    let (_, default) = played.remove(0);
    let effects = effects(&default, &played);
    work::write_all(directory, effect_files(&effects)?)?;
    let hash = csv_hash(&to_csv(&default).map_err(EvaluationError::from)?);
    let facts = identity.map(|identity| Facts::of(&identity, &hash)).unwrap_or_default();
    report::write_ablation(
        &Ablation { arms: &arms, effects: &effects, facts: &facts },
        directory,
        &args.page,
    )?;
    let (trials, seed) = (default.len() * arms.len(), args.seed);
    let table = ablation_table(&effects);
    work::print_text(&format!("{table}\n{trials} trials, seed {seed}, in {}\n", directory.display()))?;
    Ok(ExitCode::SUCCESS)
}

fn arm(label: &str) -> Result<Arm, String> {
    ARMS.iter().find(|arm| arm.name == label).copied().ok_or_else(|| {
        let names: Vec<_> = ARMS.iter().map(|arm| arm.name).collect();
        format!("take one of: {}", names.join(", "))
    })
}
