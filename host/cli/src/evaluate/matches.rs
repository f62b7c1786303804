//! `onetwo evaluate matches`: our play against other teams, and what each part of it is worth. The second
//! paper's Tables 1 and 2 (Biswas et al. 2014 §6).

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use arena::CaseNames;
use arena::cases::LibraryHandle;
use casebase::CaseBase;
use clap::Args;
use figures::FigureFile;
use hil_sim::small_size::worlds::WorldPlan;
use host::strategy::{Tactics, Team};
use report::Versions;
use rules::League;
use serde_json::json;
use study::matches::{
    Effect, MatchIdentity, MatchPlan, MatchRow, MatchTeam, Matches, Outcome, PAPER, PAPER_PASSES, Passes,
    Refusal, RefusalFile, RefusedAnswers, calibration_plot, check_same_matches, compare_matches,
    comparison_table, effects, markdown, our_passes, outcomes, plot, summary,
};
use study::store::{EvaluationError, Shard, StoredExperiment, csv_hash, merge, to_csv};

use super::merge::shards;
use super::report::insert;
use super::work::{self, WorkArgs, write};
use crate::Failure;
use crate::args::parsers::{self, league, match_seconds};
use crate::args::{DirectoryArgs, SettingsArgs, VERSION};
use crate::destination::FileKind;
use crate::library;
use crate::output::note;

/// Which matches, and the output.
#[derive(Debug, Args)]
pub(super) struct MatchesArgs {
    /// Field, robots and rules: division-b, ssl-2013 (the paper's) or division-a.
    #[arg(long, default_value = "division-b", value_parser = league)]
    league: League,
    /// The world of all matches: nominal, grsim, erforce, erforce-none, sumatra, slow-dribbler, poor-vision,
    /// weak-kickers or random:SEED; or random: each match in the random world of its own seed
    /// (docs/fields.md).
    #[arg(long, value_name = "WORLD", default_value_t)]
    world: WorldPlan,
    /// Matches of each pair of teams.
    #[arg(short, long, default_value_t = 10, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    matches: u32,
    /// Length of a match, simulated seconds.
    #[arg(short, long, value_name = "SECONDS", default_value_t = 600.0, value_parser = match_seconds)]
    duration: f64,
    /// Random seed.
    #[arg(short, long, default_value_t = 1)]
    seed: u64,
    /// The team that plays against the opponents; named as they are.
    #[arg(long, value_name = "TEAM", default_value = "ours", value_parser = MatchTeam::parse)]
    team: MatchTeam,
    /// The program of the team `strategy`, which can be named as team or opponent
    /// (docs/strategy-protocol.md).
    #[arg(long, value_name = "COMMAND")]
    strategy: Option<String>,
    /// Play every match under the league's game controller in its CI mode: its program, which is started for
    /// each match, or HOST:PORT where one listens (with --jobs 1).
    #[arg(long, value_name = "PATH|HOST:PORT")]
    game_controller: Option<String>,
    /// Opponents, with commas between: reactive, marking, zone (these three by default), idle, ours, round-1
    /// (ours by thresholds and cases, whatever the default), or ours with other tactics, such as
    /// ours-without-second-level, ours-without-cases or ours-with-coerce+pass-ahead.
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = MatchTeam::parse)]
    opponents: Vec<MatchTeam>,
    /// Measure what the cases and each part of the second paper are worth: our team with one part more or
    /// less, for each part. Instead of the opponents, or beside those that are named, or one more each in the
    /// round robin.
    #[arg(long)]
    ablations: bool,
    /// Each team against each: ours and the opponents.
    #[arg(long)]
    round_robin: bool,
    /// Every n-th match from the i-th on, for a cluster; `--merge` merges the shards.
    #[arg(long, value_name = "I/N", default_value = "1/1", value_parser = parsers::shard, conflicts_with = "merge")]
    shard: Shard,
    /// Play nothing: merge the shards that were written to this directory; may be repeated.
    #[arg(long, value_name = "DIR")]
    merge: Vec<PathBuf>,
    /// Compare with the same matches that another program, case base or setting played into this directory:
    /// the difference match by match, printed and as the page compare.html. Strategies may differ too.
    #[arg(long, value_name = "DIR", conflicts_with = "markdown")]
    compare: Option<PathBuf>,
    /// Put the tables between the markers of this Markdown file, and the plots into a directory of its name
    /// beside it.
    #[arg(long, value_name = "FILE")]
    markdown: Option<PathBuf>,
    /// Name of the markers.
    #[arg(long, value_name = "NAME", default_value = "matches", requires = "markdown")]
    section: String,
    #[command(flatten)]
    work: WorkArgs,
    #[command(flatten)]
    directory: DirectoryArgs,
    #[command(flatten)]
    settings: SettingsArgs,
}

