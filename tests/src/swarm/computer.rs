//! A robot's computer in the swarm: the same station as on a board, with an adversary on its radio, faulty
//! sensors and a clock of its own.

use std::cell::RefCell;
use std::rc::Rc;

use brain::{BrainConfig, Station};
use casebase::CaseBase;
use geometry::{Angle, Point, Pose, Twist, Vector};
use hil_sim::{Backend, Mcu, McuError, Reply, Stream};
use protocol::frame::Refusal;
use protocol::link::Packet;
use protocol::lockstep::TickIn;
use protocol::robot_io::SensorFrame;
use protocol::{Instant, RobotId};

use super::adversary::Adversary;
use super::honest::SentPackets;
use super::plan::{Fault, Plan, SensorFault, Span};

/// State shared by swarm and computers.
#[derive(Debug, Default)]
pub struct Shared {
    /// All packets the team has sent.
    pub sent_packets: SentPackets,
    /// Packets delivered to robots in this tick, after the adversary, in order.
    pub handed: Vec<(RobotId, Packet)>,
    /// Sensor frames of this tick.
    pub sensed: Vec<(RobotId, SensorFrame)>,
}

/// Boots the computers of a run.
pub struct FaultyBackend<'a> {
    plan: Rc<Plan>,
    base: CaseBase<'a>,
    shared: Rc<RefCell<Shared>>,
}

impl<'a> FaultyBackend<'a> {
    /// For the run of that plan, with this case base in every flash.
    pub fn new(plan: Rc<Plan>, base: CaseBase<'a>, shared: Rc<RefCell<Shared>>) -> Self {
        Self { plan, base, shared }
    }
}

impl<'a> Backend<'a> for FaultyBackend<'a> {
    fn name(&self) -> &'static str {
        "swarm"
    }

    fn boot(&mut self, config: &BrainConfig) -> Result<Box<dyn Mcu + 'a>, McuError> {
        let (plan, id) = (&self.plan, config.robot);
        let clock = Clock::drawn(plan, id, config.epoch);
        let sensor_faults = plan.sensor_faults.iter().filter(|(robot, ..)| *robot == id);
        Ok(Box::new(Computer {
            station: Station::with_keys(
                clock.at(Instant(0)),
                config,
                self.base,
                plan.key.of_robot(config.robot),
            ),
            id,
            clock,
            tick_ms: plan.squad.tick_ms(),
            trouble: plan.trouble,
            adversary: Adversary::new(plan, id),
            sensor_faults: sensor_faults.map(|(_, span, how)| (*span, *how, None)).collect(),
            shared: self.shared.clone(),
            reply: Reply::default(),
        }))
    }
}

/// A robot's clock against the simulator's.
#[derive(Clone, Copy, Debug)]
struct Clock {
    /// Its value at the start, µs.
    start: u64,
    /// Excess of its rate, parts per million.
    ppm: i64,
}

impl Clock {
    fn drawn(plan: &Plan, robot: RobotId, boot_epoch: u32) -> Self {
        if !plan.on.contains(&Fault::Skew) {
            return Self { start: 0, ppm: 0 };
        }
        let mut chance = Stream::new(plan.seed ^ u64::from(boot_epoch), &format!("swarm clock {robot}"));
        let ppm = i64::from(chance.whole(0, 2)) * 100 - 100;
        // From zero, just before 32 bits of µs overflow, or after a month.
        let start = [0, (1 << 32) - 4_000_000, 30 * 86_400_000_000][chance.whole(0, 2) as usize];
        Self { start, ppm }
    }

    fn at(self, now: Instant) -> Instant {
        let ahead = now.0 as i64 * self.ppm / 1_000_000;
        Instant(self.start + now.0.saturating_add_signed(ahead))
    }
}

