//! `simulation`: main loop of a trial. Tick by tick: faults, sensors, computers, radio, opponents, physics,
//! referee (docs/architecture.md §2.3, §7.1).
//!
//! In tick n at n · 40 ms: scheduled faults are applied; every running robot gets its sensor frame and its
//! packets, all robots compute (in parallel where they are processes), their answers are taken in the order
//! of ids; packets are sent and received in a later tick; the opponents decide; then the physics advances by
//! four steps of 10 ms, the referee examining each. Each robot's clock starts at its boot, so no two need to
//! agree.

use brain::BrainConfig;
use protocol::decision::DecisionReport;
use protocol::link::Packet;
use protocol::lockstep::TickIn;
use protocol::robot_io::ActuatorFrame;
use protocol::{Duration, Instant, RobotId};
use thiserror::Error;

use crate::air::{Air, AirSettings};
use crate::four_legged::fault::{Fault, ScheduledFault, flipped};
use crate::four_legged::opponents::{Opponent, OpponentRole};
use crate::four_legged::parameters::{Noise, Parameters};
use crate::four_legged::referee::{Configuration, Referee};
use crate::four_legged::scenario::Layout;
use crate::four_legged::sensors::Senses;
use crate::four_legged::trace::TraceHash;
use crate::four_legged::world::{LeggedWorld, STEP, Side, Walker, WorldEvent};
use crate::mcu::{Backend, Mcu, McuError};

/// Everything that determines a trial; equal configurations give equal runs.
#[derive(Clone, Debug)]
pub struct SimulationConfig {
    /// Seed of all random streams.
    pub seed: u64,
    /// Start positions of ball and robots.
    pub layout: Layout,
    /// The configuration of opponents; it decides what ends the trial.
    pub configuration: Configuration,
    /// The attackers' brains: the first plays from the layout's first position, and so on.
    pub brains: Vec<BrainConfig>,
    /// Settings of the radio channel.
    pub air: AirSettings,
    /// Errors of the robots' perception.
    pub noise: Noise,
    /// Parameters of the physics.
    pub parameters: Parameters,
    /// Faults with their ticks, in any order.
    pub faults: Vec<ScheduledFault>,
}

/// A running trial, advanced tick by tick.
pub struct Simulation<'a> {
    backend: Box<dyn Backend<'a> + 'a>,
    robots: Vec<Robot<'a>>,
    world: LeggedWorld,
    opponents: Vec<Opponent>,
    referee: Referee,
    air: Air,
    parameters: Parameters,
    faults: Vec<ScheduledFault>,
    trace: TraceHash,
    next: u32,
    /// The tick from which the opponents act again.
    opponents_act_from: u32,
    tick: Tick,
    worst_instructions: u32,
}

/// A robot controlled by a brain; its index in this list is its index in the world.
struct Robot<'a> {
    config: BrainConfig,
    computer: Option<Box<dyn Mcu + 'a>>,
    /// The tick in which its present epoch started.
    booted_in: u32,
    senses: Senses,
    /// Number of the bit to flip in its next order.
    flip: Option<u8>,
}

/// Inputs, outputs and events of a tick.
#[derive(Clone, Debug, Default)]
pub struct Tick {
    /// Number of the tick, from 0.
    pub number: u32,
    /// Seconds from kick-off to its start.
    pub time: f32,
    /// Faults applied in it.
    pub faults: Vec<Fault>,
    /// Packets received by robots, in delivery order.
    pub received: Vec<ReceivedPacket>,
    /// Orders to bodies, by id.
    pub orders: Vec<(RobotId, ActuatorFrame)>,
    /// Packets sent by robots, in order.
    pub sent: Vec<Sent>,
    /// Events of the physics, with the seconds from kick-off.
    pub events: Vec<(f32, WorldEvent)>,
}

/// A packet sent by a robot.
#[derive(Clone, Debug, PartialEq)]
pub struct Sent {
    /// Number of the robot that sent it.
    pub from: RobotId,
    /// The bytes of one frame.
    pub packet: Packet,
}

/// A packet delivered to a robot.
#[derive(Clone, Debug, PartialEq)]
pub struct ReceivedPacket {
    /// Number of the robot that received it.
    pub to: RobotId,
    /// The bytes of one frame.
    pub packet: Packet,
}

