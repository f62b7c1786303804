//! `halt_cli`: HALT against floods, second referees and slow lines, with the built `onetwo control` on
//! loopback and a pseudo terminal. What is held is the same on any machine: bytes and frames that come
//! before HALT. How long HALT takes is printed, and held to [`HALT_MAX`] by `cargo xtask soak` alone.
//! Times: s and ms.
#![cfg(target_os = "linux")]

mod running;
mod verb;

use std::net::{SocketAddr, UdpSocket};
use std::os::fd::AsRawFd;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, channel};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use protocol::frame::TeamKey;
use protocol::host::{HostMessage, Telemetry};
use protocol::link::{Link, Packet, overhear_host};
use protocol::serial::{self, Lines};
use protocol::team::TeamMessage;
use protocol::{RobotId, TeamId};
use rules::{Colour, Phase};
use serial2::SerialPort;
use ssl::Message;
use ssl::referee::{Command as Wire, Referee, TeamInfo};
use ssl::vision::{DetectionBall, DetectionFrame, DetectionRobot, WrapperPacket};

use running::{PATIENCE, Running};
use verb::{scratch, text};

/// Longest median latency of HALT under a flood in the soak; 1.2 to 9.3 s before queues were bounded.
const HALT_MAX: Duration = Duration::from_millis(500);
/// Frames of the host to its robots that may come between the referee's HALT and the first HALT on the radio,
/// in the median: a tenth of a second of them.
const STALE_FRAMES_MAX: usize = 80;
/// Resident memory may grow by at most this under a flood, bytes; 465 MB before.
const GROWTH_MAX: u64 = 24 << 20;
/// Datagrams of a flood before its first HALT: far more than the host's queue holds.
const FLOODED_MIN: u64 = 5_000;
/// A gigabit network, bytes a second.
const LINE_RATE: u64 = 125_000_000;
const KEY: [u8; 16] = [0x5a; 16];

/// Waits for what must come.
fn eventually(what: &str, holds: impl Fn() -> bool) {
    let until = Instant::now() + PATIENCE;
    while !holds() {
        assert!(Instant::now() < until, "{what} did not come");
        thread::sleep(Duration::from_millis(5));
    }
}

/// `onetwo control` with its referee, vision and base station simulated by the test.
struct Field {
    control: Running,
    vision: SocketAddr,
    referee: SocketAddr,
}

fn socket(address: &str) -> UdpSocket {
    UdpSocket::bind(address).expect("a port")
}

/// A port that is free at the moment.
fn free() -> SocketAddr {
    socket("127.0.0.1:0").local_addr().expect("an address")
}

impl Field {
    fn start(robots: &str, more: &[&str]) -> Self {
        let (vision, referee) = (free(), free());
        let key = scratch(&format!("{}.key", vision.port()));
        std::fs::write(&key, "5a".repeat(16)).expect("a key file");
        let own = ["control", "--name", "T", "--colour", "blue", "--headless", "--duration", "120"];
        let addresses = [vision, referee, free()].map(|address| address.to_string());
        let [to_vision, to_referee, tracker] = &addresses;
        let net = ["--robots", robots, "--vision", to_vision, "--referee", to_referee, "--tracker", tracker];
        let control = Running::start(&[&own[..], &net, &["--key-file", text(&key)], more].concat());
        Self { control, vision, referee }
    }

    /// Waits for a line that contains all of `parts`.
    fn wait_for_line(&mut self, parts: &[&str]) -> String {
        loop {
            let (_, line) = self.control.wait_for(parts[0]);
            if parts.iter().all(|part| line.contains(part)) {
                return line;
            }
        }
    }

    /// Resident memory, bytes.
    fn memory(&self) -> u64 {
        let status =
            std::fs::read_to_string(format!("/proc/{}/status", self.control.process.id())).expect("it runs");
        let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:")).expect("its memory");
        line.trim().trim_end_matches(" kB").parse::<u64>().expect("a number") * 1024
    }
}