struct Computer<'a> {
    station: Station<'a>,
    id: RobotId,
    clock: Clock,
    tick_ms: u32,
    trouble: Span,
    adversary: Adversary,
    sensor_faults: Vec<(Span, SensorFault, Option<SensorFrame>)>,
    shared: Rc<RefCell<Shared>>,
    reply: Reply,
}

impl Computer<'_> {
    fn drain(&mut self, now: Instant) {
        while let Some(packet) = self.station.poll_packet(now) {
            // As on a board, what does not fit into the tick is dropped.
            let _dropped = self.reply.packets.push(packet);
        }
    }

    fn sensors(&mut self, ms: u32, truth: &SensorFrame) -> SensorFrame {
        let mut sensors = truth.clone();
        for (span, how, before) in &mut self.sensor_faults {
            if !span.has(ms) {
                *before = None;
                continue;
            }
            match *how {
                SensorFault::Stuck => sensors = before.get_or_insert(sensors).clone(),
                SensorFault::NotANumber(which) => spoil(&mut sensors, which),
                SensorFault::Tipped => sensors.health.tipped = true,
                SensorFault::Spins(fast) => sensors.odometry.angular = fast,
                SensorFault::Battery(volts) => sensors.health.battery = Some(volts),
                SensorFault::Contact(contact) => sensors.ball_contact = contact,
            }
        }
        sensors
    }

    /// Number of packets that it did not hear, for lack of time or as the host's that came too late: a second
    /// host's late welcome, for one, leaves it with the first.
    fn unheard(&self) -> u32 {
        self.station.brain().unopened() + self.station.link().refused()[Refusal::Stale.kind()]
    }
}

impl Mcu for Computer<'_> {
    fn post(&mut self, tick: &TickIn<'_>) -> Result<(), McuError> {
        self.reply = Reply::default();
        let (now, ms) = (self.clock.at(tick.now), tick.seq * self.tick_ms);
        let mut packets: Vec<Packet> =
            tick.air.iter().filter_map(|bytes| Packet::from_slice(bytes).ok()).collect();
        if self.trouble.has(ms) {
            packets = self.adversary.tamper(packets, &self.shared.borrow().sent_packets);
        }
        let sensors = self.sensors(ms, &tick.sensors);
        {
            let mut shared = self.shared.borrow_mut();
            shared.sensed.push((self.id, sensors.clone()));
        }
        while let Some(due) = self.station.poll_timeout().filter(|due| *due <= now) {
            self.station.handle_timeout(due);
            self.drain(due);
        }
        for packet in &packets {
            let unheard = self.unheard();
            self.station.handle_packet(now, packet);
            if self.unheard() == unheard {
                self.shared.borrow_mut().handed.push((self.id, packet.clone()));
            }
            self.drain(now);
        }
        self.station.handle_sensors(now, &sensors);
        self.drain(now);
        self.reply.actuators = self.station.poll_actuators(now);
        Ok(())
    }

    fn collect(&mut self) -> Result<Reply, McuError> {
        let reply = std::mem::take(&mut self.reply);
        let mut shared = self.shared.borrow_mut();
        reply.packets.iter().for_each(|packet| shared.sent_packets.add(packet));
        Ok(reply)
    }
}

/// Replaces numbers by NaN where their bit is set: odometry, battery, pose, ball.
fn spoil(sensors: &mut SensorFrame, which: u8) {
    if which & 1 != 0 {
        sensors.odometry = Twist { linear: Vector::new(f32::NAN, f32::INFINITY), angular: f32::NEG_INFINITY };
    }
    if which & 2 != 0 {
        sensors.health.battery = Some(f32::NAN);
    }
    if which & 4 != 0 && sensors.pose.is_some() {
        let position = Point::new(f32::INFINITY, f32::NAN);
        sensors.pose = Some(Pose { position, heading: Angle::new(f32::NAN) });
    }
    if which & 8 != 0
        && let Some(ball) = &mut sensors.ball
    {
        ball.position = Point::new(f32::NAN, f32::NEG_INFINITY);
        ball.sigma = f32::NAN;
    }
}
