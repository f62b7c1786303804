//! `server`: server of the league's simulation protocol, bytes in and bytes out (docs/architecture.md §7.3).
//!
//! | port | takes | answers |
//! |---|---|---|
//! | 10300 | `SimulatorCommand` | `SimulatorResponse` with what could not be done |
//! | 10301 blue, 10302 yellow | `RobotControl` | `RobotControlResponse`: the same, and each robot's break-beam sensor |
//! | 20011, grSim's profile alone | `grSim_Packet` | `Robots_Status` to 30011 (blue) and 30012 (yellow): what changed |
//! | vision, multicast | – | `SSL_WrapperPacket` |
//!
//! No socket and no clock here: the caller calls [`Server::handle`] with received datagrams,
//! [`Server::advance`] with the time, and sends what [`Server::poll_transmit`] gives. Commands take effect in
//! the step after they arrived.

mod command;
mod config;
mod control;
mod legacy;
mod refusal;

use std::collections::{BTreeSet, VecDeque};
use std::net::SocketAddr;

use geometry::Pose;
use protocol::{Instant, RobotId};
use rules::{Colour, League};
use ssl::Message;
use ssl::net::addresses;
use ssl::simulation::{
    RobotControl, RobotControlResponse, SimulationSyncRequest, SimulationSyncResponse, SimulatorCommand,
    SimulatorResponse,
};

use super::camera::Cameras;
use super::compatibility::{Feedback, Profile};
use super::worlds::{WorldChoice, WorldModel};
use super::{Order, Who, World};
use crate::rng::Stream;

pub use refusal::Refusal;

/// Start settings of a server.
#[derive(Clone, Debug)]
pub struct ServerSettings {
    /// League whose field and robots are simulated.
    pub league: League,
    /// World model: parameters, differences between robots, faults.
    pub model: WorldModel,
    /// Compatibility profile on the wire.
    pub profile: Profile,
    /// Number of robots of each team at the start.
    pub robots: u8,
    /// Seed of all random streams.
    pub seed: u64,
    /// Unix time now, s; for profiles that send it.
    pub unix_now: f64,
    /// Destination port of vision.
    pub vision_port: u16,
}

impl ServerSettings {
    /// The settings of a league's file; `None` for leagues without wheeled robots.
    pub fn of(league: League, profile: Profile, seed: u64, unix_now: f64) -> Option<Self> {
        let model = WorldModel::of(league, &WorldChoice::Nominal)?;
        let robots = model.parameters.robots;
        Some(Self { league, model, profile, robots, seed, unix_now, vision_port: VISION_PORT })
    }
}

/// A port of the protocol.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Port {
    /// 10300: control of the simulation.
    Simulator,
    /// 10301 for blue, 10302 for yellow.
    Team(Colour),
    /// 20011, of grSim's older protocol.
    Legacy,
}

impl Port {
    /// UDP port number.
    pub const fn number(self) -> u16 {
        match self {
            Self::Simulator => addresses::SIMULATOR_PORT,
            Self::Team(Colour::Blue) => addresses::ROBOTS_BLUE_PORT,
            Self::Team(Colour::Yellow) => addresses::ROBOTS_YELLOW_PORT,
            Self::Legacy => addresses::GRSIM_PORT,
        }
    }
}

/// A datagram to be sent.
#[derive(Clone, Debug, PartialEq)]
pub struct Transmit {
    /// Destination of the datagram.
    pub to: Destination,
    /// Payload, a protobuf message.
    pub bytes: Vec<u8>,
}

/// Destination of a datagram.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Destination {
    /// The vision group, at this port.
    Vision(u16),
    /// Back to the sender of the request, from the port that received it.
    Reply {
        /// The port that received the request.
        from: Port,
        /// The address that sent the request.
        to: SocketAddr,
    },
    /// To the machine that sent the last command, at grSim's port for robots' states.
    Status(SocketAddr),
}

/// Counts of received datagrams and their results.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ServerCounts {
    /// Messages understood at 10300.
    pub simulator: u64,
    /// Messages understood at 10301 and 10302.
    pub control: u64,
    /// Datagrams that could not be decoded as a message of their port.
    pub undecodable: u64,
    /// Number of refusals reported to senders.
    pub refused: u64,
    /// Robots' commands lost on purpose (realism).
    pub lost: u64,
    /// Milliseconds not simulated because the caller called too late.
    pub skipped: u64,
}