fn unix_us() -> u64 {
    SystemTime::now().duration_since(UNIX_EPOCH).expect("after 1970").as_micros() as u64
}

/// A program that sends referee packets at 40 Hz.
struct Controller {
    command: Arc<Mutex<(Wire, u32)>>,
    socket: Arc<UdpSocket>,
    to: SocketAddr,
    identifier: &'static str,
    end: Arc<AtomicBool>,
}

impl Controller {
    fn start(identifier: &'static str, from: &str, to: SocketAddr, command: Wire) -> Self {
        let socket = Arc::new(socket(from));
        let (command, end) = (Arc::new(Mutex::new((command, 1))), Arc::new(AtomicBool::new(false)));
        let this = Self { command, socket, to, identifier, end };
        let (command, socket, end) = (this.command.clone(), this.socket.clone(), this.end.clone());
        thread::spawn(move || {
            while !end.load(Ordering::Relaxed) {
                let (command, counter) = *command.lock().expect("no panic");
                let _ = socket.send_to(&packet(identifier, command, counter), to);
                thread::sleep(Duration::from_millis(25));
            }
        });
        this
    }

    /// Sends a command, at once.
    fn send_command(&self, command: Wire) -> Instant {
        let counter = {
            let mut output = self.command.lock().expect("no panic");
            *output = (command, output.1 + 1);
            output.1
        };
        let at = Instant::now();
        self.socket.send_to(&packet(self.identifier, command, counter), self.to).expect("loopback");
        at
    }
}

impl Drop for Controller {
    fn drop(&mut self) {
        self.end.store(true, Ordering::Relaxed);
    }
}

fn packet(identifier: &str, command: Wire, counter: u32) -> Vec<u8> {
    let team = |name: &str| TeamInfo { name: name.into(), ..TeamInfo::default() };
    let packet = Referee {
        packet_timestamp: unix_us(),
        command: command as i32,
        command_counter: counter,
        command_timestamp: unix_us(),
        yellow: team("yellow"),
        blue: team("T"),
        source_identifier: Some(identifier.into()),
        ..Referee::default()
    };
    packet.encode_to_vec()
}

/// A camera frame with six robots a team and `balls` balls.
fn camera_frame(number: u32, balls: usize) -> Vec<u8> {
    let robot = |id: u32, y: f32| DetectionRobot {
        confidence: 1.0,
        robot_id: Some(id),
        x: id as f32 * 500.0 - 1_500.0,
        y,
        orientation: Some(0.0),
        ..DetectionRobot::default()
    };
    let ball =
        |n: usize| DetectionBall { confidence: 0.9, x: n as f32, y: 100.0, ..DetectionBall::default() };
    let frame = DetectionFrame {
        frame_number: number,
        t_capture: unix_us() as f64 * 1e-6,
        t_sent: unix_us() as f64 * 1e-6,
        robots_blue: (0..6).map(|id| robot(id, -800.0)).collect(),
        robots_yellow: (0..6).map(|id| robot(id, 800.0)).collect(),
        balls: (0..balls).map(ball).collect(),
        ..DetectionFrame::default()
    };
    WrapperPacket { detection: Some(frame), ..WrapperPacket::default() }.encode_to_vec()
}

/// Camera frames at 60 Hz until the test ends.
fn camera(to: SocketAddr, end: &Arc<AtomicBool>) {
    let end = end.clone();
    thread::spawn(move || {
        let socket = socket("127.0.0.1:0");
        for number in 0.. {
            if end.load(Ordering::Relaxed) {
                return;
            }
            let _ = socket.send_to(&camera_frame(number, 1), to);
            thread::sleep(Duration::from_millis(16));
        }
    });
}

/// The radio ends of six robots: they answer the host's welcomes, so that it commands them.
struct Robots {
    links: Vec<Link>,
    began: Instant,
    reported: Option<Instant>,
}

impl Robots {
    const TEAM: TeamId = TeamId::of(Colour::Blue);

    fn new() -> Self {
        let link = |robot| Link::new(Self::TEAM, robot, TeamKey(KEY).of_robot(robot), 1);
        Self { links: RobotId::all().take(6).map(link).collect(), began: Instant::now(), reported: None }
    }