impl<'a> Simulation<'a> {
    /// A trial at kick-off, with all computers started.
    pub fn new(
        config: SimulationConfig,
        mut backend: Box<dyn Backend<'a> + 'a>,
    ) -> Result<Self, SimulationError> {
        let SimulationConfig { seed, layout, configuration, brains, air, noise, parameters, faults } = config;
        if brains.len() > layout.attackers.len() {
            return Err(SimulationError::TooManyRobots {
                wanted: brains.len(),
                places: layout.attackers.len(),
            });
        }
        if let Some(pair) = brains.windows(2).find(|pair| pair[0].robot >= pair[1].robot) {
            return Err(SimulationError::IdsNotRising(pair[1].robot));
        }
        let ids: Vec<RobotId> = brains.iter().map(|brain| brain.robot).collect();
        let mut walkers: Vec<Walker> = (layout.attackers.iter().take(brains.len()))
            .map(|pose| Walker::at(Side::Attackers, *pose))
            .collect();
        walkers.extend(layout.opponents.iter().map(|placed| Walker::at(Side::Opponents, placed.pose)));
        let roles: Vec<OpponentRole> = layout.opponents.iter().map(|placed| placed.role).collect();
        let opponents = (layout.opponents.iter().zip(brains.len()..)).map(|(placed, i)| {
            Opponent::new(placed.role, placed.conduct, i, &parameters).with_noise(noise, seed)
        });
        let mut robots = Vec::new();
        for (i, config) in brains.into_iter().enumerate() {
            let computer = start(&mut *backend, &config)?;
            let senses = Senses::new(noise, seed, i, TICK);
            robots.push(Robot { config, computer: Some(computer), booted_in: 0, senses, flip: None });
        }
        let mut faults = faults;
        // Stable sort: faults of one tick are applied in the given order.
        faults.sort_by_key(|fault| fault.tick);
        Ok(Self {
            backend,
            robots,
            opponents: opponents.collect(),
            referee: Referee::new(configuration, &parameters.referee, roles, layout.ball),
            world: LeggedWorld::new(&parameters, seed, layout.ball, walkers),
            air: Air::new(air, seed, &ids),
            parameters,
            faults,
            trace: TraceHash::default(),
            next: 0,
            opponents_act_from: 0,
            tick: Tick::default(),
            worst_instructions: 0,
        })
    }

    /// Runs a tick and returns what happened. The referee's verdict does not stop the simulation; the caller
    /// decides when to stop.
    pub fn step(&mut self) -> Result<&Tick, SimulationError> {
        let number = self.next;
        self.next += 1;
        self.tick = Tick { number, time: seconds(number, 0), ..Tick::default() };
        self.apply_faults(number)?;
        self.trace.tick(number, &self.world);
        self.opponents.iter_mut().for_each(Opponent::perceive);
        self.run_computers(number)?;
        for Sent { from, packet } in &self.tick.sent {
            self.air.send(number, *from, packet);
        }
        let opponents_act = number >= self.opponents_act_from;
        for opponent in &mut self.opponents {
            if opponents_act {
                opponent.act(&mut self.world, &self.parameters);
            } else {
                opponent.stand(&mut self.world);
            }
        }
        self.run_physics(number);
        Ok(&self.tick)
    }

    /// The opponents stand still for that time from the next tick on, as "all robots stop" after a cycle of
    /// the paper's robots (Ros et al. 2009 §5.3); a grab or kick that is running ends.
    pub fn stop_opponents(&mut self, time: Duration) {
        self.opponents_act_from = self.next.saturating_add((time.0 / TICK_US).try_into().unwrap_or(u32::MAX));
    }

    /// Inputs, outputs and events of the last tick.
    pub fn tick(&self) -> &Tick {
        &self.tick
    }

    /// The true state, as it is now: at the end of the last tick.
    pub fn world(&self) -> &LeggedWorld {
        &self.world
    }

    /// The referee, with counts and outcome of the trial.
    pub fn referee(&self) -> &Referee {
        &self.referee
    }

    /// Seconds from kick-off to now.
    pub fn time(&self) -> f32 {
        seconds(self.next, 0)
    }

    /// The hash of all ticks so far.
    pub fn trace(&self) -> TraceHash {
        self.trace
    }

    /// The radio channel, for its settings and counts.
    pub fn air(&self) -> &Air {
        &self.air
    }

    /// Maximum instruction count of any robot's tick, where it can be counted; else 0.
    pub fn worst_instructions(&self) -> u32 {
        self.worst_instructions
    }

    /// The attackers' ids, in the order of [`LeggedWorld::walkers`], and whether their computers run.
    pub fn attackers(&self) -> impl Iterator<Item = (RobotId, bool)> {
        self.robots.iter().map(|robot| (robot.config.robot, robot.computer.is_some()))
    }

    /// The newest decision of each attacker whose computer can be looked into.
    pub fn decisions(&self) -> impl Iterator<Item = (RobotId, DecisionReport)> {
        self.robots
            .iter()
            .filter_map(|robot| Some((robot.config.robot, robot.computer.as_ref()?.decision()?)))
    }

    /// The opponents' roles; they follow the attackers in [`LeggedWorld::walkers`].
    pub fn opponents(&self) -> impl Iterator<Item = OpponentRole> {
        self.opponents.iter().map(|opponent| opponent.role)
    }

