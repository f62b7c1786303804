//! Tries at making a robot or its host accept a frame without the key, or with no more than recordings; of
//! earlier boot epochs too: robots and hosts restart repeatedly.

use geometry::GoalEnd;
use protocol::frame::{Audience, Frame, Sender, TeamKey};
use protocol::host::{Directive, HostCommand, HostMessage, RuleRole, Telemetry, Welcome, WorldPart};
use protocol::host_link::{HostLink, Opened};
use protocol::link::{Link, Packet, Received};
use protocol::quantized::WirePose;
use protocol::team::{Beacon, Progress, Role, Status, TeamMessage};
use protocol::{Instant, RobotId, TeamId};
use rand_core::{RngCore as _, SeedableRng as _};
use rand_xoshiro::Xoshiro256PlusPlus;
use rules::Phase;

const TEAM: TeamId = TeamId(1);
const KEY: TeamKey = TeamKey([0x5a; 16]);
const FIRST_BOOT_EPOCH: u32 = 9;
/// First epoch of the host.
const FIRST_HOST: u32 = 70;

fn robot(n: u8) -> RobotId {
    RobotId::new(n).unwrap()
}

/// The welcome first: without it the robot trusts no host.
fn messages(n: u32, welcome: Welcome) -> [HostMessage; 3] {
    let (phase, directive) = (Phase::Run, Directive::GetBall { face: None });
    let robots = heapless::Vec::new();
    let snapshot = n as u8;
    [
        HostMessage::Welcome(welcome),
        HostMessage::Command(HostCommand {
            to: robot(2),
            defending: GoalEnd::Negative,
            phase,
            rule_role: RuleRole::Player,
            directive,
        }),
        HostMessage::World(WorldPart {
            snapshot,
            part: 0,
            parts: 1,
            phase,
            placement: None,
            ball: None,
            robots,
        }),
    ]
}

fn beacon(n: u32) -> TeamMessage {
    TeamMessage::Beacon(Beacon {
        pose: WirePose::default(),
        ball: None,
        status: Status::AVAILABLE,
        case_base: n,
        cycle: None,
        progress: Progress::Idle,
        role: Role::None,
    })
}

fn telemetry(link: &mut Link, now: Instant) -> Packet {
    let mut telemetry = Telemetry::default();
    link.report(now, &mut telemetry);
    link.seal(&TeamMessage::Telemetry(telemetry))
}

/// The team: robot 2, its teammate 3, their host, all genuine and after their handshakes; and all their
/// messages so far.
struct Team {
    robot: Link,
    teammate: Link,
    host: HostLink,
    recorded: Vec<Packet>,
    /// The robot's boot epoch, and the host's.
    boot_epoch: u32,
    host_boot_epoch: u32,
    /// Clock of the team.
    now: Instant,
}

impl Team {
    fn new() -> Self {
        let link = |n, epoch| Link::new(TEAM, robot(n), KEY.of_robot(robot(n)), epoch);
        let mut team = Self {
            robot: link(2, FIRST_BOOT_EPOCH),
            teammate: link(3, 4),
            host: host(FIRST_HOST),
            recorded: Vec::new(),
            boot_epoch: FIRST_BOOT_EPOCH,
            host_boot_epoch: FIRST_HOST,
            now: Instant(0),
        };
        team.meet_host();
        team.shake_hands();
        for n in 0..100 {
            team.speak(n);
        }
        team
    }

    /// Robots trust a host once it has welcomed them, and it trusts them once they name it.
    fn meet_host(&mut self) {
        self.now.0 += 100_000;
        for (link, id) in [(&mut self.robot, robot(2)), (&mut self.teammate, robot(3))] {
            let first = telemetry(link, self.now);
            let _believed_or_not = self.host.open(self.now, &first);
            let welcome = self.host.welcome(id).map(HostMessage::Welcome).unwrap();
            let welcome = self.host.seal(self.now, &welcome);
            assert!(link.open(self.now, &welcome).is_ok());
            let second = telemetry(link, self.now);
            assert!(matches!(self.host.open(self.now, &second), Ok(Opened::Believed(..))));
            self.recorded.extend([first, welcome, second]);
        }
    }

    /// Teammates trust each other after their handshakes.
    fn shake_hands(&mut self) {
        self.now.0 += 100_000;
        let (first, second) = (self.robot.seal(&beacon(0)), self.teammate.seal(&beacon(0)));
        assert!(self.robot.open(self.now, &second).is_err() && self.host.open(self.now, &second).is_ok());
        // To the teammate a new epoch is an unauthenticated peer, and it sends a handshake.
        assert!(self.teammate.open(self.now, &first).is_err() && self.host.open(self.now, &first).is_ok());
        let handshake = self.teammate.poll_handshake(self.now).unwrap();
        assert!(
            self.robot.open(self.now, &handshake).is_ok() && self.host.open(self.now, &handshake).is_ok()
        );
        self.recorded.extend([first, second, handshake]);
    }

