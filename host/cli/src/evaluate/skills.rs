//! `onetwo evaluate skills`: how often and how fast each skill succeeds, in one world or a family of them.

use std::fmt::Write as _;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Args;
use figures::{Table, row};
use hil_sim::small_size::worlds::{WorldChoice, WorldPlan};
use rules::League;
use study::skills::{Skill, SkillPlan, SkillRow, TryResult, rows};
use study::store::Experiment;

use super::report::insert;
use super::work;
use crate::Failure;
use crate::args::{parsers::league, threads};

/// Which tries, and how they are printed.
#[derive(Debug, Args)]
pub(super) struct SkillsArgs {
    /// Field, robots, ball and rules: division-b, ssl-2013 or division-a.
    #[arg(long, default_value = "division-b", value_parser = league)]
    league: League,
    /// Physics: nominal, a profile's name, random:SEED, or random for the --worlds worlds from --seed on.
    #[arg(long, default_value = "nominal", value_name = "WORLD")]
    world: WorldPlan,
    /// How many random worlds.
    #[arg(long, default_value_t = 1, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100_000))]
    worlds: u32,
    /// Tries of each skill in each world.
    #[arg(long, default_value_t = 20, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100_000))]
    tries: u32,
    /// Random seed.
    #[arg(short, long, default_value_t = 1)]
    seed: u64,
    /// Only these skills, with commas between: placement, get-ball, receive, dribble, turn-with-ball, kick,
    /// chip, save.
    #[arg(long = "skill", value_name = "LIST", value_delimiter = ',', value_parser = skill)]
    skills: Vec<Skill>,
    /// Number of the first try of each skill, to repeat one.
    #[arg(long, default_value_t = 0, value_name = "N", value_parser = clap::value_parser!(u32).range(..=1_000_000_000))]
    first: u32,
    /// Threads; the number of cores by default.
    #[arg(short, long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    jobs: Option<u16>,
    /// Print a JSON list, a row a skill, and nothing else.
    #[arg(long, conflicts_with_all = ["failures", "story", "markdown"])]
    json: bool,
    /// List every try that failed: its start, what was wrong, and the command that repeats it.
    #[arg(long)]
    failures: bool,
    /// Print every try, a line for each tenth of a second.
    #[arg(long)]
    story: bool,
    /// Put the table between the markers of this Markdown file.
    #[arg(long, value_name = "FILE")]
    markdown: Option<PathBuf>,
    /// Name of the markers.
    #[arg(long, value_name = "NAME", default_value = "skills", requires = "markdown")]
    section: String,
}

fn skill(label: &str) -> Result<Skill, String> {
    Skill::from_label(label).ok_or_else(|| format!("take {}", Skill::ALL.map(Skill::label).join(", ")))
}

pub(super) fn run(args: &SkillsArgs) -> Result<ExitCode, Failure> {
    let plan = args.plan();
    if args.story {
        return story(&plan);
    }
    let pool = threads(args.jobs)?;
    let results = pool.install(|| plan.play_all(&|| ()))?;
    let table = rows(&plan, &results);
    if args.json {
        let json = serde_json::to_string(&table).map_err(|error| Failure::Output(error.into()))?;
        work::print_text(&format!("{json}\n"))?;
        return Ok(ExitCode::SUCCESS);
    }
    let mut text = markdown(&table);
    if let Some(file) = &args.markdown {
        insert(file, ("skills", &args.section), |_| markdown(&table), Vec::new())?;
    }
    if args.failures {
        text += &failures(&results);
    }
    work::print_text(&text)?;
    Ok(ExitCode::SUCCESS)
}

impl SkillsArgs {
    fn plan(&self) -> SkillPlan {
        let worlds = match self.world {
            WorldPlan::Same(world) => vec![world],
            WorldPlan::RandomPerMatch => {
                (0..u64::from(self.worlds)).map(|i| WorldChoice::Random(self.seed.wrapping_add(i))).collect()
            }
        };
        SkillPlan {
            league: self.league,
            world: self.world.to_string(),
            worlds,
            tries: self.tries,
            first: self.first,
            seed: self.seed,
            skills: if self.skills.is_empty() { Skill::ALL.to_vec() } else { self.skills.clone() },
        }
    }
}

fn markdown(rows: &[SkillRow]) -> String {
    let rows = rows.iter().map(|row| {
        let share = 100.0 * row.succeeded as f64 / row.tries.max(1) as f64;
        row![
            row.skill,
            row.league,
            row.world,
            row.worlds,
            row.tries,
            row.succeeded,
            format!("{share:.1} %"),
            seconds(row.time_median_s),
            seconds(row.time_p95_s),
        ]
    });
    let heads = "skill | league | world | worlds | tries | succeeded | share | median time | 95 % within";
    Table::of_texts(heads).with_rows(rows).markdown()
}

fn seconds(time: Option<f64>) -> String {
    time.map_or(String::new(), |time| format!("{time:.2} s"))
}

/// Tries that failed, two lines each.
fn failures(results: &[TryResult]) -> String {
    let mut text = String::new();
    for result in results {
        if let Err(what) = &result.end {
            let TryResult { tried, start, .. } = result;
            let (skill, world, number) = (tried.skill.label(), tried.world, tried.number);
            let _ = writeln!(text, "\n{skill} {number} in {world}: {start}: {what}\n  {}", tried.command());
        }
    }
    text
}

/// Every try of the plan, one after the other.
fn story(plan: &SkillPlan) -> Result<ExitCode, Failure> {
    for tried in plan.tries() {
        let mut lines = Vec::new();
        let result = tried.play(&mut lines)?;
        let end = match &result.end {
            Ok(time) => format!("succeeded after {time:.2} s"),
            Err(what) => format!("failed: {what}"),
        };
        let TryResult { tried, start, .. } = &result;
        let head = format!("{} {} in {}: {start}", tried.skill.label(), tried.number, tried.world);
        work::print_text(&format!("{head}\n{}\n{end}\n", lines.join("\n")))?;
    }
    Ok(ExitCode::SUCCESS)
}
