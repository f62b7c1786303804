//! `onetwo cases play`: self-test of cases. Each is played from its own situation, in its league's simulator,
//! by robots that must retrieve it themselves.
//!
//! The answer is a text table, Markdown for the file beside the cases, or JSON: a list of scores. The same
//! seed gives the same answer for any number of jobs. `--story` prints the events of single attempts instead,
//! to debug a case.

use std::fmt::Write as _;
use std::io::Write as _;
use std::process::ExitCode;

use arena::cases::LibraryHandle;
use arena::{AttemptError, CaseNames, CaseTrial, Opposition, Score, Tape};
use casebase::Case;
use clap::Args;
use rules::League;

use super::failure::NoCase;
use crate::Failure;
use crate::args::{LibraryArgs, SettingsArgs, threads};
use crate::output::{self, print_text};
use crate::progress::Progress;

/// Arguments of `cases play`.
#[derive(Debug, Args)]
pub(crate) struct PlayArgs {
    /// Cases by region/name, or whole regions; all by default.
    #[arg(value_name = "NAME")]
    names: Vec<String>,
    #[command(flatten)]
    library: LibraryArgs,
    #[command(flatten)]
    settings: SettingsArgs,
    /// Attempts a case and kind of opposition.
    #[arg(short, long, default_value_t = 200, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    trials: u32,
    /// Random seed.
    #[arg(short, long, default_value_t = 1)]
    seed: u64,
    /// Opponents that stand in the path, or that play: the paper's scripted ones, or a reactive team in the
    /// Small Size League; both by default.
    #[arg(long, value_parser = opposition)]
    opponents: Option<Opposition>,
    /// Threads; the number of cores by default.
    #[arg(short, long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    jobs: Option<u16>,
    /// One JSON list of scores.
    #[arg(long, conflicts_with_all = ["markdown", "story"])]
    json: bool,
    /// Print the table as a Markdown file, headed by the command that reproduces it.
    #[arg(long, conflicts_with = "story")]
    markdown: bool,
    /// Print the events of each attempt instead of a table.
    #[arg(long)]
    story: bool,
}

pub(super) fn run(args: &PlayArgs) -> Result<ExitCode, Failure> {
    let settings = args.settings.choose()?.settings;
    let library_handle = crate::library::open(&args.library)?;
    let case_trial = CaseTrial {
        league: library_handle.simulated_league()?,
        base: library_handle.base(),
        names: CaseNames::new(library_handle.names()),
        settings,
        trials: args.trials,
        seed: args.seed,
    };
    let cases = chosen(args, &library_handle, &case_trial)?;
    let oppositions: Vec<_> = Opposition::ALL
        .into_iter()
        .filter(|kind| args.opponents.is_none_or(|wanted| wanted == *kind))
        .collect();
    if args.story {
        return write_story(&case_trial, &cases, &oppositions);
    }
    let scores = play(args, &case_trial, &cases, &oppositions)?;
    let output = if args.json {
        serde_json::to_string(&scores).map_err(|error| Failure::Output(error.into()))? + "\n"
    } else if args.markdown {
        args.heading(&case_trial, &scores) + &arena::markdown(&scores)
    } else {
        arena::markdown(&scores)
    };
    print_text(&output)?;
    Ok(ExitCode::SUCCESS)
}

/// The authored cases that are selected, in the order of ids.
fn chosen<'a>(
    args: &PlayArgs,
    library_handle: &LibraryHandle,
    case_trial: &CaseTrial<'a>,
) -> Result<Vec<Case<'a>>, Failure> {
    let names = library_handle.names();
    let means = |asked: &str, name: &str| {
        name == asked || name.strip_prefix(asked).is_some_and(|rest| rest.starts_with('/'))
    };
    for asked in &args.names {
        if !names.iter().any(|name| means(asked, name)) {
            return Err(NoCase::UnknownName {
                asked: asked.clone(),
                league: library_handle.league().to_owned(),
            }
            .into());
        }
    }
    let wanted = |name: &str| args.names.is_empty() || args.names.iter().any(|asked| means(asked, name));
    let cases = names.iter().enumerate().filter(|(_, name)| wanted(name));
    Ok(cases.filter_map(|(number, _)| case_trial.case(number)).collect())
}

