//! `onetwo play`: a whole match in the simulator, ours against ours or another team (docs/case-format.md §5).
//! Displayed on the page at the clock's pace; `--headless` as fast as the machine plays it, printed line by
//! line, or as one JSON object.

mod moment;

use std::io::{self, Write};
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::atomic::Ordering;

use arena::CaseNames;
use arena::cases::LibraryHandle;
use arena::game::{self, Game, GameConfig, GameReport, MatchLog, StrategyReport, Watcher, Watchers};
use clap::Args;
use feed::{
    CaseExplanations, End, MatchObserver, MatchRunner, MomentSource, RecentMoments, RunSettings,
    SharedLibrary,
};
use hil_sim::NativeBackend;
use hil_sim::small_size::network::ControllerChoice;
use hil_sim::small_size::worlds::WorldChoice;
use host::record::Recorder;
use host::shell::StrategyProcess;
use host::strategy::{Tactics, Team};
use page::Powers;
use protocol::Instant;
use rules::{Colour, League};

use crate::Failure;
use crate::args::page::PageArgs;
use crate::args::parsers::{league, match_seconds, match_speed, team};
use crate::args::{DirectoryArgs, SettingsArgs};
use crate::destination::check_recording;
use crate::library;
use crate::output::{self, note, program_log, quoted};
use crate::progress::Progress;
use crate::robot_description::ensure_built_for;
use crate::stop::{signal, stopped_by_hand};
use moment::MomentArgs;

/// Settings of a match.
#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES)]
pub(crate) struct PlayArgs {
    /// Without the page: events are printed on the terminal, and the match runs as fast as the machine plays
    /// it.
    #[arg(long)]
    headless: bool,
    #[command(flatten)]
    page: PageArgs,
    /// Simulated seconds a second, with the page; its viewers can change it.
    #[arg(long, value_name = "X", default_value_t = 1.0, value_parser = match_speed, conflicts_with = "headless")]
    speed: f32,
    /// Length of the match, simulated seconds; 600 by default, 20 with --tries.
    #[arg(short, long, value_name = "SECONDS", value_parser = match_seconds)]
    duration: Option<f64>,
    /// Random seed.
    #[arg(short, long, default_value_t = 1)]
    seed: u64,
    /// Field, robots and rules: ssl-2013, division-b or division-a.
    #[arg(long, default_value = "division-b", value_parser = league)]
    league: League,
    /// Which world of the family it is played in: nominal, grsim, erforce, erforce-none, sumatra,
    /// slow-dribbler, poor-vision, weak-kickers or random:SEED (docs/fields.md).
    #[arg(long, value_name = "WORLD", default_value_t)]
    world: WorldChoice,
    /// Blue team: ours, reactive, marking, zone or idle.
    #[arg(long, value_name = "TEAM", default_value = "ours", value_parser = team)]
    blue: Team,
    /// Yellow team.
    #[arg(long, value_name = "TEAM", default_value = "ours", value_parser = team)]
    yellow: Team,
    /// Robots of each team; the league's number by default.
    #[arg(long, value_parser = clap::value_parser!(u8).range(1..=11))]
    robots: Option<u8>,
    /// Yellow's tactics of the second paper, if it is ours: none, all, default, round-1, or names such as
    /// threats,pass-ahead.
    #[arg(long, value_name = "TACTICS", default_value = "default", value_parser = Tactics::parse)]
    yellow_tactics: Tactics,
    /// The same for blue.
    #[arg(long, value_name = "TACTICS", default_value = "default", value_parser = Tactics::parse)]
    blue_tactics: Tactics,
    /// A program that gives yellow's orders: it gets the view as a line of JSON and answers with one
    /// (docs/strategy-protocol.md).
    #[arg(long, value_name = "COMMAND")]
    yellow_strategy: Option<String>,
    /// The same for blue.
    #[arg(long, value_name = "COMMAND")]
    blue_strategy: Option<String>,
    /// Play under the league's game controller in its CI mode: its program, which is started for the match,
    /// or HOST:PORT where one listens (docs/commands.md).
    #[arg(long, value_name = "PATH|HOST:PORT", requires = "headless")]
    game_controller: Option<ControllerChoice>,
    #[command(flatten)]
    moment: MomentArgs,
    /// Record the match as NAME.log.gz (for the league's tools) and NAME.trace (for `onetwo replay`).
    #[arg(short, long, value_name = "NAME")]
    record: Option<PathBuf>,
    /// Print the report as JSON, and nothing else; implies --headless.
    #[arg(long)]
    json: bool,
    /// The robot's description, a file or a built-in name: refused where it is not the one that this program
    /// is built for (docs/robots.md).
    #[arg(long, value_name = "FILE")]
    robot: Option<String>,
    #[command(flatten)]
    directory: DirectoryArgs,
    #[command(flatten)]
    settings: SettingsArgs,
}

