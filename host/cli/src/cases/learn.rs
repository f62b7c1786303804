//! `onetwo cases learn`: a library made better by play (docs/learning.md). Finished trials are kept in the
//! output directory: the same command goes on where it was stopped, and shards share the directory.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;

use clap::Args;
use feed::recording::{OpenLibrary, collect};
use feed::refusals;
use study::learning::{
    JournalPlayer, Kind, LearnError, LearnSettings, Learned, Worlds, learn, learn_matches,
};
use study::store::Shard;

use crate::Failure;
use crate::args::{LibraryArgs, VERSION, parsers, threads};
use crate::destination::{self, DestinationError, FileKind};
use crate::library;
use crate::output::print_text;
use crate::progress::Progress;
use crate::stop::stopped_by_hand;

/// Arguments of `cases learn`.
#[derive(Debug, Args)]
pub(crate) struct LearnArgs {
    #[command(flatten)]
    library: LibraryArgs,
    /// What was played before; may be repeated: `evidence.jsonl` of another run or of `cases evidence`, or
    /// what `trial --record` wrote. Successful plays become drafts of new cases.
    #[arg(long, value_name = "FILE")]
    from: Vec<PathBuf>,
    /// Trials after which no further round starts, 300000 by default. Of a library of the Small Size League,
    /// which learns from matches, scenes of 20 s of them (some 0.2 s of a core each), 10000 by default.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    budget: Option<u64>,
    /// Random seed.
    #[arg(short, long, default_value_t = 1, value_parser = clap::value_parser!(u64).range(..1 << 40))]
    seed: u64,
    /// The directory that everything is written to: journals, evidence, report and the learned library.
    #[arg(short, long, value_name = "DIR")]
    out: PathBuf,
    /// Only these kinds of changes, with commas between: scopes, actions, new, forget, order. New cases come
    /// of trials alone.
    #[arg(long, value_name = "KINDS", value_delimiter = ',', value_parser = kind)]
    only: Vec<Kind>,
    /// The world that is learned in: as the paper's simulator, as its robots with noise and pauses, or
    /// both, where a change may lower neither.
    #[arg(long, default_value = "simulated", value_parser = worlds)]
    profile: Worlds,
    /// Expected share of wrong changes among the accepted ones.
    #[arg(long, default_value_t = 0.1, value_parser = rate)]
    error_rate: f64,
    /// Sequential tests that the error rate is shared among.
    #[arg(long, default_value_t = 40, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    tries: u32,
    /// Every n-th unit of trials from the i-th on; shards run at the same time in one directory, and play
    /// what an absent one lacks. Without it, what all shards have played is read and the rest is played.
    #[arg(long, value_name = "I/N", default_value = "1/1", value_parser = parsers::shard)]
    shard: Shard,
    /// Threads; the number of cores by default.
    #[arg(short, long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    jobs: Option<u16>,
    /// Propose and screen once, and change nothing.
    #[arg(long)]
    dry_run: bool,
    /// Null control: chance decides which outcome of a pair counts as the change's.
    #[arg(long)]
    shuffle_outcomes: bool,
    /// The report as JSON on stdout.
    #[arg(long)]
    json: bool,
}

