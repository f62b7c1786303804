//! `moment`: a match from a moment of a recording, once or several times with different seeds
//! (docs/case-format.md §5.2).

use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::atomic::Ordering;

use arena::game::{GameConfig, GameStart, PerTeam, TryOutcome, tries};
use clap::Args;
use feed::recording::{RecordingFailure, start_from};
use figures::{Row, Table, row};
use rules::{Colour, League};

use crate::Failure;
use crate::args::parsers::{colour, moment_in_seconds};
use crate::output::{json_line, print_text, quoted};
use crate::progress::Progress;
use crate::stop::stopped_by_hand;

/// Default length of a try, simulated s: an attack, and the counter-attack after it.
pub(super) const TRY_S: f64 = 20.0;

/// The moment that a match starts from.
#[derive(Debug, Args)]
pub(super) struct MomentArgs {
    /// Start from a moment of this recording, a league log (.log, .log.gz) or a trace: field, ball, robots
    /// with their velocities, and the referee's state are the recording's, and play goes on from there.
    #[arg(long, value_name = "FILE", requires = "at", conflicts_with_all = ["robots", "game_controller"])]
    from: Option<PathBuf>,
    /// The moment, seconds since the recording's start, as `onetwo replay` counts them. The match's first 0.5
    /// s repeat what led to it.
    #[arg(long, value_name = "SECONDS", requires = "from", value_parser = moment_in_seconds)]
    at: Option<f64>,
    /// The robots of this team drive along their recorded tracks, each until its track ends, it is pushed
    /// off it or it touches the ball; then its team leads it.
    #[arg(long, value_name = "COLOUR", requires = "from", value_parser = colour)]
    opponents_from_log: Option<Colour>,
    /// Play this many times from the moment, with seeds from --seed on, and print a line a try; implies
    /// --headless.
    #[arg(long, value_name = "N", requires = "from", conflicts_with = "record", value_parser = clap::value_parser!(u32).range(1..=10_000))]
    pub(super) tries: Option<u32>,
}

impl MomentArgs {
    /// The moment that is asked for, with recorded tracks for at most `after_s`.
    pub(super) fn start(&self, league: League, after_s: f64) -> Result<Option<GameStart>, RecordingFailure> {
        let Some((file, at)) = self.from.as_ref().zip(self.at) else { return Ok(None) };
        start_from(file, league, at, (self.opponents_from_log, after_s)).map(Some)
    }

    /// Appends its flags to a command line.
    pub(super) fn describe(&self, text: &mut String) {
        let Some((file, at)) = self.from.as_ref().zip(self.at) else { return };
        text.extend([" --from ", &quoted(&file.to_string_lossy()), " --at ", &at.to_string()]);
        if let Some(team) = self.opponents_from_log {
            text.extend([" --opponents-from-log ", team.label()]);
        }
    }
}

/// Plays the tries; with `json` an object a line for each.
pub(super) fn run_tries(config: &GameConfig, count: u32, json: bool) -> Result<ExitCode, Failure> {
    let (stopped, bar) = (stopped_by_hand(), Progress::of(u64::from(count), "tries"));
    let outcomes = tries(config, count, || stopped.load(Ordering::Relaxed), |_| bar.add(1))?;
    drop(bar);
    if json {
        let lines: Result<String, _> = outcomes.iter().map(json_line).collect();
        print_text(&lines?)?;
        return Ok(ExitCode::SUCCESS);
    }
    let table = Table::of_texts("seed | goals blue : yellow | shots | passes | ball | first shot | stopped");
    print_text(&format!(
        "{}\n{} tries of {} s: {} goals of blue, {} of yellow\n",
        table.with_rows(outcomes.iter().map(line)).markdown(),
        outcomes.len(),
        config.duration_s,
        outcomes.iter().map(|outcome| outcome.goals.blue).sum::<u32>(),
        outcomes.iter().map(|outcome| outcome.goals.yellow).sum::<u32>()
    ))?;
    Ok(ExitCode::SUCCESS)
}

fn line(outcome: &TryOutcome) -> Row {
    let ball = outcome.first_touch.map(|team| match outcome.lost_s {
        Some(lost) => format!("{team} loses it at {lost:.1} s"),
        None => format!("{team} keeps it"),
    });
    let shot = outcome.first_shot.map(|shot| format!("{} at {:.1} s", shot.team, shot.at_s));
    let stopped = outcome.stopped_s.map(|at| format!("{at:.1} s"));
    row![
        outcome.seed,
        pair(&outcome.goals),
        pair(&outcome.shots),
        pair(&outcome.passes),
        ball.unwrap_or_else(|| "none".to_owned()),
        shot.unwrap_or_else(|| "none".to_owned()),
        stopped.unwrap_or_else(|| "no".to_owned()),
    ]
}

fn pair(values: &PerTeam<u32>) -> String {
    format!("{} : {}", values.blue, values.yellow)
}
