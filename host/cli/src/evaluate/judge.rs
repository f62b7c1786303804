//! `onetwo evaluate judge`: whether the pattern of the paper's results is reproduced. Thousands of trials a
//! cell, random starts among them.
//!
//! The same files and tables as `onetwo evaluate`; the verdicts are intended for these numbers of trials. It
//! has a seed of its own, so that what was tuned while looking at the tables is judged on other random
//! numbers. A missed line is a finding, and no error.

use std::process::ExitCode;

use clap::Args;
use study::evaluation::EvaluationPlan;
use study::store::Shard;

use super::report::ReportArgs;
use super::work::{self, WorkArgs};
use crate::Failure;
use crate::args::parsers;
use crate::setup::SetupArgs;

/// How many trials, and how they are played.
#[derive(Debug, Args)]
pub(super) struct JudgeArgs {
    /// Trials a cell of scenario, opponents and approach.
    #[arg(short, long, default_value_t = 5000, value_parser = clap::value_parser!(u32).range(1..=10_000_000))]
    trials: u32,
    /// Random seed.
    #[arg(short, long, default_value_t = 2009)]
    seed: u64,
    /// Every n-th trial from the i-th on, for a cluster; `evaluate merge` merges the shards.
    #[arg(long, value_name = "I/N", default_value = "1/1", value_parser = parsers::shard)]
    shard: Shard,
    #[command(flatten)]
    work: WorkArgs,
    #[command(flatten)]
    report: ReportArgs,
    #[command(flatten)]
    setup: SetupArgs,
}

pub(super) fn run(args: &JudgeArgs) -> Result<ExitCode, Failure> {
    let plan = EvaluationPlan::judge(args.seed).with_trials(args.trials);
    work::run(plan, args.shard, &args.setup, &args.work, &args.report)
}
