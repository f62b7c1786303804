//! `match_runner`: match runner with page and user controls. At the clock's pace, with the page beside it.
//!
//! The match itself is [`arena::game::Game`], tick by tick as without a page: observing changes nothing.
//! Where the machine is too slow for the speed ordered, the match runs slower and the page displays that.

mod kick_test;
mod situation;

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use arena::CaseNames;
use arena::game::{Game, GameConfig, GameError, GameReport, TICK_US, Watcher, Watchers};
use foreign::{excerpt, printable};
use geometry::Point;
use hil_sim::NativeBackend;
use host::run::change_text;
use page::{MatchEnd, MatchEvent, Page, ProgramLog, UserRequest};
use protocol::{RobotId, Who};
use rules::Colour;
use rules::state::RefereeCommand;

use self::kick_test::KickTests;
use self::situation::situate;
use super::gauges::{gauge, tick};
use super::{
    Composer, LedgerFeed, Moment, ParameterFeed, RecentMoments, SCENE_EVERY_S, SnapshotRequest, Snapshots,
    change_of, colour, test_of,
};
use crate::workbench::SharedLibrary;

/// If the match is farther behind the clock than this, s, the clock is reset: the match does not run faster
/// to catch up.
const BEHIND_MAX_S: f64 = 0.25;
/// At every speed, simulated time between two scenes is at most this, s, for viewers that seek back.
const SCENE_EVERY_MAX_S: f64 = 0.2;
/// Longest part of a name sent by a viewer that is quoted in an answer, characters.
const NAME_LEN: usize = 60;
/// Answer to a viewer that asks for another match.
const RESTART_REFUSED: &str = "a match that is recorded cannot start again";
/// Period of polling for requests while paused.
const POLL_EVERY: Duration = Duration::from_millis(10);

/// A match and its page.
pub struct MatchRunner<'f> {
    config: GameConfig,
    library: SharedLibrary,
    page: Page,
    speed: f32,
    /// Recorded, so that it cannot be restarted.
    recorded: bool,
    /// Moments of this match and those before it.
    snapshots: Snapshots,
    log: Arc<ProgramLog>,
    /// Ends the match when it is set.
    stopped: &'f AtomicBool,
    moments: RecentMoments,
}

/// Pace, log and end of a run.
pub struct RunSettings<'f> {
    /// Simulated seconds a second at the start; viewers can change it.
    pub speed: f32,
    /// The match is recorded: it cannot be restarted.
    pub recorded: bool,
    /// Takes alarms and faults of robots.
    pub log: Arc<ProgramLog>,
    /// Ends the match when it is set.
    pub stopped: &'f AtomicBool,
    /// Gets what happens, for the page to play on from.
    pub moments: RecentMoments,
}

struct UserControls {
    paused: bool,
    steps: u32,
    speed: f32,
    restart: Option<u64>,
    /// The clock, and the match at that time.
    clock: (Instant, f64),
    took: Duration,
    /// Simulated seconds per second of wall time, as reached.
    reached: f32,
    /// The match ended by itself.
    over: bool,
}

/// End of a run.
pub enum End {
    /// The match is over; its report.
    Over(GameReport),
    /// The operator ended the program.
    ByHand(GameReport),
}

impl<'f> MatchRunner<'f> {
    /// A match of `config`, played at the clock's pace times `speed` until `stopped` is set; alarms go to
    /// `log`. One that is recorded cannot be restarted.
    pub fn new(config: GameConfig, library: SharedLibrary, page: Page, settings: RunSettings<'f>) -> Self {
        let RunSettings { speed, recorded, log, stopped, moments } = settings;
        Self {
            config,
            library,
            page,
            speed,
            recorded,
            snapshots: Snapshots::default(),
            log,
            stopped,
            moments,
        }
    }

    /// Plays until the match is over.
    pub fn play(&mut self, observer: &mut dyn MatchObserver) -> Result<End, GameError> {
        loop {
            let mut controls = UserControls {
                paused: false,
                steps: 0,
                speed: self.speed,
                restart: None,
                clock: (Instant::now(), 0.0),
                took: Duration::ZERO,
                reached: self.speed,
                over: false,
            };
            let report = self.one(&mut controls, observer)?;
            self.speed = controls.speed;
            match controls.restart {
                Some(seed) => {
                    self.restart(seed, observer);
                }
                None if self.stopped.load(Ordering::Relaxed) => return Ok(End::ByHand(report)),
                None => return Ok(End::Over(report)),
            }
        }
    }

