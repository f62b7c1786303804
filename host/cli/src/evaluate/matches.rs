//! `onetwo evaluate matches`: what does our play come to against other teams? The second paper's Table 2 (Biswas et al. 2014 §6).

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use arena::evaluation::{EvaluationError, Shard, csv_hash, merge, to_csv};
use arena::matches::{
    MatchIdentity, MatchRow, Matches, Outcome, PAPER, PAPER_PASSES, Plan, markdown, outcomes, plot,
};
use casebase::CaseBase;
use clap::Args;
use host::strategy::Team;
use rules::League;
use serde_json::json;

use super::merge::shards;
use super::work::{self, WorkArgs};
use crate::Failure;
use crate::args::{FolderArgs, SettingsArgs, VERSION};
use crate::library::Shelf;
use crate::play::{cases, league, seconds, team};

/// Which matches, and where to.
#[derive(Debug, Args)]
pub(super) struct MatchesArgs {
    /// Field, robots and rules: division-b, ssl-2013 (the paper's) or division-a.
    #[arg(long, default_value = "division-b", value_parser = league)]
    league: League,
    /// Matches of each pair of teams.
    #[arg(long, default_value_t = 10, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    matches: u32,
    /// Length of a match, simulated seconds.
    #[arg(long, value_name = "SECONDS", default_value_t = 600.0, value_parser = seconds)]
    duration: f64,
    /// Where all chance comes from.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Against whom we play, with commas between: reactive, marking, zone, idle, ours.
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = team)]
    opponents: Vec<Team>,
    /// Each team against each: ours and the opponents.
    #[arg(long)]
    round_robin: bool,
    /// Every n-th match from the i-th on, for a cluster; `--merge` puts the shards together.
    #[arg(long, value_name = "I/N", default_value = "1/1", value_parser = work::shard, conflicts_with = "merge")]
    shard: Shard,
    /// Plays nothing: puts the shards together that were written to this folder; may be repeated.
    #[arg(long, value_name = "DIR")]
    merge: Vec<PathBuf>,
    /// A document to be written of it, its picture in a folder beside it.
    #[arg(long, value_name = "FILE")]
    markdown: Option<PathBuf>,
    #[command(flatten)]
    work: WorkArgs,
    #[command(flatten)]
    folder: FolderArgs,
    #[command(flatten)]
    settings: SettingsArgs,
}

pub(super) fn run(args: &MatchesArgs) -> Result<ExitCode, Failure> {
    if !args.merge.is_empty() {
        let mut kept = Vec::new();
        for folder in &args.merge {
            kept.extend(shards::<MatchRow>(folder)?);
        }
        let (identity, rows) = merge(kept)?;
        let folder = args.work.folder()?;
        return finish(&identity, &rows, folder, args.markdown.as_deref());
    }
    let shelf = cases(&args.folder, args.league)?;
    let matches = Matches {
        plan: args.plan(),
        base: shelf.as_ref().map_or_else(CaseBase::default, Shelf::base),
        settings: args.settings.choose()?.settings,
        program: VERSION.to_owned(),
    };
    let folder = args.work.folder()?;
    let file = folder.join(args.shard.file_name());
    let pool = args.work.pool()?;
    let rows = work::with_bar(&pool, "playing", |told| matches.play_shard(args.shard, &file, told))?;
    if args.shard == Shard::WHOLE {
        return finish(&matches.identity(), &rows, folder, args.markdown.as_deref());
    }
    let (kept, out) = (file.display(), folder.display());
    work::say(&format!(
        "{} matches in {kept}; when all shards are played: onetwo evaluate matches --merge {out} --out {out}\n",
        rows.len()
    ))?;
    Ok(ExitCode::SUCCESS)
}

impl MatchesArgs {
    fn plan(&self) -> Plan {
        let opponents = if self.opponents.is_empty() { &Team::OPPONENTS[..] } else { &self.opponents };
        let pairings = if self.round_robin {
            let teams: Vec<_> = [Team::Ours].iter().chain(opponents).copied().collect();
            Plan::round_robin(&teams)
        } else {
            Plan::against(opponents)
        };
        Plan {
            seed: self.seed,
            league: self.league.name().to_owned(),
            duration_s: self.duration,
            pairings,
            matches: self.matches,
        }
    }
}

/// Writes `matches.csv`, `matches.json` and the plot, and says the tables.
fn finish(
    identity: &MatchIdentity,
    rows: &[MatchRow],
    folder: &Path,
    document: Option<&Path>,
) -> Result<ExitCode, Failure> {
    let csv = to_csv(rows).map_err(EvaluationError::from)?;
    let hash = csv_hash(&csv);
    let outcomes = outcomes(&identity.plan, rows);
    let json = json!({
        "identity": identity, "csv_hash": hash, "pairs": outcomes,
        "paper": { "table_1": PAPER_PASSES, "table_2": PAPER },
    });
    let json = serde_json::to_vec_pretty(&json).map_err(|error| Failure::Output(error.into()))?;
    write(&folder.join("matches.csv"), &csv)?;
    write(&folder.join("matches.json"), &json)?;
    write(&folder.join("ratios.svg"), plot(&outcomes).as_bytes())?;
    if let Some(file) = document {
        let pictures = file.with_extension("");
        work::make(&pictures)?;
        write(&pictures.join("ratios.svg"), plot(&outcomes).as_bytes())?;
        let beside = pictures.file_name().unwrap_or_default().to_string_lossy().into_owned();
        write(file, text(identity, &outcomes, &hash, &beside).as_bytes())?;
    }
    let (matches, seed) = (rows.len(), identity.plan.seed);
    work::say(&format!(
        "{}\n{matches} matches, seed {seed}, csv hash {hash}, in {}\n",
        markdown(&outcomes),
        folder.display()
    ))?;
    Ok(ExitCode::SUCCESS)
}

fn text(identity: &MatchIdentity, outcomes: &[Outcome], hash: &str, pictures: &str) -> String {
    let plan = &identity.plan;
    let mut text = String::from(
        "# Matches\n\nWritten by `cargo xtask matches`; nothing here is typed by hand.\n\n\
         Means a match, in brackets their 95 % intervals (Student's t); p is the paired t test of goals for and against. \
         The offence ratio is the time in play with the ball in their half over that in ours, the attack ratio our shots at \
         the goal over theirs (Biswas et al. 2014 §6): its mean is over the matches in which they shot at all, \"of all shots\" \
         counts every match. Teams: `ours`; `reactive` chases the ball, `marking` stays with every opponent, `zone` follows the \
         ball with a wall (`host/src/strategy/opponents`).\n\n",
    );
    // Writing to a String cannot fail.
    let _ = writeln!(
        text,
        "{} matches a pair of {} s on {}, seed {}, csv hash {hash}.\n\n![Offence and attack ratios]({pictures}/ratios.svg)\n\n{}",
        plan.matches,
        plan.duration_s,
        plan.league,
        plan.seed,
        markdown(outcomes).trim_end()
    );
    text
}

fn write(file: &Path, bytes: &[u8]) -> Result<(), Failure> {
    fs::write(file, bytes).map_err(|error| EvaluationError::File { file: file.to_owned(), error }.into())
}
