//! `game`: a match between two teams: simulated field, cameras, referee and radio; on each side a host and
//! its robots' brains (docs/architecture.md §3, §7, docs/case-format.md §5.2). Deterministic: a seed gives
//! the same match to the bit, on any machine.
//!
//! ```text
//! world 1 ms ─► cameras ─► vision datagrams ─► host ─► radio frames ─► brains 10 ms ─► orders ─► world
//!    └► referee 10 ms ─► referee datagrams ─► host        ▲── beacons, telemetry ──┘
//! ```
//! [`Game`] is the match, tick by tick; [`play`] runs it to its end and returns a [`GameReport`]. A
//! [`Watcher`] gets everything that may be stored or displayed, and changes nothing.

mod config;
mod hand;
mod holds;
mod manual_referee;
mod recording;
mod report;
mod side;
mod start;
mod story;
mod tries;

pub use config::{GameConfig, TeamSetup};
pub use holds::Hold;
pub use manual_referee::{ManualReferee, RefereeOrder};
pub use recording::header;
pub use report::{BlockedReport, GameReport, PerTeam, StrategyReport, TeamReport};
pub use start::{GameStart, LEAD_IN_TICKS};
pub use story::{MatchLog, sentence};
pub use tries::{FirstShot, TryOutcome, tries};

use hil_sim::small_size::camera::Cameras;
use hil_sim::small_size::compatibility::Profile;
use hil_sim::small_size::network::{CiController, CiError};
use hil_sim::small_size::referee::InternalReferee;
use hil_sim::small_size::worlds::WorldModel;
use hil_sim::small_size::{PhysicsEvent, World};
use hil_sim::{Backend, McuError, TraceHash};
use host::Host;
use protocol::decision::DecisionReport;
use protocol::{Instant, RobotId, Who};
use rules::Colour;
use ssl::Message;

use holds::Holds;
use side::Team;

use crate::attack::{BallContact, BallLook};
use crate::ledger::MatchLedger;

/// Steps of physics in a tick of brains.
pub const STEPS_A_TICK: u64 = 10;
/// Length of a tick, µs (docs/architecture.md §2.3).
pub const TICK_US: u64 = protocol::robot_io::WHEELED_STEP.0;

