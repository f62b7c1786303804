//! `onetwo play`: a whole match in the simulator, both teams ours (DESIGN §8). Told line by line, or as one JSON object.

use std::io::{self, IsTerminal, Write};
use std::path::PathBuf;
use std::process::ExitCode;

use arena::game::{self, Crowd, Game, GameConfig, GameReport, GameStory, Watcher};
use casebase::CaseBase;
use clap::Args;
use hil_sim::NativeBackend;
use host::shell::Recorder;
use indicatif::{ProgressBar, ProgressStyle};
use rules::League;

use crate::Failure;
use crate::args::{FolderArgs, LibraryArgs, SettingsArgs};
use crate::library::Shelf;

/// What decides a match.
#[derive(Debug, Args)]
pub(crate) struct PlayArgs {
    /// Without the page: a match is told on the terminal, as fast as the machine plays it.
    #[arg(long)]
    headless: bool,
    /// Length of the match, simulated seconds.
    #[arg(long, value_name = "SECONDS", default_value_t = 600.0, value_parser = seconds)]
    duration: f64,
    /// Where all chance comes from.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Field, robots and rules: ssl-2013, division-b or division-a.
    #[arg(long, default_value = "division-b", value_parser = league)]
    league: League,
    /// Robots of each team; the league's number unless told.
    #[arg(long, value_parser = clap::value_parser!(u8).range(1..=11))]
    robots: Option<u8>,
    /// Keep the match as NAME.log.gz (for the league's tools) and NAME.trace (for `onetwo replay`).
    #[arg(long, value_name = "NAME")]
    record: Option<PathBuf>,
    /// Print the report as JSON, and nothing else.
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    folder: FolderArgs,
    #[command(flatten)]
    settings: SettingsArgs,
}

fn seconds(text: &str) -> Result<f64, String> {
    let seconds: f64 = text.parse().map_err(|_| "expected seconds, such as 600".to_owned())?;
    if (0.0..=36_000.0).contains(&seconds) { Ok(seconds) } else { Err("0 to 36000 seconds".to_owned()) }
}

pub(crate) fn league(name: &str) -> Result<League, String> {
    [League::Ssl2013, League::DivisionB, League::DivisionA]
        .into_iter()
        .find(|league| league.name() == name)
        .ok_or_else(|| "expected ssl-2013, division-b or division-a".to_owned())
}

/// `onetwo play`.
pub(crate) fn run(args: &PlayArgs) -> Result<ExitCode, Failure> {
    let mut config = GameConfig::new(args.league, args.seed, args.duration);
    let settings = args.settings.choose()?.settings;
    for team in &mut config.teams {
        team.settings = settings.clone();
        team.robots = args.robots.unwrap_or(team.robots);
    }
    let shelf = cases(args)?;
    let base = shelf.as_ref().map_or_else(CaseBase::default, Shelf::base);
    let mut backend = NativeBackend::new(base);
    let mut recording = args.record.as_ref().map(|stem| record(stem, &config)).transpose()?;
    let mut teller = Teller::new(args);
    let report = {
        let mut crowd = Crowd(vec![&mut teller]);
        if let Some(recording) = &mut recording {
            crowd.0.push(recording);
        }
        game::play(&config, &mut backend, &mut crowd).map_err(|error| Failure::Game(error.to_string()))?
    };
    if let Some(recording) = recording {
        recording.finish().map_err(|error| Failure::Recording(error.to_string()))?;
    }
    teller.end();
    let mut out = io::stdout().lock();
    if args.json {
        let json = serde_json::to_string(&report).map_err(|error| Failure::Output(error.into()))?;
        writeln!(out, "{json}").map_err(Failure::Output)?;
    } else {
        tell(&mut out, args, &report).map_err(Failure::Output)?;
    }
    Ok(ExitCode::SUCCESS)
}

/// The league's cases; a league without any plays by the reactive behaviour where the host leaves robots free.
fn cases(args: &PlayArgs) -> Result<Option<Shelf>, Failure> {
    let known = case_library::LEAGUES.iter().any(|league| league.name == args.league.name());
    if args.folder.library.is_none() && !known {
        eprintln!("no cases come with {}: robots that are left free play reactively", args.league.name());
        return Ok(None);
    }
    let folder = FolderArgs { library: args.folder.library.clone() };
    Shelf::open(&LibraryArgs { folder, league: args.league.name().to_owned() }).map(Some)
}

fn record(stem: &std::path::Path, config: &GameConfig) -> Result<Recorder, Failure> {
    let header = game::header(env!("CARGO_PKG_VERSION"), env!("ONETWO_COMMIT"), config);
    Recorder::begin(stem, &header).map_err(|error| Failure::Recording(format!("{}: {error}", stem.display())))
}

fn tell(out: &mut impl Write, args: &PlayArgs, report: &GameReport) -> io::Result<()> {
    let percent = report.ball_in_play * 100.0;
    writeln!(
        out,
        "blue {} : {} yellow after {:.0} s, ball in play {percent:.0} %",
        report.score.blue, report.score.yellow, report.duration_s
    )?;
    let teams = [
        ("blue", &report.metrics.blue, &report.fouls.blue),
        ("yellow", &report.metrics.yellow, &report.fouls.yellow),
    ];
    for (name, metrics, fouls) in teams {
        let fouls: Vec<_> = fouls.iter().map(|(kind, n)| format!("{n} {}", kind.replace('_', " "))).collect();
        let fouls = if fouls.is_empty() { "no fouls".to_owned() } else { fouls.join(", ") };
        writeln!(
            out,
            "{name}: {} shots, {} chances, {} passes, {:.0} s of possession; {fouls}",
            metrics.shots, metrics.chances, metrics.passes, metrics.possession_s
        )?;
    }
    let words = if args.duration == 600.0 { String::new() } else { format!(" --duration {}", args.duration) };
    writeln!(out, "trace {}, to see it again: onetwo play --seed {}{words}", report.trace_hash, args.seed)
}

/// Tells the story on stdout, or how far it is on a terminal where only the report is wanted.
struct Teller {
    story: Option<GameStory>,
    bar: ProgressBar,
}

impl Teller {
    fn new(args: &PlayArgs) -> Self {
        let bar = if args.json && io::stderr().is_terminal() {
            let style = ProgressStyle::with_template("{bar:40} {pos} of {len} s")
                .unwrap_or_else(|_| ProgressStyle::default_bar());
            ProgressBar::new(args.duration as u64).with_style(style)
        } else {
            ProgressBar::hidden()
        };
        Self { story: (!args.json).then(GameStory::default), bar }
    }

    fn end(&self) {
        self.bar.finish_and_clear();
    }
}

impl Watcher for Teller {
    fn tick(&mut self, game: &Game<'_>) {
        self.bar.set_position(game.time() as u64);
        if let Some(story) = &mut self.story {
            story.tick(game);
            let mut out = io::stdout().lock();
            for line in story.take_lines() {
                // A reader who has had enough ends the program with the report's own write.
                let _ = writeln!(out, "{line}");
            }
        }
    }
}
