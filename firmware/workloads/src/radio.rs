//! `radio`: tasks of the radio benchmark, one robot's end of it: each kind of message sealed and
//! opened, shortest and longest, and frames refused. The same frames in the bench's firmware (`radio-bench`
//! of the QEMU board) and in `cargo xtask bench radio`, which drives it.

use geometry::GoalEnd;
use protocol::frame::{Audience, TeamKey};
use protocol::host::{
    Condition, Directive, Hint, HostCommand, HostMessage, PART_ROBOTS_MAX, RuleRole, Telemetry, Welcome,
    WireBall, WireRobot, WireWho, WorldPart,
};
use protocol::host_link::HostLink;
use protocol::link::{Link, Packet, Received};
use protocol::quantized::{WirePoint, WirePose};
use protocol::team::{
    BallQuality, BallReport, Beacon, CycleState, Decision, Play, Progress, Role, Status, TeamMessage,
};
use protocol::{CaseId, CycleId, Instant, RobotId, TeamId};
use rules::{Phase, Side};

/// Number of repetitions of each work.
pub const ROUNDS: usize = 20;

geometry::labels! {
    /// One operation of a robot's radio.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum Work {
        /// Seals the first message after a boot.
        SealShort = "seal a short beacon",
        /// Seals the longest beacon.
        SealLong = "seal the longest beacon",
        /// Seals the robot's telemetry to the host.
        SealTelemetry = "seal telemetry",
        /// Opens the shortest command.
        OpenCommand = "open a short command",
        /// Opens the longest command.
        OpenLongCommand = "open the longest command",
        /// Opens a teammate's short beacon.
        OpenShort = "open a short beacon",
        /// Opens a teammate's longest beacon.
        OpenLong = "open the longest beacon",
        /// Opens a part of the world with one robot in it.
        OpenSmallWorld = "open a world part with one robot",
        /// Opens a full part of the world.
        OpenWorld = "open a full world part",
        /// Skips a command to another robot.
        Skip = "skip a command to another robot",
        /// Refuses a frame that was received before.
        RefuseReplay = "refuse a replay",
        /// Refuses a forged frame of a teammate, as long as its longest.
        RefuseForged = "refuse a forged frame",
    }
}

impl Work {
    /// Returns whether the work opens or refuses a frame; else it seals one.
    pub const fn opens(self) -> bool {
        !matches!(self, Self::SealShort | Self::SealLong | Self::SealTelemetry)
    }
}

/// A robot, its teammate and its host, after their handshakes.
pub struct Bench {
    robot: Link,
    teammate: Link,
    host: HostLink,
}

/// A work with its inputs.
pub struct RadioTask<'b> {
    link: &'b mut Link,
    /// Frame to open; empty for works that seal.
    packet: Packet,
    message: Option<TeamMessage>,
}

impl Bench {
    /// A bench with a key that is not all zeros.
    pub fn new() -> Self {
        let (team, key) = (TeamId(2), TeamKey(core::array::from_fn(|i| 7 * i as u8 + 1)));
        let mut bench = Self {
            robot: Link::new(team, id(2), key.of_robot(id(2)), 9),
            teammate: Link::new(team, id(3), key.of_robot(id(3)), 4),
            host: HostLink::new(team, key, 70),
        };
        // Six robots play, as in division B.
        bench.host.set_audience(Audience(0b11_1111));
        let welcome = HostMessage::Welcome(Welcome { to: id(2), boot_epoch: 9, offset: 0 });
        let _welcomed = bench.robot.open(NOW, &bench.host.seal(NOW, &welcome));
        // The teammate receives a first frame and sends a handshake; the receiver of a handshake trusts its
        // sender.
        let first = bench.robot.seal(&short());
        let _received = bench.teammate.open(NOW, &first);
        if let Some(handshake) = bench.teammate.poll_handshake(Instant(0)) {
            let _greeted = bench.robot.open(NOW, &handshake);
        }
        bench
    }

