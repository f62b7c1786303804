//! `spectator`: what the operator of `onetwo simulate` sees of the field, on the terminal and on the page,
//! and our own tracker beside it.

use std::net::SocketAddr;
use std::time::Duration;

use hil_sim::small_size::network::{FieldRequest, Spectator};
use hil_sim::small_size::referee::InternalReferee;
use hil_sim::small_size::server::Server;
use host::tracking::{Publisher, Tracker};
use rules::League;
use ssl::Message;
use ssl::net::NetSender;
use ssl::vision::WrapperPacket;

use super::SimulateArgs;
use super::dashboard::Dashboard;
use crate::args::page::PageArgs;
use crate::output::note;
use crate::progress::Progress;

/// A terminal, a page where one is wanted, and a tracker where one is wanted.
pub(super) struct FieldOperator<'a> {
    args: &'a SimulateArgs,
    /// What is simulated, in a line.
    title: String,
    league: League,
    bar: Option<Progress>,
    dashboard: Option<Dashboard>,
    tracked: Option<Tracked>,
}

impl<'a> FieldOperator<'a> {
    pub(super) fn new(args: &'a SimulateArgs, title: String) -> Self {
        let tracked = args.tracker.map(|to| Tracked::new(to, args.interface.as_deref()));
        Self { args, title, league: args.league, bar: None, dashboard: None, tracked }
    }
}

impl Spectator for FieldOperator<'_> {
    fn started(&mut self, lines: Vec<String>) {
        note!("{}", self.title);
        for line in lines {
            note!("{line}");
        }
        if let Some(to) = self.args.tracker {
            note!("tracker  to {to}");
        }
        if !self.args.headless {
            let page = PageArgs::at(self.args.page, "--page");
            self.dashboard = Dashboard::open(&page, self.league, self.args.seed, self.args.speed);
        }
        self.bar = Some(Progress::open());
    }

    fn line(&mut self, line: String) {
        match &self.bar {
            Some(bar) => bar.aside(|| note!("{line}")),
            None => note!("{line}"),
        }
    }

    fn status(&mut self, status: String) {
        if let Some(bar) = &self.bar {
            bar.set_text(status);
        }
    }

    fn vision(&mut self, bytes: &[u8], running: Duration) -> Option<String> {
        self.dashboard.iter_mut().for_each(|dashboard| dashboard.vision(bytes, running));
        self.tracked.as_mut()?.receive(bytes, running)
    }

    fn referee(&mut self, bytes: &[u8], running: Duration) {
        self.dashboard.iter_mut().for_each(|dashboard| dashboard.referee(bytes, running));
    }

    fn look(
        &mut self,
        running: Duration,
        server: &mut Server,
        referee: Option<&mut InternalReferee>,
    ) -> FieldRequest {
        let dashboard = self.dashboard.as_mut();
        dashboard.map_or_else(FieldRequest::default, |dashboard| dashboard.look(running, server, referee))
    }

    fn restarted(&mut self, seed: u64) {
        self.tracked = self.args.tracker.map(|to| Tracked::new(to, self.args.interface.as_deref()));
        self.dashboard.iter_mut().for_each(|dashboard| dashboard.restart(self.league, seed));
    }

    fn ended(&mut self) {
        self.bar = None;
    }
}

/// Our own tracker on the simulated vision.
struct Tracked {
    tracker: Tracker,
    publisher: Publisher,
    sender: NetSender,
}

impl Tracked {
    fn new(to: SocketAddr, interface: Option<&str>) -> Self {
        Self {
            tracker: Tracker::default(),
            publisher: Publisher::new("onetwo-simulate", "onetwo simulate"),
            sender: NetSender::new(to, interface),
        }
    }

    fn receive(&mut self, vision: &[u8], running: Duration) -> Option<String> {
        let packet = WrapperPacket::decode(vision).ok()?;
        packet.detection.as_ref()?;
        self.tracker.handle(&packet, protocol::Instant(running.as_micros() as u64));
        let tracked = self.publisher.publish(&self.tracker)?;
        self.sender.send(&tracked.encode_to_vec())
    }
}
