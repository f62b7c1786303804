//! `field_loop`: the clock that drives a field on the network. One thread: every millisecond it polls the
//! sockets, advances the world to the clock and sends what is due.

use std::net::SocketAddr;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use ssl::Message;
use ssl::net::{LoopbackProbe, NetSender, probe_loopback};
use ssl::simulation::{SimulatorCommand, SimulatorControl};

use super::ports::Ports;
use super::referee::{REFEREE_EVERY_MS, Referee};
use super::sync::SyncPorts;
use super::{FieldRequest, NetworkError, NetworkSettings, Spectator};
use crate::small_size::server::{Destination, Port, Server, ServerSettings};

/// Period of the loop: one step of the world.
const STEP_EVERY: Duration = Duration::from_millis(1);
/// Time left out of a second from which it is reported, ms: a twentieth.
const SLOW_FROM_MS: u64 = 50;
/// A slow machine is reported once in this number of seconds.
const SLOW_EVERY_S: u64 = 10;
/// Time that a probe of the loopback waits.
const PROBE_TIME: Duration = Duration::from_millis(100);
/// Longest time that the referee's steps catch up, µs: the simulator itself skips what a longer pause of this
/// program left out.
const BEHIND_MAX_US: u64 = 1_000_000;

/// Serves a field until `stopped` is set.
pub fn run(
    settings: &NetworkSettings,
    spectator: &mut dyn Spectator,
    stopped: &AtomicBool,
) -> Result<(), NetworkError> {
    let mut field = FieldLoop::open(settings, spectator)?;
    field.set_speed(settings.speed);
    let began = Instant::now();
    while !stopped.load(Ordering::Relaxed) {
        let running = began.elapsed();
        if settings.duration.is_some_and(|duration| running.as_secs_f64() >= duration) {
            break;
        }
        field.step(running)?;
        thread::sleep(STEP_EVERY.saturating_sub(began.elapsed().saturating_sub(running)));
    }
    field.end();
    Ok(())
}

struct FieldLoop<'s> {
    settings: &'s NetworkSettings,
    spectator: &'s mut dyn Spectator,
    server: Server,
    ports: Ports,
    sync: Option<SyncPorts>,
    vision: NetSender,
    referee: Referee,
    /// Lines for the operator that were not printed yet.
    lines: Vec<String>,
    /// The second that is running, and time left out before it, ms.
    second: u64,
    skipped: u64,
}

impl<'s> FieldLoop<'s> {
    fn open(settings: &'s NetworkSettings, spectator: &'s mut dyn Spectator) -> Result<Self, NetworkError> {
        let mut lines = Vec::new();
        let ports = Ports::open(settings.listen, settings.port, settings.legacy_port, &mut lines);
        let vision = NetSender::new(settings.vision, settings.interface.as_deref());
        let server = Server::new(&settings.server);
        let referee = Referee::new(settings, server.world())?;
        let sync =
            settings.sync.map(|blue| SyncPorts::open(blue).map_err(|error| NetworkError::Sync(blue, error)));
        let sync = sync.transpose()?;
        let mut started = vec![format!("control  {}", ports.addresses())];
        started.extend(sync.as_ref().map(SyncPorts::line));
        started.push(format!("vision   to {}", vision.to()));
        started.extend(referee.lines());
        spectator.started(started);
        lines.extend(multicast_advice(settings.vision));
        Ok(Self { settings, spectator, server, ports, sync, vision, referee, lines, second: 0, skipped: 0 })
    }

    fn step(&mut self, running: Duration) -> Result<(), NetworkError> {
        self.ports.listen(&mut self.server, &mut self.lines);
        self.referee.sends = self.ports.serve();
        self.referee.listen(self.server.world(), running, &mut self.lines);
        match &mut self.sync {
            Some(sync) => {
                let referee = &mut self.referee;
                sync.serve(&mut self.server, &mut self.lines, |world, lines| referee.look(world, lines));
            }
            None => self.advance(running.as_micros() as u64),
        }
        if let Some(error) = self.referee.failure.take() {
            return Err(error.into());
        }
        for packet in self.referee.packets.drain(..) {
            self.spectator.referee(&packet, running);
        }
        let request = self.spectator.look(running, &mut self.server, self.referee.internal());
        self.obey(request)?;
        self.referee.packets.clear();
        self.transmit(running);
        if running.as_secs() > self.second {
            self.second = running.as_secs();
            self.report();
        }
        for line in self.lines.drain(..) {
            self.spectator.line(line);
        }
        Ok(())
    }

