//! `show`: a recording on the page: every moment of it, for each viewer to seek through at its own pace.
//!
//! A trace replays the decisions of its hosts: they are built from its header and decide again. A league's
//! log file gives what was on the field and what the referee sent; with `--team` a host of ours is fed with
//! it too.

use std::process::ExitCode;
use std::sync::atomic::Ordering;

use foreign::printable;
use host::record::header::RecordingHeader;
use host::record::recheck::Recheck;
use host::record::trace::{Reader, RecordKind};
use host::referee::SenderAddress;
use host::{Host, HostSettings, Input};
use page::{MatchEvent, MatchEventKind as PageKind, Page, Powers};
use protocol::Instant;
use rules::{Colour, League};
use ssl::log::MessageKind;

use super::beside::Beside;
use super::clock::LogClock;
use super::{ReplayArgs, TRACE, begins, failed, open, trace};
use crate::Failure;
use crate::failure::RecordedError;
use crate::live::{
    CaseExplanations, Composer, LedgerFeed, Moment, PageArgs, SCENE_EVERY_S, library_handle_of, stay,
};
use crate::output::note;
use crate::stop::stopped_by_hand;

/// Displays the file until Ctrl-C.
pub(super) fn run(args: &ReplayArgs, page: &PageArgs) -> Result<ExitCode, Failure> {
    if begins(&args.file)?.starts_with(TRACE) { show_trace(args, page) } else { show_log(args, page) }
}

/// The page and its composer.
struct Projector<'a> {
    page: Page,
    composer: Composer,
    ledger: LedgerFeed,
    due: f64,
    /// The file is cut or damaged.
    broken: bool,
    /// A second trace.
    beside: Option<Beside<'a>>,
}

impl<'a> Projector<'a> {
    fn new(args: &'a ReplayArgs, page: &PageArgs, league: League) -> Result<Self, Failure> {
        let library_handle = library_handle_of(league, args.directory.library.as_deref())?;
        let composer = Composer::new(library_handle.as_ref());
        let ledger = LedgerFeed::new(library_handle.as_ref());
        let name = args.file.file_name().map(|name| name.to_string_lossy().into_owned());
        let explanations = CaseExplanations::new(library_handle, casebase::RetrievalSettings::default());
        let page = page.open(name.unwrap_or_default(), true, Powers::None, explanations)?;
        let beside = args.compare.as_deref().map(|other| Beside::open(args, other)).transpose()?;
        if let Some(beside) = &beside {
            note!("{}", printable(&beside.description()));
        }
        Ok(Self { page, composer, ledger, due: f64::NEG_INFINITY, broken: false, beside })
    }

    /// Displays the moment after a message, if the last scene is long enough ago.
    fn look(&mut self, now: Instant, feed: &Host, hosts: &[&Host]) {
        let t = now.0 as f64 * 1e-6;
        self.ledger.look(t, feed, hosts);
        if t < self.due {
            return;
        }
        self.due = t + SCENE_EVERY_S;
        let moment = Moment { t, now, feed, hosts, truth: None, referee: None, gauges: Vec::new() };
        let mut deferred_scene = self.composer.compose(moment);
        if let Some(beside) = &mut self.beside {
            if let Some(differs) = beside.play(now) {
                self.page.push(differs);
            }
            deferred_scene.scene.layers.push(beside.layer(now, &feed.tracker().world(now)));
        }
        for match_event in self.composer.take_match_events() {
            self.page.push(match_event);
        }
        self.page.keep(deferred_scene);
        self.ledger.send(t, hosts, false, &self.page);
    }

    /// Every record was read: what became of every case is final.
    fn close(&mut self, now: Instant, hosts: &[&Host]) {
        self.ledger.send(now.0 as f64 * 1e-6, hosts, true, &self.page);
    }

    /// Reports that the file is truncated, and where: it is not the end of the match.
    fn breaks_off(&mut self, now: Instant, damage: &str, feed: &Host, hosts: &[&Host]) {
        let t = now.0 as f64 * 1e-6;
        let description = format!("the file breaks off: {damage}");
        note!("{}", printable(&description));
        self.broken = true;
        self.page.push(MatchEvent {
            t,
            kind: PageKind::Fault,
            team: None,
            description,
            at: None,
            problem: None,
            decided: None,
        });
        self.due = f64::NEG_INFINITY;
        self.look(now, feed, hosts);
    }

