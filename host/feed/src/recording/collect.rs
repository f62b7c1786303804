//! `collect`: what recordings say of cases, as evidence, and their plays that led to a shot or a goal. Reads
//! `evidence.jsonl`, traces and league log files; the order of files does not matter.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use arena::CycleEnd;
use arena::cases::{LibraryHandle, problem};
use arena::game::TICK_US;
use arena::ledger::Followed;
use arena::successful_plays::PlayFinder;
use case_tools::Files;
use foreign::excerpt;
use host::record::header::RecordingHeader;
use host::record::recheck::Recheck;
use host::record::trace::Reader;
use host::referee::SenderAddress;
use host::{Host, HostSettings, Input};
use protocol::{Instant, RobotId};
use rules::Colour;
use ssl::log::MessageKind;
use study::learning::{CasePlay, Collected, Evidence, LearnError, Situation, Variant};

use super::clock::LogClock;
use super::decisions::Decisions;
use super::trace::{all, damage_of, key};
use super::{TRACE, begins, failed, open};
use crate::Failure;
use crate::args::LibraryArgs;
use crate::failure::RecordedError;
use crate::output::{note, printable_path};
use crate::progress::Progress;

/// The library whose cases are counted.
pub(crate) struct OpenLibrary {
    pub(crate) handle: LibraryHandle,
    /// The same with its files; names and texts alone count, wherever it lies.
    pub(crate) variant: Variant,
}

impl OpenLibrary {
    /// The library that the command line names.
    pub(crate) fn open(args: &LibraryArgs) -> Result<Self, Failure> {
        Self::of(crate::library::open(args)?)
    }

    /// An opened one.
    pub(crate) fn of(handle: LibraryHandle) -> Result<Self, Failure> {
        let refused = |findings| {
            let directory = handle.directory().map_or_else(PathBuf::new, Path::to_owned);
            Failure::faulty_library(directory, findings)
        };
        let files = handle.files().map_err(refused)?;
        let texts = files.cases.iter().map(|file| (file.name.as_str(), file.text.as_str()));
        let files = Files::from_texts(&files.league, &files.rules.text, &texts.collect::<Vec<_>>());
        let variant = Variant::new(files).map_err(|e| Failure::Learning(LearnError::Library(e)))?;
        Ok(Self { handle, variant })
    }
}

/// What these files give to the library: evidence (unless `cases` is false) and plays. A file that is given
/// twice counts once.
pub(crate) fn collect(
    files: &[PathBuf],
    known: &OpenLibrary,
    key_file: Option<&Path>,
    cases: bool,
) -> Result<Collected, Failure> {
    let (mut collected, mut read) = (Collected::default(), BTreeSet::new());
    for file in files {
        // One that is not there is reported by its reader.
        if !read.insert(file.canonicalize().unwrap_or_else(|_| file.clone())) {
            continue;
        }
        let begin = begins(file)?;
        let more = if begin.starts_with(TRACE) {
            from_trace(file, known, key_file, cases)?
        } else if begin.starts_with(LOG) {
            from_log(file, known)?
        } else if begin.first().is_none_or(|first| *first == b'{' || first.is_ascii_whitespace()) {
            from_text(file)?
        } else {
            return Err(failed(file)(RecordedError::NoRecording));
        };
        collected = collected.merge(more);
    }
    Ok(collected)
}

/// `evidence.jsonl`.
fn from_text(file: &Path) -> Result<Collected, Failure> {
    let failed = |what: String| failed(file)(RecordedError::Damaged(what));
    let text = foreign::read_text(file, TEXT_LEN_MAX).map_err(|error| failed(error.to_string()))?;
    Collected::from_jsonl(&text).map_err(failed)
}

/// A trace of a match: evidence of the teams whose robots had this library.
fn from_trace(
    file: &Path,
    known: &OpenLibrary,
    key_file: Option<&Path>,
    cases: bool,
) -> Result<Collected, Failure> {
    let mut reader = Reader::new(open(file)?).map_err(RecordedError::Trace).map_err(failed(file))?;
    let header =
        RecordingHeader::from_json(reader.header()).map_err(RecordedError::Header).map_err(failed(file))?;
    let league = header.league().map_err(RecordedError::Header).map_err(failed(file))?;
    if known.handle.simulated_league()? != league {
        return Err(other_league(file, league.name(), known));
    }
    let key = key(key_file, file, &header)?;
    let mut recheck = Recheck::new(&header, key).map_err(RecordedError::Header).map_err(failed(file))?;
    let mut decisions = Decisions::new(Some(&known.handle));
    let (mut finder, mut tick) = (PlayFinder::default(), 0);
    let mut bases: [BTreeSet<u32>; 2] = Default::default();
    let bar = Progress::open();
    for record in reader.by_ref() {
        bar.add(1);
        if let Some(feed) = recheck.host(0) {
            let hosts = all(&recheck);
            decisions.look(record.at, feed, &hosts);
            if record.at.0 / TICK_US > tick {
                tick = record.at.0 / TICK_US;
                finder.look(feed, (tick * TICK_US) as f64 * 1e-6);
                for host in hosts {
                    let beacons = RobotId::all().filter_map(|robot| host.beacon(robot));
                    bases[host.settings().us as usize].extend(beacons.map(|beacon| beacon.case_base));
                }
            }
        }
        recheck.feed(&record);
    }
    drop(bar);
    if let Some(feed) = recheck.host(0) {
        decisions.finish(feed, &all(&recheck));
    }
    if let Some(damage) = damage_of(reader.end()) {
        note!("{}: {damage}; what was before counts", printable_path(file));
    }
    let world = header.world.as_deref().map_or_else(|| "field".to_owned(), |world| excerpt(world, WORLD_LEN));
    let mut evidence = Evidence::default();
    if cases {
        let counted = Counted { file, known, world: &world, decisions: &decisions };
        for host in all(&recheck) {
            counted.add(host, &bases[host.settings().us as usize], &mut evidence)?;
        }
    }
    Ok(Collected { evidence, plays: finder.finish().into_iter().collect() })
}

