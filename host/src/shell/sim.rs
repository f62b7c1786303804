//! `sim`: link to virtual robots in a simulator. `sim://HOST`: a process each, `onetwo virtual-robot`, that
//! exchanges radio frames with the host and uses the league's simulation protocol with the simulator.
//!
//! **Life cycle.** The processes are started here; each is restarted a second after it ended, which is
//! reported. They end with the host, even if it crashes: the pipe to their standard input closes. The pipe
//! also carries the key, so that no process list contains it.

use std::ffi::OsString;
use std::io::Write as _;
use std::net::{SocketAddr, UdpSocket};
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use protocol::frame::{Frame, Sender, TeamKey, TeamKeys};
use protocol::link::{Packet, overhear};
use protocol::{RobotId, TeamId};
use rules::{Colour, League};

use super::hub::Hub;
use super::udp::{receive, send};
use super::{Link, LinkError, key};
use crate::radio::{Relay, To};

/// A robot that ended is started again after this time; its next epoch is then greater, as epochs count
/// seconds.
const RESTART_AFTER: Duration = Duration::from_millis(1_100);
/// A robot that ended this often in a row within [`FAILED_WITHIN`] is not restarted.
const FAILURES_MAX: u32 = 5;
/// A process that ran for less than this counts as failed.
const FAILED_WITHIN: Duration = Duration::from_secs(3);
/// Interval of checks whether all processes run.
const CHECK_EVERY: Duration = Duration::from_millis(100);

/// Virtual robots to start, and their program.
#[derive(Clone, Debug)]
pub struct SimSettings {
    /// The program that has the verb `virtual-robot`; usually this one.
    pub program: PathBuf,
    /// The colour our robots play with.
    pub colour: Colour,
    /// The league, which sets field and rules.
    pub league: League,
    /// Numbers of the robots to start.
    pub robots: Vec<RobotId>,
    /// Address at which the simulator takes our robots' commands: port 10301 for blue, 10302 for yellow.
    pub simulator: SocketAddr,
    /// The team's key, sent to each process.
    pub key: TeamKey,
    /// More arguments for each robot's command line: library, settings.
    pub more: Vec<OsString>,
}

/// Robots' processes and the sockets to them.
#[derive(Debug)]
pub struct SimLink {
    settings: SimSettings,
    keys: TeamKeys,
    socket: UdpSocket,
    own: SocketAddr,
    hub: Hub,
    robots: Vec<Robot>,
    looked: Instant,
    notices: Vec<String>,
}

#[derive(Debug)]
struct Robot {
    id: RobotId,
    process: Option<Child>,
    since: Instant,
    address: Option<SocketAddr>,
    restarts: u32,
    short_lives: u32,
}

impl Robot {
    fn new(id: RobotId, now: Instant) -> Self {
        Self { id, process: None, since: now, address: None, restarts: 0, short_lives: 0 }
    }
}

impl SimLink {
    /// Starts the processes of all robots.
    pub fn start(settings: SimSettings) -> Result<Self, LinkError> {
        let system = |error| LinkError::Socket { doing: "open a socket for virtual robots".into(), error };
        let socket = UdpSocket::bind("127.0.0.1:0").map_err(system)?;
        let own = socket.local_addr().map_err(system)?;
        let hub = Hub::start(settings.simulator)?;
        let now = Instant::now();
        let robots = settings.robots.iter().map(|id| Robot::new(*id, now)).collect();
        let keys = settings.key.of_team();
        let mut link = Self { settings, keys, socket, own, hub, robots, looked: now, notices: Vec::new() };
        for place in 0..link.robots.len() {
            link.boot(place)?;
        }
        Ok(link)
    }

    /// Number of restarts of robots' processes in total.
    pub fn restarts(&self) -> u32 {
        self.robots.iter().map(|robot| robot.restarts).sum()
    }

    /// The process of each running robot.
    pub fn processes(&self) -> impl Iterator<Item = (RobotId, u32)> {
        self.robots.iter().filter_map(|robot| Some((robot.id, robot.process.as_ref()?.id())))
    }

    fn boot(&mut self, place: usize) -> Result<(), LinkError> {
        let Some(robot) = self.robots.get_mut(place) else { return Ok(()) };
        let settings = &self.settings;
        let start = |error| LinkError::Start { program: settings.program.display().to_string(), error };
        let mut command = Command::new(&settings.program);
        // Ctrl-C in a terminal reaches a whole group: robots must run until their host has halted them.
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(&mut command, 0);
        let mut process = command
            .arg("virtual-robot")
            .args(["--id", &robot.id.to_string(), "--team", settings.colour.label()])
            .args(["--league", settings.league.name(), "--host", &self.own.to_string()])
            .args(["--simulator", &self.hub.address().to_string(), "--with-parent"])
            .args(&settings.more)
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .spawn()
            .map_err(start)?;
        if let Some(pipe) = &mut process.stdin {
            // If it has ended already, the next check detects it.
            let _ = writeln!(pipe, "{}", key::format(&settings.key));
        }
        robot.process = Some(process);
        robot.since = Instant::now();
        Ok(())
    }