    /// Keeps the page open after the match until the operator ends the program; the seed if another match is
    /// requested.
    pub fn linger(&mut self) -> Option<u64> {
        while !self.stopped.load(Ordering::Relaxed) {
            match self.page.next_request() {
                Some(UserRequest::Restart { .. }) if self.recorded => self.page.refuse(RESTART_REFUSED),
                Some(UserRequest::Restart { seed }) => return Some(seed.unwrap_or(self.config.seed)),
                Some(_) if self.recorded => self.page.refuse("the match is over"),
                Some(_) => self.page.refuse("the match is over: start another one"),
                None => {}
            }
            thread::sleep(POLL_EVERY);
        }
        None
    }

    /// Restarts with another seed, and with the cases that are on disk now.
    pub fn restart(&mut self, seed: u64, observer: &mut dyn MatchObserver) {
        self.config.seed = seed;
        if let Err(failure) = self.library.read_again() {
            let reason = format!("the cases stay as they were, their library is refused: {failure}");
            observer.note(&printable(&reason));
            self.page.refuse(reason);
        }
        if let Some(library_handle) = self.library.now() {
            self.config.names = CaseNames::new(library_handle.names());
            self.config.cases = Some(library_handle.lasting_base());
        }
        self.page.clear();
        observer.restart();
    }

    fn one(
        &mut self,
        controls: &mut UserControls,
        observer: &mut dyn MatchObserver,
    ) -> Result<GameReport, GameError> {
        let config = self.config.clone();
        let library_handle = self.library.now();
        let mut backend = NativeBackend::new(config.cases.unwrap_or_default());
        let mut game = Game::new(&config, &mut backend)?;
        let mut feed = Feed {
            composer: Composer::new(library_handle.as_ref(), self.log.clone()),
            ledger: LedgerFeed::new(library_handle.as_ref()),
            parameters: ParameterFeed::default(),
            t: 0.0,
            moments: self.moments.clone(),
        };
        self.moments.begin(&config);
        let ticks = (config.duration_s * 1e6 / TICK_US as f64) as u64;
        let mut displayed = f64::NEG_INFINITY;
        let mut tests = KickTests::default();
        let stopped = self.stopped;
        while game.now().0 / TICK_US < ticks && !game.is_over() && !stopped.load(Ordering::Relaxed) {
            while let Some(request) = self.page.next_request() {
                let mut watchers = Watchers(vec![&mut feed, observer.watcher()]);
                if let Some(done) = change_host(&request, &mut game, &mut tests, &mut watchers) {
                    match done {
                        Ok(None) => {}
                        Ok(Some(done)) => {
                            feed.parameters.hasten();
                            self.page.push(MatchEvent::fault(game.time(), done));
                        }
                        Err(reason) => self.page.refuse(reason),
                    }
                    continue;
                }
                self.obey(&request, controls, &mut game, &mut backend)?;
            }
            if controls.restart.is_some() {
                break;
            }
            if controls.paused && controls.steps == 0 {
                self.show(&game, &mut feed, controls);
                thread::sleep(Duration::from_secs_f64(SCENE_EVERY_S));
                continue;
            }
            controls.steps = controls.steps.saturating_sub(1);
            let begun = Instant::now();
            feed.t = game.time();
            tests.hold(&mut game, &mut Watchers(vec![&mut feed, observer.watcher()]));
            game.step(&mut Watchers(vec![&mut feed, observer.watcher()]))?;
            controls.took = (controls.took * 15 + begun.elapsed()) / 16;
            tests.tend(&mut game);
            let every = (SCENE_EVERY_S * f64::from(controls.speed)).min(SCENE_EVERY_MAX_S);
            if game.time() - displayed >= every - 1e-6 || controls.paused {
                displayed = game.time();
                self.show(&game, &mut feed, controls);
            }
            if !controls.paused {
                controls.wait(game.time());
            }
        }
        controls.over = controls.restart.is_none() && !stopped.load(Ordering::Relaxed);
        self.show(&game, &mut feed, controls);
        self.tell_cases(&game, &mut feed, true);
        Ok(GameReport::of(&config, &game))
    }

