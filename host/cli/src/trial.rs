//! `onetwo trial`: one trial of the paper, printed as events, as a report or as a figure (Ros et al. 2009
//! §5.1; docs/case-format.md §5.2).

use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use arena::Profile;
use arena::cases::{LibraryHandle, described};
use arena::{Recording, TextLog, TrialConfig, TrialReport, Watcher};
use brain::Approach;
use casebase::RetrievalSettings;
use clap::{Args, ValueEnum};
use feed::recording::OpenLibrary;
use feed::{CaseExplanations, Legged};
use firmware_build::Install;
use hil_sim::{Backend, Configuration, NativeBackend, QemuBackend, Scenario};
use page::Powers;
use study::learning::{Change, Edit, LearnError, RETRIEVAL, TrialRecorder};

use crate::Failure;
use crate::args::page::{PageArgs, stay};
use crate::args::parsers::{opponents, profile, scenario};
use crate::destination::{self, FileKind};
use crate::output::{self, note};
use crate::setup::SetupArgs;

/// Settings of a trial.
#[derive(Debug, Args)]
pub(crate) struct TrialArgs {
    /// Start positions: the paper's 1 to 4, or random.
    #[arg(long, default_value = "3", value_parser = scenario)]
    scenario: Scenario,
    /// Defender and goalie, or two defenders.
    #[arg(long, default_value = "dg", value_parser = opponents)]
    opponents: Configuration,
    /// Approach of the attackers.
    #[arg(long, value_enum, default_value_t = ApproachLabel::Cbr)]
    approach: ApproachLabel,
    /// Random seed.
    #[arg(short, long, default_value_t = 1)]
    seed: u64,
    /// Where the attackers' brains run.
    #[arg(long, value_enum, default_value_t = BackendLabel::Native)]
    backend: BackendLabel,
    /// As the paper's simulator, or as its robots: noisy perception, 5 s of standing still after every cycle.
    #[arg(long, default_value = "simulated", value_parser = profile)]
    profile: Profile,
    /// Attackers; the paper has 2.
    #[arg(long, default_value_t = 2, value_parser = clap::value_parser!(u8).range(1..=4))]
    robots: u8,
    #[command(flatten)]
    setup: SetupArgs,
    /// Display it on the page, every moment of it, until Ctrl-C.
    #[arg(long, conflicts_with = "json")]
    watch: bool,
    #[command(flatten)]
    page: PageArgs,
    /// Print the report as JSON, and nothing else.
    #[arg(long)]
    json: bool,
    /// Keep its decisions, what became of them, and its play where it led to goal, for `cases learn --from`,
    /// `cases evidence` and `cases draft`.
    #[arg(short, long, value_name = "FILE")]
    record: Option<PathBuf>,
    /// Draw the trial into this file.
    #[arg(long, value_name = "FILE")]
    svg: Option<PathBuf>,
}

/// A trial's approach on the command line.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum ApproachLabel {
    /// Cases; the reactive behaviour where none fits.
    Cbr,
    /// The reactive behaviour alone.
    Reactive,
    /// Both, by expected time to a shot.
    Hybrid,
}

/// Where brains run, on the command line.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum BackendLabel {
    /// In this process.
    Native,
    /// As the firmware, each robot in a QEMU of its own.
    Qemu,
}

pub(crate) fn run(args: &TrialArgs) -> Result<ExitCode, Failure> {
    let svg = args.svg.as_deref();
    let recorded = args.record.as_deref().map(|file| (file, FileKind::Json));
    let drawn = svg.map(|file| (file, FileKind::Svg));
    let outputs: Vec<_> = recorded.into_iter().chain(drawn).collect();
    destination::check(&outputs, args.setup.directory().as_slice())?;
    let (mut recording, mut story) = (Recording::default(), TextLog::default());
    let mut recorder = args.record.is_some().then(TrialRecorder::default);
    let mut legged = args.watch.then(|| on_page(args)).transpose()?;
    let mut watchers: Vec<&mut dyn Watcher> = vec![&mut recording, &mut story];
    watchers.extend(legged.as_mut().map(|legged| legged as &mut dyn Watcher));
    watchers.extend(recorder.as_mut().map(|recorder| recorder as &mut dyn Watcher));
    let report = play(args, &mut watchers)?;
    if let (Some(file), Some(recorder)) = (&args.record, &recorder) {
        record(args, recorder, file)?;
    }
    if let Some(file) = svg {
        destination::write(file, FileKind::Svg, arena::picture(&recording).as_bytes())?;
    }
    let mut out = output::lines();
    if args.json {
        let json = serde_json::to_string(&report).map_err(|error| Failure::Output(error.into()))?;
        writeln!(out, "{json}").and_then(|()| out.flush()).map_err(Failure::Output)?;
        return Ok(ExitCode::SUCCESS);
    }
    for line in story.take_lines() {
        writeln!(out, "{line}").map_err(Failure::Output)?;
    }
    writeln!(out, "trace {}, to see it again: {}", report.trace_hash, args.again(&report))
        .map_err(Failure::Output)?;
    if let Some(file) = svg {
        writeln!(out, "picture: {}", output::printable_path(file)).map_err(Failure::Output)?;
    }
    out.flush().map_err(Failure::Output)?;
    drop(out);
    if let Some(legged) = legged {
        stay(legged.into_page(), "the trial is over");
    }
    Ok(ExitCode::SUCCESS)
}