const EXIT_CODES: &str = "\
Exit codes: 0 played to its end; 1 it could not be played or recorded; 2 wrong usage. With --headless a first Ctrl-C (or SIGTERM) ends
the match in order: recordings are closed, the summary is printed, and the exit code is 130 (or 143). A second one ends it at once.";

pub(crate) fn run(args: &PlayArgs) -> Result<ExitCode, Failure> {
    ensure_built_for(args.robot.as_deref())?;
    check_recording(args.record.as_deref(), args.directory.library.as_deref().as_slice())?;
    let mut config = GameConfig::new(args.league, args.seed, args.duration()).between(args.blue, args.yellow);
    config.world = args.world;
    let settings = args.settings.choose()?.settings;
    for team in &mut config.teams {
        team.settings = settings.clone();
        team.tactics = if team.colour == Colour::Blue { args.blue_tactics } else { args.yellow_tactics };
        team.robots = args.robots.unwrap_or(team.robots);
        let command = if team.colour == Colour::Blue { &args.blue_strategy } else { &args.yellow_strategy };
        team.strategy = command.as_deref().map(StrategyProcess::starter);
    }
    config.controller.clone_from(&args.game_controller);
    let library_handle = library::of_match(&args.directory, args.league)?;
    if let Some(library_handle) = &library_handle {
        config.names = CaseNames::new(library_handle.names());
        config.cases = Some(library_handle.lasting_base());
    }
    if let Some(start) = args.moment.start(args.league, args.duration())? {
        config = config.starting_from(start.into());
    }
    if let Some(count) = args.moment.tries {
        return moment::run_tries(&config, count, args.json);
    }
    let mut backend = NativeBackend::new(config.cases.unwrap_or_default());
    let mut recording = args.record.as_ref().map(|stem| record(stem, &config)).transpose()?;
    let mut teller = Teller::new(args);
    if !args.headless && !args.json {
        return on_page(args, config, library_handle, Watched { teller, recording });
    }
    let stopped = stopped_by_hand();
    let report = {
        let mut crowd = Watchers(vec![&mut teller]);
        if let Some(recording) = &mut recording {
            crowd.0.push(recording);
        }
        game::play_until(&config, &mut backend, &mut crowd, || stopped.load(Ordering::Relaxed))?
    };
    if let Some(recording) = recording {
        recording.finish().map_err(|error| Failure::Recording { stem: None, error })?;
    }
    teller.end();
    let mut out = output::lines();
    if args.json {
        let json = serde_json::to_string(&report).map_err(|error| Failure::Output(error.into()))?;
        writeln!(out, "{json}").map_err(Failure::Output)?;
    } else {
        write_report(&mut out, args, &report).map_err(Failure::Output)?;
    }
    out.flush().map_err(Failure::Output)?;
    let strategies = [("blue", &report.metrics.blue), ("yellow", &report.metrics.yellow)];
    let mut never_played = false;
    for (name, metrics) in strategies {
        let Some(strategy) = &metrics.strategy else { continue };
        never_played |= strategy.never_played();
        if let Some(warning) = strategy.warning().filter(|_| args.json || strategy.never_played()) {
            note!("warning  {name}: {warning}");
        }
    }
    let Some((signal, code)) = signal() else {
        return Ok(if never_played { ExitCode::FAILURE } else { ExitCode::SUCCESS });
    };
    note!(
        "ended by {signal} after {:.2} s of {} s; what was played is above",
        report.duration_s,
        args.duration()
    );
    Ok(code)
}