pub(super) fn run(args: &MatchesArgs) -> Result<ExitCode, Failure> {
    if !args.merge.is_empty() {
        let (mut kept, mut refusals) = (Vec::new(), Vec::new());
        for directory in &args.merge {
            for shard in shards::<MatchRow>(directory)? {
                refusals.extend(RefusalFile::beside(&shard.file).read()?);
                kept.push(shard);
            }
        }
        let (identity, rows) = merge(kept)?;
        let directory = args.work.directory(args.shard)?;
        return args.finish(&identity, &rows, &refusals, directory);
    }
    let library_handle = library::of_match(&args.directory, args.league)?;
    let mut matches = Matches {
        plan: args.plan(),
        base: library_handle.as_ref().map_or_else(CaseBase::default, LibraryHandle::lasting_base),
        settings: args.settings.choose()?.settings,
        program: VERSION.to_owned(),
        names: CaseNames::new(library_handle.as_ref().map_or_else(Vec::new, LibraryHandle::names)),
        refusals: None,
    };
    // Before hours are spent on matches that cannot be compared.
    args.before(&matches.identity())?;
    let directory = args.work.directory(args.shard)?;
    let file = directory.join(args.shard.file_name());
    let pool = args.work.pool()?;
    if matches.plan.strategy.is_some() {
        matches.refusals = Some(RefusalFile::beside(&file).open(&file)?);
    }
    let rows =
        work::with_bar(&pool, "playing", |on_progress| matches.play_shard(args.shard, &file, on_progress))?;
    let refusals = matches.refusals.as_ref().map_or_else(|| Ok(Vec::new()), RefusalFile::read)?;
    for Refusal { number, answers, .. } in &refusals {
        note!("warning  match {number}: {}", answers.warning().unwrap_or_default());
    }
    if args.shard == Shard::WHOLE {
        return args.finish(&matches.identity(), &rows, &refusals, directory);
    }
    let (kept, out) = (file.display(), directory.display());
    work::print_text(&format!(
        "{} matches in {kept}; when all shards are played: onetwo evaluate matches --merge {out} --out {out}\n",
        rows.len()
    ))?;
    Ok(ExitCode::SUCCESS)
}

impl MatchesArgs {
    fn plan(&self) -> MatchPlan {
        let mut opponents = self.opponents.clone();
        if opponents.is_empty() && (self.round_robin || !self.ablations) {
            opponents.extend(Team::OPPONENTS.map(MatchTeam::from));
        }
        if self.ablations {
            opponents.extend(MatchTeam::ablations());
        }
        let pairings = if self.round_robin {
            let teams: Vec<_> = [self.team].into_iter().chain(opponents).collect();
            MatchPlan::round_robin(&teams)
        } else {
            MatchPlan::against(self.team, &opponents)
        };
        MatchPlan {
            seed: self.seed,
            league: self.league.name().to_owned(),
            world: self.world,
            duration_s: self.duration,
            pairings,
            matches: self.matches,
            strategy: self.strategy.clone(),
            controller: self.game_controller.clone(),
        }
    }

    /// The matches to compare with, those of `now` by another program.
    fn before(&self, now: &MatchIdentity) -> Result<Option<(MatchIdentity, Vec<MatchRow>)>, Failure> {
        let Some(directory) = &self.compare else { return Ok(None) };
        let (identity, rows) = merge(shards::<MatchRow>(directory)?)?;
        check_same_matches(&identity, now).map_err(|differences| EvaluationError::OtherMatches {
            directory: directory.clone(),
            differences,
        })?;
        Ok(Some((identity, rows)))
    }