/// Writes what was recorded.
fn record(args: &TrialArgs, recorder: &TrialRecorder, file: &Path) -> Result<(), Failure> {
    if matches!(args.backend, BackendLabel::Qemu) {
        note!("robots under QEMU do not hand out their decisions: {} has none", output::printable_path(file));
    }
    let setup = args.setup.choose(usize::from(args.robots))?;
    let library_handle = args.setup.open(&setup)?;
    let known = OpenLibrary::of(library_handle)?;
    let mut library = known.variant;
    if library.base().hash() != library_handle.base().hash() {
        return Err(Failure::Recording { stem: Some(file.to_owned()), error: io::Error::other(REDUCED) });
    }
    let usual = described(&RetrievalSettings::default());
    for (name, value) in described(&setup.settings).into_iter().filter(|one| !usual.contains(one)) {
        let change = Change::Setting(name, value);
        let changed = library.edited(&Edit { case: RETRIEVAL.to_owned(), change });
        library = changed.map_err(LearnError::Library)?;
    }
    let world = study::learning::world_of_trials(args.profile);
    let collected = recorder.collected(&library, &world, args.opponents.label());
    Ok(destination::write(file, FileKind::Json, collected.to_jsonl().as_bytes())?)
}

/// Why a trial with half a library is not recorded.
const REDUCED: &str = "evidence is of whole libraries; leave out --no-symmetry and --no-opponents";

/// The page that stores the trial's course.
fn on_page(args: &TrialArgs) -> Result<Legged, Failure> {
    let setup = args.setup.choose(usize::from(args.robots))?;
    let library_handle = args.setup.open(&setup)?;
    let base = library_handle.lasting_base();
    let explanations = CaseExplanations::new(Some(library_handle), setup.settings.clone());
    let title = format!("trial, scenario {}, seed {}", args.scenario.label(), args.seed);
    Ok(Legged::new(args.page.open(title, true, Powers::None, explanations)?, base))
}

fn play(args: &TrialArgs, watchers: &mut [&mut dyn Watcher]) -> Result<TrialReport, Failure> {
    let approach = match args.approach {
        ApproachLabel::Cbr => Approach::Cases,
        ApproachLabel::Reactive => Approach::Reactive,
        ApproachLabel::Hybrid => Approach::Hybrid,
    };
    let robots = usize::from(args.robots);
    let setup = args.setup.choose(robots)?;
    let library_handle = args.setup.open(&setup)?;
    let base = library_handle.base();
    let names = arena::CaseNames::new(library_handle.names());
    let config =
        TrialConfig { robots, ..TrialConfig::new(args.scenario, args.opponents, approach, args.seed) };
    let config = args.profile.apply(setup.apply(config)).with_library(base, names);
    let backend: Box<dyn Backend<'_>> = match args.backend {
        BackendLabel::Native => Box::new(NativeBackend::new(base)),
        BackendLabel::Qemu => Box::new(qemu(args, &library_handle)?),
    };
    Ok(arena::run(&config, backend, watchers)?)
}

/// QEMU with freshly built firmware; the user's own library goes into the robots' flash beside it.
fn qemu(args: &TrialArgs, library_handle: &LibraryHandle) -> Result<QemuBackend, Failure> {
    firmware_build::ensure_qemu(Install::ForUser)?;
    let image =
        firmware_build::build_image(&firmware_build::workspace_root(), firmware_build::ImageBody::Legged)?;
    let backend = QemuBackend::new(image);
    if args.setup.is_built_in() {
        return Ok(backend);
    }
    Ok(backend.with_library(library_handle.base().bytes())?)
}

impl TrialArgs {
    /// The command that replays the same trial.
    fn again(&self, report: &TrialReport) -> String {
        use std::fmt::Write as _;
        let mut command = format!(
            "onetwo trial --scenario {} --opponents {} --approach {} --seed {}",
            self.scenario.label(),
            self.opponents.label(),
            report.approach,
            self.seed
        );
        if self.profile == Profile::Robots {
            command.push_str(" --profile robots");
        }
        if self.robots != 2 {
            let _ = write!(command, " --robots {}", self.robots);
        }
        command.push_str(&self.setup.changed_flags());
        command
    }
}
