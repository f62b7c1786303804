//! `virtual_robot_cli`: tests of virtual robots in processes of their own: they obey the host in a simulator
//! that is reached by the league's protocol alone, are restarted when they end, and end with their host.
//!
//! The host's radio and link on one side, the sans-IO simulator with sockets on the other, the built program
//! between.
// Processes are checked and killed by `kill`.
#![cfg(unix)]

use std::net::UdpSocket;
use std::process::Command as Process;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant as Clock};

use geometry::{Angle, Field, GoalEnd, Point, Pose};
use hil_sim::small_size::compatibility::Profile;
use hil_sim::small_size::server::{Destination, Port, Server, ServerSettings};
use host::radio::{Radio, RadioSettings, RadioSituation, Relay, To};
use host::shell::{Link as _, SimLink, SimSettings};
use host::world::{BallModels, Robot, World};
use protocol::frame::TeamKey;
use protocol::host::{Directive, HostCommand, RuleRole};
use protocol::{Instant, RobotId, TeamId, Who};
use rules::{Colour, League, Phase};

const US: Colour = Colour::Blue;
const KEY: TeamKey = TeamKey([5; 16]);
const ROBOTS: [u8; 3] = [0, 2, 5];

fn id(n: u8) -> RobotId {
    RobotId::new(n).unwrap()
}

/// Where each robot is ordered to go, m.
fn target(robot: RobotId) -> Point<Field> {
    Point::new(-2.5, f32::from(robot.number()) * 0.6 - 1.5)
}

/// The simulator behind a socket, in real time; publishes its truth as a tracker would.
fn simulate(profile: Profile, socket: &UdpSocket, displayed: &Mutex<World>, end: &AtomicBool) {
    let settings = ServerSettings::of(League::DivisionB, profile, 7, 0.0).unwrap();
    let mut server = Server::new(&settings);
    // Robots without a host are removed; grSim's answers still name them.
    for who in server.world().robots().iter().map(|robot| robot.who).collect::<Vec<_>>() {
        if who.colour != US || !ROBOTS.contains(&who.id.number()) {
            server.world_mut().remove(who);
        }
    }
    let start = Clock::now();
    socket.set_read_timeout(Some(Duration::from_millis(1))).unwrap();
    let mut bytes = [0; 4096];
    while !end.load(Ordering::Relaxed) {
        if let Ok((len, from)) = socket.recv_from(&mut bytes) {
            server.handle(Port::Team(US), from, &bytes[..len]);
        }
        let now = Instant(start.elapsed().as_micros() as u64);
        server.advance(now);
        while let Some(sent) = server.poll_transmit() {
            if let Destination::Reply { to, .. } = sent.to {
                socket.send_to(&sent.bytes, to).unwrap();
            }
        }
        let mut world = World::empty(now, BallModels::default());
        for robot in ROBOTS {
            let Some(seen) = server.world().robot(Who::blue(id(robot))) else { continue };
            let pose: Pose<Field> = seen.pose;
            world.put(Robot {
                who: Who { colour: US, id: id(robot) },
                pose,
                velocity: seen.velocity,
                angular: 0.0,
                confidence: 1.0,
                seen: now,
            });
        }
        *displayed.lock().unwrap() = world;
    }
}

/// A host that orders every robot to go to its target.
struct Team {
    radio: Radio,
    link: SimLink,
    start: Clock,
    offered: Instant,
}

impl Team {
    fn start(simulator: &UdpSocket) -> Self {
        let settings = SimSettings {
            program: env!("CARGO_BIN_EXE_onetwo").into(),
            colour: US,
            league: League::DivisionB,
            robots: ROBOTS.map(id).to_vec(),
            simulator: simulator.local_addr().unwrap(),
            key: KEY,
            more: Vec::new(),
        };
        let link = SimLink::start(settings).unwrap();
        assert_eq!(link.relay(), Relay::ToEach);
        let settings =
            RadioSettings { key: KEY, relay: link.relay(), ..RadioSettings::new(TeamId::of(US), 1) };
        Self { radio: Radio::new(settings), link, start: Clock::now(), offered: Instant(0) }
    }

    fn now(&self) -> Instant {
        Instant(self.start.elapsed().as_micros() as u64)
    }

    /// One turn: receives the robots' reports, sends a snapshot every 10 ms.
    fn turn(&mut self, displayed: &Mutex<World>) {
        if let Some(frame) = self.link.receive(Duration::from_millis(1)).unwrap() {
            let _refused = self.radio.handle_packet(self.now(), &frame);
        }
        let now = self.now();
        if now.since(self.offered).0 >= 10_000 {
            self.offered = now;
            let mut world = displayed.lock().unwrap().clone();
            world.time = now;
            let situation = RadioSituation { us: US, phase: Phase::Run, placement: None };
            let commands = ROBOTS.map(|robot| {
                let pose = Pose { position: target(id(robot)), heading: Angle::new(0.0) };
                let directive = Directive::GoTo { pose: pose.into() };
                let (phase, rule_role, defending) = (Phase::Run, RuleRole::Player, GoalEnd::Negative);
                HostCommand { to: id(robot), defending, phase, rule_role, directive }
            });
            self.radio.offer(now, &world, situation, &commands);
        }
        self.radio.handle_timeout(now);
        while let Some((to, packet)) = self.radio.poll_packet() {
            assert!(packet.len() <= 120 && (to == To::All || packet.len() <= 64));
            self.link.send(to, &packet).unwrap();
        }
    }