    /// Keeps the page open after the whole file was read.
    fn stay(self, description: &str) -> ExitCode {
        stay(self.page, description);
        if self.broken { ExitCode::FAILURE } else { ExitCode::SUCCESS }
    }
}

fn show_trace(args: &ReplayArgs, page: &PageArgs) -> Result<ExitCode, Failure> {
    let file = &args.file;
    let mut reader = Reader::new(open(file)?).map_err(RecordedError::Trace).map_err(failed(file))?;
    let header =
        RecordingHeader::from_json(reader.header()).map_err(RecordedError::Header).map_err(failed(file))?;
    let league = header.league().map_err(RecordedError::Header).map_err(failed(file))?;
    let key = trace::key(args.key_file.as_deref(), file, &header)?;
    let mut recheck = Recheck::new(&header, key).map_err(RecordedError::Header).map_err(failed(file))?;
    let mut projector = Projector::new(args, page, league)?;
    let stopped = stopped_by_hand();
    let mut now = Instant(0);
    for record in reader.by_ref() {
        if stopped.load(Ordering::Relaxed) {
            return Ok(ExitCode::SUCCESS);
        }
        now = now.max(record.at);
        // Every host receives the same packets: those of the first one are enough.
        match record.kind {
            RecordKind::Vision if record.host == 0 => projector.composer.vision(&record.bytes),
            RecordKind::Referee if record.host == 0 => {
                projector.composer.referee(&record.bytes, now.0 as f64 * 1e-6, false);
            }
            _ => {}
        }
        recheck.feed(&record);
        let hosts: Vec<&Host> = (0..header.hosts.len()).filter_map(|i| recheck.host(i)).collect();
        if let Some(feed) = hosts.first() {
            projector.look(now, feed, &hosts);
        }
    }
    if let Some(damage) = trace::damage_of(reader.end()) {
        let hosts: Vec<&Host> = (0..header.hosts.len()).filter_map(|i| recheck.host(i)).collect();
        if let Some(feed) = hosts.first() {
            projector.breaks_off(now, &damage, feed, &hosts);
        }
    }
    let hosts: Vec<&Host> = (0..header.hosts.len()).filter_map(|i| recheck.host(i)).collect();
    projector.close(now, &hosts);
    recheck.finish(true);
    let same = recheck.results().all(|(_, difference)| difference.is_none());
    let description = if same {
        "every decision was taken again as recorded"
    } else {
        "hosts decide otherwise than recorded: see the summary"
    };
    Ok(projector.stay(description))
}

fn show_log(args: &ReplayArgs, page: &PageArgs) -> Result<ExitCode, Failure> {
    if args.compare.is_some() {
        return Err(failed(&args.file)(RecordedError::NoTrace));
    }
    let mut reader = ssl::log::open(&args.file).map_err(RecordedError::Log).map_err(failed(&args.file))?;
    let settings = HostSettings::new(args.team.unwrap_or(Colour::Blue), args.league, 1);
    let mut host = Host::new(settings, Instant(0));
    let mut projector = Projector::new(args, page, args.league)?;
    let stopped = stopped_by_hand();
    let (mut clock, mut began, mut now) = (LogClock::default(), false, Instant(0));
    for record in reader.by_ref() {
        if stopped.load(Ordering::Relaxed) {
            return Ok(ExitCode::SUCCESS);
        }
        began = true;
        now = clock.read(record.timestamp_ns);
        match record.kind {
            MessageKind::Vision2014 => {
                projector.composer.vision(&record.payload);
                host.handle(now, Input::Vision(&record.payload));
            }
            MessageKind::Refbox2013 => {
                projector.composer.referee(&record.payload, now.0 as f64 * 1e-6, false);
                host.handle(now, Input::Referee(&record.payload, SenderAddress::INTERNAL));
            }
            _ => continue,
        }
        while host.poll_packet().is_some() {}
        let hosts = [&host];
        projector.look(now, &host, if args.team.is_some() { &hosts } else { &[] });
    }
    if !began {
        return Err(failed(&args.file)(RecordedError::Empty));
    }
    if let Some(end) = reader.end().filter(|end| !end.is_whole()) {
        let hosts = [&host];
        projector.breaks_off(now, &end.to_string(), &host, if args.team.is_some() { &hosts } else { &[] });
    }
    Ok(projector.stay("all that the file holds is there"))
}
