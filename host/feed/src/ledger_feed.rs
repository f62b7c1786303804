//! `ledger_feed`: what became of every case, for the page: a table a second.

use arena::CaseNames;
use arena::cases::LibraryHandle;
use arena::game::TICK_US;
use arena::ledger::MatchLedger;
use host::Host;
use page::Page;

/// The page gets a table at most this often, s of the match.
const TABLE_EVERY_S: f64 = 1.0;
/// A host is looked at this often, s.
const LOOK_EVERY_S: f64 = TICK_US as f64 * 1e-6;

/// Passes tables to the page.
pub struct LedgerFeed {
    names: CaseNames,
    ledger: MatchLedger,
    looked: f64,
    sent: f64,
}

impl LedgerFeed {
    /// Names cases as the library does.
    pub fn new(library_handle: Option<&LibraryHandle>) -> Self {
        Self {
            names: CaseNames::new(library_handle.map_or_else(Vec::new, LibraryHandle::names)),
            ledger: MatchLedger::default(),
            looked: f64::NEG_INFINITY,
            sent: f64::NEG_INFINITY,
        }
    }

    /// Keeps a ledger of what these hosts see, where there is no simulation that keeps one.
    pub fn look(&mut self, t: f64, feed: &Host, hosts: &[&Host]) {
        if !(0.0..LOOK_EVERY_S).contains(&(t - self.looked)) {
            self.looked = t;
            self.ledger.look_through(feed, hosts, t);
        }
    }

    /// Sends the table of its own ledger if it is due, and in any case where the match is over.
    pub fn send(&mut self, t: f64, hosts: &[&Host], over: bool, page: &Page) {
        if self.is_due(t, over) {
            page.keep_cases(t, self.tables(&self.ledger, hosts, over));
        }
    }

    /// Sends the table of a simulation's ledger, likewise.
    pub fn send_of(&mut self, ledger: &MatchLedger, t: f64, hosts: &[&Host], over: bool, page: &Page) {
        if self.is_due(t, over) {
            page.keep_cases(t, self.tables(ledger, hosts, over));
        }
    }

    fn is_due(&mut self, t: f64, over: bool) -> bool {
        let due = over || !(0.0..TABLE_EVERY_S).contains(&(t - self.sent));
        if due {
            self.sent = t;
        }
        due
    }

    fn tables(&self, ledger: &MatchLedger, hosts: &[&Host], over: bool) -> String {
        // Names and counts: nothing that JSON cannot hold.
        serde_json::to_string(&ledger.tables(hosts, &self.names, over)).unwrap_or_default()
    }
}
