//! `server_loop`: server loop of `onetwo simulate`: the clock that drives the field, the network around it,
//! the referee beside it.
//!
//! One thread: every millisecond it polls three sockets, advances the world to the clock and sends what is
//! due.

use std::net::SocketAddr;
use std::process::ExitCode;
use std::sync::atomic::Ordering;
use std::thread;
use std::time::{Duration, Instant};

use hil_sim::small_size::referee::{InternalReferee, RefereeSettings};
use hil_sim::small_size::server::{Destination, Port, Server, ServerSettings};
use hil_sim::small_size::{PhysicsEvent, World};
use host::tracking::{Publisher, Tracker};
use ssl::Message;
use ssl::net::{LoopbackProbe, probe_loopback};
use ssl::simulation::{SimulatorCommand, SimulatorControl};
use ssl::vision::WrapperPacket;

use super::SimulateArgs;
use super::board::Board;
use super::crew::Crew;
use super::failure::SimulateError;
use super::ports::Ports;
use super::sync::SyncPorts;
use crate::Failure;
use crate::args::page::PageArgs;
use crate::args::parsers::RefereeKind;
use crate::net::NetSender;
use crate::output::note;
use crate::progress::Progress;
use crate::stop::stopped_by_hand;

/// Period of the referee, simulated ms: its detectors are tuned for it.
const REFEREE_EVERY: u64 = 10;
/// Period of the loop: one step of the world.
const BEAT: Duration = Duration::from_millis(1);
/// If more than this is skipped in a second, it is reported: a twentieth of the time.
const SLOW_MS: u64 = 50;
/// A slow machine is reported once in this number of seconds.
const SLOW_EVERY: u64 = 10;
/// Time that a probe of the loopback waits.
const PROBE: Duration = Duration::from_millis(100);

/// Runs until the operator ends it.
pub(super) fn run(
    args: &SimulateArgs,
    settings: &ServerSettings,
    mut server: Server,
    unix_us: u64,
) -> Result<ExitCode, Failure> {
    let stopped = stopped_by_hand();
    let mut description = Vec::new();
    let mut ports = Ports::open(args.listen, args.ports, args.legacy_port(), &mut description);
    let mut vision = NetSender::new(args.vision, args.interface.as_deref());
    let mut game_referee = Referee::new(args, unix_us)?;
    let mut tracker = args.tracker.map(|to| Tracked::new(to, args));
    note!(
        "simulating {}, {} v {} robots, world {}, seed {}; Ctrl-C ends it",
        args.league.name(),
        settings.robots,
        settings.robots,
        settings.model.name,
        args.seed
    );
    note!("control  {}", ports.description());
    let mut sync = match args.sync.map(|blue| (blue, SyncPorts::open(blue))) {
        None => None,
        Some((_, Ok(sync))) => Some(sync),
        Some((blue, Err(error))) => {
            return Err(SimulateError::Sync(blue, error).into());
        }
    };
    if let Some(sync) = &sync {
        note!("{}", sync.line());
    }
    note!("vision   to {}", vision.to());
    game_referee.lines().iter().for_each(|line| note!("{line}"));
    if let Some(tracked) = &tracker {
        note!("tracker  to {}", tracked.sender.to());
    }
    let page = PageArgs::at(args.page, "--page");
    let mut board =
        (!args.headless).then(|| Board::open(&page, args.league, args.seed, args.speed)).flatten();
    description.extend(multicast_advice(args.vision));
    set_pace(&mut server, args.speed);

    let bar = Progress::open();
    let (began, mut second, mut skipped) = (Instant::now(), 0, 0);
    while !stopped.load(Ordering::Relaxed) {
        let running = began.elapsed();
        if args.duration.is_some_and(|duration| running.as_secs_f64() >= duration) {
            break;
        }
        ports.listen(&mut server, &mut description);
        game_referee.listen(server.world(), running, &mut description);
        match &mut sync {
            Some(sync) => {
                sync.serve(&mut server, &mut description, |world, lines| game_referee.look(world, lines));
            }
            None => advance(&mut server, running.as_micros() as u64, &mut game_referee, &mut description),
        }
        if let Some(board) = &mut board {
            game_referee.sent_packets.drain(..).for_each(|bytes| board.referee(&bytes, running));
            let request = board.look(running, &mut server, game_referee.ours());
            if let Some(pace) = request.pace {
                set_pace(&mut server, pace);
            }
            for _ in 0..request.ticks {
                (0..REFEREE_EVERY).for_each(|_| server.step());
                game_referee.look(server.world_mut(), &mut description);
            }
            if let Some(seed) = request.restart {
                let pace = server.pace();
                server = Server::new(&ServerSettings { seed, ..settings.clone() });
                set_pace(&mut server, pace);
                game_referee.anew(args, unix_us, seed)?;
                tracker = args.tracker.map(|to| Tracked::new(to, args));
                board.restart(args.league, seed);
                skipped = 0;
            }
        }
        game_referee.sent_packets.clear();
        while let Some(transmit) = server.poll_transmit() {
            match transmit.to {
                Destination::Reply { from, to } => ports.answer(from, to, &transmit.bytes),
                Destination::Status(to) => ports.send_to(to, &transmit.bytes),
                Destination::Vision(port) => {
                    if let Some(board) = &mut board {
                        board.vision(&transmit.bytes, running);
                    }
                    vision.set_port(port);
                    description.extend(vision.send(&transmit.bytes));
                    if let Some(tracked) = &mut tracker {
                        description.extend(tracked.receive(&transmit.bytes, running));
                    }
                }
            }
        }
        if running.as_secs() > second {
            second = running.as_secs();
            let late = server.counts().skipped - std::mem::replace(&mut skipped, server.counts().skipped);
            if late > SLOW_MS && second.is_multiple_of(SLOW_EVERY) {
                description.push(format!(
                    "this machine is too slow: {late} ms of the last second were left out; take --speed below {} or fewer robots",
                    server.pace()
                ));
            }
            bar.set_text(status(&server, &game_referee, &vision));
        }
        for description in description.drain(..) {
            bar.aside(|| note!("{description}"));
        }
        thread::sleep(BEAT.saturating_sub(began.elapsed().saturating_sub(running)));
    }
    drop(bar);
    let counts = server.counts();
    note!(
        "ended after {:.1} simulated s: {} vision packets out, {} control and {} robot messages in, {} undecodable, {} refusals reported, {} ms left out",
        server.world().time(),
        vision.sent,
        counts.simulator,
        counts.control,
        counts.undecodable,
        counts.refused,
        counts.skipped
    );
    Ok(ExitCode::SUCCESS)
}