    fn show(&mut self, game: &Game<'_>, feed: &mut Feed, controls: &UserControls) {
        let hosts = [game.host(Colour::Blue), game.host(Colour::Yellow)];
        let gauges =
            vec![tick(controls.took), gauge("program", "speed reached", controls.reached, "×", None)];
        let mut deferred_scene = feed.composer.compose(Moment {
            t: game.time(),
            now: game.now(),
            feed: hosts[0],
            hosts: &hosts,
            truth: Some(game.world()),
            referee: Some(game.referee()),
            gauges,
        });
        for match_event in feed.composer.take_match_events() {
            self.page.push(match_event);
        }
        deferred_scene.scene.paused = controls.paused;
        deferred_scene.scene.speed = controls.speed;
        deferred_scene.scene.seed = Some(self.config.seed);
        deferred_scene.scene.over = controls.over.then_some(MatchEnd { another: !self.recorded });
        if controls.over {
            // No later scene makes up for this one.
            self.page.keep(deferred_scene);
        } else {
            self.page.show(deferred_scene);
        }
        self.tell_cases(game, feed, false);
    }

    fn tell_cases(&self, game: &Game<'_>, feed: &mut Feed, over: bool) {
        let hosts = [game.host(Colour::Blue), game.host(Colour::Yellow)];
        feed.ledger.send_of(game.ledger(), game.time(), &hosts, over, &self.page);
        feed.parameters.look(&hosts, None, &self.page);
    }

    fn obey<'b>(
        &mut self,
        request: &UserRequest,
        controls: &mut UserControls,
        game: &mut Game<'b>,
        backend: &mut NativeBackend<'b>,
    ) -> Result<(), GameError> {
        let t = game.time();
        let (mut noted, mut refused) = (None, None);
        let playing = |team: page::PageTeam, id: u8| {
            let who = RobotId::new(id).map(|id| Who { colour: colour(team), id });
            who.filter(|who| game.world().robot(*who).is_some_and(|robot| robot.present))
                .ok_or_else(|| format!("{} has no robot {id} on the field", colour(team).label()))
        };
        match request {
            UserRequest::Pause { on } => {
                (controls.paused, controls.steps) = (*on, 0);
                controls.clock = (Instant::now(), t);
            }
            UserRequest::Step { ticks } => (controls.paused, controls.steps) = (true, *ticks),
            UserRequest::Speed { factor } => {
                controls.speed = *factor;
                controls.clock = (Instant::now(), t);
            }
            UserRequest::Restart { .. } if self.recorded => {
                refused = Some(RESTART_REFUSED.into());
            }
            UserRequest::Restart { seed } => controls.restart = Some(seed.unwrap_or(self.config.seed)),
            UserRequest::Situation { name } => {
                if !situate(game, self.library.now().as_ref(), name) {
                    refused = Some(format!(
                        "no situation of the name {} can be set up now",
                        excerpt(name, NAME_LEN)
                    ));
                }
            }
            UserRequest::Ball { at } => game.move_ball(Point::new(at[0], at[1]), controls.paused),
            UserRequest::Robot { team, id, at } => match playing(*team, *id) {
                Ok(who) => game.move_robot(who, Point::new(at[0], at[1]), controls.paused),
                Err(reason) => refused = Some(reason),
            },
            UserRequest::Power { team, id, on } => match playing(*team, *id) {
                Ok(who) => {
                    let name = format!("{} {}", who.colour.label(), who.id.number());
                    if game.power(who, *on, backend)? {
                        let what = if *on { "boots, by hand" } else { "crashes, by hand" };
                        noted = Some(format!("{name} {what}"));
                    } else {
                        refused = Some(format!("{name} is {} already", if *on { "on" } else { "off" }));
                    }
                }
                Err(reason) => refused = Some(reason),
            },
            UserRequest::Loss { share } => {
                game.lose(*share);
                noted = Some(format!("the radio loses {:.0} % of all packets, by hand", share * 100.0));
            }
            UserRequest::Keep {} | UserRequest::Return { .. } | UserRequest::Load { .. } => {
                let league = self.config.league;
                match self.snapshots.ask(request, game.world(), league, &self.page) {
                    SnapshotRequest::Return(snapshot) if game.command(RefereeCommand::ForceStart) => {
                        noted = Some(format!("back at {:.2} s, by hand", snapshot.t));
                        game.restore(snapshot);
                    }
                    SnapshotRequest::Return(_) => refused = Some("the game cannot start now".to_owned()),
                    SnapshotRequest::Kept(done) => noted = Some(done),
                    SnapshotRequest::Refused(reason) => refused = Some(reason),
                    SnapshotRequest::Other => {}
                }
            }
            // Refused when it was read.
            UserRequest::Seek { .. } => {}
            // Handled before: they go through the watchers.
            UserRequest::Parameter { .. } | UserRequest::Kicks { .. } | UserRequest::Drive { .. } => {}
            UserRequest::Remote { .. } => {
                refused = Some(
                    "this match has no game controller's remote control: start control with --remote".into(),
                );
            }
            UserRequest::Save {} => {
                refused = Some("a simulated match has no team's file: copy the text, or download it".into());
            }
            UserRequest::Halt {} => {
                game.command(RefereeCommand::Halt);
            }
            UserRequest::Referee { command } => {
                let done = command_of(command).is_some_and(|command| game.command(command));
                if !done {
                    let name = command.to_lowercase().replace('_', " ");
                    refused = Some(format!("{} makes no sense now", excerpt(&name, NAME_LEN)));
                }
            }
        }
        if let Some(done) = noted {
            self.page.push(MatchEvent::fault(t, done));
        }
        if let Some(reason) = refused {
            self.page.refuse(reason);
        }
        Ok(())
    }
}