    /// Advances the world to `now`, µs; the referee observes it in between.
    fn advance(&mut self, now: u64) {
        let step = (REFEREE_EVERY_MS as f32 * 1000.0 / self.server.pace().max(1.0)) as u64;
        let mut at = self.referee.advanced.max(now.saturating_sub(BEHIND_MAX_US));
        while at < now {
            at = (at + step.max(100)).min(now);
            self.server.advance(protocol::Instant(at));
            self.referee.look(self.server.world_mut(), &mut self.lines);
        }
        self.referee.advanced = at;
    }

    fn obey(&mut self, request: FieldRequest) -> Result<(), NetworkError> {
        if let Some(speed) = request.speed {
            self.set_speed(speed);
        }
        for _ in 0..request.ticks {
            (0..REFEREE_EVERY_MS).for_each(|_| self.server.step());
            self.referee.look(self.server.world_mut(), &mut self.lines);
        }
        if let Some(seed) = request.restart {
            let speed = self.server.pace();
            self.server = Server::new(&ServerSettings { seed, ..self.settings.server.clone() });
            self.set_speed(speed);
            self.referee.restart(self.settings, seed, self.server.world())?;
            self.spectator.restarted(seed);
            self.skipped = 0;
        }
        Ok(())
    }

    fn transmit(&mut self, running: Duration) {
        while let Some(transmit) = self.server.poll_transmit() {
            match transmit.to {
                Destination::Reply { from, to } => self.ports.answer(from, to, &transmit.bytes),
                Destination::Status(to) => self.ports.send_to(to, &transmit.bytes),
                Destination::Vision(port) => {
                    if !self.ports.serve() {
                        continue;
                    }
                    self.vision.set_port(port);
                    self.lines.extend(self.vision.send(&transmit.bytes));
                    self.lines.extend(self.spectator.vision(&transmit.bytes, running));
                }
            }
        }
    }

    /// Reports once a second how it goes.
    fn report(&mut self) {
        let counts = self.server.counts();
        let late = counts.skipped - std::mem::replace(&mut self.skipped, counts.skipped);
        if late > SLOW_FROM_MS && self.second.is_multiple_of(SLOW_EVERY_S) {
            self.lines.push(format!(
                "this machine is too slow: {late} ms of the last second were left out; take --speed below {} or fewer robots",
                self.server.pace()
            ));
        }
        self.spectator.status(format!(
            "{:.0} s, {}, {} vision packets out, {} robot messages in, {} refusals",
            self.server.world().time(),
            self.referee.state(),
            self.vision.sent,
            counts.control,
            counts.refused
        ));
    }

    fn end(&mut self) {
        self.spectator.ended();
        let counts = self.server.counts();
        self.spectator.line(format!(
            "ended after {:.1} simulated s: {} vision packets out, {} control and {} robot messages in, {} undecodable, {} refusals reported, {} ms left out",
            self.server.world().time(),
            self.vision.sent,
            counts.simulator,
            counts.control,
            counts.undecodable,
            counts.refused,
            counts.skipped
        ));
    }

    /// Sets the speed by the protocol itself, as a client would; the answer is discarded.
    fn set_speed(&mut self, speed: f32) {
        let control = SimulatorControl { simulation_speed: Some(speed), ..SimulatorControl::default() };
        let command = SimulatorCommand { control: Some(control), config: None };
        let no_client = SocketAddr::from(([127, 0, 0, 1], 9));
        self.server.handle(Port::Simulator, no_client, &command.encode_to_vec());
        while self.server.poll_transmit().is_some() {}
    }
}

/// How to fix it if programs on this machine cannot receive a group that this one sends to.
fn multicast_advice(to: SocketAddr) -> Option<String> {
    let SocketAddr::V4(group) = to else { return None };
    if !group.ip().is_multicast() {
        return None;
    }
    match probe_loopback(*group.ip(), PROBE_TIME) {
        LoopbackProbe::Works { .. } => None,
        probe => Some(format!("{probe}; or speak to one machine: --vision 127.0.0.1:{}", group.port())),
    }
}
