//! `qemu_wheels`: tests: the firmware image drives wheels as the native brain does, within its step budget
//! (docs/architecture.md §2.4, §9).
//!
//! Three robots of ours, each once native and once in a QEMU of its own, receive the same packets of a host
//! and of each other and see the same world; six opponents drive about. Needs QEMU and a compiler for the
//! target.

use std::path::PathBuf;
use std::sync::LazyLock;

use brain::BrainConfig;
use firmware_build::inspect::{STACK_BUDGET, STEP_BUDGET};
use geometry::{Field, GoalEnd, Point, Pose, Twist, Vector};
use hil_sim::small_size::{Ball, Drive, Order, Parameters, World};
use hil_sim::{Backend, Mcu, Meter, NativeBackend, QemuBackend};
use protocol::frame::{Audience, Frame, TeamKey};
use protocol::host::{
    Directive, HostCommand, HostMessage, KickOrder, PART_ROBOTS_MAX, RuleRole, Welcome, WireBall, WireRobot,
    WireWho, WorldPart,
};
use protocol::host_link::{HostLink, Opened};
use protocol::link::Packet;
use protocol::lockstep::{AIR_IN_BYTES_MAX, AIR_IN_MAX, TickIn};
use protocol::quantized::{WirePoint, WirePose, to_mm};
use protocol::team::TeamMessage;
use protocol::{Instant, RobotId, TeamId, Who};
use rules::{Colour, League, Phase, Side};

/// Duration of each of the parts below, s.
const SECONDS: u64 = 6;

#[test]
fn wheeled_robots_under_qemu_equal_native_within_the_step_budget() {
    let mut table = Table::new();
    let mut robots = robots();
    let mut steps = Vec::new();
    let meter = Meter::default();
    for (phase, directives) in parts() {
        let mut of_part = Vec::new();
        for _ in 0..SECONDS * 100 {
            table.tick(phase, &directives, &mut robots, &mut of_part, &meter);
        }
        of_part.sort_unstable();
        let (median, worst) = (of_part[of_part.len() / 2], of_part[of_part.len() - 1]);
        println!("{phase:?}: median {median}, worst {worst} instructions");
        steps.extend(of_part);
    }
    steps.sort_unstable();
    let (median, worst) = (steps[steps.len() / 2], steps[steps.len() - 1]);
    let stack = meter.stack();
    println!(
        "{} steps on wheels: median {median}, worst {worst} instructions; deepest stack {stack} B",
        steps.len()
    );
    assert!((1..=STACK_BUDGET).contains(&stack), "{stack} B of stack");
    assert!((1..=STEP_BUDGET).contains(&worst), "the worst step took {worst} instructions");
}

#[test]
fn a_flood_of_packets_keeps_every_step_within_its_budget() {
    let mut table = Table::new();
    let mut robots = robots();
    let play = [const { Directive::Gameplay { hint: None } }; 3];
    for flood in [None, Some(Flood::Elsewhere), Some(Flood::Beacons), Some(Flood::ForgedHost)] {
        table.flood = flood;
        let (mut steps, meter) = (Vec::new(), Meter::default());
        for _ in 0..300 {
            table.tick(Phase::Run, &play, &mut robots, &mut steps, &meter);
        }
        steps.sort_unstable();
        let (median, worst) = (steps[steps.len() / 2], steps[steps.len() - 1]);
        println!("{flood:?}: median {median}, worst {worst} instructions");
        assert!((1..=STEP_BUDGET).contains(&worst), "{flood:?}: the worst step took {worst} instructions");
        assert!((1..=STACK_BUDGET).contains(&meter.stack()), "{flood:?}: {} B of stack", meter.stack());
    }
}

/// Packets that fill the radio's time.
#[derive(Clone, Copy, Debug)]
enum Flood {
    /// The host's commands to another robot.
    Elsewhere,
    /// Beacons in teammates' names with a stolen robot's key, each newer than the last.
    Beacons,
    /// Snapshots that claim to be the host's.
    ForgedHost,
}

