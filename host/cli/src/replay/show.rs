//! `show`: a recording on the page, until Ctrl-C.

use std::process::ExitCode;

use arena::cases::LibraryHandle;
use casebase::RetrievalSettings;
use feed::recording::{
    Beside, PlaySettings, Projector, RecordedError, Shown, TraceFile, begins_as_trace, comparable, in_file,
};
use feed::{CaseExplanations, MomentSource};
use page::{Page, Powers};
use rules::League;

use super::ReplayArgs;
use crate::Failure;
use crate::args::page::stay;
use crate::library;
use crate::output::program_log;
use crate::progress::Progress;
use crate::stop::stopped_by_hand;

pub(super) fn run(args: &ReplayArgs) -> Result<ExitCode, Failure> {
    let (page, shown, end) = if begins_as_trace(&args.file)? { show_trace(args)? } else { show_log(args)? };
    match shown {
        Shown::Stopped => return Ok(ExitCode::SUCCESS),
        Shown::Broken { .. } | Shown::Whole { .. } => stay(page, end),
    }
    Ok(if matches!(shown, Shown::Broken { .. }) { ExitCode::FAILURE } else { ExitCode::SUCCESS })
}

/// The page with all of the recording, for a verb that goes on with it.
pub(super) fn load(args: &ReplayArgs) -> Result<Page, Failure> {
    let (page, ..) = if begins_as_trace(&args.file)? { show_trace(args)? } else { show_log(args)? };
    Ok(page)
}

fn show_trace(args: &ReplayArgs) -> Result<(Page, Shown, &'static str), Failure> {
    let (observer, key_file) = (Progress::silent(), args.key_file.as_deref());
    let trace = TraceFile::open(&args.file)?;
    let recheck = trace.recheck(key_file, &observer)?;
    let (mut page, library) = open(args, trace.league)?;
    let beside = args.compare.as_deref().map(|other| {
        comparable(&args.file, other)?;
        let bar = Progress::open();
        Beside::open(&args.file, other, PlaySettings { library: library.as_ref(), key_file, observer: &bar })
    });
    let beside = beside.transpose()?;
    let mut projector = Projector::new(&mut page, library.as_ref(), program_log(), &observer, beside);
    let shown = projector.show_trace(trace, recheck, stopped_by_hand());
    let end = match shown {
        Shown::Broken { same: false } | Shown::Whole { same: false } => {
            "hosts decide otherwise than recorded: see the summary"
        }
        _ => "every decision was taken again as recorded",
    };
    Ok((page, shown, end))
}

fn show_log(args: &ReplayArgs) -> Result<(Page, Shown, &'static str), Failure> {
    if args.compare.is_some() {
        return Err(in_file(&args.file)(RecordedError::NoTrace).into());
    }
    // A file that is no log is reported before the page is opened.
    ssl::log::open(&args.file).map_err(in_file(&args.file))?;
    let (mut page, library) = open(args, args.league)?;
    let observer = Progress::silent();
    let mut projector = Projector::new(&mut page, library.as_ref(), program_log(), &observer, None);
    let shown = projector.show_log(&args.file, args.league, args.team, stopped_by_hand())?;
    Ok((page, shown, "all that the file holds is there"))
}

/// The page, and the cases that it names.
fn open(args: &ReplayArgs, league: League) -> Result<(Page, Option<LibraryHandle>), Failure> {
    let library = library::of_league(league, args.directory.library.as_deref())?;
    let name = args.file.file_name().map(|name| name.to_string_lossy().into_owned());
    let explanations = CaseExplanations::new(library, RetrievalSettings::default())
        .playing_on(MomentSource::Recording(args.file.clone(), league));
    let powers = if args.send.is_wanted() { Powers::Replay } else { Powers::None };
    Ok((args.page.open(name.unwrap_or_default(), true, powers, explanations)?, library))
}
