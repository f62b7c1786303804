//! `board`: the page beside a real field: displays what the host knows, and accepts HALT; where the operator
//! allows it, changes of parameters too.

use std::time::{Duration, Instant};

use arena::cases::LibraryHandle;
use feed::{CaseExplanations, Composer, LedgerFeed, Moment, SCENE_EVERY_S, tick};
use host::Host;
use page::{MatchEvent, Page, Powers, UserRequest};

use crate::args::page::{NoPage, PageArgs};
use crate::output::{note, program_log};

/// A page and its composer.
pub(super) struct Board {
    page: Page,
    composer: Composer,
    ledger: LedgerFeed,
    drawn_at: Option<Instant>,
    /// Time an input takes, as a sliding mean.
    took: Duration,
}

impl Board {
    /// Opens the page. If it cannot be opened, the error is printed and the robots are controlled without it.
    pub(super) fn open(
        args: &PageArgs,
        title: String,
        powers: Powers,
        library_handle: Option<LibraryHandle>,
        settings: casebase::RetrievalSettings,
    ) -> Option<Self> {
        let open = || {
            let composer = Composer::new(library_handle.as_ref(), program_log());
            let ledger = LedgerFeed::new(library_handle.as_ref());
            let page = args.open(title, false, powers, CaseExplanations::new(library_handle, settings))?;
            Ok::<_, NoPage>(Self { page, composer, ledger, drawn_at: None, took: Duration::ZERO })
        };
        open().map_err(|failure| note!("page     there is none: {failure}")).ok()
    }

    pub(super) fn vision(&mut self, bytes: &[u8]) {
        self.composer.vision(bytes);
    }

    pub(super) fn referee(&mut self, bytes: &[u8], now: protocol::Instant) {
        self.composer.referee(bytes, now.0 as f64 * 1e-6, false);
    }

    /// Adds a fault to the page's events.
    pub(super) fn fault(&mut self, now: protocol::Instant, description: String) {
        let t = now.0 as f64 * 1e-6;
        self.page.push(MatchEvent::fault(t, description));
    }

    /// Records how long an input took.
    pub(super) fn took(&mut self, time: Duration) {
        self.took = (self.took * 15 + time) / 16;
    }

    /// Sends the scene to the page if it is due.
    pub(super) fn look(&mut self, now: protocol::Instant, host: &Host, alarms: Vec<String>) {
        let every = Duration::from_secs_f64(SCENE_EVERY_S);
        let t = now.0 as f64 * 1e-6;
        self.ledger.look(t, host, &[host]);
        if self.drawn_at.is_none_or(|drawn_at| drawn_at.elapsed() >= every) {
            self.drawn_at = Some(Instant::now());
            let gauges = vec![tick(self.took)];
            let moment = Moment { t, now, feed: host, hosts: &[host], truth: None, referee: None, gauges };
            let mut deferred_scene = self.composer.compose(moment);
            deferred_scene.scene.alarms = alarms;
            for match_event in self.composer.take_match_events() {
                self.page.push(match_event);
            }
            self.page.show(deferred_scene);
            self.ledger.send(t, &[host], false, &self.page);
        }
    }

    /// The next request of a viewer.
    pub(super) fn next_request(&self) -> Option<UserRequest> {
        self.page.next_request()
    }

    /// The page, to show parameters on it and to refuse what was asked last.
    pub(super) fn page(&self) -> &Page {
        &self.page
    }
}