/// What is known of a trace's plays.
struct Counted<'t> {
    file: &'t Path,
    known: &'t OpenLibrary,
    world: &'t str,
    decisions: &'t Decisions,
}

impl Counted<'_> {
    /// Adds the plays of a host's team. A play is to goal if a goal of the team followed it in the window of
    /// the ledger: until the team lost the ball or play stopped for another reason. A shot alone does not
    /// count: most cases end with one, whatever it is worth.
    fn add(&self, host: &Host, bases: &BTreeSet<u32>, evidence: &mut Evidence) -> Result<(), Failure> {
        let (us, own) = (host.settings().us, self.known.variant.base().hash());
        let plays: Vec<_> = self.decisions.ledger().team(us).plays().collect();
        if let Some(other) = bases.iter().find(|base| **base != own).filter(|_| !plays.is_empty()) {
            if bases.contains(&own) {
                let file = printable_path(self.file);
                note!("{file}: {}'s robots had several case bases; its plays are left out", us.label());
                return Ok(());
            }
            return Err(failed(self.file)(RecordedError::OtherLibrary { recorded: *other, library: own }));
        }
        let mut unknown = 0;
        for (cycle, followed) in plays {
            let Some(play) = &cycle.play else { continue };
            let decided = |by_coordinator: bool| {
                self.decisions.all.iter().find(|decision| {
                    let note = &decision.note;
                    decision.team == us.label()
                        && (note.cycle, note.id) == (cycle.id.counter, Some(play.case.0))
                        && (!by_coordinator || note.by == cycle.coordinator.number())
                })
            };
            let noted = decided(true).or_else(|| decided(false));
            let problem =
                noted.and_then(|decision| problem::parse(&decision.note.problem.as_ref()?.to_string()).ok());
            let Some(problem) = problem else {
                unknown += 1;
                continue;
            };
            let situation = Situation::of(&problem);
            let end = cycle.end.map_or(CycleEnd::TrialOver, |(_, end)| end);
            let play = CasePlay {
                situation: &situation,
                case: Some(play.case.0),
                to_goal: followed == Followed::Goal,
                end: Some(end.label()),
            };
            let opponents = situation.opponents.len().to_string();
            evidence.add_play(&self.known.variant, self.world, &opponents, &play);
        }
        if unknown > 0 {
            let file = printable_path(self.file);
            note!("{file}: the situations of {unknown} plays of {} are not known: left out", us.label());
        }
        Ok(())
    }
}

/// A league log file: plays of both teams, whoever they are.
fn from_log(file: &Path, known: &OpenLibrary) -> Result<Collected, Failure> {
    let league = known.handle.simulated_league()?;
    if league.limits().is_none() {
        return Err(other_league(file, "the Small Size League", known));
    }
    let mut reader = ssl::log::open(file).map_err(RecordedError::Log).map_err(failed(file))?;
    let mut host = Host::new(HostSettings::new(Colour::Blue, league, 1), Instant(0));
    let (mut finder, mut clock) = (PlayFinder::default(), LogClock::default());
    let bar = Progress::open();
    for record in reader.by_ref() {
        bar.add(1);
        let now = clock.read(record.timestamp_ns);
        let input = match record.kind {
            MessageKind::Vision2014 => Input::Vision(&record.payload),
            MessageKind::Refbox2013 => Input::Referee(&record.payload, SenderAddress::INTERNAL),
            _ => continue,
        };
        host.handle(now, input);
        while host.poll_packet().is_some() {}
        finder.look(&host, now.0 as f64 * 1e-6);
    }
    drop(bar);
    if let Some(damage) = reader.end().filter(|end| !end.is_whole()) {
        note!("{}: {damage}; what was before counts", printable_path(file));
    }
    Ok(Collected { evidence: Evidence::default(), plays: finder.finish().into_iter().collect() })
}

fn other_league(file: &Path, recorded: &str, known: &OpenLibrary) -> Failure {
    let library = known.handle.league().to_owned();
    failed(file)(RecordedError::OtherLeague { recorded: recorded.to_owned(), library })
}

/// The first bytes of every league log file.
const LOG: &[u8] = b"SSL_LOG_FILE";
/// Longest `evidence.jsonl` that is read, bytes.
const TEXT_LEN_MAX: u64 = 1 << 28;
/// Longest name of a world that is kept, characters.
const WORLD_LEN: usize = 40;