impl PlayArgs {
    fn duration(&self) -> f64 {
        let default = if self.moment.tries.is_some() { moment::TRY_S } else { MATCH_S };
        self.duration.unwrap_or(default)
    }
}

/// Default length of a match, simulated s: the two halves of the league's.
const MATCH_S: f64 = 600.0;

/// At the clock's pace, with the page; it stays open when the match is over.
fn on_page(
    args: &PlayArgs,
    config: GameConfig,
    library_handle: Option<LibraryHandle>,
    mut watched: Watched,
) -> Result<ExitCode, Failure> {
    let settings = args.settings.choose()?.settings;
    let library = SharedLibrary::new(library_handle);
    let moments = RecentMoments::default();
    let explanations =
        CaseExplanations::sharing(library.clone(), settings).playing_on(MomentSource::Match(moments.clone()));
    let world =
        if args.world == WorldChoice::Nominal { String::new() } else { format!(", world {}", args.world) };
    let [blue, yellow] = [(args.blue, &args.blue_strategy), (args.yellow, &args.yellow_strategy)]
        .map(|(team, command)| side(team, command.as_deref()));
    let title = format!("{blue} – {yellow}, {}, seed {}{world}", args.league.name(), args.seed);
    let page = args.page.open(title, false, Powers::Simulation, explanations)?;
    note!("playing  {}; Ctrl-C ends it", args.league.name());
    let (speed, recorded) = (args.speed, args.record.is_some());
    let settings = RunSettings { speed, recorded, log: program_log(), stopped: stopped_by_hand(), moments };
    let mut match_runner = MatchRunner::new(config, library, page, settings);
    loop {
        let (report, over) = match match_runner.play(&mut watched)? {
            End::Over(report) => (report, true),
            End::ByHand(report) => (report, false),
        };
        if let Some(recording) = watched.recording.take() {
            recording.finish().map_err(|error| Failure::Recording { stem: None, error })?;
        }
        let mut out = output::lines();
        write_report(&mut out, args, &report).and_then(|()| out.flush()).map_err(Failure::Output)?;
        if !over {
            return Ok(ExitCode::SUCCESS);
        }
        note!("the match is over; the page stays until Ctrl-C");
        let Some(seed) = match_runner.linger() else { return Ok(ExitCode::SUCCESS) };
        match_runner.restart(seed, &mut watched);
    }
}

/// Event printer and recorder of a match on the page.
struct Watched {
    teller: Teller,
    recording: Option<Recorder>,
}

impl MatchObserver for Watched {
    fn watcher(&mut self) -> &mut dyn Watcher {
        self
    }

    fn restart(&mut self) {
        self.teller.story = self.teller.story.is_some().then(MatchLog::default);
    }

    fn note(&mut self, line: &str) {
        note!("{line}");
    }
}

impl Watcher for Watched {
    fn vision(&mut self, now: Instant, bytes: &[u8]) {
        self.recording.iter_mut().for_each(|recording| recording.vision(now, bytes));
    }
    fn referee(&mut self, now: Instant, bytes: &[u8]) {
        self.recording.iter_mut().for_each(|recording| recording.referee(now, bytes));
    }
    fn input(&mut self, now: Instant, host: Colour, input: host::Input<'_>) {
        self.recording.iter_mut().for_each(|recording| recording.input(now, host, input));
    }
    fn sent(&mut self, now: Instant, host: Colour, to: host::radio::To, packet: &[u8]) {
        self.recording.iter_mut().for_each(|recording| recording.sent(now, host, to, packet));
    }
    fn tick(&mut self, game: &Game<'_>) {
        self.teller.tick(game);
    }
}