    fn now(&self) -> protocol::Instant {
        protocol::Instant(self.began.elapsed().as_micros() as u64)
    }

    /// Takes a frame of the host: whether its phase is HALT, if it has a phase.
    fn receive(&mut self, frame: &[u8]) -> Option<bool> {
        let now = self.now();
        for link in &mut self.links {
            let _ = link.open(now, frame);
        }
        let read =
            |robot: RobotId| overhear_host(frame, Self::TEAM, &TeamKey(KEY).of_robot(robot), robot).ok();
        match RobotId::all().take(6).find_map(read)? {
            HostMessage::World(part) => Some(part.phase == Phase::Halt),
            HostMessage::Command(command) => Some(command.phase == Phase::Halt),
            HostMessage::Welcome(_) | HostMessage::Limits(_) => None,
        }
    }

    /// Telemetry of all robots, ten times a second.
    fn poll(&mut self) -> Vec<Packet> {
        if self.reported.is_some_and(|reported| reported.elapsed() < Duration::from_millis(100)) {
            return Vec::new();
        }
        self.reported = Some(Instant::now());
        let now = self.now();
        let report = |link: &mut Link| {
            let mut telemetry = Telemetry::default();
            link.report(now, &mut telemetry);
            link.seal(&TeamMessage::Telemetry(telemetry))
        };
        self.links.iter_mut().map(report).collect()
    }
}

/// What the base station receives: whether the newest frame is a HALT, and when.
fn station() -> (SocketAddr, Receiver<(Instant, bool)>) {
    let socket = socket("127.0.0.1:0");
    let (send, frames) = channel();
    let address = socket.local_addr().expect("an address");
    thread::spawn(move || {
        let (mut bytes, mut robots) = ([0; 256], Robots::new());
        while let Ok((length, host)) = socket.recv_from(&mut bytes) {
            if let Some(halt) = robots.receive(&bytes[..length])
                && send.send((Instant::now(), halt)).is_err()
            {
                return;
            }
            for packet in robots.poll() {
                let _ = socket.send_to(&packet, host);
            }
        }
    });
    (address, frames)
}

/// How long a frame was waited for, and the number of other frames that came meanwhile.
struct Waited {
    latency: Duration,
    stale_frames: usize,
}

/// Waits for a frame that is a HALT, or one that is not, sent after `since`.
fn wait_for(frames: &Receiver<(Instant, bool)>, halt: bool, since: Instant) -> Waited {
    let (until, mut stale_frames) = (Instant::now() + PATIENCE, 0);
    loop {
        let left = until.saturating_duration_since(Instant::now());
        match frames.recv_timeout(left) {
            Ok((at, is_halt)) if is_halt == halt && at >= since => {
                return Waited { latency: at - since, stale_frames };
            }
            Ok((at, _)) => stale_frames += usize::from(at >= since),
            Err(error) => panic!("no frame with halt = {halt} comes: {error}"),
        }
    }
}

/// Sends datagrams at a gigabit until the end; returns the number sent.
fn flood(to: SocketAddr, datagrams: Vec<Vec<u8>>, end: &Arc<AtomicBool>) -> Arc<AtomicU64> {
    let (sent, end) = (Arc::new(AtomicU64::new(0)), end.clone());
    let count = sent.clone();
    thread::spawn(move || {
        let socket = socket("127.0.0.1:0");
        let (began, mut bytes) = (Instant::now(), 0);
        for datagram in datagrams.iter().cycle() {
            if end.load(Ordering::Relaxed) {
                return;
            }
            let _ = socket.send_to(datagram, to);
            count.fetch_add(1, Ordering::Relaxed);
            bytes += datagram.len() as u64;
            let due = Duration::from_secs_f64(bytes as f64 / LINE_RATE as f64);
            thread::sleep(due.saturating_sub(began.elapsed()));
        }
    });
    sent
}