    /// Prepares a task: only [`RadioTask::run`] is measured.
    pub fn task(&mut self, work: Work) -> RadioTask<'_> {
        let Self { robot, teammate, host } = self;
        let mut message = None;
        let mut packet = Packet::new();
        match work {
            Work::SealShort => message = Some(short()),
            Work::SealLong => message = Some(long()),
            Work::SealTelemetry => message = Some(telemetry()),
            Work::OpenCommand => packet = host.seal(NOW, &command(2, Directive::Stand)),
            Work::OpenLongCommand => packet = host.seal(NOW, &command(2, longest())),
            Work::OpenShort => packet = teammate.seal(&short()),
            Work::OpenLong => packet = teammate.seal(&long()),
            Work::OpenSmallWorld => packet = host.seal(NOW, &world(1)),
            Work::OpenWorld => packet = host.seal(NOW, &world(PART_ROBOTS_MAX)),
            Work::Skip => packet = host.seal(NOW, &command(3, longest())),
            Work::RefuseReplay => {
                packet = teammate.seal(&long());
                let _believed = robot.open(NOW, &packet);
            }
            Work::RefuseForged => {
                packet = teammate.seal(&long());
                if let Some(last) = packet.last_mut() {
                    *last ^= 1;
                }
            }
        }
        RadioTask { link: robot, packet, message }
    }
}

impl Default for Bench {
    fn default() -> Self {
        Self::new()
    }
}

impl RadioTask<'_> {
    /// Runs the work; returns the frame's length, and 1,000 more where a frame was accepted.
    #[inline(never)]
    pub fn run(&mut self) -> u32 {
        if let Some(message) = &self.message {
            return self.link.seal(message).len() as u32;
        }
        let believed =
            matches!(self.link.open(NOW, &self.packet), Ok(Received::Teammate(..) | Received::Host(..)));
        self.packet.len() as u32 + 1_000 * u32::from(believed)
    }
}

/// An arbitrary time, late enough for every lease.
const NOW: Instant = Instant(12_345_678);

fn id(number: u8) -> RobotId {
    RobotId::new(number).unwrap_or(RobotId::ZERO)
}

const FAR_POINT: WirePoint = WirePoint { x: -12_345, y: 23_456 };

fn short() -> TeamMessage {
    TeamMessage::Beacon(Beacon {
        pose: WirePose { at: FAR_POINT, heading: 1571 },
        ball: None,
        status: Status::AVAILABLE,
        case_base: 0x1234_5678,
        cycle: None,
        progress: Progress::Idle,
        role: Role::None,
    })
}

fn long() -> TeamMessage {
    let play =
        Play { case: CaseId(300), ball: FAR_POINT, robots: [1, 3, 5, 7].map(id).into_iter().collect() };
    TeamMessage::Beacon(Beacon {
        pose: WirePose { at: FAR_POINT, heading: 1571 },
        ball: Some(BallReport { at: FAR_POINT, distance: 999, quality: BallQuality::default() }),
        status: Status::AVAILABLE,
        case_base: 0x1234_5678,
        cycle: Some(CycleState {
            id: CycleId { counter: 70_000, proposer: id(1) },
            coordinator: id(3),
            decision: Decision::Play(play),
        }),
        progress: Progress::Execute { done: 2 },
        role: Role::Attacker,
    })
}

fn telemetry() -> TeamMessage {
    let condition = Condition::BALL_CONTACT.with(Condition::KICKER_READY);
    TeamMessage::Telemetry(Telemetry { condition, battery: 1580, received: 999, ..Telemetry::default() })
}

fn command(to: u8, directive: Directive) -> HostMessage {
    let (defending, phase) = (GoalEnd::Negative, Phase::FreeKick(Side::Ours));
    HostMessage::Command(HostCommand { to: id(to), defending, phase, rule_role: RuleRole::Player, directive })
}

fn longest() -> Directive {
    let robots = [1, 3, 5, 7].map(id).into_iter().collect();
    Directive::Gameplay { hint: Some(Hint { case: CaseId(u16::MAX), robots, pass_point: Some(FAR_POINT) }) }
}

fn world(robots: usize) -> HostMessage {
    let pose = WirePose { at: FAR_POINT, heading: -3 };
    let robot = WireRobot { who: WireWho { side: Side::Theirs, id: id(4) }, pose, vx: 1234, vy: -1234 };
    HostMessage::World(WorldPart {
        snapshot: 7,
        part: 0,
        parts: 2,
        phase: Phase::FreeKick(Side::Ours),
        placement: Some(FAR_POINT),
        ball: Some(WireBall { at: FAR_POINT, height: 150, vx: 3000, vy: -3000 }),
        robots: core::iter::repeat_n(robot, robots).collect(),
    })
}
