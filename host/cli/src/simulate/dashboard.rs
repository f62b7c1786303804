//! `dashboard`: the page beside a simulated field on which other programs play: the truth, the output of our
//! tracker for the vision, and controls for the ball.

use std::time::{Duration, Instant};

use feed::{
    CaseExplanations, Composer, Moment, SCENE_EVERY_S, SnapshotRequest, Snapshots, colour, command_of,
};
use foreign::excerpt;
use geometry::Point;
use hil_sim::small_size::network::FieldRequest;
use hil_sim::small_size::referee::InternalReferee;
use hil_sim::small_size::server::Server;
use host::referee::SenderAddress;
use host::{Host, HostSettings, Input};
use page::{Page, Powers, UserRequest};
use protocol::{RobotId, Who};
use rules::{Colour, League};

use crate::Failure;
use crate::args::page::PageArgs;
use crate::library;
use crate::output::{note, program_log};

/// Longest part of a name sent by a viewer that is quoted in an answer, characters.
const NAME_LEN: usize = 60;

/// A page, its composer, and the host whose world is displayed, which commands no robot.
pub(super) struct Dashboard {
    page: Page,
    composer: Composer,
    feed: Host,
    drawn_at: Option<Instant>,
    /// The speed after a pause.
    speed: f32,
    seed: u64,
    /// Simulated seconds.
    t: f64,
    snapshots: Snapshots,
}

impl Dashboard {
    /// Opens the page. If it cannot be opened, the error is printed and the field is simulated without it.
    pub(super) fn open(args: &PageArgs, league: League, seed: u64, speed: f32) -> Option<Self> {
        let open = || {
            let explanations = CaseExplanations::new(
                library::of_league(league, None)?,
                casebase::RetrievalSettings::default(),
            );
            let page =
                args.open(format!("simulate, {}", league.name()), false, Powers::Simulation, explanations)?;
            let feed = Host::new(HostSettings::new(Colour::Blue, league, 1), protocol::Instant(0));
            Ok::<_, Failure>(Self {
                page,
                composer: Composer::new(None, program_log()),
                feed,
                drawn_at: None,
                speed,
                seed,
                t: 0.0,
                snapshots: Snapshots::default(),
            })
        };
        open().map_err(|failure| note!("page     there is none: {failure}")).ok()
    }

    pub(super) fn vision(&mut self, bytes: &[u8], running: Duration) {
        self.composer.vision(bytes);
        self.feed.handle(protocol::Instant(running.as_micros() as u64), Input::Vision(bytes));
        while self.feed.poll_packet().is_some() {}
    }

    pub(super) fn referee(&mut self, bytes: &[u8], running: Duration) {
        let now = protocol::Instant(running.as_micros() as u64);
        self.composer.referee(bytes, self.t, true);
        self.feed.handle(now, Input::Referee(bytes, SenderAddress::INTERNAL));
    }

    /// Another game starts.
    pub(super) fn restart(&mut self, league: League, seed: u64) {
        self.feed = Host::new(HostSettings::new(Colour::Blue, league, 1), protocol::Instant(0));
        (self.composer, self.drawn_at, self.seed, self.t) =
            (Composer::new(None, program_log()), None, seed, 0.0);
        self.page.clear();
    }

    /// Displays the moment if it is due, and handles viewers' requests; what remains is returned for the
    /// simulator loop.
    pub(super) fn look(
        &mut self,
        running: Duration,
        server: &mut Server,
        mut referee: Option<&mut InternalReferee>,
    ) -> FieldRequest {
        let mut wanted = FieldRequest::default();
        self.t = server.world().time();
        while let Some(request) = self.page.next_request() {
            match request {
                UserRequest::Pause { on } => wanted.speed = Some(if on { 0.0 } else { self.speed }),
                UserRequest::Step { ticks } => {
                    (wanted.speed, wanted.ticks) = (Some(0.0), wanted.ticks + ticks);
                }
                UserRequest::Restart { seed } => wanted.restart = Some(seed.unwrap_or(self.seed)),
                UserRequest::Speed { factor } => {
                    self.speed = factor;
                    wanted.speed = Some(factor);
                }
                UserRequest::Ball { at } => server.world_mut().drag_ball(Point::new(at[0], at[1])),
                UserRequest::Robot { team, id, at } => {
                    let who = RobotId::new(id).map(|id| Who { colour: colour(team), id });
                    let there = |who: &Who| server.world().robot(*who).is_some_and(|robot| robot.present);
                    if let Some(who) = who.filter(there) {
                        server.world_mut().drag_robot(who, Point::new(at[0], at[1]), None);
                    } else {
                        let team = colour(team).label();
                        self.page.refuse(format!("{team} has no robot {id} on the field"));
                    }
                }
                UserRequest::Keep {} | UserRequest::Return { .. } | UserRequest::Load { .. } => {
                    let league = self.feed.settings().league;
                    match self.snapshots.ask(&request, server.world(), league, &self.page) {
                        SnapshotRequest::Return(snapshot) => snapshot.restore(server.world_mut()),
                        SnapshotRequest::Refused(reason) => self.page.refuse(reason),
                        SnapshotRequest::Kept(_) | SnapshotRequest::Other => {}
                    }
                }
                UserRequest::Referee { command } => {
                    let done = command_of(&command)
                        .zip(referee.as_deref_mut())
                        .is_some_and(|(command, referee)| referee.command_by_hand(command));
                    if !done {
                        let name = command.to_lowercase().replace('_', " ");
                        self.page.refuse(format!("{} makes no sense now", excerpt(&name, NAME_LEN)));
                    }
                }
                UserRequest::Halt {}
                | UserRequest::Situation { .. }
                | UserRequest::Power { .. }
                | UserRequest::Loss { .. }
                | UserRequest::Parameter { .. }
                | UserRequest::Kicks { .. }
                | UserRequest::Drive { .. }
                | UserRequest::Remote { .. }
                | UserRequest::Seek { .. }
                | UserRequest::Save {} => {
                    self.page.refuse("that can be asked of `onetwo play`; here others command the robots");
                }
            }
        }
        let every = Duration::from_secs_f64(SCENE_EVERY_S);
        if self.drawn_at.is_none_or(|drawn_at| drawn_at.elapsed() >= every) {
            self.drawn_at = Some(Instant::now());
            let moment = Moment {
                t: self.t,
                now: protocol::Instant(running.as_micros() as u64),
                feed: &self.feed,
                hosts: &[],
                truth: Some(server.world()),
                referee: referee.as_deref(),
                gauges: Vec::new(),
            };
            let mut deferred_scene = self.composer.compose(moment);
            for match_event in self.composer.take_match_events() {
                self.page.push(match_event);
            }
            let speed = wanted.speed.unwrap_or(server.pace());
            deferred_scene.scene.paused = speed == 0.0;
            deferred_scene.scene.speed = self.speed;
            deferred_scene.scene.seed = Some(self.seed);
            self.page.show(deferred_scene);
        }
        wanted
    }
}