    /// The robot boots, then the host restarts: each time every recording is tried, then the handshakes are
    /// made.
    fn boot(&mut self, counters: &mut Counters) {
        (self.boot_epoch, self.host_boot_epoch) = (self.boot_epoch + 1, self.host_boot_epoch + 1);
        self.robot = Link::new(TEAM, robot(2), KEY.of_robot(robot(2)), self.boot_epoch);
        for packet in &self.recorded {
            let opened = self.robot.open(self.now, packet);
            assert!(
                !matches!(opened, Ok(Received::Host(..) | Received::Teammate(..))),
                "after a boot: {packet:02x?}"
            );
        }
        counters.after_boots += self.recorded.len() as u64;
        self.meet_host();
        self.shake_hands();
        self.host = host(self.host_boot_epoch);
        for packet in &self.recorded {
            let opened = self.host.open(self.now, packet);
            assert!(!matches!(opened, Ok(Opened::Believed(..))), "a fresh host: {packet:02x?}");
        }
        counters.to_fresh_hosts += self.recorded.len() as u64;
        self.meet_host();
    }

    /// Each sends a message, and all others accept it.
    fn speak(&mut self, n: u32) {
        self.now.0 += 10_000;
        let now = self.now;
        let welcome = self.host.welcome(robot(2)).unwrap();
        let sent = messages(n, welcome).map(|message| self.host.seal(now, &message));
        for packet in &sent {
            assert!(matches!(self.robot.open(now, packet), Ok(Received::Host(..))));
        }
        let (own, teammates) = (telemetry(&mut self.robot, now), self.teammate.seal(&beacon(n)));
        for packet in [&own, &teammates] {
            assert!(matches!(self.host.open(now, packet), Ok(Opened::Believed(..))));
        }
        assert!(matches!(self.robot.open(now, &teammates), Ok(Received::Teammate(..))));
        self.recorded.extend(sent);
        self.recorded.extend([own, teammates]);
    }

    fn believes(&mut self, packet: &[u8]) -> bool {
        matches!(self.robot.open(self.now, packet), Ok(Received::Host(..) | Received::Teammate(..)))
            || matches!(self.host.open(self.now, packet), Ok(Opened::Believed(..)))
    }
}

fn host(epoch: u32) -> HostLink {
    let mut host = HostLink::new(TEAM, KEY, epoch);
    host.set_audience(Audience(0b1100));
    host
}

/// Counters of the tries.
#[derive(Debug, Default)]
pub(crate) struct Counters {
    /// By kind: as it was sent; flipped bits; a newer counter; a newer epoch; another length; another name;
    /// made from nothing.
    pub kinds: [u64; 7],
    /// Recordings received by a robot that had just booted.
    pub after_boots: u64,
    /// Number of its boots.
    pub boots: u32,
    /// Recordings received by a host that had just started.
    pub to_fresh_hosts: u64,
}

/// Runs `count` tries; panics with the first frame that is accepted.
pub(crate) fn tries(count: u64, seed: u64) -> Counters {
    let mut counters = Counters::default();
    let mut team = Team::new();
    let mut dice = Xoshiro256PlusPlus::seed_from_u64(seed);
    let mut draw = |n: usize| (dice.next_u64() % n as u64) as usize;
    for n in 0..count {
        let recorded = team.recorded[draw(team.recorded.len())].clone();
        let mut bytes = recorded.to_vec();
        let kind = draw(counters.kinds.len());
        counters.kinds[kind] += 1;
        match kind {
            // As it was sent.
            0 => {}
            // A bit or a few, anywhere.
            1 => (0..=draw(3)).for_each(|_| bytes[draw(recorded.len())] ^= 1 << draw(8)),
            // A counter or epoch that would be new.
            2 => bytes[7..11].copy_from_slice(&u32::MAX.to_le_bytes()),
            3 => bytes[3..7].copy_from_slice(&u32::MAX.to_le_bytes()),
            // Shorter, or longer.
            4 if draw(2) == 0 => bytes.truncate(draw(recorded.len())),
            4 => bytes.resize(recorded.len() + 1 + draw(30), 0),
            // The name of another sender, new too.
            5 => {
                bytes[2] = (bytes[2] + 1 + draw(17) as u8) % 18;
                bytes[7..11].copy_from_slice(&(1_u32 << 30).to_le_bytes());
            }
            // A frame made with a guessed key and a guessed tag.
            _ => bytes = forged(&mut draw),
        }
        if bytes[..] == recorded[..] && kind != 0 {
            continue;
        }
        assert!(!team.believes(&bytes), "try {n}, kind {kind}: {bytes:02x?}");
        if n % 1000 == 0 {
            team.speak(n as u32);
        }
        if n % 20_000 == 19_999 {
            team.boot(&mut counters);
            counters.boots += 1;
            team.speak(n as u32);
        }
    }
    counters
}

fn forged(draw: &mut impl FnMut(usize) -> usize) -> Vec<u8> {
    let message =
        messages(0, Welcome { to: robot(2), boot_epoch: FIRST_BOOT_EPOCH, offset: 0 })[draw(3)].clone();
    let mut payload = [0; 101];
    let payload = &*postcard::to_slice(&message, &mut payload).unwrap();
    let sender = Sender::new(draw(Sender::COUNT) as u8).unwrap();
    let (epoch, counter) = ([70, 71, 9, 4, 5][draw(5)], 10_000 + draw(1_000_000) as u32);
    let audience = (sender == Sender::Host && draw(2) == 0).then_some(Audience(0b1100));
    let frame = Frame { team: TEAM, sender, audience, epoch, counter, payload };
    let key = TeamKey(std::array::from_fn(|_| draw(256) as u8));
    let keys = key.of_team();
    let out = if audience.is_some() { frame.emit_to_audience(&keys) } else { frame.emit(keys.team()) };
    out.unwrap().to_vec()
}