    fn apply_faults(&mut self, number: u32) -> Result<(), SimulationError> {
        let due = self.faults.partition_point(|fault| fault.tick <= number);
        for ScheduledFault { fault, .. } in self.faults.drain(..due).collect::<Vec<_>>() {
            self.tick.faults.push(fault.clone());
            let place = |id: RobotId| self.robots.iter().position(|robot| robot.config.robot == id);
            match fault {
                Fault::Crash(id) => {
                    if let Some(i) = place(id) {
                        self.robots[i].computer = None;
                        self.world.let_go(i);
                    }
                }
                Fault::Return(id) => {
                    let Some(i) = place(id).filter(|&i| self.robots[i].computer.is_none()) else { continue };
                    let robot = &mut self.robots[i];
                    robot.config.epoch = robot.config.epoch.wrapping_add(1);
                    robot.booted_in = number;
                    robot.computer = Some(start(&mut *self.backend, &robot.config)?);
                }
                Fault::Air(settings) => self.air.set(settings),
                Fault::FlipOrderBit { robot, bit } => {
                    if let Some(i) = place(robot) {
                        self.robots[i].flip = Some(bit);
                    }
                }
            }
        }
        Ok(())
    }

    /// Sends every computer its tick, then collects its answer.
    fn run_computers(&mut self, number: u32) -> Result<(), SimulationError> {
        for (i, robot) in self.robots.iter_mut().enumerate() {
            let id = robot.config.robot;
            // Measured even without a computer, so that odometry spans one tick after a reboot.
            let opponents = self.opponents.iter().map(|opponent| opponent.reported(&self.world));
            let sensors = robot.senses.look(&self.world, i, opponents, TICK);
            let Some(computer) = &mut robot.computer else {
                self.air.discard(number, id);
                continue;
            };
            let packets = self.air.deliver(number, id);
            let first = self.tick.received.len();
            self.tick.received.extend(packets.into_iter().map(|packet| ReceivedPacket { to: id, packet }));
            let tick = TickIn {
                seq: number,
                now: Instant(u64::from(number - robot.booted_in) * TICK_US),
                air: self.tick.received[first..].iter().map(|received| &received.packet[..]).collect(),
                sensors,
            };
            computer.post(&tick).map_err(|error| SimulationError::Computer(id, error))?;
        }
        for (i, robot) in self.robots.iter_mut().enumerate() {
            let id = robot.config.robot;
            let Some(computer) = &mut robot.computer else { continue };
            let reply = computer.collect().map_err(|error| SimulationError::Computer(id, error))?;
            self.worst_instructions = self.worst_instructions.max(reply.instructions);
            self.tick.sent.extend(reply.packets.into_iter().map(|packet| Sent { from: id, packet }));
            if let Some(order) = reply.actuators {
                let order = robot.flip.take().map_or(order, |bit| flipped(order, bit));
                self.trace.order(id, &order);
                self.world.command(i, &order);
                self.tick.orders.push((id, order));
            }
        }
        for ReceivedPacket { to, packet } in &self.tick.received {
            self.trace.packet(*to, packet);
        }
        Ok(())
    }

    /// Four steps of physics, each examined by the referee.
    fn run_physics(&mut self, number: u32) {
        let mut events = Vec::new();
        for step in 1..=STEPS_PER_TICK {
            self.world.step();
            self.world.take_events(&mut events);
            let time = seconds(number, step);
            self.referee.observe(time, &self.world, &events);
            self.tick.events.extend(events.drain(..).map(|event| (time, event)));
        }
    }
}

/// Failure of a trial at its start or in a tick.
#[derive(Debug, Error)]
pub enum SimulationError {
    /// The layout has fewer positions than there are brains.
    #[error("{wanted} robots, but the scenario has places for {places}")]
    TooManyRobots {
        /// Number of brains given.
        wanted: usize,
        /// Number of positions in the layout.
        places: usize,
    },
    /// Brains must be given in rising order of their ids, each once; this id is out of order.
    #[error("robot {0} is named twice or out of order")]
    IdsNotRising(RobotId),
    /// A robot's computer failed.
    #[error("robot {0}: {1}")]
    Computer(RobotId, #[source] McuError),
}

fn start<'a>(
    backend: &mut (dyn Backend<'a> + 'a),
    config: &BrainConfig,
) -> Result<Box<dyn Mcu + 'a>, SimulationError> {
    backend.boot(config).map_err(|error| SimulationError::Computer(config.robot, error))
}

/// Seconds from kick-off to a physics step of a tick, computed from whole milliseconds.
fn seconds(tick: u32, step: u32) -> f32 {
    (tick * TICK_MS + step * (TICK_MS / STEPS_PER_TICK)) as f32 * 0.001
}

/// Period of a brain's tick, ms (docs/architecture.md §2.3: four-legged, every 40 ms).
const TICK_MS: u32 = 40;
/// Period of a brain's tick, µs.
pub const TICK_US: u64 = TICK_MS as u64 * 1000;
/// Period of a brain's tick, s.
const TICK: f32 = 0.04;
/// Physics steps per tick.
const STEPS_PER_TICK: u32 = 4;
const _: () = assert!(TICK == STEPS_PER_TICK as f32 * STEP && TICK_MS.is_multiple_of(STEPS_PER_TICK));

#[cfg(test)]
mod tests;
