//! `onetwo evaluate scenes`: what each part of our play is worth, on short scenes from equal starts.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Args;
use hil_sim::small_size::worlds::WorldChoice;
use host::strategy::{ROUND_1, Team};
use rules::League;
use study::drills::{DrillKind, DrillPlan, drill_results, drill_table, situations};
use study::matches::MatchTeam;
use study::scenes::{SceneEffect, ScenePlan, scene_effects, scene_table};
use study::store::{EvaluationError, csv_hash, to_csv};

use super::report::insert;
use super::work::{self, write};
use crate::Failure;
use crate::args::parsers::league;
use crate::destination::{self, FileKind};

/// Which scenes, and how they are printed.
#[derive(Debug, Args)]
pub(super) struct ScenesArgs {
    /// Field, robots and rules: division-b or ssl-2013. Robots play the cases of division B.
    #[arg(long, default_value = "division-b", value_parser = league)]
    league: League,
    /// Physics: nominal, a profile's name or random:SEED.
    #[arg(long, default_value = "nominal", value_name = "WORLD")]
    world: WorldChoice,
    /// Free kicks against each opponent.
    #[arg(long, default_value_t = 200, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=100_000))]
    free_kicks: u32,
    /// Moments of open play against each opponent.
    #[arg(long, default_value_t = 500, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=100_000))]
    open_play: u32,
    /// The team that the others are compared with.
    #[arg(long, value_name = "TEAM", default_value = "ours", value_parser = MatchTeam::parse)]
    team: MatchTeam,
    /// The same with one part more or less, with commas between, such as ours-with-coerce; by default our
    /// team once for each part.
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = MatchTeam::parse)]
    variants: Vec<MatchTeam>,
    /// Opponents, with commas between; by default reactive (a wall and markers against free kicks), marking
    /// (man against man), zone (a wall that follows the ball) and round-1 (second-level threats).
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = MatchTeam::parse)]
    opponents: Vec<MatchTeam>,
    /// Instead of scenes: these drills against scripted opponents, with commas between: carrier, marker,
    /// cross, rebound, shielder, goal-line, contested. Of our team's options --team, --world, --seed, --jobs,
    /// --csv, --json count.
    #[arg(long = "drill", value_name = "LIST", value_delimiter = ',', value_parser = drill)]
    drills: Vec<DrillKind>,
    /// Draw the drills around the situations of this CSV file, plain or gzip, with its index.csv beside it;
    /// by default around those that come with the program.
    #[arg(long, value_name = "FILE", requires = "drills")]
    situations: Option<PathBuf>,
    /// Tries of each drill.
    #[arg(long, default_value_t = 200, value_name = "N", requires = "drills", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    tries: u32,
    /// Random seed.
    #[arg(short, long, default_value_t = 1)]
    seed: u64,
    /// Threads; the number of cores by default.
    #[arg(short, long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    jobs: Option<u16>,
    /// Write every scene as a row of this CSV file.
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Print a JSON list, an object for each effect, and nothing else; of drills an object a line for each.
    #[arg(long, conflicts_with = "markdown")]
    json: bool,
    /// Put the table between the markers of this Markdown file.
    #[arg(long, value_name = "FILE")]
    markdown: Option<PathBuf>,
    /// Name of the markers.
    #[arg(long, value_name = "NAME", default_value = "scenes", requires = "markdown")]
    section: String,
}

pub(super) fn run(args: &ScenesArgs) -> Result<ExitCode, Failure> {
    if let Some(file) = &args.csv {
        let inputs: Vec<_> = args.markdown.iter().chain(&args.situations).map(PathBuf::as_path).collect();
        destination::check(&[(file, FileKind::Csv)], &inputs)?;
    }
    if !args.drills.is_empty() {
        return run_drills(args);
    }
    let plan = args.plan();
    let rows = work::play_all(&plan, plan.len() as u64, args.jobs)?;
    let csv = to_csv(&rows).map_err(EvaluationError::from)?;
    if let Some(file) = &args.csv {
        write(file, FileKind::Csv, &csv)?;
    }
    let effects = scene_effects(&plan, &rows);
    if args.json {
        let json = serde_json::to_string(&effects).map_err(|error| Failure::Output(error.into()))?;
        work::print_text(&format!("{json}\n"))?;
        return Ok(ExitCode::SUCCESS);
    }
    let text = args.text(&plan, &effects, &csv_hash(&csv));
    if let Some(file) = &args.markdown {
        insert(file, ("scenes", &args.section), |_| text.clone(), Vec::new())?;
    }
    work::print_text(&text)?;
    Ok(ExitCode::SUCCESS)
}

/// Plays the drills; with --json one object a drill, a line each.
fn run_drills(args: &ScenesArgs) -> Result<ExitCode, Failure> {
    let situations = match &args.situations {
        Some(file) => situations::read(file),
        None => situations::built_in(),
    };
    let plan = DrillPlan {
        drills: args.drills.clone(),
        situations: situations?,
        tries: args.tries,
        seed: args.seed,
        world: args.world,
        team: args.team,
    };
    let of = plan.drills.len() as u64 * u64::from(plan.tries);
    let rows = work::play_all(&plan, of, args.jobs)?;
    let csv = to_csv(&rows).map_err(EvaluationError::from)?;
    if let Some(file) = &args.csv {
        write(file, FileKind::Csv, &csv)?;
    }
    let results = drill_results(&plan, &rows);
    if !args.json {
        let text = drill_table(&results);
        work::print_text(&format!(
            "{text}\n{} in {}, seed {}, csv hash {}\n",
            args.team,
            args.world,
            args.seed,
            csv_hash(&csv)
        ))?;
        return Ok(ExitCode::SUCCESS);
    }
    let lines: Result<Vec<_>, _> = results.iter().map(serde_json::to_string).collect();
    let lines = lines.map_err(|error| Failure::Output(error.into()))?;
    work::print_text(&format!("{}\n", lines.join("\n")))?;
    Ok(ExitCode::SUCCESS)
}

fn drill(label: &str) -> Result<DrillKind, String> {
    DrillKind::from_label(label)
        .ok_or_else(|| format!("take {}", DrillKind::ALL.map(DrillKind::label).join(", ")))
}

impl ScenesArgs {
    fn plan(&self) -> ScenePlan {
        let references = Team::OPPONENTS.map(MatchTeam::from).into_iter().chain([MatchTeam::round_1()]);
        ScenePlan {
            league: self.league,
            world: self.world,
            seed: self.seed,
            free_kicks: self.free_kicks,
            open_play: self.open_play,
            team: self.team,
            variants: given_or(&self.variants, MatchTeam::ablations()),
            opponents: given_or(&self.opponents, references.collect()),
        }
    }

    fn text(&self, plan: &ScenePlan, effects: &[SceneEffect], hash: &str) -> String {
        format!(
            "{}\n{} scenes in {}, seed {}, csv hash {hash}; {ROUND_1} is our team by thresholds\n",
            scene_table(effects),
            plan.len(),
            self.world,
            self.seed
        )
    }
}

/// The teams given on the command line, or these if there are none.
fn given_or(given: &[MatchTeam], default: Vec<MatchTeam>) -> Vec<MatchTeam> {
    if given.is_empty() { default } else { given.to_vec() }
}