/// A simulator with the league's protocol.
#[derive(Clone, Debug)]
pub struct Server {
    world: World,
    cameras: Cameras,
    profile: Profile,
    radio: RadioRealism,
    chance: Stream,
    pace: f32,
    vision_port: u16,
    last: Option<Instant>,
    /// Simulated µs not yet stepped.
    owed: f32,
    /// Orders not yet in effect, by the step they take effect in.
    coming: VecDeque<(u64, Who, Order)>,
    /// Robots that were placed far outside the walls: off the field surface, but not removed.
    parked: BTreeSet<Who>,
    /// Robots' last reported states in grSim's older protocol.
    reported: legacy::ReportedStates,
    out: VecDeque<Transmit>,
    counts: ServerCounts,
}

/// Loss and delay of robots' commands and answers.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct RadioRealism {
    command_loss: f32,
    answer_loss: f32,
    /// Delay of commands, steps.
    delay: u64,
}

impl Server {
    /// A field with both teams lined up in their halves, blue at −x, and the ball in the middle.
    pub fn new(settings: &ServerSettings) -> Self {
        let mut world = World::of_model(settings.league, &settings.model, settings.seed);
        let field = settings.league.field();
        for n in 0..settings.robots.min(RobotId::COUNT as u8) {
            let Some(id) = RobotId::new(n) else { continue };
            // Columns of four, 0.4 m apart, starting a metre from the halfway line (or half way into a small
            // field).
            let depth = (field.length * 0.25).min(1.0) + f32::from(n / 4) * LINE_UP_SPACING;
            let aside = (f32::from(n % 4) - 1.5) * LINE_UP_SPACING;
            world.put(Who::blue(id), Pose::from_mm_deg(-depth * 1000.0, aside * 1000.0, 0.0));
            world.put(Who::yellow(id), Pose::from_mm_deg(depth * 1000.0, aside * 1000.0, 180.0));
        }
        world.add_bystanders(settings.model.bystanders);
        let WorldModel { link, vision, .. } = &settings.model;
        let cameras = Cameras::of_model(settings.profile, settings.unix_now, &world, *vision, settings.seed);
        let answer_loss = cameras.settings().compatibility.answer_loss.max(link.loss);
        let (command_loss, delay) = (link.loss, u64::from(link.latency_ms));
        Self {
            world,
            cameras,
            profile: settings.profile,
            radio: RadioRealism { command_loss, answer_loss, delay },
            chance: Stream::new(settings.seed, "simulation server"),
            pace: 1.0,
            vision_port: settings.vision_port,
            last: None,
            owed: 0.0,
            coming: VecDeque::new(),
            parked: BTreeSet::new(),
            reported: legacy::ReportedStates::default(),
            out: VecDeque::new(),
            counts: ServerCounts::default(),
        }
    }

    /// The true state of ball and robots.
    pub fn world(&self) -> &World {
        &self.world
    }

    /// The true state, mutable, for a referee's manual acts.
    pub fn world_mut(&mut self) -> &mut World {
        &mut self.world
    }

    /// Counts of received datagrams and their results.
    pub fn counts(&self) -> ServerCounts {
        self.counts
    }

    /// Simulated seconds per second; 0 stands still.
    pub fn pace(&self) -> f32 {
        self.pace
    }

    /// The compatibility profile in force.
    pub fn profile(&self) -> Profile {
        self.profile
    }

    /// Handles a datagram that arrived at `port`.
    pub fn handle(&mut self, port: Port, from: SocketAddr, bytes: &[u8]) {
        match port {
            Port::Simulator => {
                let errors = match SimulatorCommand::decode(bytes) {
                    Ok(command) => {
                        self.counts.simulator += 1;
                        self.steer(&command)
                    }
                    Err(_) => self.undecodable(),
                };
                let errors = self.reported(&errors);
                if !errors.is_empty() || self.cameras.settings().compatibility.answers_control {
                    self.reply(port, from, SimulatorResponse { errors }.encode_to_vec());
                }
            }
            Port::Team(colour) => {
                let answer = if let Ok(control) = RobotControl::decode(bytes) {
                    self.counts.control += 1;
                    self.lead(colour, &control)
                } else {
                    let errors = self.undecodable();
                    RobotControlResponse { errors: self.reported(&errors), feedback: Vec::new() }
                };
                self.answer(port, from, answer);
            }
            Port::Legacy => self.legacy(from, bytes),
        }
    }

    fn answer(&mut self, port: Port, from: SocketAddr, answer: RobotControlResponse) {
        if self.cameras.settings().compatibility.feedback != Feedback::CommandedPresent {
            self.reply(port, from, answer.encode_to_vec());
            return;
        }
        // ER-Force's simulator sends errors and feedback in separate packets, and none where there is nothing
        // to send.
        let RobotControlResponse { errors, feedback } = answer;
        if !errors.is_empty() {
            let errors = RobotControlResponse { errors, feedback: Vec::new() };
            self.reply(port, from, errors.encode_to_vec());
        }
        if !feedback.is_empty() {
            let feedback = RobotControlResponse { errors: Vec::new(), feedback };
            self.reply(port, from, feedback.encode_to_vec());
        }
    }

