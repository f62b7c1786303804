//! `onetwo trial`: one trial of the paper, told, reported or drawn (Ros et al. 2009 §5.1; DESIGN §8).
//!
//! The same flags lead `onetwo play`, which for now is a trial with its story and picture.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use arena::{Recording, Story, TrialConfig, TrialReport, Watcher};
use brain::{Approach, Positioning};
use clap::{Args, ValueEnum};
use firmware_build::Install;
use hil_sim::{AirSettings, Backend, Configuration, NativeBackend, QemuBackend, Scenario};

use crate::Failure;
use crate::args::{LibraryArgs, SettingsArgs};
use crate::library::Shelf;

/// What decides a trial.
#[derive(Debug, Args)]
pub(crate) struct TrialArgs {
    /// Where everybody stands: the paper's 1 to 4, or random.
    #[arg(long, default_value = "3", value_parser = scenario)]
    scenario: Scenario,
    /// Defender and goalie, or two defenders.
    #[arg(long, default_value = "dg", value_parser = opponents)]
    opponents: Configuration,
    /// What leads the attackers.
    #[arg(long, value_enum, default_value_t = ApproachWord::Cbr)]
    approach: ApproachWord,
    /// Where all chance comes from.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Where the attackers' brains run.
    #[arg(long, value_enum, default_value_t = BackendWord::Native)]
    backend: BackendWord,
    /// When a case's actions begin.
    #[arg(long, value_enum, default_value_t = PositioningWord::Dependent)]
    positioning: PositioningWord,
    /// Attackers; the paper has 2.
    #[arg(long, default_value_t = 2, value_parser = clap::value_parser!(u8).range(1..=4))]
    robots: u8,
    /// How many of them may retrieve; all unless told.
    #[arg(long, value_parser = clap::value_parser!(u8).range(1..=4))]
    retrievers: Option<u8>,
    /// Share of packets lost, 0 to 1.
    #[arg(long, default_value_t = 0.0, value_parser = share)]
    loss: f32,
    #[command(flatten)]
    library: LibraryArgs,
    #[command(flatten)]
    settings: SettingsArgs,
    /// Print the report as JSON, and nothing else.
    #[arg(long)]
    json: bool,
    /// Draw the trial into this file.
    #[arg(long, value_name = "FILE")]
    svg: Option<PathBuf>,
}

/// A trial's approach on the command line.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum ApproachWord {
    /// Cases; the reactive behaviour where none fits.
    Cbr,
    /// The reactive behaviour alone.
    Reactive,
    /// Both, by expected time to a shot (not built yet).
    Hybrid,
}

/// Where brains run, on the command line.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum BackendWord {
    /// In this process.
    Native,
    /// As the firmware image, each robot in a QEMU of its own.
    Qemu,
}

/// The paper's two positionings, on the command line.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum PositioningWord {
    /// As soon as the robot that gets the ball is at its place.
    Dependent,
    /// When all are at their places.
    Independent,
}

/// `onetwo trial`.
pub(crate) fn run(args: &TrialArgs) -> Result<ExitCode, Failure> {
    tell(args, args.svg.as_deref())
}

/// `onetwo play`: for now a trial, always with its picture.
pub(crate) fn run_with_picture(args: &TrialArgs) -> Result<ExitCode, Failure> {
    tell(args, Some(args.svg.as_deref().unwrap_or(Path::new("trial.svg"))))
}

fn tell(args: &TrialArgs, svg: Option<&Path>) -> Result<ExitCode, Failure> {
    let (mut recording, mut story) = (Recording::default(), Story::default());
    let report = play(args, &mut [&mut recording, &mut story])?;
    if let Some(file) = svg {
        fs::write(file, arena::picture(&recording))
            .map_err(|error| Failure::Picture { file: file.to_owned(), words: error.to_string() })?;
    }
    let mut out = io::stdout().lock();
    if args.json {
        let json = serde_json::to_string(&report).map_err(|error| Failure::Output(error.into()))?;
        return writeln!(out, "{json}").map(|()| ExitCode::SUCCESS).map_err(Failure::Output);
    }
    for line in story.take_lines() {
        writeln!(out, "{line}").map_err(Failure::Output)?;
    }
    writeln!(out, "trace {}, to see it again: {}", report.trace_hash, args.again(&report))
        .map_err(Failure::Output)?;
    if let Some(file) = svg {
        writeln!(out, "picture: {}", file.display()).map_err(Failure::Output)?;
    }
    Ok(ExitCode::SUCCESS)
}

