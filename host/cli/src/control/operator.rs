//! `operator`: what the operator of `onetwo control` sees of the host, on the terminal and on the page, and
//! what is asked for on the page: HALT, and where it is allowed changes of parameters and tests of kickers.

use std::path::PathBuf;
use std::time::{Duration, Instant};

use arena::cases::LibraryHandle;
use feed::{
    CaseExplanations, Composer, LedgerFeed, Moment, ParameterFeed, SCENE_EVERY_S, change_of, test_of, tick,
};
use host::Host;
use host::config::TeamConfig;
use host::health_checks::Finding;
use host::referee::remote::{RemoteRequest, RemoteState};
use host::run::{Operator, Request};
use page::{MatchEvent, Page, Powers, UserRequest};

use super::terminal::Terminal;
use crate::args::page::PageArgs;
use crate::output::{note, printable_path, program_log};

/// What the operator's page is opened with.
pub(super) struct PageSettings<'a> {
    pub(super) args: &'a PageArgs,
    pub(super) live_parameters: bool,
    pub(super) library: Option<LibraryHandle>,
    pub(super) retrieval: casebase::RetrievalSettings,
    /// Power on the radio's channels, for the page.
    pub(super) spectrum: Option<serde_json::Value>,
}

/// A terminal, and a page beside it.
pub(super) struct ControlOperator<'a> {
    config: &'a TeamConfig,
    /// The team's file, for the page.
    file: Option<PathBuf>,
    page_settings: Option<PageSettings<'a>>,
    terminal: Option<Terminal>,
    dashboard: Option<Dashboard>,
    /// Time between two tables of the robots, and when the next is due.
    glance: Option<(protocol::Duration, protocol::Instant)>,
}

impl<'a> ControlOperator<'a> {
    pub(super) fn new(
        config: &'a TeamConfig,
        file: Option<PathBuf>,
        page_settings: Option<PageSettings<'a>>,
    ) -> Self {
        Self { config, file, page_settings, terminal: None, dashboard: None, glance: None }
    }

    /// The robots at a glance are printed every so many seconds.
    pub(super) fn glancing(self, every_s: Option<f64>) -> Self {
        let every = every_s.map(|seconds| protocol::Duration((seconds * 1e6) as u64));
        Self { glance: every.map(|every| (every, protocol::Instant(0) + every)), ..self }
    }

    fn on_page(&mut self, act: impl FnOnce(&mut Dashboard)) {
        if let Some(dashboard) = &mut self.dashboard {
            act(dashboard);
        }
    }
}

impl Operator for ControlOperator<'_> {
    fn started(&mut self) {
        let TeamConfig { name, colour, league, .. } = self.config;
        note!(
            "controlling {name}, {}, {}; Ctrl-C halts the robots and ends it",
            colour.label(),
            league.name()
        );
        let title = format!("{name}, {}", colour.label());
        self.dashboard = self.page_settings.take().and_then(|settings| Dashboard::open(settings, title));
        self.terminal = Some(Terminal::open());
    }

    fn line(&mut self, line: String) {
        match &mut self.terminal {
            Some(terminal) => terminal.line(line),
            None => note!("{line}"),
        }
    }

    fn status(&mut self, status: String) {
        if let Some(terminal) = &self.terminal {
            terminal.status(status);
        }
    }

    fn vision(&mut self, bytes: &[u8]) {
        self.on_page(|dashboard| dashboard.composer.vision(bytes));
    }

    fn referee(&mut self, now: protocol::Instant, bytes: &[u8]) {
        self.on_page(|dashboard| dashboard.composer.referee(bytes, now.0 as f64 * 1e-6, false));
    }

    fn took(&mut self, time: Duration) {
        self.on_page(|dashboard| dashboard.took = (dashboard.took * 15 + time) / 16);
    }

    fn fault(&mut self, now: protocol::Instant, fault: String) {
        self.on_page(|dashboard| dashboard.page.push(MatchEvent::fault(now.0 as f64 * 1e-6, fault)));
    }

    fn changed(&mut self) {
        self.on_page(|dashboard| dashboard.parameters.hasten());
    }

    fn remote(&mut self, state: Option<&RemoteState>) {
        let state = serde_json::to_value(state).ok();
        self.on_page(|dashboard| dashboard.remote = state);
    }

    fn look(&mut self, now: protocol::Instant, host: &Host, findings: &[Finding]) {
        if let Some((every, due)) = self.glance.filter(|(_, due)| *due <= now) {
            self.glance = Some((every, due + every));
            self.line(host::glance::table(&host::glance::robots(host, now)));
        }
        if let Some(dashboard) = &mut self.dashboard {
            dashboard.look(now, host, findings);
            let name = self.file.as_deref().map(printable_path);
            let file = Some((self.config, name.as_deref()));
            dashboard.parameters.look(&[host], file, &dashboard.page);
        }
    }

    fn next_request(&mut self) -> Option<Request> {
        let page = &self.dashboard.as_ref()?.page;
        while let Some(request) = page.next_request() {
            match request_of(request) {
                Some(Ok(request)) => return Some(request),
                Some(Err(reason)) => page.refuse(reason),
                None => {}
            }
        }
        None
    }

    fn refuse(&mut self, reason: String) {
        self.on_page(|dashboard| dashboard.page.refuse(reason));
    }

    fn ended(&mut self) {
        if let Some(terminal) = self.terminal.take() {
            terminal.close();
        }
    }
}