/// An observer of a match.
pub trait Watcher {
    /// A datagram of the cameras, as both teams receive it.
    fn vision(&mut self, _now: Instant, _bytes: &[u8]) {}
    /// A datagram of the referee.
    fn referee(&mut self, _now: Instant, _bytes: &[u8]) {}
    /// An input of a host.
    fn input(&mut self, _now: Instant, _host: Colour, _input: host::Input<'_>) {}
    /// A packet sent by a host.
    fn sent(&mut self, _now: Instant, _host: Colour, _to: host::radio::To, _packet: &[u8]) {}
    /// Called after every tick.
    fn tick(&mut self, _game: &Game<'_>) {}
}

/// A running match, advanced tick by tick.
pub struct Game<'a> {
    world: World,
    cameras: Cameras,
    /// The referee; where a game controller runs the match, its mirror.
    referee: InternalReferee,
    controller: Option<CiController>,
    teams: [Team<'a>; 2],
    trace: TraceHash,
    tick: u32,
    events: Vec<PhysicsEvent>,
    holds: Holds,
    ledger: MatchLedger,
    /// Vision's packets reach no host.
    blind: bool,
    /// Robots that are still led along the recording that it starts from.
    on_track: Vec<Who>,
    config: GameConfig,
}

/// Error that keeps a match from being played.
#[derive(Debug, thiserror::Error)]
pub enum GameError {
    /// A robot's computer failed.
    #[error("{colour} {id}: {1}", colour = .0.colour.label(), id = .0.id)]
    Computer(Who, McuError),
    /// The league has no such matches.
    #[error("{0}")]
    League(String),
    /// A team's own strategy cannot be started by this command.
    #[error("the strategy `{0}` does not start: {1}")]
    Strategy(String, std::io::Error),
    /// The league's game controller.
    #[error(transparent)]
    Controller(#[from] CiError),
    /// A team's own strategy does not answer any more.
    #[error("{0}")]
    StrategyFailed(String),
}

impl<'a> Game<'a> {
    /// Robots on their halves, the ball in the middle, the referee before its first command.
    pub fn new(config: &GameConfig, backend: &mut dyn Backend<'a>) -> Result<Self, GameError> {
        let league = config.league;
        let model = WorldModel::of(league, &config.world).ok_or_else(|| {
            GameError::League(format!("{} has no wheels: `onetwo trial` plays it", league.name()))
        })?;
        let mut referee = InternalReferee::new(config.referee.clone(), config.seed)
            .map_err(|_| GameError::League(format!("{} has no referee of its own", league.name())))?;
        let mut world = World::of_model(league, &model, config.seed);
        let mut teams = Vec::new();
        for setup in &config.teams {
            teams.push(Team::new(config, setup, &model.link, &mut world, backend)?);
        }
        let mut on_track = Vec::new();
        if let Some(start) = &config.start {
            start.place(0, &mut world);
            referee.resume(&start.referee, world.ball.position);
            on_track.extend(start.on_track());
        }
        world.add_bystanders(model.bystanders);
        let Ok(teams) = <[Team<'a>; 2]>::try_from(teams) else { unreachable!("two set-ups give two teams") };
        let cameras = Cameras::of_model(Profile::Ours, 0.0, &world, model.vision, config.seed);
        let geometry = || cameras.geometry(&world, None);
        let start = |choice| CiController::start(choice, &config.referee, config.seed, geometry());
        let controller = config.controller.as_ref().map(start).transpose()?;
        Ok(Self {
            world,
            cameras,
            referee,
            controller,
            teams,
            trace: TraceHash::default(),
            tick: 0,
            events: Vec::new(),
            holds: Holds::default(),
            ledger: MatchLedger::default(),
            blind: false,
            on_track,
            config: config.clone(),
        })
    }

    /// Seconds since the start.
    pub fn time(&self) -> f64 {
        self.world.time()
    }

    /// The common time of hosts and robots.
    pub fn now(&self) -> Instant {
        Instant(u64::from(self.tick) * TICK_US)
    }

    /// True state of ball and robots.
    pub fn world(&self) -> &World {
        &self.world
    }

    /// The referee of the simulated match.
    pub fn referee(&self) -> &InternalReferee {
        &self.referee
    }

    /// The host of one team.
    pub fn host(&self, team: Colour) -> &Host {
        &self.teams[team as usize].host
    }

    /// The newest decision of each robot of a team whose computer can be looked into: its own, not what the
    /// host heard of it. None of emulated robots.
    pub fn decisions(&self, team: Colour) -> impl Iterator<Item = (RobotId, DecisionReport)> {
        self.teams[team as usize].decisions()
    }

    /// Events of the last tick.
    pub fn events(&self) -> &[PhysicsEvent] {
        &self.events
    }

    /// Ledger of every case, and of what the teams made of the ball.
    pub fn ledger(&self) -> &MatchLedger {
        &self.ledger
    }

    /// Robots that held the ball in play, and for how long.
    fn holds(&self) -> &Holds {
        &self.holds
    }

    /// The hash over all ticks so far.
    pub fn trace(&self) -> TraceHash {
        self.trace
    }

    /// Whether the referee has ended it.
    pub fn is_over(&self) -> bool {
        self.referee.is_over()
    }

    /// Most instructions of a robot's tick, where they can be counted.
    pub fn worst_instructions(&self) -> u32 {
        self.teams.iter().map(Team::worst_instructions).max().unwrap_or(0)
    }

    /// Runs 10 ms: brains step and order, then physics moves, cameras capture and the referee judges.
    pub fn step(&mut self, watcher: &mut dyn Watcher) -> Result<(), GameError> {
        self.advance(watcher)?;
        self.judge(watcher)?;
        let mut holds = std::mem::take(&mut self.holds);
        holds.look(self);
        self.holds = holds;
        let mut ledger = std::mem::take(&mut self.ledger);
        self.keep(&mut ledger);
        self.ledger = ledger;
        watcher.tick(self);
        Ok(())
    }

    /// Takes this tick into the ledger.
    fn keep(&self, ledger: &mut MatchLedger) {
        let present = self.world.robots().iter().filter(|robot| robot.present);
        let robots: Vec<_> = present.map(|robot| (robot.who, robot.pose.position)).collect();
        let contacts: Vec<_> = self.events.iter().filter_map(|event| contact(event, self.time())).collect();
        let colours = [Colour::Yellow, Colour::Blue];
        let look = BallLook {
            now: self.time(),
            field: &self.config.league.field(),
            ball: self.world.ball.position,
            height: self.world.ball.height,
            robots: &robots,
            phase: self.referee.phase(),
            score: colours.map(|team| self.referee.accounts().of(team).score),
            own_ends: colours.map(|team| self.referee.own_end(team)),
            contacts: &contacts,
        };
        ledger.look(&look, &colours.map(|team| self.host(team)));
    }

    /// The same without the referee, as drills have one of their own.
    pub fn advance(&mut self, watcher: &mut dyn Watcher) -> Result<(), GameError> {
        let (tick, now) = (self.tick, self.now());
        let led = match &self.config.start {
            Some(start) => start.lead(tick, &mut self.world, &mut self.on_track),
            None => Vec::new(),
        };
        self.trace.small_size_tick(tick, &self.world);
        for team in &mut self.teams {
            team.receive(tick, now, watcher);
            team.lead(&led);
            team.think(tick, now, &mut self.world, &mut self.trace)?;
        }
        for (who, order) in led {
            self.world.order(who, order);
        }
        self.events.clear();
        for step in 0..STEPS_A_TICK {
            self.world.step();
            let now = Instant(now.0 + (step + 1) * 1_000);
            for team in &mut self.teams {
                team.deadline(tick, now, watcher);
            }
            self.cameras.watch(&self.world);
            while let Some(packet) = self.cameras.poll(self.world.now()) {
                if self.blind {
                    continue;
                }
                let bytes = packet.encode_to_vec();
                watcher.vision(now, &bytes);
                for team in &mut self.teams {
                    team.feed(tick, now, host::Input::Vision(&bytes), watcher);
                }
            }
        }
        self.tick += 1;
        self.world.take_events(&mut self.events);
        let failed = self.teams.iter().find_map(Team::strategy_failure);
        failed.map_or(Ok(()), |words| Err(GameError::StrategyFailed(words)))
    }

    fn judge(&mut self, watcher: &mut dyn Watcher) -> Result<(), GameError> {
        let now = self.now();
        if let Some(controller) = &mut self.controller {
            for packet in controller.look(&mut self.world, &self.events, &mut self.referee)? {
                self.announce(now, &packet, watcher);
            }
            return Ok(());
        }
        // What led to the moment is judged already.
        if self.config.start.is_none() || self.tick > LEAD_IN_TICKS {
            self.referee.look(&self.world, &self.events);
        }
        while let Some(packet) = self.referee.poll_packet() {
            self.announce(now, &packet, watcher);
        }
        while let Some(order) = self.referee.poll_order() {
            order.carry_out(&mut self.world);
        }
        Ok(())
    }

    /// Delivers a packet of the referee to both teams.
    pub fn announce(&mut self, now: Instant, packet: &ssl::referee::Referee, watcher: &mut dyn Watcher) {
        let bytes = packet.encode_to_vec();
        watcher.referee(now, &bytes);
        for team in &mut self.teams {
            let input = host::Input::Referee(&bytes, host::referee::SenderAddress::INTERNAL);
            team.feed(self.tick, now, input, watcher);
        }
    }

    /// The true world, for placing objects in a drill.
    pub fn world_mut(&mut self) -> &mut World {
        &mut self.world
    }

    /// A team's robots get these orders in place of its coach's; `None`: the coach's again.
    pub fn drill(&mut self, team: Colour, orders: Option<host::Drill>) {
        self.teams[team as usize].host.drill(orders);
    }
}

/// Plays a match to its end, or for its configured duration.
pub fn play(
    config: &GameConfig,
    backend: &mut dyn Backend<'_>,
    watcher: &mut dyn Watcher,
) -> Result<GameReport, GameError> {
    play_until(config, backend, watcher, || false)
}

/// The same, but ends at the first tick at which `stop` is true; the report is of what was played.
pub fn play_until(
    config: &GameConfig,
    backend: &mut dyn Backend<'_>,
    watcher: &mut dyn Watcher,
    stop: impl Fn() -> bool,
) -> Result<GameReport, GameError> {
    let mut game = Game::new(config, backend)?;
    let ticks = (config.duration_s * 1e6 / TICK_US as f64) as u32;
    while game.tick < ticks && !game.is_over() && !stop() {
        game.step(watcher)?;
    }
    Ok(GameReport::of(config, &game))
}

/// A watcher that does nothing.
pub struct NoWatcher;
impl Watcher for NoWatcher {}

/// The contact with the ball that a physical event at this time is, if any.
fn contact(event: &PhysicsEvent, time: f64) -> Option<BallContact> {
    match *event {
        PhysicsEvent::Kicked { robot, at, velocity, .. } => {
            Some(BallContact::Kicked { by: robot, at: time, from: at, velocity })
        }
        PhysicsEvent::Touched { robot, at } => Some(BallContact::Touched { by: robot, at }),
        _ => None,
    }
}

/// Our robots' numbers in a team of `robots`.
pub fn numbers(robots: u8) -> impl Iterator<Item = RobotId> {
    RobotId::all().take(usize::from(robots))
}

/// Several watchers as one.
pub struct Watchers<'w>(pub Vec<&'w mut dyn Watcher>);
impl Watcher for Watchers<'_> {
    fn vision(&mut self, now: Instant, bytes: &[u8]) {
        self.0.iter_mut().for_each(|watcher| watcher.vision(now, bytes));
    }
    fn referee(&mut self, now: Instant, bytes: &[u8]) {
        self.0.iter_mut().for_each(|watcher| watcher.referee(now, bytes));
    }
    fn input(&mut self, now: Instant, host: Colour, input: host::Input<'_>) {
        self.0.iter_mut().for_each(|watcher| watcher.input(now, host, input));
    }
    fn sent(&mut self, now: Instant, host: Colour, to: host::radio::To, packet: &[u8]) {
        self.0.iter_mut().for_each(|watcher| watcher.sent(now, host, to, packet));
    }
    fn tick(&mut self, game: &Game<'_>) {
        self.0.iter_mut().for_each(|watcher| watcher.tick(game));
    }
}
