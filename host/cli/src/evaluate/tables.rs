//! `onetwo evaluate` alone: the trials behind the paper's Tables 1 to 6, by default as many as the paper's.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use arena::Profile;
use brain::Approach;
use clap::Args;
use hil_sim::{Configuration, Scenario};
use study::evaluation::{ARMS, EvaluationCell, EvaluationPlan, TrialRow, effects};
use study::store::{Shard, merge};

use super::merge::shards;
use super::report::ReportArgs;
use super::work::{self, WorkArgs};
use crate::Failure;
use crate::args::parsers::{self, approach, opponents, profile, scenario};
use crate::destination;
use crate::output::printable_path;
use crate::setup::SetupArgs;

/// Which trials, and how they are played.
#[derive(Debug, Args)]
pub(super) struct TablesArgs {
    /// Trials a cell of scenario, opponents and approach; by default the paper's: 500, 200 against two
    /// defenders.
    #[arg(short, long, value_parser = clap::value_parser!(u32).range(1..=10_000_000))]
    trials: Option<u32>,
    /// Random seed.
    #[arg(short, long, default_value_t = 1)]
    seed: u64,
    /// Every n-th trial from the i-th on, for a cluster; `evaluate merge` merges the shards.
    #[arg(long, value_name = "I/N", default_value = "1/1", value_parser = parsers::shard)]
    shard: Shard,
    #[command(flatten)]
    work: WorkArgs,
    /// Only these scenarios: 1 to 4, random; may be repeated.
    #[arg(long, value_parser = scenario)]
    scenario: Vec<Scenario>,
    /// Only against these: dg or 2d; may be repeated.
    #[arg(long, value_parser = opponents)]
    opponents: Vec<Configuration>,
    /// Only these approaches; may be repeated.
    #[arg(long, value_parser = approach)]
    approach: Vec<Approach>,
    /// Only this world: as the paper's simulator (Tables 1 to 5), or as its robots (Table 6).
    #[arg(long, value_parser = profile)]
    profile: Option<Profile>,
    /// Random starts too, which no case was written for: a fifth family beside the paper's scenarios; as
    /// by the robots only with `--profile robots`.
    #[arg(long)]
    random: bool,
    /// Compare with the same trials that another program, library or setting played into this directory: the
    /// differences trial by trial.
    #[arg(long, value_name = "DIR", conflicts_with = "shard")]
    compare: Option<PathBuf>,
    #[command(flatten)]
    report: ReportArgs,
    #[command(flatten)]
    setup: SetupArgs,
}

pub(super) fn run(args: &TablesArgs) -> Result<ExitCode, Failure> {
    let plan = args.plan()?;
    let Some(directory) = &args.compare else {
        return work::run(plan, args.shard, &args.setup, &args.work, &args.report);
    };
    destination::check_directory(args.work.out(), directory)?;
    // Before trials are played that cannot be compared.
    let (identity, before) = merge(shards::<TrialRow>(directory)?)?;
    if identity.plan != plan {
        return Err(OtherTrials(directory.clone()).into());
    }
    let code = work::run(plan, args.shard, &args.setup, &args.work, &args.report)?;
    let (_, now) = merge(shards::<TrialRow>(args.work.out())?)?;
    work::print_text(&compared(directory, before, now))?;
    Ok(code)
}

/// Case-based attackers' measures in both directories, over all cells.
fn compared(directory: &Path, mut before: Vec<TrialRow>, mut now: Vec<TrialRow>) -> String {
    for rows in [&mut before, &mut now] {
        rows.retain(|row| row.approach != Approach::Reactive);
    }
    let effects = effects(&before, &[(ARMS[0], now)]);
    let all: Vec<_> = effects.into_iter().filter(|effect| effect.scenario.is_none()).collect();
    let Some(trials) = all.first().map(|effect| effect.trials) else {
        return "nothing to compare: no trial of attackers with cases\n".to_owned();
    };
    let mut text = format!("against {}, {trials} pairs of trials with cases:\n", printable_path(directory));
    for effect in all {
        let p = effect.p_paired.map_or_else(|| "equal".to_owned(), |p| format!("p {p:.3}"));
        let (measure, default, value, difference) =
            (effect.measure, effect.default, effect.value, effect.difference);
        let _ = writeln!(text, "  {measure:<10} {default:>8.2} -> {value:>8.2}  {difference:>+8.2}  {p}");
    }
    text
}

/// Trials of another plan cannot be compared in pairs.
#[derive(Debug, thiserror::Error)]
#[error(
    "the trials in {} are others: give the --trials, --seed and filters that they were played with", printable_path(.0)
)]
struct OtherTrials(PathBuf);

impl TablesArgs {
    fn plan(&self) -> Result<EvaluationPlan, Failure> {
        let wants_random = self.random || self.scenario.contains(&Scenario::Random);
        let plan = EvaluationPlan::paper(self.seed);
        let world = self.profile.unwrap_or(Profile::Simulated);
        let plan = if wants_random { plan.with_random(world) } else { plan };
        let scenario = |asked: Scenario| {
            self.scenario.is_empty()
                || self.scenario.contains(&asked)
                || (self.random && asked == Scenario::Random)
        };
        let wanted = |cell: &EvaluationCell| {
            scenario(cell.scenario)
                && (self.opponents.is_empty() || self.opponents.contains(&cell.configuration))
                && (self.approach.is_empty() || self.approach.contains(&cell.approach))
                && self.profile.is_none_or(|profile| profile == cell.profile)
        };
        let plan = plan.only(wanted);
        let plan = self.trials.map_or(plan.clone(), |trials| plan.with_trials(trials));
        if plan.is_empty() { Err(NoTrials.into()) } else { Ok(plan) }
    }
}

/// The filters of an evaluation leave nothing.
#[derive(Debug, thiserror::Error)]
#[error(
    "no trial is left: robots' trials (--profile robots) are against dg, of scenarios 3 and 4 and, asked for, \
     random; leave out a filter"
)]
struct NoTrials;
