//! `shared`: state of a page that all its connections use, and the requests that they pass to the match.

use std::sync::atomic::AtomicUsize;
use std::sync::mpsc::{RecvTimeoutError, SyncSender, sync_channel};
use std::sync::{Arc, Mutex, OnceLock};
use std::thread;
use std::time::Duration;

use crate::archive::Kept;
use crate::http::Status;
use crate::request::UserRequest;
use crate::settings::{ExplanationService, PageSettings};
use crate::viewers::{Mailbox, Viewers};

/// State shared by all request handlers.
pub(crate) struct Shared {
    /// The teams' parameters, as a JSON list.
    pub(crate) parameters: Arc<Mutex<String>>,
    /// Kept moments of the simulated field, as a JSON list.
    pub(crate) snapshots: Arc<Mutex<String>>,
    /// Power on the radio's channels, where it was measured.
    pub(crate) spectrum: Arc<OnceLock<serde_json::Value>>,
    pub(crate) port: u16,
    pub(crate) settings: PageSettings,
    pub(crate) explanations: Arc<dyn ExplanationService>,
    pub(crate) viewers: Arc<Viewers>,
    pub(crate) kept: Arc<Mutex<Kept>>,
    pub(crate) asks: SyncSender<Ask>,
    pub(crate) seats: Arc<AtomicUsize>,
}

/// Request of a viewer, with the mailbox for its refusal.
pub(crate) struct Ask {
    pub(crate) request: UserRequest,
    pub(crate) asker: Arc<Mailbox>,
}

impl Shared {
    /// True where a viewer that brought that token may send requests.
    pub(crate) fn may_ask(&self, brought: Option<&str>) -> bool {
        self.settings.token.as_ref().is_none_or(|token| brought.is_some_and(|brought| token.is(brought)))
    }

    /// Whether the beginning of a request shows the token, in its address line or a header.
    pub(crate) fn shows_token(&self, request: &[u8]) -> bool {
        let text = String::from_utf8_lossy(request);
        let mut words = text.split(|c: char| c.is_whitespace() || "?&=".contains(c));
        self.settings.token.as_ref().is_some_and(|token| words.any(|word| token.is(word)))
    }

    /// Computes an answer within that time on a thread of its own, not on the connection's: it cannot be
    /// cancelled.
    pub(crate) fn in_time<T: Send + 'static>(
        &self,
        within: Duration,
        work: impl FnOnce(&dyn ExplanationService) -> T + Send + 'static,
    ) -> Result<T, Status> {
        let (done, answer) = sync_channel(1);
        let explanations = self.explanations.clone();
        let worker = thread::Builder::new().spawn(move || done.send(work(&*explanations)));
        worker.map_err(|_| Status::UNAVAILABLE)?;
        answer.recv_timeout(within).map_err(|error| match error {
            RecvTimeoutError::Timeout => Status::TIMED_OUT,
            RecvTimeoutError::Disconnected => Status::INTERNAL,
        })
    }
}