/// All attempts, on the selected number of threads.
fn play(
    args: &PlayArgs,
    case_trial: &CaseTrial<'_>,
    cases: &[Case<'_>],
    oppositions: &[Opposition],
) -> Result<Vec<Score>, Failure> {
    let pool = threads(args.jobs)?;
    let attempts = u64::from(args.trials) * (cases.len() * oppositions.len()) as u64;
    // Drawn on stderr where that is a terminal, and nowhere else.
    let bar = Progress::of(attempts, "");
    let mut scores = Vec::new();
    for case in cases {
        let name = case_trial.names.of(case.id());
        bar.set_text(name.clone());
        for kind in oppositions {
            let attempts = pool.install(|| case_trial.play(case, *kind, &|| bar.add(1)));
            let attempts = attempts.map_err(failure)?;
            scores.push(Score::of(name.clone(), kind.label(), &attempts));
        }
    }
    Ok(scores)
}

/// Attempts as text, one after the other.
fn write_story(
    case_trial: &CaseTrial<'_>,
    cases: &[Case<'_>],
    oppositions: &[Opposition],
) -> Result<ExitCode, Failure> {
    let mut out = output::lines();
    for case in cases {
        for (kind, number) in
            oppositions.iter().flat_map(|kind| (0..case_trial.trials).map(move |n| (*kind, n)))
        {
            let mut tape = Tape::default();
            let attempt = case_trial.attempt(case, kind, number, Some(&mut tape)).map_err(failure)?;
            let mut text =
                format!("{}, opponents {}, attempt {number}\n", case_trial.names.of(case.id()), kind.label());
            for line in tape.story {
                let _ = writeln!(text, "{line}");
            }
            let end = attempt.end.map_or("not played", arena::CycleEnd::label);
            let _ = writeln!(text, "{end}, the ball {:.2} m nearer to the goal line\n", attempt.progress);
            out.write_all(text.as_bytes()).and_then(|()| out.flush()).map_err(Failure::Output)?;
        }
    }
    Ok(ExitCode::SUCCESS)
}

fn failure(error: AttemptError) -> Failure {
    match error {
        AttemptError::FourLegged(error) => error.into(),
        AttemptError::SmallSize(error) => error.into(),
    }
}

impl PlayArgs {
    /// Lines above the table.
    fn heading(&self, case_trial: &CaseTrial<'_>, scores: &[Score]) -> String {
        let [trials, seed, hash] = [u64::from(self.trials), self.seed, u64::from(case_trial.base.hash())];
        let reached = |label: &str| {
            let of_kind: Vec<_> = scores.iter().filter(|score| score.opponents == label).collect();
            let reached = of_kind.iter().filter(|score| score.completed_percent() >= ENOUGH_PERCENT).count();
            format!("{reached} of {}", of_kind.len())
        };
        let mut command = "onetwo cases play".to_owned();
        let small_size = case_trial.league != League::FourLegged;
        if small_size {
            let _ = write!(command, " --league {}", case_trial.league.name());
        }
        for name in &self.names {
            let _ = write!(command, " {name}");
        }
        if let Some(directory) = &self.library.directory.library {
            let _ = write!(command, " --library {}", directory.display());
        }
        let _ = write!(command, " --trials {trials} --seed {seed}");
        for (name, value) in self.settings.given() {
            let _ = write!(command, " --set {name}={value}");
        }
        if let Some(kind) = self.opponents {
            let _ = write!(command, " --opponents {}", kind.label());
        }
        let playing = if small_size {
            "they play reactively, one that starts in its own defence area as keeper"
        } else {
            "they are the paper's scripted ones, at home in the region of their role, or in one as deep about their scope \
             where no role is at home"
        };
        format!(
            "# Cases played from their own situations\n\n\
             Written by `{command} --markdown` (case base {hash:08x}). Each case is played {trials} times by its own robots alone, \
             which must retrieve it themselves: the ball in the core of its scope (similarity H), robots 150 mm about their places, \
             opponents drawn on their scopes. *standing*: opponents hold their places. *playing*: {playing}. Percentages are shares \
             of all {trials} attempts; *completed* means that every robot did its whole part; *why not* counts what was retrieved \
             instead and why gameplays ended early; the last columns are of completed gameplays, the ball watched until it lies still \
             or is taken.\n\n\
             At least {ENOUGH_PERCENT:.0} % completed: {} standing, {} playing.\n\n",
            reached("standing"),
            reached("playing"),
        )
    }
}

fn opposition(label: &str) -> Result<Opposition, String> {
    Opposition::from_label(label).ok_or_else(|| "take standing or playing".to_owned())
}

/// A case that is completed less often must give the reason in its file, percent.
const ENOUGH_PERCENT: f64 = 60.0;