/// Advances the world to `now`, µs; the referee observes it in between.
fn advance(server: &mut Server, now: u64, game_referee: &mut Referee, description: &mut Vec<String>) {
    let step = (REFEREE_EVERY as f32 * 1000.0 / server.pace().max(1.0)) as u64;
    let mut at = game_referee.advanced;
    // The simulator itself skips the time of a pause of this program that was too long.
    if now.saturating_sub(at) > 1_000_000 {
        at = now - 1_000_000;
    }
    while at < now {
        at = (at + step.max(100)).min(now);
        server.advance(protocol::Instant(at));
        game_referee.look(server.world_mut(), description);
    }
    game_referee.advanced = at;
}

/// The referee source, and what it published.
struct Referee {
    who: RefereeSource,
    sender: NetSender,
    events: Vec<PhysicsEvent>,
    /// The step of the world at its last call.
    looked: u64,
    /// Time that the world has been advanced to, µs.
    advanced: u64,
    /// Packets it sent since the page last took them.
    sent_packets: Vec<Vec<u8>>,
}

enum RefereeSource {
    Ours(Box<InternalReferee>),
    NoWatcher,
    Elsewhere(Box<Crew>),
}

impl Referee {
    fn new(args: &SimulateArgs, unix_us: u64) -> Result<Self, Failure> {
        let crew = |from| {
            let crew = Crew::new(from, args.league, args.assistant, args.autoref.as_deref());
            crew.map(Box::new)
        };
        let serves = args.assistant || args.autoref.is_some();
        let who = match args.referee {
            RefereeKind::Internal => RefereeSource::Ours(internal(args, unix_us, args.seed)?),
            RefereeKind::None if serves => {
                RefereeSource::Elsewhere(crew(ssl::net::addresses::REFEREE.into())?)
            }
            RefereeKind::None => RefereeSource::NoWatcher,
            RefereeKind::Received(from) => RefereeSource::Elsewhere(crew(from)?),
        };
        let sender = NetSender::new(args.referee_to, args.interface.as_deref());
        Ok(Self { who, sender, events: Vec::new(), looked: 0, advanced: 0, sent_packets: Vec::new() })
    }

