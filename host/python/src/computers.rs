//! `computers`: a match's hosts, brains, cameras, radio and referee (`arena::game`) beside an episode's
//! world, on a thread of their own. Ticks of 10 ms.
//!
//! The world goes there and back with each tick, so that the episode orders and places robots as it does
//! without computers. Robots that the caller moves have theirs switched off.

use std::sync::Mutex;
use std::sync::mpsc::{Receiver, Sender, channel};

use arena::cases::LibraryHandle;
use arena::game::{Game, GameConfig, GameError, ManualReferee, NoWatcher, RefereeOrder, numbers};
use hil_sim::NativeBackend;
use hil_sim::small_size::World;
use hil_sim::small_size::referee::MatchClock;
use host::Drill;
use host::strategy::Team;
use protocol::{Duration, RobotId, Who};
use rules::{Colour, Phase};

use crate::legged;
use crate::settings::{End, Settings};

/// What the referee says of a tick.
#[derive(Clone, Copy, Debug, Default)]
pub struct Judgement {
    /// Goals of the own team and of the opponents.
    pub score: [u32; 2],
    /// Whether the ball is in play.
    pub in_play: bool,
    /// The side whose restart it is.
    pub restart: Option<Colour>,
    /// How the referee of a trial ends it.
    pub end: Option<End>,
}

/// One tick's world, judged.
type Tick = Result<(World, Judgement), String>;

/// The thread that plays the computers of one episode; it ends with this value.
#[derive(Debug)]
pub struct Computers {
    worlds: Sender<World>,
    ticks: Mutex<Receiver<Tick>>,
}

impl Computers {
    /// Starts them; `world` has the robots where the task wants them, and has then played their warm-up.
    pub fn start(settings: &Settings, seed: u64, world: &mut World) -> Result<Self, String> {
        let (worlds, inbox) = channel();
        let (outbox, ticks) = channel();
        let (settings, places) = (settings.clone(), world.clone());
        let thread = std::thread::Builder::new().name("onetwo computers".to_owned()).spawn(move || {
            let played = if let Some(scenario) = settings.task.spec().scenario {
                legged::play(&settings, (scenario, seed), places, &inbox, |world, judgement| {
                    outbox.send(Ok((world, judgement))).is_ok()
                })
            } else {
                play(&settings, seed, &places, &inbox, &outbox).map_err(|error| error.to_string())
            };
            if let Err(error) = played {
                // The episode may be gone already.
                let _ = outbox.send(Err(error));
            }
        });
        thread.map_err(|error| format!("no thread for the robots' computers: {error}"))?;
        let computers = Self { worlds, ticks: Mutex::new(ticks) };
        *world = computers.answer()?.0;
        Ok(computers)
    }

    /// Plays one tick from this world on.
    pub fn tick(&self, world: &mut World) -> Result<Judgement, String> {
        self.worlds.send(world.clone()).map_err(|_| ENDED.to_owned())?;
        let (played, judgement) = self.answer()?;
        *world = played;
        Ok(judgement)
    }

    fn answer(&self) -> Tick {
        self.ticks.lock().map_err(|_| ENDED)?.recv().map_err(|_| ENDED)?
    }
}

/// The thread's body: a first world after the warm-up, then one for each that comes.
fn play(
    settings: &Settings,
    seed: u64,
    places: &World,
    inbox: &Receiver<World>,
    outbox: &Sender<Tick>,
) -> Result<(), GameError> {
    let library = LibraryHandle::named(settings.league.name());
    let library = library.map_err(|error| GameError::League(error.to_string()))?;
    let mut backend = NativeBackend::new(library.lasting_base());
    let mut game = Game::new(&config(settings, seed), &mut backend)?;
    for (colour, first) in [(Colour::Blue, settings.agents), (Colour::Yellow, 0)] {
        let driven = settings.driver(colour).team().is_some();
        for id in numbers(settings.count(colour) as u8) {
            if !driven || usize::from(id.number()) < first {
                game.power(Who { colour, id }, false, &mut backend)?;
            }
        }
    }
    let mut referee = (!settings.task.spec().referee).then(|| ManualReferee::new(&game));
    if let Some(referee) = &mut referee {
        warm_up(&mut game, referee, places)?;
    }
    let mut answer = (game.world().clone(), judgement(&game));
    while outbox.send(Ok(answer)).is_ok() {
        let Ok(world) = inbox.recv() else { break };
        *game.world_mut() = world;
        if let Some(referee) = &mut referee {
            referee.speak(&mut game);
            game.advance(&mut NoWatcher)?;
        } else {
            game.step(&mut NoWatcher)?;
        }
        answer = (game.world().clone(), judgement(&game));
    }
    Ok(())
}