    /// Writes `matches.csv`, `matches.json` and the plots, and prints the tables.
    fn finish(
        &self,
        identity: &MatchIdentity,
        rows: &[MatchRow],
        refusals: &[Refusal],
        directory: &Path,
    ) -> Result<ExitCode, Failure> {
        let made = Made::new(identity, rows, refusals)?;
        let before = self.before(identity)?;
        let mut compared = String::new();
        if let Some((earlier, before)) = &before {
            let found = compare_matches(&identity.plan, before, rows);
            let names = [earlier, identity].map(version);
            let page = Versions { names: [&names[0], &names[1]], rows: [before, rows], found: &found }.html();
            let file = directory.join("compare.html");
            write(&file, FileKind::Html, page.as_bytes())?;
            compared = format!(
                "{}\n{}: both, match by match\n\n",
                comparison_table(&found).markdown(),
                file.display()
            );
        }
        write(&directory.join("matches.csv"), FileKind::Csv, &made.csv)?;
        write(&directory.join("matches.json"), FileKind::Json, &made.json()?)?;
        for figure in made.figures("") {
            write(&directory.join(&figure.name).with_extension("svg"), FileKind::Svg, figure.svg.as_bytes())?;
        }
        if let Some(file) = &self.markdown {
            let text_with = |beside: &str| made.text(beside, &self.section);
            insert(file, ("matches", &self.section), text_with, made.figures(&format!("{}-", self.section)))?;
        }
        let (matches, seed) = (made.matches, made.identity.plan.seed);
        work::print_text(&format!(
            "{}{}\n{}{matches} matches, seed {seed}, csv hash {}, in {}\n",
            compared,
            made.tables(),
            summary(&made.outcomes),
            made.hash,
            directory.display()
        ))?;
        Ok(ExitCode::SUCCESS)
    }
}

/// What is compared: the strategy's command, or who else played.
fn version(identity: &MatchIdentity) -> String {
    let MatchIdentity { plan, program, case_base, .. } = identity;
    plan.strategy.clone().unwrap_or_else(|| format!("{program}, cases {case_base}"))
}

/// Results of all matches.
struct Made<'a> {
    identity: &'a MatchIdentity,
    matches: usize,
    csv: Vec<u8>,
    hash: String,
    outcomes: Vec<Outcome>,
    effects: Vec<Effect>,
    passes: Passes,
    /// Refused answers, where a strategy plays.
    refused: Option<RefusedAnswers>,
}

impl<'a> Made<'a> {
    fn new(identity: &'a MatchIdentity, rows: &[MatchRow], refusals: &[Refusal]) -> Result<Self, Failure> {
        let csv = to_csv(rows).map_err(EvaluationError::from)?;
        Ok(Self {
            identity,
            matches: rows.len(),
            hash: csv_hash(&csv),
            csv,
            outcomes: outcomes(&identity.plan, rows),
            effects: effects(&identity.plan, rows),
            passes: our_passes(rows),
            refused: identity.plan.strategy.as_ref().map(|_| RefusedAnswers::of(refusals)),
        })
    }

    fn json(&self) -> Result<Vec<u8>, Failure> {
        let json = json!({
            "identity": self.identity, "csv_hash": self.hash, "pairs": self.outcomes, "effects": self.effects,
            "restart_passes": self.passes, "refused_answers": self.refused, "paper": { "table_1": PAPER_PASSES, "table_2": PAPER },
        });
        serde_json::to_vec_pretty(&json).map_err(|error| Failure::Output(error.into()))
    }

    fn tables(&self) -> String {
        markdown(&self.outcomes, &self.effects, &self.passes)
    }

    fn figures(&self, prefix: &str) -> Vec<FigureFile> {
        let named = |name: &str, svg| FigureFile { name: format!("{prefix}{name}"), svg };
        vec![named("ratios", plot(&self.outcomes)), named("calibration", calibration_plot(&self.passes))]
    }

    /// For a document whose figures are in the directory `beside`.
    fn text(&self, beside: &str, section: &str) -> String {
        let MatchIdentity { plan, case_base, program, .. } = self.identity;
        let cases = if case_library::league(&plan.league).is_some() {
            format!("cases {case_base}")
        } else {
            "no cases come with this league: robots that the host leaves free play reactively".to_owned()
        };
        let world = if plan.world == WorldPlan::default() {
            String::new()
        } else {
            format!(", world {}", plan.world)
        };
        let mut text = String::new();
        // Writing to a String cannot fail.
        let _ = writeln!(
            text,
            "{} matches a pair of {} s on {} ({cases}), seed {}{world}, csv hash {}, by {program}. `ours` plays {} of the second paper.\n\n\
             ![Offence and attack ratios]({beside}{section}-ratios.svg)\n\n\
             ![P(receive) as predicted and seen]({beside}{section}-calibration.svg)\n\n{}",
            plan.matches,
            plan.duration_s,
            plan.league,
            plan.seed,
            self.hash,
            Tactics::default().description().replace(',', ", "),
            self.tables().trim_end()
        );
        text
    }
}