/// HALT under a flood of those datagrams on vision's port: median and worst of several HALTs, and the growth
/// of memory.
fn halts_under(field: &mut Field, frames: &Receiver<(Instant, bool)>, flooded: Vec<Vec<u8>>) {
    let end = Arc::new(AtomicBool::new(false));
    camera(field.vision, &end);
    let controller = Controller::start("gc", "127.0.0.1:0", field.referee, Wire::Stop);
    field.wait_for_line(&["the referee is received"]);
    controller.send_command(Wire::ForceStart);
    wait_for(frames, false, Instant::now());
    let before = field.memory();
    let sent = flood(field.vision, flooded, &end);
    eventually("the flood", || sent.load(Ordering::Relaxed) > FLOODED_MIN);
    let (mut took, mut stale, mut most) = (Vec::new(), Vec::new(), before);
    for _ in 0..8 {
        let since = controller.send_command(Wire::Halt);
        let Waited { latency, stale_frames } = wait_for(frames, true, since);
        took.push(latency);
        stale.push(stale_frames);
        controller.send_command(Wire::Stop);
        wait_for(frames, false, Instant::now());
        most = most.max(field.memory());
    }
    end.store(true, Ordering::Relaxed);
    took.sort();
    stale.sort_unstable();
    let (median, worst) = (took[took.len() / 2], took[took.len() - 1]);
    eprintln!(
        "HALT to the first HALT on the radio under {} datagrams: median {median:.1?}, worst {worst:.1?}, frames before it \
         {stale:?}; memory {} kB before, {} kB most",
        sent.load(Ordering::Relaxed),
        before / 1024,
        most / 1024
    );
    assert!(stale[stale.len() / 2] <= STALE_FRAMES_MAX, "{stale:?}");
    assert!(most <= before + GROWTH_MAX, "{before} bytes before, {most} under the flood");
    if std::env::var_os("ONETWO_SOAK").is_some() {
        assert!(median <= HALT_MAX, "{took:?}");
    }
}

#[test]
fn finding_3_halt_does_not_wait_behind_a_flood_of_camera_frames() {
    let frames: Vec<_> = (0..64).map(|number| camera_frame(number + 1_000_000, 300)).collect();
    assert!((8_000..10_240).contains(&frames[0].len()), "{} bytes", frames[0].len());
    let (robots, received) = station();
    halts_under(&mut Field::start(&format!("udp://{robots}"), &[]), &received, frames);
}

#[test]
fn finding_3_halt_does_not_wait_behind_long_frames_of_a_second_vision() {
    let frames = vec![camera_frame(1_000_000, 2_000)];
    assert!(frames[0].len() > 50_000, "{} bytes", frames[0].len());
    let (robots, received) = station();
    let mut field = Field::start(&format!("udp://{robots}"), &[]);
    halts_under(&mut field, &received, frames);
    field.wait_for_line(&["a second vision sends camera 0"]);
}

#[test]
fn finding_2_two_referees_that_disagree_are_reported_with_both_addresses() {
    let (robots, frames) = station();
    let mut field = Field::start(&format!("udp://{robots}"), &[]);
    let end = Arc::new(AtomicBool::new(false));
    camera(field.vision, &end);
    let genuine = Controller::start("gc\u{1b}[31m", "127.0.0.1:0", field.referee, Wire::ForceStart);
    wait_for(&frames, false, Instant::now());
    let other = Controller::start("other", "127.0.0.2:0", field.referee, Wire::Halt);
    let line = field.wait_for_line(&[
        "two referees disagree",
        "127.0.0.1:",
        "127.0.0.2:",
        "--referee-source 127.0.0.1",
    ]);
    assert!(!line.contains('\u{1b}'), "{line:?}");
    wait_for(&frames, true, Instant::now());
    drop(other);
    wait_for(&frames, false, Instant::now());
    drop(genuine);
    end.store(true, Ordering::Relaxed);
}