/// Three robots, each native and as an image.
fn robots() -> Vec<(RobotId, [Box<dyn Mcu + 'static>; 2])> {
    let base = case_library::division_b();
    let mut native = NativeBackend::new(base);
    let mut emulated = QemuBackend::new(&*IMAGE).with_library(base.bytes()).expect("room for it");
    let boot = |number| {
        let config = BrainConfig::hosted(id(number), TeamId(1), League::DivisionB);
        let boot = |backend: &mut dyn Backend<'static>| backend.boot(&config).expect("boots");
        (id(number), [boot(&mut native), boot(&mut emulated)])
    };
    (1..=3).map(boot).collect()
}

/// Phases, and the directives of the three robots in them.
fn parts() -> Vec<(Phase<Side>, [Directive; 3])> {
    let at = |x, y| WirePoint { x, y };
    let go = |x, y| Directive::GoTo { pose: WirePose { at: at(x, y), heading: 0 } };
    let kick = KickOrder::Flat(400);
    let play = Directive::Gameplay { hint: None };
    vec![
        (Phase::Run, [play.clone(), play.clone(), play]),
        (Phase::Stop, [go(3000, 0), go(-3000, 1000), go(2000, -2500)]),
        (
            Phase::FreeKick(Side::Ours),
            [Directive::Kick { at: at(4500, 0), kick }, go(3000, 1500), go(2000, -2000)],
        ),
        (
            Phase::BallPlacement(Side::Ours),
            [Directive::PlaceBall { at: at(0, 1000) }, go(0, 0), go(-2000, 0)],
        ),
        (
            Phase::Run,
            [
                Directive::GetBall { face: None },
                Directive::Receive { at: at(1000, 1000), then: Some(at(4500, 0)) },
                Directive::Block { from: at(-4300, -500), to: at(-4300, 500) },
            ],
        ),
    ]
}

/// The true state, the host and the radio channel.
struct Table {
    world: World,
    link: HostLink,
    air: Vec<(RobotId, Packet)>,
    ticks: u32,
    flood: Option<Flood>,
    /// A beacon of each robot, as it was sent last.
    beacons: Vec<(RobotId, Packet)>,
}

impl Table {
    fn new() -> Self {
        let mut world =
            World::new(League::DivisionB, Parameters::of(League::DivisionB).expect("a league"), 7);
        for (number, x, y) in [(1_u8, -600.0, 100.0), (2, 500.0, 1200.0), (3, -200.0, -1300.0)] {
            world.put(ours(id(number)), Pose::from_mm_deg(x, y, 0.0));
        }
        for number in 0..6_u8 {
            let x = 500.0 + 600.0 * f32::from(number);
            let y = 800.0 - 500.0 * f32::from(number % 4);
            world.put(theirs(number), Pose::from_mm_deg(x, y, 180.0));
        }
        world.put_ball(Ball::at(Point::new(0.0, 0.1)));
        let mut link = HostLink::new(TeamId(1), TeamKey::ZERO, 1);
        // As many tags as in a match of six.
        link.set_audience(Audience(0b111_1110));
        Self { world, link, air: Vec::new(), ticks: 0, flood: None, beacons: Vec::new() }
    }

    fn tick(
        &mut self,
        phase: Phase<Side>,
        directives: &[Directive; 3],
        robots: &mut [(RobotId, [Box<dyn Mcu + 'static>; 2])],
        steps: &mut Vec<u32>,
        meter: &Meter,
    ) {
        self.ticks += 1;
        let (seq, now) = (self.ticks, Instant(u64::from(self.ticks) * 10_000));
        let field = League::DivisionB.field();
        if !field.contains(self.world.ball.position) {
            self.world.put_ball(Ball::at(Point::new(0.3, -0.4)));
        }
        let received = std::mem::take(&mut self.air);
        let parts = self.parts(now, phase);
        for ((robot, computers), directive) in robots.iter_mut().zip(directives) {
            let mut packets: Vec<Packet> = Vec::new();
            if seq % 100 == 1 {
                let welcome = Welcome { to: *robot, boot_epoch: 1, offset: 0 };
                packets.push(self.link.seal(now, &HostMessage::Welcome(welcome)));
            }
            packets.extend(parts.iter().cloned());
            let command = HostCommand {
                to: *robot,
                defending: GoalEnd::Negative,
                phase,
                rule_role: match robot.number() {
                    1 => RuleRole::Kicker,
                    3 => RuleRole::Keeper,
                    _ => RuleRole::Player,
                },
                directive: directive.clone(),
            };
            packets.push(self.link.seal(now, &HostMessage::Command(command)));
            packets
                .extend(received.iter().filter(|(from, _)| from != robot).map(|(_, packet)| packet.clone()));
            packets.splice(0..0, self.flooded(*robot, now, &packets));
            let sensors = self.world.sensors(ours(*robot)).expect("a robot");
            let tick = TickIn { seq, now, air: packets.iter().map(|p| &p[..]).collect(), sensors };
            let [native, emulated] = computers;
            let (a, b) = (native.exchange(&tick).expect("native"), emulated.exchange(&tick).expect("QEMU"));
            assert_eq!((&a.actuators, &a.packets), (&b.actuators, &b.packets), "robot {robot}, tick {seq}");
            steps.push(b.instructions);
            meter.note(&b);
            if let Some(order) = a.actuators {
                self.world.command(ours(*robot), &order);
            }
            // The host relays messages for teammates.
            for packet in a.packets {
                let opened = self.link.open(now, &packet);
                if let Ok(Opened::Believed(_, TeamMessage::Beacon(_) | TeamMessage::Handshake(_))) = opened {
                    if let Ok(Opened::Believed(_, TeamMessage::Beacon(_))) = opened {
                        self.beacons.retain(|(from, _)| from != robot);
                        self.beacons.push((*robot, packet.clone()));
                    }
                    self.air.push((*robot, packet));
                }
            }
        }
        for number in 0..6_u8 {
            let turn = f32::from(number) + 0.004 * seq as f32;
            let linear = Vector::<Field>::polar(0.8, geometry::Angle::new(turn));
            let drive = Drive::Global(Twist { linear, angular: 0.0 });
            self.world.order(theirs(number), Order { drive, ..Order::default() });
        }
        for _ in 0..10 {
            self.world.step();
        }
    }

    /// What floods the air before these packets for `robot`, as far as a tick has room.
    fn flooded(&mut self, robot: RobotId, now: Instant, genuine: &[Packet]) -> Vec<Packet> {
        let Some(flood) = self.flood else { return Vec::new() };
        let mut room = AIR_IN_BYTES_MAX - genuine.iter().map(|packet| packet.len()).sum::<usize>();
        let mut packets = Vec::new();
        for number in genuine.len()..AIR_IN_MAX {
            let packet = match flood {
                Flood::Elsewhere => {
                    let directive = Directive::Gameplay { hint: None };
                    let (phase, rule_role) = (Phase::Run, RuleRole::Player);
                    let command =
                        HostCommand { to: id(9), defending: GoalEnd::Negative, phase, rule_role, directive };
                    self.link.seal(now, &HostMessage::Command(command))
                }
                Flood::Beacons => {
                    let of_others: Vec<_> = self.beacons.iter().filter(|(from, _)| *from != robot).collect();
                    let Some((_, beacon)) = of_others.get(number % of_others.len().max(1)) else { break };
                    let frame = Frame::parse(beacon, TeamId(1)).expect("a frame");
                    let counter = 1_000_000 + self.ticks * 64 + number as u32;
                    Frame { counter, ..frame }.emit(&TeamKey::ZERO.of_robot(robot).team).expect("fits")
                }
                Flood::ForgedHost => {
                    let Some(first) = genuine.iter().find(|packet| packet.len() > 100) else { break };
                    let mut forged = first.clone();
                    // In the payload.
                    forged[40] ^= 1 + number as u8;
                    forged
                }
            };
            let Some(left) = room.checked_sub(packet.len()) else { break };
            room = left;
            packets.push(packet);
        }
        packets
    }

    /// The snapshot, sealed.
    fn parts(&mut self, now: Instant, phase: Phase<Side>) -> Vec<Packet> {
        let ball = &self.world.ball;
        let ball = WireBall {
            at: ball.position.into(),
            height: (ball.height * 1000.0) as u16,
            vx: to_mm(ball.velocity.x()),
            vy: to_mm(ball.velocity.y()),
        };
        let wire = |robot: &hil_sim::small_size::Robot| WireRobot {
            who: WireWho {
                side: if robot.who.colour == Colour::Blue { Side::Ours } else { Side::Theirs },
                id: robot.who.id,
            },
            pose: robot.pose.into(),
            vx: to_mm(robot.velocity.x()),
            vy: to_mm(robot.velocity.y()),
        };
        let robots: Vec<_> = self.world.robots().iter().map(wire).collect();
        let chunks = robots.chunks(PART_ROBOTS_MAX);
        let (count, snapshot) = (chunks.len() as u8, self.ticks as u8);
        let part = |(part, robots): (u8, &[WireRobot])| WorldPart {
            snapshot,
            part,
            parts: count,
            phase,
            placement: Some(WirePoint { x: 0, y: 1000 }),
            ball: Some(ball),
            robots: robots.iter().copied().collect(),
        };
        let parts: Vec<_> = (0..count).zip(chunks).map(part).collect();
        parts.into_iter().map(|part| self.link.seal(now, &HostMessage::World(part))).collect()
    }
}

fn id(number: u8) -> RobotId {
    RobotId::new(number).expect("an id")
}

fn ours(id: RobotId) -> Who {
    Who { colour: Colour::Blue, id }
}

fn theirs(number: u8) -> Who {
    Who { colour: Colour::Yellow, id: id(number) }
}

/// The firmware image, built where it is missing or old.
static IMAGE: LazyLock<PathBuf> = LazyLock::new(|| {
    let root = firmware_build::workspace_root();
    firmware_build::build_image(&root, firmware_build::ImageBody::Omni)
        .unwrap_or_else(|error| panic!("{error}"))
});
