//! `collect`: what recordings say of cases, as evidence, and their plays that led to a shot or a goal. Reads
//! `evidence.jsonl`, traces and league log files; the order of files does not matter.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use arena::CycleEnd;
use arena::cases::{LibraryError, LibraryHandle, problem};
use arena::game::TICK_US;
use arena::ledger::Followed;
use arena::successful_plays::PlayFinder;
use case_tools::Files;
use foreign::{excerpt, printable_path};
use host::referee::SenderAddress;
use host::{Host, HostSettings, Input};
use protocol::{Instant, RobotId};
use rules::Colour;
use ssl::log::MessageKind;

use study::learning::{CasePlay, Collected, Evidence, LearnError, Situation, Variant};
use thiserror::Error;

use super::ReadObserver;

use super::decisions::{Decision, Decisions};
use super::failure::{RecordedError, RecordingFailure, in_file};
use super::log_messages::LogMessages;
use super::trace_file::{TraceFile, begin, begins_as_trace, hosts_of};

/// Why nothing is collected.
#[derive(Debug, Error)]
pub enum CollectError {
    /// The library cannot be used.
    #[error(transparent)]
    Library(#[from] LibraryError),
    /// Learning refuses the library.
    #[error(transparent)]
    Learn(#[from] LearnError),
    /// A recording cannot be used.
    #[error(transparent)]
    Recording(#[from] RecordingFailure),
}

/// The library whose cases are counted.
pub struct OpenLibrary {
    /// The library as it was opened.
    pub handle: LibraryHandle,
    /// The same with its files; names and texts alone count, wherever it lies.
    pub variant: Variant,
}

impl OpenLibrary {
    /// An opened library with its files.
    pub fn of(handle: LibraryHandle) -> Result<Self, CollectError> {
        let files = handle.files().map_err(|findings| LibraryError::Faulty {
            directory: handle.directory().map_or_else(PathBuf::new, Path::to_owned),
            findings,
        })?;
        let texts = files.cases.iter().map(|file| (file.name.as_str(), file.text.as_str()));
        let files = Files::from_texts(&files.league, &files.rules.text, &texts.collect::<Vec<_>>());
        let variant = Variant::new(files).map_err(LearnError::Library)?;
        Ok(Self { handle, variant })
    }
}

/// Gains of the library from these files: evidence (unless `cases` is false) and plays. A file that is given
/// twice counts once.
pub fn collect(
    files: &[PathBuf],
    known: &OpenLibrary,
    key_file: Option<&Path>,
    cases: bool,
    observer: &dyn ReadObserver,
) -> Result<Collected, CollectError> {
    let (mut collected, mut read) = (Collected::default(), BTreeSet::new());
    for file in files {
        // One that is not there is reported by its reader.
        if !read.insert(file.canonicalize().unwrap_or_else(|_| file.clone())) {
            continue;
        }
        let begin = begin(file)?;
        let more = if begins_as_trace(file)? {
            from_trace(file, known, key_file, cases, observer)?
        } else if begin.starts_with(LOG) {
            from_log(file, known, observer)?
        } else if begin
            .strip_prefix(BYTE_ORDER_MARK)
            .unwrap_or(&begin)
            .first()
            .copied()
            .is_none_or(begins_json)
        {
            from_text(file)?
        } else {
            return Err(in_file(file)(RecordedError::NoRecording).into());
        };
        collected = collected.merge(more);
    }
    Ok(collected)
}

/// `evidence.jsonl`.
fn from_text(file: &Path) -> Result<Collected, RecordingFailure> {
    let failed = |what: String| in_file(file)(RecordedError::Damaged(what));
    let text = foreign::read_text(file, TEXT_LEN_MAX).map_err(|error| failed(error.to_string()))?;
    Collected::from_jsonl(text.trim_start_matches('\u{feff}')).map_err(failed)
}

/// A trace of a match: evidence of the teams whose robots had this library.
fn from_trace(
    file: &Path,
    known: &OpenLibrary,
    key_file: Option<&Path>,
    cases: bool,
    observer: &dyn ReadObserver,
) -> Result<Collected, CollectError> {
    let mut trace = TraceFile::open(file)?;
    if known.handle.simulated_league()? != trace.league {
        return Err(other_league(file, trace.league.name(), known).into());
    }
    let mut recheck = trace.recheck(key_file, observer)?;
    let mut decisions = Decisions::new(Some(&known.handle));
    let (mut finder, mut tick) = (PlayFinder::default(), 0);
    let mut bases: [BTreeSet<u32>; 2] = Default::default();
    for record in trace.by_ref() {
        observer.record();
        if let Some(feed) = recheck.host(0) {
            let hosts = hosts_of(&recheck);
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
    if let Some(feed) = recheck.host(0) {
        decisions.finish(feed, &hosts_of(&recheck));
    }
    if let Some(damage) = trace.damage() {
        observer.note(&format!("{}: {damage}; what was before counts", printable_path(file)));
    }
    let world =
        trace.header.world.as_deref().map_or_else(|| "field".to_owned(), |world| excerpt(world, WORLD_LEN));
    let mut evidence = Evidence::default();
    if cases {
        let counted = Counted { file, known, world: &world, decisions: &decisions, observer };
        for host in hosts_of(&recheck) {
            counted.add(host, &bases[host.settings().us as usize], &mut evidence)?;
        }
    }
    Ok(Collected { evidence, plays: finder.finish().into_iter().collect() })
}

/// A trace whose plays are counted.
struct Counted<'t> {
    file: &'t Path,
    known: &'t OpenLibrary,
    world: &'t str,
    decisions: &'t Decisions,
    observer: &'t dyn ReadObserver,
}

impl Counted<'_> {
    /// Adds the plays of a host's team. A play is to goal if a goal of the team followed it in the window of
    /// the ledger: until the team lost the ball or play stopped for another reason. A shot alone does not
    /// count: most cases end with one, whatever it is worth.
    fn add(
        &self,
        host: &Host,
        bases: &BTreeSet<u32>,
        evidence: &mut Evidence,
    ) -> Result<(), RecordingFailure> {
        let (us, own) = (host.settings().us, self.known.variant.base().hash());
        let plays: Vec<_> = self.decisions.ledger().team(us).plays().collect();
        if let Some(other) = bases.iter().find(|base| **base != own).filter(|_| !plays.is_empty()) {
            if bases.contains(&own) {
                let file = printable_path(self.file);
                self.observer.note(&format!(
                    "{file}: {}'s robots had several case bases; its plays are left out",
                    us.label()
                ));
                return Ok(());
            }
            return Err(in_file(self.file)(RecordedError::OtherLibrary { recorded: *other, library: own }));
        }
        let mut unknown = 0;
        for (cycle, followed) in plays {
            let Some(play) = &cycle.play else { continue };
            let key = (cycle.id.counter, Some(play.case.0));
            let of_cycle = self.decisions.all.iter().filter(|decision| {
                decision.team == us.label() && (decision.note.cycle, decision.note.id) == key
            });
            let by_coordinator = |decision: &&Decision| decision.note.by == cycle.coordinator.number();
            let noted = of_cycle.clone().find(by_coordinator).or_else(|| of_cycle.clone().next());
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
            self.observer.note(&format!(
                "{file}: the situations of {unknown} plays of {} are not known: left out",
                us.label()
            ));
        }
        Ok(())
    }
}

/// A league log file: plays of both teams, whoever they are.
fn from_log(
    file: &Path,
    known: &OpenLibrary,
    observer: &dyn ReadObserver,
) -> Result<Collected, CollectError> {
    let league = known.handle.simulated_league()?;
    if league.limits().is_none() {
        return Err(other_league(file, "the Small Size League", known).into());
    }
    let mut messages = LogMessages::open(file)?;
    let mut host = Host::new(HostSettings::new(Colour::Blue, league, 1), Instant(0));
    let mut finder = PlayFinder::default();
    for (now, record) in messages.by_ref() {
        observer.record();
        let present = record.present();
        let input = match &present {
            Some((MessageKind::Vision2014, bytes)) => Input::Vision(bytes),
            Some((MessageKind::Refbox2013, bytes)) => Input::Referee(bytes, SenderAddress::INTERNAL),
            _ => continue,
        };
        host.handle(now, input);
        while host.poll_packet().is_some() {}
        finder.look(&host, now.0 as f64 * 1e-6);
    }
    if let Some(damage) = messages.damage() {
        observer.note(&format!("{}: {damage}; what was before counts", printable_path(file)));
    }
    Ok(Collected { evidence: Evidence::default(), plays: finder.finish().into_iter().collect() })
}

fn other_league(file: &Path, recorded: &str, known: &OpenLibrary) -> RecordingFailure {
    let library = known.handle.league().to_owned();
    in_file(file)(RecordedError::OtherLeague { recorded: recorded.to_owned(), library })
}

/// Whether a text that begins with this byte may be lines of JSON.
fn begins_json(first: u8) -> bool {
    first == b'{' || first.is_ascii_whitespace()
}

/// What some editors put before a text.
const BYTE_ORDER_MARK: &[u8] = "\u{feff}".as_bytes();
/// The first bytes of every league log file.
const LOG: &[u8] = b"SSL_LOG_FILE";
/// Longest `evidence.jsonl` that is read, bytes.
const TEXT_LEN_MAX: u64 = 1 << 28;
/// Longest name of a world that is kept, characters.
const WORLD_LEN: usize = 40;
