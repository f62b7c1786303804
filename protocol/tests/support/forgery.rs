//! Tries at making a robot or its host believe something without the key, or with no more than recordings; of lives that are over
//! too: robots boot anew all the while.

use geometry::GoalEnd;
use protocol::frame::{Frame, HEADER_LEN, Sender, TAG_LEN, TeamKey};
use protocol::host::{Command, Directive, Duty, HostMessage, Telemetry, Welcome, WorldPart};
use protocol::host_link::HostLink;
use protocol::link::{Link, Packet};
use protocol::team::TeamMessage;
use protocol::{Instant, RobotId, TeamId};
use rand_core::{RngCore as _, SeedableRng as _};
use rand_xoshiro::Xoshiro256PlusPlus;
use rules::Phase;

const TEAM: TeamId = TeamId(1);
const KEY: TeamKey = TeamKey([0x5a; 16]);
/// Of the robot.
const FIRST_LIFE: u32 = 9;

fn robot(n: u8) -> RobotId {
    RobotId::new(n).unwrap()
}

/// The welcome first: without it the robot believes no host.
fn messages(n: u32, life: u32) -> [HostMessage; 3] {
    let (phase, directive) = (Phase::Run, Directive::GetBall { face: None });
    let robots = heapless::Vec::new();
    let picture = n as u8;
    [
        HostMessage::Welcome(Welcome { to: robot(2), life }),
        HostMessage::Command(Command {
            to: robot(2),
            defending: GoalEnd::Negative,
            phase,
            duty: Duty::Player,
            directive,
        }),
        HostMessage::World(WorldPart {
            picture,
            part: 0,
            parts: 1,
            phase,
            placement: None,
            ball: None,
            robots,
        }),
    ]
}

fn telemetry(n: u32) -> TeamMessage {
    TeamMessage::Telemetry(Telemetry { battery: n as u16, ..Telemetry::default() })
}

/// The team: robot 2, its mate 3, their host, all genuine and acquainted; and all they have said so far.
struct Team {
    robot: Link,
    mate: Link,
    host: HostLink,
    recorded: Vec<Packet>,
    /// The robot's life.
    life: u32,
    /// Their clock, µs: a tick for every word.
    now: u64,
}

impl Team {
    fn new() -> Self {
        let mut team = Self {
            robot: Link::new(TEAM, robot(2), KEY, FIRST_LIFE),
            mate: Link::new(TEAM, robot(3), KEY, 4),
            host: HostLink::new(TEAM, KEY, 70),
            recorded: Vec::new(),
            life: FIRST_LIFE,
            now: 0,
        };
        team.greet();
        for n in 0..100 {
            team.speak(n);
        }
        team
    }

    /// Mates believe each other once they have greeted.
    fn greet(&mut self) {
        self.now += 100_000;
        let (first, second) = (self.robot.seal(&telemetry(0)), self.mate.seal(&telemetry(0)));
        assert!(self.robot.open(&second).is_err() && self.host.open(&second).is_ok());
        // To the mate a new life is a stranger, and it greets it.
        assert!(self.mate.open(&first).is_err() && self.host.open(&first).is_ok());
        let greeting = self.mate.poll_greeting(Instant(self.now)).unwrap();
        assert!(self.robot.open(&greeting).is_ok() && self.host.open(&greeting).is_ok());
        self.recorded.extend([first, second, greeting]);
    }

    /// The robot boots anew: at once every recording is tried, then its mates make its acquaintance.
    fn boot(&mut self, tally: &mut Tally) {
        self.life += 1;
        self.robot = Link::new(TEAM, robot(2), KEY, self.life);
        for packet in &self.recorded {
            assert!(self.robot.open(packet).is_err(), "after a boot: {packet:02x?}");
        }
        tally.after_boots += self.recorded.len() as u64;
        self.greet();
    }

    /// Everybody says something, and everybody else believes it.
    fn speak(&mut self, n: u32) {
        let said = messages(n, self.life).map(|message| self.host.seal(&message));
        for packet in &said {
            assert!(self.robot.open(packet).is_ok());
        }
        let (own, mates) = (self.robot.seal(&telemetry(n)), self.mate.seal(&telemetry(n)));
        assert!(self.host.open(&own).is_ok() && self.host.open(&mates).is_ok());
        assert!(self.robot.open(&mates).is_ok());
        self.recorded.extend(said);
        self.recorded.extend([own, mates]);
    }

    fn believes(&mut self, packet: &[u8]) -> bool {
        self.robot.open(packet).is_ok() || self.host.open(packet).is_ok()
    }
}

/// What was tried.
#[derive(Debug, Default)]
pub(crate) struct Tally {
    /// By kind: as it was said; flipped bits; a newer counter; a newer epoch; another length; another name; made from nothing.
    pub kinds: [u64; 7],
    /// Recordings heard by a robot that had just booted, and how often it booted.
    pub after_boots: u64,
    /// See there.
    pub boots: u32,
}

/// So many tries; panics with the first frame that is believed.
pub(crate) fn tries(count: u64, seed: u64) -> Tally {
    let mut tally = Tally::default();
    let mut team = Team::new();
    let mut dice = Xoshiro256PlusPlus::seed_from_u64(seed);
    let mut draw = |n: usize| (dice.next_u64() % n as u64) as usize;
    for n in 0..count {
        let recorded = team.recorded[draw(team.recorded.len())].clone();
        let mut bytes = recorded.to_vec();
        let kind = draw(tally.kinds.len());
        tally.kinds[kind] += 1;
        match kind {
            // As it was said.
            0 => {}
            // A bit or a few, anywhere.
            1 => (0..=draw(3)).for_each(|_| bytes[draw(recorded.len())] ^= 1 << draw(8)),
            // A counter or epoch that would be news.
            2 => bytes[7..11].copy_from_slice(&u32::MAX.to_le_bytes()),
            3 => bytes[3..7].copy_from_slice(&u32::MAX.to_le_bytes()),
            // Shorter, or longer.
            4 if draw(2) == 0 => bytes.truncate(draw(recorded.len())),
            4 => bytes.resize(recorded.len() + 1 + draw(30), 0),
            // Somebody else's name, news too.
            5 => {
                bytes[2] = (bytes[2] + 1 + draw(16) as u8) % 17;
                bytes[7..11].copy_from_slice(&(1_u32 << 30).to_le_bytes());
            }
            // A frame made from nothing with a guessed key and a guessed tag.
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
            team.boot(&mut tally);
            tally.boots += 1;
            team.speak(n as u32);
        }
    }
    tally
}

fn forged(draw: &mut impl FnMut(usize) -> usize) -> Vec<u8> {
    let message = messages(0, FIRST_LIFE)[draw(3)].clone();
    let mut payload = [0; 101];
    let payload = &*postcard::to_slice(&message, &mut payload).unwrap();
    let sender = Sender::new(draw(Sender::COUNT) as u8).unwrap();
    let (epoch, counter) = ([70, 71, 9, 4, 5][draw(5)], 10_000 + draw(1_000_000) as u32);
    let frame = Frame { team: TEAM, sender, epoch, counter, payload };
    let mut out = vec![0; HEADER_LEN + payload.len() + TAG_LEN];
    let key = TeamKey(std::array::from_fn(|_| draw(256) as u8));
    frame.emit(&key, &mut out).unwrap();
    out
}