    fn reply(&mut self, from: Port, to: SocketAddr, bytes: Vec<u8>) {
        self.out.push_back(Transmit { to: Destination::Reply { from, to }, bytes });
    }

    /// Advances the time to `now`: the world follows at its pace, and vision packets fall due.
    pub fn advance(&mut self, now: Instant) {
        let before = *self.last.get_or_insert(now);
        self.last = Some(now);
        self.owed += now.since(before).0 as f32 * self.pace;
        let late = ((self.owed - CATCH_UP_US) / STEP_US).max(0.0) as u64;
        self.counts.skipped += late;
        self.owed -= late as f32 * STEP_US;
        while self.owed >= STEP_US {
            self.owed -= STEP_US;
            self.step();
        }
    }

    /// One step of physics and its consequences, independent of the time.
    pub fn step(&mut self) {
        let now = self.world.now();
        while let Some((_, who, order)) = self.coming.pop_front_if(|(due, ..)| *due <= now) {
            self.world.order(who, order);
        }
        self.world.step();
        self.cameras.watch(&self.world);
        while let Some(packet) = self.cameras.poll(self.world.now()) {
            let to = Destination::Vision(self.vision_port);
            self.out.push_back(Transmit { to, bytes: packet.encode_to_vec() });
        }
    }

    /// Time at which [`Server::advance`] has to be called next; `None` while the world stands still.
    pub fn poll_timeout(&self) -> Option<Instant> {
        let last = self.last.unwrap_or_default();
        (self.pace > 0.0).then(|| Instant(last.0 + ((STEP_US - self.owed) / self.pace).max(0.0) as u64 + 1))
    }

    /// The next datagram to send.
    pub fn poll_transmit(&mut self) -> Option<Transmit> {
        self.out.pop_front()
    }

    /// The protocol's synchronous mode: carries out the request, simulates `sim_step` seconds (none: no time
    /// passes), and returns what cameras then see. After every step `each` gets the world, for a referee.
    pub fn synchronous(
        &mut self,
        colour: Colour,
        request: &SimulationSyncRequest,
        mut each: impl FnMut(&mut World),
    ) -> SimulationSyncResponse {
        let mut refused = match &request.simulator_command {
            Some(command) => self.steer(command),
            None => Vec::new(),
        };
        let mut commanded = [false; RobotId::COUNT];
        let mut response = RobotControlResponse::default();
        if let Some(control) = &request.robot_control {
            let ids = control.robot_commands.iter().map(|command| command.id as usize);
            ids.filter_map(|id| commanded.get_mut(id).map(|asked| *asked = true)).for_each(drop);
            response.errors = self.lead(colour, control).errors;
        }
        let step = request.sim_step.unwrap_or(0.0);
        if (0.0..=SYNC_MAX).contains(&step) {
            for _ in 0..(step * 1000.0 + 0.5) as u32 {
                self.step();
                each(&mut self.world);
            }
            // Vision goes into the answer instead.
            self.out.retain(|transmit| !matches!(transmit.to, Destination::Vision(_)));
        } else {
            refused.push(Refusal::SyncStep(step));
        }
        response.errors.extend(self.reported(&refused));
        response.feedback = self.feedback(colour, &commanded);
        SimulationSyncResponse {
            detection: self.cameras.capture(&self.world),
            robot_control_response: Some(response),
        }
    }

    fn undecodable(&mut self) -> Vec<Refusal> {
        self.counts.undecodable += 1;
        vec![Refusal::Undecodable]
    }

    fn reported(&mut self, refusals: &[Refusal]) -> Vec<ssl::simulation::SimulatorError> {
        self.counts.refused += refusals.len() as u64;
        let profile = self.profile;
        refusals.iter().filter_map(|refusal| refusal.reported(profile)).collect()
    }
}

/// Maximum simulation speed: no machine is faster.
pub const SPEED_MAX: f32 = 1000.0;
/// Maximum synchronous step, s.
pub const SYNC_MAX: f32 = 10.0;
/// Default port of simulators' vision packets: not a tournament's 10006.
pub const VISION_PORT: u16 = addresses::VISION_SIMULATED.port();
/// µs in a step.
const STEP_US: f32 = 1000.0;
/// Simulated µs that are simulated at once after a pause of the caller; the remainder is skipped.
const CATCH_UP_US: f32 = 250_000.0;
/// Distance between robots at the start, m.
const LINE_UP_SPACING: f32 = 0.4;

#[cfg(test)]
mod tests;
