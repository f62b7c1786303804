//! `projector`: a recording on the page: every moment of it, for each viewer to seek through at its own pace.
//!
//! A trace replays the decisions of its hosts: they are built from its header and decide again. A league's
//! log file gives what was on the field and what the referee sent; for one team a host of ours is fed with
//! it too.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use arena::cases::LibraryHandle;
use foreign::printable;
use host::record::trace::RecordKind;
use host::referee::SenderAddress;
use host::{Host, HostSettings, Input};
use page::{MatchEvent, Page, ProgramLog};
use protocol::Instant;
use rules::{Colour, League};
use ssl::log::MessageKind;

use super::ReadObserver;
use super::beside::Beside;
use super::failure::{RecordedError, RecordingFailure, in_file};
use super::log_messages::LogMessages;
use super::trace_file::{TraceFile, hosts_of};
use crate::{Composer, LedgerFeed, Moment, SCENE_EVERY_S};

/// Shows a recording on a page.
pub struct Projector<'a> {
    page: &'a mut Page,
    observer: &'a dyn ReadObserver,
    composer: Composer,
    ledger: LedgerFeed,
    /// Time of the next scene, s.
    due: f64,
    beside: Option<Beside<'a>>,
}

/// The part of a recording that is on the page.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shown {
    /// Only a part: the operator ended the program.
    Stopped,
    /// All that a cut or damaged file holds.
    Broken {
        /// Every decision was taken again as recorded.
        same: bool,
    },
    /// All of it.
    Whole {
        /// Every decision was taken again as recorded.
        same: bool,
    },
}

impl<'a> Projector<'a> {
    /// A projector that names cases as `library` does; alarms go to `log`, lines for the operator to
    /// `observer`. `beside` is a second trace.
    pub fn new(
        page: &'a mut Page,
        library: Option<&LibraryHandle>,
        log: Arc<ProgramLog>,
        observer: &'a dyn ReadObserver,
        beside: Option<Beside<'a>>,
    ) -> Self {
        if let Some(beside) = &beside {
            observer.note(&printable(&beside.first_difference()));
        }
        let (composer, ledger) = (Composer::new(library, log), LedgerFeed::new(library));
        Self { page, observer, composer, ledger, due: f64::NEG_INFINITY, beside }
    }

    /// Shows a trace; its records are fed to the hosts of `recheck`.
    pub fn show_trace(
        &mut self,
        mut trace: TraceFile<'_>,
        mut recheck: host::record::recheck::Recheck,
        stopped: &AtomicBool,
    ) -> Shown {
        let mut now = Instant(0);
        for record in trace.by_ref() {
            if stopped.load(Ordering::Relaxed) {
                return Shown::Stopped;
            }
            now = now.max(record.at);
            // Every host receives the same packets: those of the first one are enough.
            match record.kind {
                RecordKind::Vision if record.host == 0 => self.composer.vision(&record.bytes),
                RecordKind::Referee if record.host == 0 => {
                    self.composer.referee(&record.bytes, now.0 as f64 * 1e-6, false);
                }
                _ => {}
            }
            recheck.feed(&record);
            let hosts = hosts_of(&recheck);
            if let Some(feed) = hosts.first() {
                self.look(now, feed, &hosts);
            }
        }
        let (hosts, damage) = (hosts_of(&recheck), trace.damage());
        if let (Some(damage), Some(feed)) = (&damage, hosts.first()) {
            self.breaks_off(now, damage, feed, &hosts);
        }
        // What became of every case is final.
        self.ledger.send(now.0 as f64 * 1e-6, &hosts, true, self.page);
        recheck.finish(true);
        let same = recheck.results().all(|(_, difference)| difference.is_none());
        if damage.is_some() { Shown::Broken { same } } else { Shown::Whole { same } }
    }

    /// Shows a league log file of a match of `league`, with the orders of a host of `team` if one is given.
    pub fn show_log(
        &mut self,
        file: &Path,
        league: League,
        team: Option<Colour>,
        stopped: &AtomicBool,
    ) -> Result<Shown, RecordingFailure> {
        let mut messages = LogMessages::open(file)?;
        let settings = HostSettings::new(team.unwrap_or(Colour::Blue), league, 1);
        let mut host = Host::new(settings, Instant(0));
        let displayed = usize::from(team.is_some());
        let (mut began, mut now) = (false, Instant(0));
        for (at, record) in messages.by_ref() {
            if stopped.load(Ordering::Relaxed) {
                return Ok(Shown::Stopped);
            }
            began = true;
            now = at;
            match record.present() {
                Some((MessageKind::Vision2014, bytes)) => {
                    self.composer.vision(&bytes);
                    host.handle(now, Input::Vision(&bytes));
                }
                Some((MessageKind::Refbox2013, bytes)) => {
                    self.composer.referee(&bytes, now.0 as f64 * 1e-6, false);
                    host.handle(now, Input::Referee(&bytes, SenderAddress::INTERNAL));
                }
                _ => continue,
            }
            while host.poll_packet().is_some() {}
            self.look(now, &host, &[&host][..displayed]);
        }
        if !began {
            return Err(in_file(file)(RecordedError::Empty));
        }
        let Some(damage) = messages.damage() else {
            return Ok(Shown::Whole { same: true });
        };
        self.breaks_off(now, &damage, &host, &[&host][..displayed]);
        Ok(Shown::Broken { same: true })
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
        self.ledger.send(t, hosts, false, self.page);
    }

    /// Reports that the file is truncated, and where: it is not the end of the match.
    fn breaks_off(&mut self, now: Instant, damage: &str, feed: &Host, hosts: &[&Host]) {
        let fault = format!("the file breaks off: {damage}");
        self.observer.note(&printable(&fault));
        self.page.push(MatchEvent::fault(now.0 as f64 * 1e-6, fault));
        self.due = f64::NEG_INFINITY;
        self.look(now, feed, hosts);
    }
}
