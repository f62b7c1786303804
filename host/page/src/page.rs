//! `page`: handle of a match's page. [`Page::open`] takes the port; from then on the match passes scenes and
//! events, and never waits.

use std::cell::RefCell;
use std::io;
use std::net::{SocketAddr, TcpListener};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, sync_channel};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use serde::Serialize;
use thiserror::Error;

use crate::archive::Archive;
use crate::deferred_scene::DeferredScene;
use crate::match_event::MatchEvent;
use crate::request::UserRequest;
use crate::server::Server;
use crate::settings::{ExplanationService, PageSettings};
use crate::shared::{Ask, Shared};
use crate::viewers::{Mailbox, Viewers};

/// Requests that may wait for the match; further ones are answered that it is busy.
const REQUESTS_MAX: usize = 256;

/// Failure to open a page.
#[derive(Debug, Error)]
pub enum PageError {
    /// Another program has the port.
    #[error(
        "{0} belongs to another program, perhaps another match: end that, or choose another port, such as {other}",
        other = SocketAddr::new(.0.ip(), .0.port().checked_add(1).unwrap_or(0))
    )]
    Taken(SocketAddr),
    /// The address cannot be served.
    #[error("{0} cannot be served ({1}): choose an address of this machine, such as 127.0.0.1:8080")]
    Listen(SocketAddr, io::Error),
}

impl PageError {
    fn of(address: SocketAddr, error: io::Error) -> Self {
        match error.kind() {
            io::ErrorKind::AddrInUse => Self::Taken(address),
            _ => Self::Listen(address, error),
        }
    }
}

/// The moment of a recording that is sent to the network, for viewers to follow.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Transport {
    /// Seconds since its start.
    pub at: f64,
    /// Time passes.
    pub playing: bool,
    /// Seconds of the recording a second while it plays.
    pub speed: f32,
}

/// A page that is served until this value is dropped.
pub struct Page {
    address: SocketAddr,
    archive: Archive,
    requests: Receiver<Ask>,
    /// To the viewer whose request was taken last.
    asker: RefCell<Option<Arc<Mailbox>>>,
    viewers: Arc<Viewers>,
    seats: Arc<AtomicUsize>,
    parameters: Arc<Mutex<String>>,
    snapshots: Arc<Mutex<String>>,
    spectrum: Arc<OnceLock<serde_json::Value>>,
    pushed: u64,
    left_out: u64,
    _server: Server,
}

impl Page {
    /// Opens the port and serves.
    pub fn open(
        settings: PageSettings,
        explanations: Arc<dyn ExplanationService>,
    ) -> Result<Self, PageError> {
        let listen = settings.listen;
        let failed = |error: io::Error| PageError::of(listen, error);
        let listener = TcpListener::bind(listen).map_err(failed)?;
        let address = listener.local_addr().map_err(failed)?;
        let viewers = Arc::new(Viewers::default());
        let archive = Archive::begin(viewers.clone());
        let (asks, requests) = sync_channel(REQUESTS_MAX);
        let seats = Arc::new(AtomicUsize::new(0));
        let [parameters, snapshots] = [(); 2].map(|()| Arc::new(Mutex::new(String::from("[]"))));
        let spectrum = Arc::default();
        let shared = Shared {
            port: address.port(),
            settings,
            explanations,
            viewers: viewers.clone(),
            kept: archive.kept(),
            asks,
            parameters: parameters.clone(),
            snapshots: snapshots.clone(),
            spectrum: Arc::clone(&spectrum),
            seats: seats.clone(),
        };
        let server = Server::start(listener, shared).map_err(failed)?;
        Ok(Self {
            address,
            archive,
            requests,
            asker: RefCell::default(),
            viewers,
            seats,
            parameters,
            snapshots,
            spectrum,
            pushed: 0,
            left_out: 0,
            _server: server,
        })
    }

    /// Address that it is served on.
    pub fn address(&self) -> SocketAddr {
        self.address
    }

    /// Passes a moment to the page; if the page's thread is behind, it is left out. Never waits.
    pub fn show(&mut self, deferred_scene: impl Into<DeferredScene>) {
        let deferred_scene = self.dated(deferred_scene.into());
        if !self.archive.show(deferred_scene) {
            self.left_out += 1;
        }
    }

    /// Stores a moment in any case, and waits for it: for recordings.
    pub fn keep(&mut self, deferred_scene: impl Into<DeferredScene>) {
        self.archive.keep(self.dated(deferred_scene.into()));
    }

    fn dated(&self, mut deferred_scene: DeferredScene) -> DeferredScene {
        deferred_scene.scene.happened = self.pushed;
        deferred_scene
    }

    /// Passes an event to the page. Never waits.
    pub fn push(&mut self, match_event: MatchEvent) {
        self.pushed += 1;
        self.archive.keep_event(match_event);
    }

    /// Passes what became of every case up to `t` to the page, as JSON. Never waits.
    pub fn keep_cases(&self, t: f64, tables: String) {
        self.archive.keep_cases(t, tables);
    }

    /// Passes the teams' parameters to the page, as a JSON list.
    pub fn set_parameters(&self, teams: String) {
        *self.parameters.lock().unwrap_or_else(PoisonError::into_inner) = teams;
    }

    /// Passes the kept moments of the simulated field to the page, as a JSON list.
    pub fn set_snapshots(&self, snapshots: String) {
        *self.snapshots.lock().unwrap_or_else(PoisonError::into_inner) = snapshots;
    }

    /// Passes the power on the radio's channels to the page, once: `sweeps`, `counts` of channels 0 on, MHz
    /// above 2,400, and the team's `channel`.
    pub fn set_spectrum(&self, spectrum: serde_json::Value) {
        // A second one is not shown: a scan is measured before the match.
        let _ = self.spectrum.set(spectrum);
    }

    /// Hands the moment of a recording that is sent to the network to all viewers. Never waits.
    pub fn set_transport(&self, transport: Transport) {
        let text = serde_json::json!({ "transport": transport }).to_string();
        self.viewers.follow(&Arc::from(text));
    }

    /// Drops the history: another match starts.
    pub fn clear(&mut self) {
        self.pushed = 0;
        self.archive.clear();
    }

    /// The next request of a viewer.
    pub fn next_request(&self) -> Option<UserRequest> {
        let Ask { request, asker } = self.requests.try_recv().ok()?;
        self.asker.replace(Some(asker));
        Some(request)
    }

    /// Answers the viewer whose request was taken last with the reason why it is refused.
    pub fn refuse(&self, reason: impl Into<String>) {
        if let Some(asker) = &*self.asker.borrow() {
            // A viewer that is gone, or that asks faster than it reads, gets no reply.
            asker.refuse(reason.into());
        }
    }

    /// Number of viewers at the moment.
    pub fn viewers(&self) -> usize {
        self.seats.load(Ordering::Relaxed)
    }

    /// Scenes that were left out because finishing and encoding them was behind.
    pub fn left_out(&self) -> u64 {
        self.left_out
    }
}