    /// Detects processes that have ended, and starts those that are due.
    fn look(&mut self) -> Result<(), LinkError> {
        let now = Instant::now();
        if now.duration_since(self.looked) < CHECK_EVERY {
            return Ok(());
        }
        self.looked = now;
        for place in 0..self.robots.len() {
            let Some(robot) = self.robots.get_mut(place) else { continue };
            match &mut robot.process {
                Some(process) => {
                    let how = match process.try_wait() {
                        Ok(None) => continue,
                        Ok(Some(status)) => status.to_string(),
                        Err(error) => format!("it cannot be watched: {error}"),
                    };
                    let short = now.duration_since(robot.since) < FAILED_WITHIN;
                    robot.short_lives = if short { robot.short_lives + 1 } else { 0 };
                    (robot.process, robot.address, robot.since) = (None, None, now);
                    if robot.short_lives >= FAILURES_MAX {
                        let times = robot.short_lives;
                        return Err(LinkError::GivesUp { robot: robot.id.number(), how, times });
                    }
                    self.notices
                        .push(format!("virtual robot {} ended ({how}); it is started again", robot.id));
                }
                None if now.duration_since(robot.since) >= RESTART_AFTER => {
                    robot.restarts += 1;
                    self.boot(place)?;
                }
                None => {}
            }
        }
        Ok(())
    }

    /// Learns a robot's address from a frame under its team's keys.
    fn learn(&mut self, packet: &[u8], from: SocketAddr) {
        let team = TeamId::of(self.settings.colour);
        let Ok(frame) = Frame::parse(packet, team) else { return };
        let Sender::Robot(id) = frame.sender else { return };
        let known = self.robots.iter_mut().find(|robot| robot.id == id);
        if let Some(robot) = known.filter(|robot| robot.address != Some(from))
            && overhear(packet, team, &self.keys).is_ok()
        {
            robot.address = Some(from);
        }
    }
}

impl Link for SimLink {
    fn send(&mut self, to: To, packet: &[u8]) -> Result<(), LinkError> {
        for robot in &self.robots {
            if let (true, Some(address)) = (to == To::All || to == To::One(robot.id), robot.address) {
                send(&self.socket, address, packet)?;
            }
        }
        Ok(())
    }

    fn receive(&mut self, wait: Duration) -> Result<Option<Packet>, LinkError> {
        self.look()?;
        let Some((packet, from)) = receive(&self.socket, wait)? else { return Ok(None) };
        self.learn(&packet, from);
        Ok(Some(packet))
    }

    fn relay(&self) -> Relay {
        Relay::ToEach
    }

    fn notice(&mut self) -> Option<String> {
        (!self.notices.is_empty()).then(|| self.notices.remove(0))
    }

    fn advice(&self) -> String {
        let alive = self.robots.iter().filter(|robot| robot.process.is_some()).count();
        format!(
            "{alive} of {} virtual robots run; does a simulator listen at {}?",
            self.robots.len(),
            self.settings.simulator
        )
    }
}

impl Drop for SimLink {
    fn drop(&mut self) {
        for robot in &mut self.robots {
            if let Some(process) = &mut robot.process {
                // The closed pipe makes it end; the signal does not wait for an answer.
                drop(process.stdin.take());
                let _ = process.kill();
                let _ = process.wait();
            }
        }
    }
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use protocol::host::Telemetry;
    use protocol::link::Link as RobotEnd;
    use protocol::team::TeamMessage;

    fn id(n: u8) -> RobotId {
        RobotId::new(n).unwrap()
    }

    fn settings(program: &str, robots: &[u8]) -> SimSettings {
        SimSettings {
            program: program.into(),
            colour: Colour::Blue,
            league: League::DivisionB,
            robots: robots.iter().map(|n| id(*n)).collect(),
            simulator: ([127, 0, 0, 1], 9).into(),
            key: TeamKey([3; 16]),
            more: Vec::new(),
        }
    }

    #[test]
    fn a_robot_is_spoken_to_where_its_genuine_frames_come_from() {
        // `cat` keeps its standard input open and sends nothing: it stands for a robot's process (and
        // complains about its arguments).
        let mut link = SimLink::start(settings("cat", &[2, 4])).unwrap();
        let robot = UdpSocket::bind("127.0.0.1:0").unwrap();
        let mut end = RobotEnd::new(TeamId::of(Colour::Blue), id(4), TeamKey([3; 16]).of_robot(id(4)), 9);
        let mut forger = RobotEnd::new(TeamId::of(Colour::Blue), id(2), TeamKey::ZERO.of_robot(id(2)), 9);
        let telemetry = TeamMessage::Telemetry(Telemetry::default());
        for packet in [end.seal(&telemetry), forger.seal(&telemetry)] {
            robot.send_to(&packet, link.own).unwrap();
            assert_eq!(link.receive(Duration::from_secs(2)).unwrap(), Some(packet));
        }
        link.send(To::One(id(2)), b"to nobody known").unwrap();
        link.send(To::One(id(4)), b"to four").unwrap();
        link.send(To::All, b"to all").unwrap();
        let (first, _) = receive(&robot, Duration::from_secs(2)).unwrap().unwrap();
        let (second, _) = receive(&robot, Duration::from_secs(2)).unwrap().unwrap();
        assert_eq!((&first[..], &second[..]), (&b"to four"[..], &b"to all"[..]));
    }

    #[test]
    fn a_robot_process_that_keeps_failing_is_given_up_and_reported() {
        let mut link = SimLink::start(settings("false", &[0])).unwrap();
        let mut error = None;
        for _ in 0..200 {
            // The second between two starts need not pass in a test.
            for robot in &mut link.robots {
                robot.since -= RESTART_AFTER;
            }
            link.looked -= CHECK_EVERY;
            std::thread::sleep(Duration::from_millis(5));
            if let Err(why) = link.look() {
                error = Some(why.to_string());
                break;
            }
        }
        let error = error.expect("given up");
        assert!(error.contains("virtual robot 0 ended 5 times"), "{error}");
        assert_eq!(link.restarts(), 4);
        assert!(link.notice().unwrap().contains("virtual robot 0 ended (exit status: 1)"));
        let missing = SimLink::start(settings("no-such-program", &[0])).unwrap_err().to_string();
        assert!(missing.contains("no-such-program"), "{missing}");
    }
}
