//! `onetwo cases draft`: cases drafted from the plays of recordings that led to a shot or a goal, as files of
//! a library.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Args;
use feed::recording::{OpenLibrary, collect};
use study::learning::{Change, RecordedDraft, draft};

use crate::Failure;
use crate::args::LibraryArgs;
use crate::destination::{self, FileKind};
use crate::library;
use crate::output::{note, print_text, printable_path};
use crate::progress::Progress;

/// Arguments of `cases draft`.
#[derive(Debug, Args)]
pub(crate) struct DraftArgs {
    /// Recordings of anybody: league logs (.log, .log.gz), traces (.trace), what `trial --record` or `cases
    /// evidence` wrote; may be repeated.
    #[arg(long, required = true, value_name = "FILE")]
    from: Vec<PathBuf>,
    #[command(flatten)]
    library: LibraryArgs,
    /// The directory that cases are written to, with the league's league.toml where it has none.
    #[arg(short, long, value_name = "DIR")]
    out: PathBuf,
    /// Only plays that a goal followed.
    #[arg(long)]
    goals: bool,
    /// The key of the team that recorded a trace, if it had one: 32 hexadecimal digits in a file.
    #[arg(long, value_name = "FILE")]
    key_file: Option<PathBuf>,
}

pub(super) fn run(args: &DraftArgs) -> Result<ExitCode, Failure> {
    destination::make_directory(&args.out)?;
    let inputs: Vec<_> = args.library.directory.library.as_deref().into_iter().collect();
    let known = OpenLibrary::of(library::open(&args.library)?)?;
    let collected = collect(&args.from, &known, args.key_file.as_deref(), false, &Progress::open())?;
    let rules = &known.variant.files.rules;
    let (mut written, mut blocked) = (BTreeSet::new(), 0);
    let mut refused = BTreeMap::<String, u32>::new();
    let plays = collected.plays.iter().filter(|play| play.goal || !args.goals);
    for play in plays.clone() {
        match draft(play, rules) {
            Ok(RecordedDraft { edit, retrieved }) => {
                blocked += u32::from(!retrieved);
                let Change::New(text) = &edit.change else { continue };
                write(&args.out.join(format!("{}.toml", edit.case)), text, &inputs)?;
                written.insert(edit.case);
            }
            Err(why) => *refused.entry(why.to_string()).or_default() += 1,
        }
    }
    let league = args.out.join("league.toml");
    if !written.is_empty() && !league.exists() {
        write(&league, &rules.text, &inputs)?;
    }
    if blocked > 0 {
        note!("{blocked} are not retrieved where they were played: an opponent stood in the ball's path");
    }
    for (why, count) in &refused {
        note!("{count} left out: {why}");
    }
    let (count, all, out) = (written.len(), plays.count(), printable_path(&args.out));
    let told: Vec<String> =
        written.into_iter().chain([format!("{count} cases of {all} successful plays, in {out}\n")]).collect();
    print_text(&told.join("\n"))?;
    Ok(ExitCode::SUCCESS)
}

fn write(file: &Path, text: &str, inputs: &[&Path]) -> Result<(), Failure> {
    destination::check(&[(file, FileKind::Toml)], inputs)?;
    if let Some(directory) = file.parent() {
        destination::make_directory(directory)?;
    }
    Ok(destination::write(file, FileKind::Toml, text.as_bytes())?)
}