    /// Turns until `done`, for at most `seconds`; a busy machine needs longer than the robots.
    fn until(
        &mut self,
        displayed: &Mutex<World>,
        seconds: u64,
        mut done: impl FnMut(&mut Self) -> bool,
    ) -> bool {
        let end = Clock::now() + Duration::from_secs(seconds);
        while Clock::now() < end {
            self.turn(displayed);
            if done(self) {
                return true;
            }
        }
        false
    }
}

fn arrived(displayed: &Mutex<World>) -> bool {
    let world = displayed.lock().unwrap();
    ROBOTS.iter().all(|robot| {
        world.robot(Who { colour: US, id: id(*robot) }).is_some_and(|robot| {
            robot.pose.position.distance(target(robot.who.id)) < 0.1 && robot.velocity.norm() < 0.1
        })
    })
}

fn lives(process: u32) -> bool {
    Process::new("kill").args(["-0", &process.to_string()]).output().is_ok_and(|out| out.status.success())
}

fn play(profile: Profile) {
    let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
    let displayed = Mutex::new(World::empty(Instant(0), BallModels::default()));
    let end = AtomicBool::new(false);
    std::thread::scope(|scope| {
        scope.spawn(|| simulate(profile, &socket, &displayed, &end));
        let mut team = Team::start(&socket);
        let there = team.until(&displayed, 60, |_| arrived(&displayed));
        let rows = ROBOTS.iter().filter_map(|n| Some((id(*n), team.radio.quality(id(*n))?)));
        println!("{}", host::radio::table(rows, team.radio.foreign()));
        assert!(there, "{:?}", displayed.lock().unwrap());
        assert_eq!(team.radio.present(team.now()).collect::<Vec<_>>(), ROBOTS.map(id));

        // One is killed: it is reported, started again, and welcomed again.
        let (robot, process) = team.link.processes().next().unwrap();
        let before = team.radio.quality(robot).unwrap().lives();
        assert!(Process::new("kill").args(["-9", &process.to_string()]).status().unwrap().success());
        let back = team.until(&displayed, 30, |team| {
            let quality = team.radio.quality(robot).unwrap();
            quality.lives() > before && quality.start_up().is_some()
        });
        assert!(back && team.link.restarts() == 1);
        assert!(team.link.notice().unwrap().contains("virtual robot 0 ended"));

        let processes: Vec<u32> = team.link.processes().map(|(_, process)| process).collect();
        assert!(processes.iter().all(|process| lives(*process)));
        drop(team);
        assert!(!processes.iter().any(|process| lives(*process)));
        end.store(true, Ordering::Relaxed);
    });
}

#[test]
fn robots_in_our_simulator_go_where_their_host_says_come_back_and_end_with_it() {
    play(Profile::Ours);
}

#[test]
fn trap_09_and_in_one_with_er_forces_manners() {
    play(Profile::ErForce);
}

#[test]
fn trap_09_and_in_one_with_grsims_manners() {
    play(Profile::Grsim);
}

#[test]
fn a_robot_whose_parent_is_gone_ends() {
    use std::io::Write as _;
    use std::process::Stdio;
    let mut robot = Process::new(env!("CARGO_BIN_EXE_onetwo"))
        .args(["virtual-robot", "--id", "1", "--team", "yellow", "--host", "127.0.0.1:9"])
        .args(["--simulator", "127.0.0.1:9", "--with-parent"])
        .stdin(Stdio::piped())
        .spawn()
        .unwrap();
    let mut pipe = robot.stdin.take().unwrap();
    writeln!(pipe, "{}", "00".repeat(16)).unwrap();
    std::thread::sleep(Duration::from_millis(300));
    assert!(robot.try_wait().unwrap().is_none(), "it plays while it has a parent");
    drop(pipe);
    let end = Clock::now() + Duration::from_secs(20);
    while robot.try_wait().unwrap().is_none() {
        assert!(Clock::now() < end, "it has not ended");
        std::thread::sleep(Duration::from_millis(10));
    }
}

#[test]
fn a_key_that_is_none_and_a_host_no_one_knows_are_reported() {
    let robot = |more: &[&str]| {
        let out = Process::new(env!("CARGO_BIN_EXE_onetwo"))
            .args(["virtual-robot", "--id", "1", "--team", "blue", "--host", "127.0.0.1:9"])
            .args(more)
            .stdin(std::process::Stdio::null())
            .output()
            .unwrap();
        (out.status.code(), String::from_utf8(out.stderr).unwrap())
    };
    let (code, description) = robot(&["--simulator", "no.such.host.invalid"]);
    assert!(code == Some(1) && description.contains("--simulator"), "{description}");
    let (code, description) = robot(&["--simulator", "127.0.0.1", "--with-parent"]);
    assert!(code == Some(1) && description.contains("no key"), "{description}");
    let (code, description) = robot(&["--simulator", "127.0.0.1", "--key-file", "no-such.key"]);
    assert!(code == Some(1) && description.contains("no-such.key"), "{description}");
    let (code, _) = robot(&["--simulator", "127.0.0.1", "--id", "16"]);
    assert_eq!(code, Some(2));
}