pub(super) fn run(args: &LearnArgs) -> Result<ExitCode, Failure> {
    let known = OpenLibrary::of(library::open(&args.library)?)?;
    let matches = known.handle.simulated_league()?.limits().is_some();
    if !matches {
        known.handle.check_field_of_trials()?;
    }
    check_outputs(args, &known.variant.files.league)?;
    let budget = args.budget.unwrap_or(if matches { SCENES } else { TRIALS });
    let files = known.variant.files.clone();
    let earlier = collect(&args.from, &known, None, true, &Progress::open())?;
    let kinds: BTreeSet<Kind> =
        if args.only.is_empty() { Kind::ALL.into() } else { args.only.iter().copied().collect() };
    let refused = known.handle.directory().map_or_else(|| Ok(BTreeSet::new()), refusals);
    let settings = LearnSettings {
        seed: args.seed,
        budget,
        kinds,
        worlds: args.profile,
        error_rate: args.error_rate,
        tries: args.tries,
        refused: refused.map_err(Failure::Refusals)?,
        shuffle: args.shuffle_outcomes,
        dry_run: args.dry_run,
    };
    let start = known.variant;
    let mut hash = hil_sim::Fnv::default();
    hash.add(earlier.to_jsonl().as_bytes());
    let identity = serde_json::json!({
        "program": VERSION, "settings": settings, "library": format!("{:016x}", start.hash),
        "world": hil_sim::world_hash(), "evidence": hash.to_string(),
    });
    destination::make_directory(&args.out)?;
    let pool = threads(args.jobs)?;
    let bar = Progress::of(budget, if matches { "scenes" } else { "trials" });
    let on_trials = |trials| bar.add(trials);
    let learned = pool.install(|| {
        let (identity, stopped) = (identity.to_string(), stopped_by_hand());
        let (out, shard, seed) = (&args.out, args.shard, args.seed);
        if matches {
            let player = JournalPlayer::open(out, &identity, shard, seed, stopped, &on_trials);
            let mut player = player.map_err(LearnError::Play)?.with_patience(PLAYER_SILENCE_MAX);
            return learn_matches(files, earlier, &settings, &mut player);
        }
        let player = JournalPlayer::open(out, &identity, shard, seed, stopped, &on_trials);
        learn(files, earlier, &settings, &mut player.map_err(LearnError::Play)?)
    });
    drop(bar);
    let learned = learned?;
    // Every shard has learned the same; the first one writes it.
    if args.shard.has(0) {
        write(&learned, &args.out)?;
    }
    if args.json {
        print_text(&format!("{}\n", study::learning::json(&learned)))?;
    } else {
        print_text(&study::learning::summary(&learned))?;
    }
    Ok(ExitCode::SUCCESS)
}

/// Trials of a run by default.
const TRIALS: u64 = 300_000;
/// Scenes of a run with matches by default: some half an hour of a core.
const SCENES: u64 = 10_000;
/// Time without a match of a shard after which it counts as absent: several whole matches.
const PLAYER_SILENCE_MAX: Duration = Duration::from_mins(1);

/// Refuses a directory in which something else would be overwritten.
fn check_outputs(args: &LearnArgs, league: &str) -> Result<(), DestinationError> {
    let inputs = args.from.iter().chain(&args.library.directory.library);
    let inputs: Vec<_> = inputs.map(PathBuf::as_path).collect();
    let files = [EVIDENCE, REPORT, PAGE].map(|(name, kind)| (args.out.join(name), kind));
    let files = files.each_ref().map(|(file, kind)| (file.as_path(), *kind));
    destination::check(&files, &inputs)?;
    destination::check_library(&args.out.join(league), &inputs)
}

const EVIDENCE: (&str, FileKind) = ("evidence.jsonl", FileKind::Json);
const REPORT: (&str, FileKind) = ("report.json", FileKind::Json);
const PAGE: (&str, FileKind) = ("report.html", FileKind::Html);

/// Writes a file of that name and kind into the directory.
fn put(out: &Path, (name, kind): (&str, FileKind), text: &str) -> Result<(), DestinationError> {
    destination::write(&out.join(name), kind, text.as_bytes())
}

/// Writes evidence, report and library.
fn write(learned: &Learned, out: &Path) -> Result<(), Failure> {
    put(out, EVIDENCE, &learned.evidence.to_jsonl())?;
    put(out, REPORT, &format!("{:#}\n", study::learning::json(learned)))?;
    put(out, PAGE, &study::learning::html(learned))?;
    let library = &learned.end.files;
    let directory = out.join(&library.league);
    destination::clear_library(&directory)?;
    destination::make_directory(&directory)?;
    put(out, (&format!("{}/league.toml", library.league), FileKind::Toml), &library.rules.text)?;
    for file in &library.cases {
        let path = directory.join(format!("{}.toml", file.name));
        if let Some(region) = path.parent() {
            destination::make_directory(region)?;
        }
        put(out, (&format!("{}/{}.toml", library.league, file.name), FileKind::Toml), &file.text)?;
    }
    Ok(())
}

fn kind(label: &str) -> Result<Kind, String> {
    Kind::from_label(label).ok_or_else(|| {
        let known: Vec<_> = Kind::ALL.into_iter().map(Kind::label).collect();
        format!("take some of {}", known.join(", "))
    })
}

fn worlds(label: &str) -> Result<Worlds, String> {
    Worlds::from_label(label).ok_or_else(|| "take simulated, robots or both".to_owned())
}

fn rate(label: &str) -> Result<f64, String> {
    let rate = label.parse().ok().filter(|rate| (0.0001..=0.5).contains(rate));
    rate.ok_or_else(|| "take a share from 0.0001 to 0.5".to_owned())
}