/// Passes on what a host itself takes, which is recorded: what was done, if it is worth an event, or why not;
/// none: it is for the match.
fn change_host(
    request: &UserRequest,
    game: &mut Game<'_>,
    tests: &mut KickTests,
    watchers: &mut Watchers<'_>,
) -> Option<Result<Option<String>, String>> {
    Some(match request {
        UserRequest::Parameter { team, key, robot, value } => {
            let team = colour(*team);
            change_of(key, *robot, value.as_ref()).and_then(|change| {
                game.change(team, &change, watchers).map_err(|refused| refused.to_string())?;
                Ok(Some(format!("{}: {}", team.label(), change_text(&change))))
            })
        }
        UserRequest::Kicks { .. } | UserRequest::Drive { .. } => {
            let (team, order) = test_of(request)?;
            tests.order(game, colour(team), order, watchers).map_err(|refused| refused.to_string())
        }
        _ => return None,
    })
}

impl UserControls {
    /// Waits until the clock reaches the match time.
    fn wait(&mut self, t: f64) {
        let (began, from) = self.clock;
        let due = (t - from) / f64::from(self.speed);
        let passed = began.elapsed().as_secs_f64();
        if due > passed {
            thread::sleep(Duration::from_secs_f64(due - passed));
        }
        let passed = began.elapsed().as_secs_f64();
        if passed > 1.0 || passed - due > BEHIND_MAX_S {
            self.reached = ((t - from) / passed.max(1e-6)) as f32;
            self.clock = (Instant::now(), t);
        }
    }
}

/// The caller of a match: watches it, and learns what the page's viewers do to it.
pub trait MatchObserver {
    /// The watcher of the running match.
    fn watcher(&mut self) -> &mut dyn Watcher;
    /// Another match starts.
    fn restart(&mut self);
    /// A line for the operator.
    fn note(&mut self, line: &str);
}

struct Feed {
    composer: Composer,
    ledger: LedgerFeed,
    parameters: ParameterFeed,
    t: f64,
    moments: RecentMoments,
}

impl Watcher for Feed {
    fn vision(&mut self, _now: protocol::Instant, bytes: &[u8]) {
        self.composer.vision(bytes);
    }
    fn tick(&mut self, game: &Game<'_>) {
        self.moments.tick(game);
    }
    fn referee(&mut self, now: protocol::Instant, bytes: &[u8]) {
        self.moments.referee(now, bytes);
        self.composer.referee(bytes, self.t, true);
    }
}

/// A command by its name in the league.
pub fn command_of(name: &str) -> Option<RefereeCommand> {
    let of = |begin: &str| match name.strip_prefix(begin)? {
        "BLUE" => Some(Colour::Blue),
        "YELLOW" => Some(Colour::Yellow),
        _ => None,
    };
    Some(match name {
        "HALT" => RefereeCommand::Halt,
        "STOP" => RefereeCommand::Stop,
        "NORMAL_START" => RefereeCommand::NormalStart,
        "FORCE_START" => RefereeCommand::ForceStart,
        _ => of("PREPARE_KICKOFF_")
            .map(RefereeCommand::PrepareKickoff)
            .or_else(|| of("PREPARE_PENALTY_").map(RefereeCommand::PreparePenalty))
            .or_else(|| of("DIRECT_FREE_").map(RefereeCommand::FreeKick))?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commands_go_by_their_names_in_the_league() {
        assert_eq!(command_of("HALT"), Some(RefereeCommand::Halt));
        assert_eq!(command_of("DIRECT_FREE_BLUE"), Some(RefereeCommand::FreeKick(Colour::Blue)));
        assert_eq!(
            command_of("PREPARE_KICKOFF_YELLOW"),
            Some(RefereeCommand::PrepareKickoff(Colour::Yellow))
        );
        assert_eq!(command_of("PREPARE_KICKOFF_RED"), None);
        assert_eq!(command_of("GOAL_BLUE"), None);
    }
}