    /// Another game starts; the internal referee starts again with it, an external game controller does not
    /// know of it.
    fn anew(&mut self, args: &SimulateArgs, unix_us: u64, seed: u64) -> Result<(), Failure> {
        match &mut self.who {
            RefereeSource::Ours(ours) => *ours = internal(args, unix_us, seed)?,
            RefereeSource::Elsewhere(crew) => {
                crew.restart()?;
            }
            RefereeSource::NoWatcher => {}
        }
        self.events.clear();
        self.looked = 0;
        Ok(())
    }

    fn lines(&self) -> Vec<String> {
        match &self.who {
            RefereeSource::Ours(_) => vec![format!("referee  internal, to {}", self.sender.to())],
            RefereeSource::NoWatcher => vec!["referee  none".to_owned()],
            RefereeSource::Elsewhere(crew) => crew.lines(),
        }
    }

    fn ours(&mut self) -> Option<&mut InternalReferee> {
        match &mut self.who {
            RefereeSource::Ours(ours) => Some(ours),
            RefereeSource::NoWatcher | RefereeSource::Elsewhere(_) => None,
        }
    }

    /// The state of the game, as text.
    fn state(&self) -> String {
        match &self.who {
            RefereeSource::Ours(ours) => ours.phase().to_string(),
            RefereeSource::NoWatcher => "no referee".to_owned(),
            RefereeSource::Elsewhere(crew) => crew.state(),
        }
    }

    /// The referee observes the world, and the assistant's tasks are done.
    fn look(&mut self, world: &mut World, lines: &mut Vec<String>) {
        world.take_events(&mut self.events);
        if world.now() < self.looked + REFEREE_EVERY {
            return;
        }
        self.looked = world.now();
        match &mut self.who {
            RefereeSource::Ours(ours) => {
                ours.look(world, &self.events);
                while let Some(order) = ours.poll_order() {
                    order.carry_out(world);
                }
                while let Some(packet) = ours.poll_packet() {
                    let bytes = packet.encode_to_vec();
                    lines.extend(self.sender.send(&bytes));
                    self.sent_packets.push(bytes);
                }
            }
            RefereeSource::Elsewhere(crew) => crew.look(world, &self.events, lines),
            RefereeSource::NoWatcher => {}
        }
        self.events.clear();
    }

    /// Receives an external game controller, if there is one.
    fn listen(&mut self, world: &World, running: Duration, lines: &mut Vec<String>) {
        if let RefereeSource::Elsewhere(crew) = &mut self.who {
            crew.listen(world, running, &mut self.sent_packets, lines);
        }
    }
}

/// The referee of our own.
fn internal(args: &SimulateArgs, unix_us: u64, seed: u64) -> Result<Box<InternalReferee>, Failure> {
    let settings = RefereeSettings { epoch_us: unix_us, ..RefereeSettings::new(args.league) };
    let settings = RefereeSettings { blue_on_positive_half: false, max_robots: args.robots, ..settings };
    let ours = InternalReferee::new(settings, seed);
    Ok(Box::new(ours?))
}

/// Our own tracker on the simulated vision.
struct Tracked {
    tracker: Tracker,
    publisher: Publisher,
    sender: NetSender,
}

impl Tracked {
    fn new(to: SocketAddr, args: &SimulateArgs) -> Self {
        Self {
            tracker: Tracker::default(),
            publisher: Publisher::new("onetwo-simulate", "onetwo simulate"),
            sender: NetSender::new(to, args.interface.as_deref()),
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

/// By the protocol itself, as a client would; the answer is discarded.
fn set_pace(server: &mut Server, speed: f32) {
    let control = SimulatorControl { simulation_speed: Some(speed), ..SimulatorControl::default() };
    let command = SimulatorCommand { control: Some(control), config: None };
    let nobody = SocketAddr::from(([127, 0, 0, 1], 9));
    server.handle(Port::Simulator, nobody, &command.encode_to_vec());
    while server.poll_transmit().is_some() {}
}

/// How to fix it if programs on this machine cannot receive a group that this one sends to.
fn multicast_advice(to: SocketAddr) -> Option<String> {
    let SocketAddr::V4(group) = to else { return None };
    if !group.ip().is_multicast() {
        return None;
    }
    match probe_loopback(*group.ip(), PROBE) {
        LoopbackProbe::Works { .. } => None,
        probe => Some(format!("{probe}; or speak to one machine: --vision 127.0.0.1:{}", group.port())),
    }
}

fn status(server: &Server, game_referee: &Referee, vision: &NetSender) -> String {
    let counts = server.counts();
    format!(
        "{:.0} s, {}, {} vision packets out, {} robot messages in, {} refusals",
        server.world().time(),
        game_referee.state(),
        vision.sent,
        counts.control,
        counts.refused
    )
}
