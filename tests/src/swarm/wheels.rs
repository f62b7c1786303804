//! A run of robots on wheels with a host: the Small Size world, the host's own radio with a script for a
//! strategy, the swarm's computers, and a guard for each of them.

use std::cell::RefCell;
use std::rc::Rc;

use brain::BrainConfig;
use geometry::{Angle, GoalEnd, Point, Pose};
use hil_sim::small_size::{Ball, Order, Parameters, World};
use hil_sim::{Air, Backend, Mcu, Stream};
use host::radio::{RadioSettings, Relay};
use protocol::lockstep::TickIn;
use protocol::robot_io::{ActuatorFrame, OmniKick};
use protocol::{Duration, Instant, RobotId, Who};
use rules::{Colour, League};

use super::adversary::earlier_match;
use super::computer::{FaultyBackend, Shared};
use super::guard::Guard;
use super::plan::{FIRST_BOOT_EPOCH, Plan, TEAM};
use super::script::{Headquarters, Script};
use super::team::TeamWatch;
use super::{Broken, Counters, Found};

/// A robot of ours.
struct Player<'a> {
    config: BrainConfig,
    computer: Option<Box<dyn Mcu + 'a>>,
    born: u32,
    guard: Guard,
    /// Whether it stood in the last step.
    stood: bool,
}

/// A running run.
struct Run<'a> {
    plan: Rc<Plan>,
    shared: Rc<RefCell<Shared>>,
    backend: FaultyBackend<'a>,
    world: World,
    air: Air,
    players: Vec<Player<'a>>,
    /// The sending hosts.
    hosts: Vec<Headquarters>,
    watch: TeamWatch,
}

pub(super) fn run(plan: Plan) -> Result<Counters, Found> {
    let mut run = Run::new(Rc::new(plan));
    for number in 0..run.plan.end / TICK_MS {
        run.tick(number)?;
    }
    Ok(run.watch.counters())
}