/// Robots and hosts exchange their first packets, standing; then ball and robots are placed, and the ball is
/// in play.
fn warm_up(game: &mut Game<'_>, referee: &mut ManualReferee, places: &World) -> Result<(), GameError> {
    let teams = [Colour::Yellow, Colour::Blue];
    place(game, places);
    for team in teams {
        game.drill(team, Some(Drill::new()));
    }
    for _ in 0..WARM_UP_TICKS {
        referee.speak(game);
        game.advance(&mut NoWatcher)?;
    }
    place(game, places);
    for team in teams {
        game.drill(team, None);
    }
    referee.send(game, RefereeOrder::Run);
    Ok(())
}

fn place(game: &mut Game<'_>, places: &World) {
    for robot in places.robots() {
        game.put_robot(robot.who, robot.pose);
    }
    game.world_mut().put_ball(places.ball);
}

fn config(settings: &Settings, seed: u64) -> GameConfig {
    let spec = settings.task.spec();
    let mut config = GameConfig::new(settings.league, seed, 0.0);
    config.world = settings.world.of_match(seed);
    // The own team is blue and attacks +x; both halves are longer than the episode, so that it stays so.
    config.referee.blue_on_positive_half = false;
    let half_us = (settings.time_limit_s + HALF_SPARE_S).min(HALF_MAX_S) * 1e6;
    config.referee.clock = MatchClock::Simulated { total: Duration(2 * half_us as u64) };
    config.referee.max_robots = Some(settings.own.max(settings.opponents) as u8);
    for setup in &mut config.teams {
        setup.robots = settings.count(setup.colour) as u8;
        setup.plays = settings.driver(setup.colour).team().unwrap_or(Team::Idle);
        let has_keeper = spec.referee || (spec.keeper && setup.colour == Colour::Yellow);
        let team = config.referee.team_mut(setup.colour);
        team.can_place_ball = setup.plays != Team::Idle;
        team.drives = setup.plays != Team::Idle;
        if !has_keeper && let Some(absent) = RobotId::all().last() {
            team.keeper = absent;
        }
    }
    config
}

fn judgement(game: &Game<'_>) -> Judgement {
    let referee = game.referee();
    let restart = match referee.phase() {
        Phase::BallPlacement(team)
        | Phase::PrepareKickoff(team)
        | Phase::Kickoff(team)
        | Phase::PreparePenalty(team)
        | Phase::Penalty(team)
        | Phase::FreeKick(team) => Some(team),
        _ => None,
    };
    Judgement {
        score: [Colour::Blue, Colour::Yellow].map(|team| referee.accounts().of(team).score),
        in_play: referee.phase() == Phase::Run,
        restart,
        end: None,
    }
}

/// Whether these settings need computers.
pub fn are_needed(settings: &Settings) -> bool {
    settings.task.spec().referee
        || settings.task.spec().scenario.is_some()
        || settings.opponents_by.team().is_some()
        || (settings.teammates_by.team().is_some() && settings.agents < settings.own)
}

const ENDED: &str = "the robots' computers have ended";
/// Length of a tick, ms.
pub const TICK_MS: u32 = 10;
/// Before an episode: cameras' first frames, radio's handshake, and tracks that are sure; as case trials
/// have.
const WARM_UP_TICKS: u32 = 80;
/// Time by which a half is longer than the episode, s.
const HALF_SPARE_S: f64 = 60.0;
/// Longest half, s: a day; an episode without a limit ends there at the latest.
const HALF_MAX_S: f64 = 86_400.0;
