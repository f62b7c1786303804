//! `onetwo evaluate`: evaluations, by default the first paper's tables of case-based against reactive
//! attackers (Ros et al. 2009 §5; docs/case-format.md §5).
//!
//! Data goes into the directory `--out`, the tables as text to stdout. Every trial is stored as soon as it is
//! over: the same command continues where it was stopped, and shards played elsewhere are merged into the
//! same bytes.

mod ablations;
mod judge;
mod matches;
mod merge;
mod report;
mod scenes;
mod skills;
mod tables;
mod work;

use std::process::ExitCode;

use clap::{Args, Subcommand};

use crate::Failure;

/// What is evaluated.
#[derive(Debug, Args)]
#[command(args_conflicts_with_subcommands = true)]
pub(crate) struct EvaluateArgs {
    #[command(subcommand)]
    verb: Option<EvaluateVerb>,
    #[command(flatten)]
    tables: tables::TablesArgs,
}

/// One verb, one file.
#[derive(Debug, Subcommand)]
enum EvaluateVerb {
    /// Merge the shards of an evaluation.
    Merge(merge::MergeArgs),
    /// Write the report of a played evaluation again.
    Report(report::AgainArgs),
    /// Judge whether the pattern of the paper's results is reproduced, at thousands of trials a cell.
    Judge(judge::JudgeArgs),
    /// Measure what each part of the approach is worth: one thing changed at a time.
    Ablations(ablations::AblationsArgs),
    /// Play matches against other teams and print the results: the second paper's Table 2.
    Matches(Box<matches::MatchesArgs>),
    /// Measure what each part of our play is worth on short scenes from equal starts.
    Scenes(scenes::ScenesArgs),
    /// Try single skills in one world or a family of them: how often they succeed, and how fast.
    Skills(skills::SkillsArgs),
}

pub(crate) fn run(args: &EvaluateArgs) -> Result<ExitCode, Failure> {
    match &args.verb {
        None => tables::run(&args.tables),
        Some(EvaluateVerb::Merge(args)) => merge::run(args),
        Some(EvaluateVerb::Report(args)) => report::run(args),
        Some(EvaluateVerb::Judge(args)) => judge::run(args),
        Some(EvaluateVerb::Ablations(args)) => ablations::run(args),
        Some(EvaluateVerb::Matches(args)) => matches::run(args),
        Some(EvaluateVerb::Scenes(args)) => scenes::run(args),
        Some(EvaluateVerb::Skills(args)) => skills::run(args),
    }
}