impl Run<'_> {
    fn new(plan: Rc<Plan>) -> Self {
        let shared = Rc::new(RefCell::new(Shared::default()));
        for packet in earlier_match(&plan) {
            shared.borrow_mut().sent_packets.add(&packet);
        }
        let parameters = Parameters::of(League::DivisionB).expect("a Small Size league");
        let mut world = World::new(League::DivisionB, parameters, plan.seed);
        let mut chance = Stream::new(plan.seed, "swarm places");
        let mut backend = FaultyBackend::new(plan.clone(), case_library::division_b(), shared.clone());
        let mut place = |x: f32| {
            let at = Point::new(x + chance.between(-0.3, 0.3), chance.between(-2.0, 2.0));
            Pose { position: at, heading: Angle::new(chance.between(-3.0, 3.0)) }
        };
        let mut players = Vec::new();
        for (i, config) in plan.brains.iter().enumerate() {
            world.put(Who::blue(config.robot), place(i as f32 - 2.0));
            let computer = backend.boot(config).expect("native computers start");
            let guard = Guard::new(config.robot, config.epoch, 0);
            players.push(Player {
                config: config.clone(),
                computer: Some(computer),
                born: 0,
                guard,
                stood: true,
            });
        }
        for (i, id) in RobotId::all().take(3).enumerate() {
            world.put(Who::yellow(id), place(i as f32 + 1.5));
        }
        world.put_ball(Ball::at(place(0.0).position));
        let ids: Vec<RobotId> = plan.ids().collect();
        let air = Air::with_host(plan.air_at(0), plan.seed, &ids);
        let watch = TeamWatch::new(&plan);
        let script = if plan.on.is_empty() { Script::free_play() } else { Script::drawn(&plan) };
        let hosts = vec![headquarters(&plan, FIRST_BOOT_EPOCH + 10, script)];
        Self { plan, shared, backend, world, air, players, hosts, watch }
    }

    fn tick(&mut self, number: u32) -> Result<(), Found> {
        let ms = number * TICK_MS;
        self.happen(ms);
        if !League::DivisionB.field().contains(self.world.ball.position) {
            self.world.put_ball(Ball::at(Point::new(0.3, -0.4)));
        }
        self.lead(number, ms);
        self.think(number, ms);
        for _ in 0..TICK_MS {
            self.world.step();
        }
        self.watch.end_of_step(ms)
    }

    /// Applies the plan's events of this moment.
    fn happen(&mut self, ms: u32) {
        let plan = self.plan.clone();
        if plan.air_changes().into_iter().any(|change| round_up(change) == ms) {
            self.air.set(plan.air_at(ms));
        }
        for (id, span) in &plan.reboots {
            let Some(player) = self.players.iter_mut().find(|player| player.config.robot == *id) else {
                continue;
            };
            if round_up(span.from) == ms {
                player.computer = None;
                self.world.order(Who::blue(*id), Order::default());
                self.watch.crashed(ms, *id);
            } else if round_up(span.to).max(round_up(span.from) + TICK_MS) == ms {
                player.config.epoch += 1;
                player.born = ms;
                player.guard = Guard::new(*id, player.config.epoch, ms);
                player.computer = Some(self.backend.boot(&player.config).expect("native computers start"));
                self.watch.booted(ms, *id);
            }
        }
        if let Some((span, later)) = plan.second_host {
            if round_up(span.from) == ms {
                let epoch = if later { FIRST_BOOT_EPOCH + 20 } else { FIRST_BOOT_EPOCH + 5 };
                let script = Script::drawn_for_second(&plan);
                self.hosts.push(headquarters(&plan, epoch, script));
            }
            if round_up(span.to) == ms {
                self.hosts.truncate(1);
            }
        }
        if round_up(plan.trouble.to) == ms && plan.second_host.is_some_and(|(_, later)| later) {
            // The robots follow the second host; the remaining one restarts with a newer epoch to be
            // accepted.
            self.hosts = vec![headquarters(&plan, FIRST_BOOT_EPOCH + 30, Script::free_play())];
        }
    }

    /// Hosts receive and send.
    fn lead(&mut self, number: u32, ms: u32) {
        let now = Instant(u64::from(ms) * 1000);
        let received = self.air.deliver_to_host(number);
        let ids: Vec<RobotId> = self.plan.ids().collect();
        for host in &mut self.hosts {
            host.receive(now, &received);
            let shared = &mut *self.shared.borrow_mut();
            let air = &mut self.air;
            // Cameras take 75 frames a second.
            if !number.is_multiple_of(4) {
                host.lead(now, ms, &self.plan, &ids, &self.world);
            }
            host.speak(|to, packet| {
                shared.sent_packets.add(packet);
                air.send_from_host(number, to, packet);
            });
        }
    }

    /// Robots receive, decide, order and send.
    fn think(&mut self, number: u32, ms: u32) {
        let Self { plan, shared, world, air, players, watch, .. } = self;
        for player in players {
            let id = player.config.robot;
            let sensors = world.sensors(Who::blue(id)).expect("it is on the field");
            let Some(computer) = &mut player.computer else {
                air.discard(number, id);
                continue;
            };
            let packets = air.deliver(number, id);
            let now = Instant(u64::from(ms - player.born) * 1000);
            let tick =
                TickIn { seq: number, now, air: packets.iter().map(|packet| &packet[..]).collect(), sensors };
            let reply = computer.exchange(&tick).expect("native computers do not fail");
            let mut shared = shared.borrow_mut();
            let handed = std::mem::take(&mut shared.handed);
            for (_, packet) in handed {
                let believed = player.guard.honest.receive(&packet, &shared.sent_packets);
                if let Some(believed) = &believed {
                    player.guard.receive(ms, believed);
                }
                watch.received(ms, id, believed.as_ref());
            }
            for packet in &reply.packets {
                watch.note_sent(ms, plan, packet);
                air.send(number, id, packet);
            }
            let sensed = shared.sensed.pop().map_or(tick.sensors, |(_, sensors)| sensors);
            let Some(order) = reply.actuators else { continue };
            world.command(Who::blue(id), &order);
            let (armed, stands) = (player.guard.is_armed(), discharges(&order));
            match player.guard.judge(ms, &sensed, &order) {
                Ok(()) => watch.braked(u64::from(stands)),
                Err(danger) => watch.find(ms, Broken::Body(id, danger)),
            }
            // In a plan with loss as its only fault it stands for no other reason than silence.
            if ms >= plan.trouble.from {
                watch.stood(armed && stands && !player.stood, if stands { TICK_MS } else { 0 });
            }
            player.stood = stands;
            if ms >= plan.trouble.to + ARMED_AFTER && discharges(&order) {
                watch.find(ms, Broken::Lame(id));
            }
        }
    }
}

fn headquarters(plan: &Plan, epoch: u32, script: Script) -> Headquarters {
    let defaults = RadioSettings::new(TEAM, epoch);
    let settings =
        RadioSettings { key: plan.key, relay: Relay::No, latency: Duration::millis(10), ..defaults };
    Headquarters::new(settings, Colour::Blue, GoalEnd::Negative, script)
}

fn discharges(order: &ActuatorFrame) -> bool {
    matches!(order, ActuatorFrame::Omni { kick: OmniKick::Discharge, .. } | ActuatorFrame::Released)
}

/// The first tick at or after that moment.
fn round_up(ms: u32) -> u32 {
    ms.div_ceil(TICK_MS) * TICK_MS
}

/// Period of a brain's tick, ms.
const TICK_MS: u32 = super::plan::Squad::Wheels.tick_ms();
/// ms: delayed packets, a welcome, half a second of good link.
const ARMED_AFTER: u32 = 1_000;