/// Plays it.
fn play(args: &TrialArgs, watchers: &mut [&mut dyn Watcher]) -> Result<TrialReport, Failure> {
    let approach = match args.approach {
        ApproachWord::Cbr => Approach::Cases,
        ApproachWord::Reactive => Approach::Reactive,
        ApproachWord::Hybrid => return Err(Failure::NotBuilt("--approach hybrid")),
    };
    let chosen = args.settings.choose()?;
    let shelf = Shelf::open(&args.library)?;
    let base = shelf.base();
    let names = arena::CaseNames::new(shelf.names());
    let robots = usize::from(args.robots);
    let config = TrialConfig {
        settings: chosen.settings,
        positioning: match args.positioning {
            PositioningWord::Dependent => Positioning::Dependent,
            PositioningWord::Independent => Positioning::Independent,
        },
        robots,
        retrievers: args.retrievers.map_or(robots, usize::from).min(robots),
        air: AirSettings::with_loss(args.loss),
        ..TrialConfig::new(args.scenario, args.opponents, approach, args.seed)
    }
    .with_library(base, names);
    let backend: Box<dyn Backend<'_>> = match args.backend {
        BackendWord::Native => Box::new(NativeBackend::new(base)),
        BackendWord::Qemu => Box::new(qemu(args, &shelf)?),
    };
    arena::run(&config, backend, watchers).map_err(Failure::Trial)
}

/// QEMU with a fresh image; a library of one's own goes into the robots' flash beside it.
fn qemu(args: &TrialArgs, shelf: &Shelf) -> Result<QemuBackend, Failure> {
    firmware_build::ensure_qemu(Install::ForUser).map_err(|error| Failure::Firmware(error.to_string()))?;
    let image = firmware_build::build_image(&firmware_build::workspace_root())
        .map_err(|error| Failure::Firmware(error.to_string()))?;
    let backend = QemuBackend::new(image);
    match &args.library.folder.library {
        None => Ok(backend),
        Some(_) => backend.with_library(shelf.base().bytes()).map_err(|e| Failure::Firmware(e.to_string())),
    }
}

impl TrialArgs {
    /// The command that shows the same trial again.
    fn again(&self, report: &TrialReport) -> String {
        use std::fmt::Write as _;
        let mut words = format!(
            "onetwo trial --scenario {} --opponents {} --approach {} --seed {}",
            self.scenario.word(),
            self.opponents.word(),
            report.approach,
            self.seed
        );
        for (flag, value, default) in [
            ("--robots", self.robots.to_string(), "2"),
            ("--retrievers", self.retrievers.map_or_else(String::new, |k| k.to_string()), ""),
            ("--loss", self.loss.to_string(), "0"),
            ("--positioning", report.positioning.to_owned(), "dependent"),
            ("--league", self.library.league.clone(), "four-legged"),
        ] {
            if value != default {
                let _ = write!(words, " {flag} {value}");
            }
        }
        if let Some(folder) = &self.library.folder.library {
            let _ = write!(words, " --library {}", folder.display());
        }
        for (name, value) in self.settings.given() {
            let _ = write!(words, " --set {name}={value}");
        }
        words
    }
}

fn scenario(word: &str) -> Result<Scenario, String> {
    Scenario::from_word(word).ok_or_else(|| "take 1, 2, 3, 4 or random".to_owned())
}

fn opponents(word: &str) -> Result<Configuration, String> {
    Configuration::from_word(word).ok_or_else(|| "take dg or 2d".to_owned())
}

fn share(word: &str) -> Result<f32, String> {
    word.parse().ok().filter(|x| (0.0..=1.0).contains(x)).ok_or_else(|| "take a share from 0 to 1".to_owned())
}
