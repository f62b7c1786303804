//! Can anybody who does not have the key, or has only a recording, make a robot or a host believe something? 10^5 tries.

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
const TRIES: u32 = 100_000;

fn robot(n: u8) -> RobotId {
    RobotId::new(n).unwrap()
}

/// The welcome first: without it the robot believes no host.
fn messages(n: u32) -> [HostMessage; 3] {
    let (phase, directive) = (Phase::Run, Directive::GetBall { face: None });
    let robots = heapless::Vec::new();
    let picture = n as u8;
    [
        HostMessage::Welcome(Welcome { to: robot(2), life: 9 }),
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
}

impl Team {
    fn new() -> Self {
        let mut team = Self {
            robot: Link::new(TEAM, robot(2), KEY, 9),
            mate: Link::new(TEAM, robot(3), KEY, 4),
            host: HostLink::new(TEAM, KEY, 70),
            recorded: Vec::new(),
        };
        // Mates believe each other once they have greeted.
        let (first, second) = (team.robot.seal(&telemetry(0)), team.mate.seal(&telemetry(0)));
        assert!(team.robot.open(&second).is_err() && team.mate.open(&first).is_err());
        let greeting = team.mate.poll_greeting(Instant(0)).unwrap();
        assert!(team.robot.open(&greeting).is_ok() && team.host.open(&greeting).is_ok());
        team.recorded.extend([first, second, greeting]);
        for n in 0..100 {
            team.speak(n);
        }
        team
    }

    /// Everybody says something, and everybody else believes it.
    fn speak(&mut self, n: u32) {
        let said = messages(n).map(|message| self.host.seal(&message));
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

#[test]
fn of_a_hundred_thousand_forged_replayed_and_foreign_frames_none_is_believed() {
    let mut team = Team::new();
    let mut dice = Xoshiro256PlusPlus::seed_from_u64(11);
    let mut draw = |n: usize| (dice.next_u64() % n as u64) as usize;
    // Kinds tried: so that no kind is left out by chance.
    let mut tried = [0; 7];
    for n in 0..TRIES {
        let recorded = team.recorded[draw(team.recorded.len())].clone();
        let mut bytes = recorded.to_vec();
        let kind = draw(tried.len());
        tried[kind] += 1;
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
            team.speak(100 + n);
        }
    }
    assert!(tried.iter().all(|tries| *tries > TRIES / 10), "{tried:?}");
}

#[test]
fn a_robot_that_boots_anew_believes_no_recording_of_its_host() {
    let team = Team::new();
    for life in [8, 10, u32::MAX] {
        let mut booted = Link::new(TEAM, robot(2), KEY, life);
        let host = |packet: &&Packet| Frame::parse(packet, TEAM).is_ok_and(|f| f.sender == Sender::Host);
        for packet in team.recorded.iter().filter(host) {
            assert!(booted.open(packet).is_err());
        }
    }
}

fn forged(draw: &mut impl FnMut(usize) -> usize) -> Vec<u8> {
    let message = messages(0)[draw(3)].clone();
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