/// A viewer's request to the host, or why it is none; nothing where it is for a simulation, which was refused
/// when it was read.
fn request_of(request: UserRequest) -> Option<Result<Request, String>> {
    if let Some((_, order)) = test_of(&request) {
        return Some(Ok(Request::Test(order)));
    }
    Some(match request {
        UserRequest::Halt {} => Ok(Request::Halt),
        UserRequest::Parameter { key, robot, value, .. } => {
            change_of(&key, robot, value.as_ref()).map(Request::Change)
        }
        UserRequest::Save {} => Ok(Request::Save),
        UserRequest::Remote { request, robot } => RemoteRequest::named(&request, robot).map(Request::Remote),
        _ => return None,
    })
}

/// The page beside a real field, and what fills it.
struct Dashboard {
    page: Page,
    composer: Composer,
    ledger: LedgerFeed,
    parameters: ParameterFeed,
    drawn_at: Option<Instant>,
    /// State by the game controller's port for remote controls; null: no connection.
    remote: Option<serde_json::Value>,
    /// Time an input takes, as a sliding mean.
    took: Duration,
}

impl Dashboard {
    /// Opens the page. If it cannot be opened, the error is printed and the robots are controlled without it.
    fn open(settings: PageSettings<'_>, title: String) -> Option<Self> {
        let PageSettings { args, live_parameters, library, retrieval, spectrum } = settings;
        let powers = if live_parameters { Powers::Tune } else { Powers::Halt };
        let page = args
            .open(title, false, powers, CaseExplanations::new(library, retrieval))
            .map_err(|error| note!("page     there is none: {error}"))
            .ok()?;
        if let Some(spectrum) = spectrum {
            page.set_spectrum(spectrum);
        }
        Some(Self {
            page,
            composer: Composer::new(library.as_ref(), program_log()),
            ledger: LedgerFeed::new(library.as_ref()),
            parameters: ParameterFeed::default(),
            drawn_at: None,
            remote: None,
            took: Duration::ZERO,
        })
    }

    /// Sends the scene to the page if it is due.
    fn look(&mut self, now: protocol::Instant, host: &Host, findings: &[Finding]) {
        let every = Duration::from_secs_f64(SCENE_EVERY_S);
        let t = now.0 as f64 * 1e-6;
        self.ledger.look(t, host, &[host]);
        if self.drawn_at.is_none_or(|drawn_at| drawn_at.elapsed() >= every) {
            self.drawn_at = Some(Instant::now());
            let gauges = vec![tick(self.took)];
            let moment = Moment { t, now, feed: host, hosts: &[host], truth: None, referee: None, gauges };
            let mut deferred_scene = self.composer.compose(moment);
            deferred_scene.scene.alarms = findings.iter().map(ToString::to_string).collect();
            deferred_scene.scene.findings = findings.iter().map(Finding::to_json).collect();
            deferred_scene.scene.remote.clone_from(&self.remote);
            for match_event in self.composer.take_match_events() {
                self.page.push(match_event);
            }
            self.page.show(deferred_scene);
            self.ledger.send(t, &[host], false, &self.page);
        }
    }
}