fn record(stem: &std::path::Path, config: &GameConfig) -> Result<Recorder, Failure> {
    let header = game::header(env!("CARGO_PKG_VERSION"), env!("ONETWO_COMMIT"), config);
    Recorder::begin(stem, &header).map_err(|error| Failure::Recording { stem: Some(stem.to_owned()), error })
}

fn write_report(out: &mut impl Write, args: &PlayArgs, report: &GameReport) -> io::Result<()> {
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
    for (name, metrics, fouls) in &teams {
        let fouls: Vec<_> = fouls.iter().map(|(kind, n)| format!("{n} {}", kind.replace('_', " "))).collect();
        let fouls = if fouls.is_empty() { "no fouls".to_owned() } else { fouls.join(", ") };
        writeln!(
            out,
            "{name}: {} shots, {} chances, {} passes, {:.0} s of possession; {fouls}",
            metrics.shots, metrics.chances, metrics.passes, metrics.possession_s
        )?;
        writeln!(out, "{name}: {}", metrics.cases.summary())?;
    }
    for (name, metrics, _) in teams {
        if let Some(warning) = metrics.strategy.as_ref().and_then(StrategyReport::warning) {
            writeln!(out, "{name}: {warning}")?;
        }
    }
    for block in &report.blocked {
        let phase = format!("blocked for {:.1} s from {:.1} s", block.lasted_s, block.from_s);
        writeln!(out, "{phase}: {}", block.description)?;
    }
    let mut text =
        if args.duration() == MATCH_S { String::new() } else { format!(" --duration {}", args.duration()) };
    args.moment.describe(&mut text);
    if args.league != League::DivisionB {
        text.extend([" --league ", args.league.name()]);
    }
    if args.world != WorldChoice::Nominal {
        text.extend([" --world ", &args.world.to_string()]);
    }
    if let Some(robots) = args.robots {
        text.extend([" --robots ", &robots.to_string()]);
    }
    if let Some(directory) = &args.directory.library {
        text.extend([" --library ", &quoted(&directory.to_string_lossy())]);
    }
    for (name, value) in args.settings.given() {
        text.extend([" --set ", &quoted(&format!("{name}={value}"))]);
    }
    for (side, team) in [("blue", args.blue), ("yellow", args.yellow)] {
        if team != Team::Ours {
            text.extend([" --", side, " ", team.label()]);
        }
    }
    for (side, tactics) in [("blue", args.blue_tactics), ("yellow", args.yellow_tactics)] {
        if tactics != Tactics::default() {
            text.extend([" --", side, "-tactics ", &tactics.description()]);
        }
    }
    for (side, command) in [("blue", &args.blue_strategy), ("yellow", &args.yellow_strategy)] {
        if let Some(command) = command {
            text.extend([" --", side, "-strategy ", &quoted(command)]);
        }
    }
    if let Some(controller) = &args.game_controller {
        text.extend([" --headless --game-controller ", &quoted(&controller.to_string())]);
    }
    writeln!(out, "trace {}, to see it again: onetwo play --seed {}{text}", report.trace_hash, args.seed)
}

/// Who plays on a side: the command of a strategy, or the name of a team.
fn side(team: Team, command: Option<&str>) -> &str {
    command.unwrap_or_else(|| team.label())
}

/// Prints events on stdout, or the progress on a terminal where only the report is wanted.
struct Teller {
    story: Option<MatchLog>,
    bar: Option<Progress>,
}

impl Teller {
    fn new(args: &PlayArgs) -> Self {
        let bar = args.json.then(|| Progress::of(args.duration() as u64, "s"));
        Self { story: (!args.json).then(MatchLog::default), bar }
    }

    fn end(&mut self) {
        self.bar = None;
    }
}

impl Watcher for Teller {
    fn tick(&mut self, game: &Game<'_>) {
        if let Some(bar) = &self.bar {
            bar.reach(game.time() as u64);
        }
        if let Some(story) = &mut self.story {
            story.tick(game);
            let mut out = output::lines();
            for line in story.take_lines() {
                // A closed stdout is detected when the report is written.
                let _ = writeln!(out, "{line}");
            }
            let _ = out.flush();
        }
    }
}