#[test]
fn a_pinned_referee_is_obeyed_and_the_other_one_reported() {
    let (robots, frames) = station();
    let mut field = Field::start(&format!("udp://{robots}"), &["--referee-source", "127.0.0.2"]);
    let end = Arc::new(AtomicBool::new(false));
    camera(field.vision, &end);
    let _other = Controller::start("other", "127.0.0.1:0", field.referee, Wire::Halt);
    let pinned = Controller::start("gc", "127.0.0.2:0", field.referee, Wire::ForceStart);
    field.wait_for_line(&["\"other\" at 127.0.0.1:", "is ignored", "127.0.0.2"]);
    wait_for(&frames, false, Instant::now());
    let since = pinned.send_command(Wire::Halt);
    wait_for(&frames, true, since);
    end.store(true, Ordering::Relaxed);
}

#[test]
fn finding_10_on_a_slow_line_halt_overtakes_snapshots_and_the_rate_is_told() {
    /// Bytes a second of a line with 115,200 bit/s.
    const RATE: f64 = 11_520.0;
    /// Frames that are read at most until a HALT is among them.
    const FRAMES_MAX: usize = 10_000;
    /// Bytes that may come before HALT: 0.2 s of the line; 22,000 before.
    const STALE_MAX: u64 = 2_304;
    let began = Instant::now();
    let (station, line) = SerialPort::pair().expect("a pseudo terminal");
    let device = std::fs::read_link(format!("/proc/self/fd/{}", line.as_raw_fd())).expect("its name");
    let mut field = Field::start(&format!("serial:{}:115200", device.display()), &[]);
    let end = Arc::new(AtomicBool::new(false));
    let read = Arc::new(AtomicU64::new(0));
    // The base station takes what comes: the host alone keeps to the rate. HALT or not, and bytes so far.
    let (send, frames) = channel();
    let (count, stop) = (read.clone(), end.clone());
    thread::spawn(move || {
        let (mut lines, mut robots) = (Lines::new(), Robots::new());
        while !stop.load(Ordering::Relaxed) {
            for packet in robots.poll() {
                let _ = station.write_all(&serial::line(&packet));
            }
            let mut bytes = [0; 64];
            let got = station.read(&mut bytes).unwrap_or(0);
            count.fetch_add(got as u64, Ordering::Relaxed);
            for byte in &bytes[..got] {
                if let Some(halt) = lines.push(*byte).and_then(|frame| robots.receive(&frame)) {
                    let _ = send.send((count.load(Ordering::Relaxed), halt));
                }
            }
        }
    });
    camera(field.vision, &end);
    let controller = Controller::start("gc", "127.0.0.1:0", field.referee, Wire::Stop);
    field.wait_for_line(&["the referee is received"]);
    controller.send_command(Wire::ForceStart);
    let arguments = field.wait_for_line(&["robots' line", "is too slow", "bit/s"]);
    eprintln!("{arguments}");
    let line_carries = |seconds: f64| {
        let enough = read.load(Ordering::Relaxed) + (seconds * RATE) as u64;
        eventually("the line's bytes", || read.load(Ordering::Relaxed) >= enough);
    };
    line_carries(2.0);
    let mut stale = Vec::new();
    for _ in 0..5 {
        while frames.try_recv().is_ok() {}
        let before = read.load(Ordering::Relaxed);
        controller.send_command(Wire::Halt);
        let all = std::iter::repeat_with(|| frames.recv_timeout(PATIENCE).expect("a frame"));
        let at = all.take(FRAMES_MAX).find(|(_, halt)| *halt).expect("a HALT").0;
        stale.push(at - before);
        controller.send_command(Wire::Stop);
        line_carries(0.4);
    }
    let (carried, seconds) = (read.load(Ordering::Relaxed), began.elapsed().as_secs_f64());
    end.store(true, Ordering::Relaxed);
    assert!((carried as f64) < RATE * seconds, "{carried} bytes in {seconds} s");
    stale.sort_unstable();
    eprintln!("bytes on the line from HALT's packet to HALT's frame, that frame included: {stale:?}");
    assert!(stale[stale.len() / 2] <= STALE_MAX, "{stale:?}");
}
