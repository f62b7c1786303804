//! `log_cli`: `onetwo robot bring-up --log` beside a robot on UDP that logs while its kicker is measured, and
//! whose radio loses packets: the file has what was logged, and nothing else waits for it.

mod lossy;

use std::cell::{Cell, RefCell};
use std::net::UdpSocket;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use protocol::bring_up::{CHECKS, Reporter};
use protocol::frame::{Frame, TeamKey};
use protocol::{RobotId, TeamId, pulses, robot_log};
use runtime::bring_up::{BenchStep, Listener, LogRing, Results, RobotLog};
use runtime::kicker::{FULL_VOLTS, KickerAct, KickerState};
use runtime::wheel::Motors;
use serde_json::Value;

use lossy::LossyStation;

const KEY: TeamKey = TeamKey([0x5a; 16]);
const TEAM: TeamId = TeamId(2);

/// defmt-rtt's ring.
struct Ring {
    bytes: RefCell<[u8; 1_024]>,
    end: Cell<usize>,
    /// All that was logged.
    all: RefCell<Vec<u8>>,
}

impl LogRing for &Ring {
    fn look<T>(&self, read: impl FnOnce(&[u8], usize) -> T) -> T {
        read(&*self.bytes.borrow(), self.end.get())
    }
}

impl Ring {
    /// Logs a frame of 41 bytes, whose number is in it.
    fn log(&self) {
        let number = self.all.borrow().len() / 41;
        let digits = [number / 200, number % 200].map(|digit| 1 + digit as u8);
        let frame = digits.into_iter().chain([0xa5; 38]).chain([0]);
        for byte in frame {
            let place = self.end.get();
            self.bytes.borrow_mut()[place] = byte;
            self.end.set((place + 1) % 1_024);
            self.all.borrow_mut().push(byte);
        }
    }
}

/// What a robot did.
struct Played {
    logged: Vec<u8>,
    fired: usize,
    /// Times in ms and kinds of the frames that it sent, lost ones too.
    sent: Vec<(u64, u8)>,
}

/// A robot with its kicker behind a base station that loses that share of its packets, both ways. It logs 600
/// bytes at the start, 80 a second until its second pulse, and frames that fill the ring thrice if asked.
fn robot(mut station: LossyStation<'_>, (logs, floods): (bool, bool), end: &AtomicBool) -> Played {
    let robot = RobotId::new(3).expect("a number");
    let who = Reporter { team: TEAM, robot, key: KEY.of_robot(robot).host, epoch: 17 };
    let (mut results, mut listener, mut volts) = (Results::new(who), Listener::default(), 0.0_f32);
    results.take(&BenchStep { motors: Motors::Released, report: None, check: Some(CHECKS[0]) });
    let ring = Ring { bytes: RefCell::new([0; 1_024]), end: Cell::new(0), all: RefCell::new(Vec::new()) };
    let mut log = RobotLog::new(&ring);
    let (mut fired, mut sent) = (0, Vec::new());
    (0..15).for_each(|_| ring.log());
    let (began, mut ms) = (Instant::now(), 0_u64);
    while !end.load(Ordering::Relaxed) {
        ms += 1;
        thread::sleep(Duration::from_millis(ms).saturating_sub(began.elapsed()));
        let now = protocol::Instant(1_000 * ms);
        station.receive(|packet| {
            listener.receive(packet);
            results.kicks.receive(now, packet);
        });
        if ms.is_multiple_of(500) && fired < 2 || floods && (1_500..1_575).contains(&ms) {
            ring.log();
        }
        match results.kicks.step(now, KickerState { ball: true, volts }) {
            KickerAct::Charge => volts = (volts + FULL_VOLTS / 1_000.0).min(1.02 * FULL_VOLTS),
            KickerAct::Rest => {}
            KickerAct::Bleed => volts *= 0.9997,
            KickerAct::Flat(_) | KickerAct::Chip(_) => {
                volts *= 0.9;
                fired += 1;
                ring.log();
            }
        }
        // As a board does (`board_kit::bring_up`).
        if !station.has_host() || !ms.is_multiple_of(20) {
            continue;
        }
        let heard = listener.host_epoch(TEAM);
        let piece = log.report(now, heard).filter(|_| logs);
        let packets = [results.packet(heard), Some(results.kick_packet(now, heard))];
        let log = piece.map(|piece| results.log_packet(&piece));
        for packet in packets.into_iter().chain([log]).flatten() {
            sent.push((ms, Frame::parse(&packet, TEAM).expect("a frame").payload[0]));
            station.send(&packet);
        }
    }
    Played { logged: ring.all.take(), fired, sent }
}

/// A file of its own for each test.
fn file(name: &str) -> PathBuf {
    std::env::temp_dir().join(format!("onetwo-log-{}-{name}", std::process::id()))
}

fn onetwo(robots: &str, key: &Path, log: &Path, more: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_onetwo"))
        .args(["robot", "bring-up", "--team", "2", "--robot", "3", "--robots", robots, "--kick", "1500,2600"])
        .args(["--ball", "0", "--key-file"])
        .args([key, "--log".as_ref(), log])
        .args(more)
        .env("XDG_STATE_HOME", file("state"))
        .stdin(Stdio::null())
        .output()
        .expect("the program starts")
}

/// What the program printed, the file that it wrote, and what the robot did.
fn played(name: &str, log: (bool, bool), loses: f32, more: &[&str]) -> (Output, Vec<u8>, Played) {
    let station = UdpSocket::bind("127.0.0.1:0").expect("a port");
    let robots = format!("udp://{}", station.local_addr().expect("an address"));
    let (key, path, end) = (file(&format!("{name}.key")), file(name), AtomicBool::new(false));
    std::fs::write(&key, "5a".repeat(16)).expect("a key file");
    let (output, robot) = thread::scope(|scope| {
        let robot = scope.spawn(|| robot(LossyStation::new(&station, loses), log, &end));
        let output = onetwo(&robots, &key, &path, more);
        end.store(true, Ordering::Relaxed);
        (output, robot.join().expect("the robot"))
    });
    let written = std::fs::read(&path).expect("the log");
    for file in [key, path] {
        std::fs::remove_file(file).expect("our own file");
    }
    assert_eq!((robot.fired, output.status.code()), (2, Some(0)), "{}", text(&output.stderr));
    (output, written, robot)
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// The last line as JSON.
fn counts(output: &Output) -> Value {
    let stdout = text(&output.stdout);
    serde_json::from_str(stdout.lines().last().expect("a line")).expect("an object a line")
}

#[test]
fn with_30_percent_lost_the_file_is_the_log_and_nothing_waits_for_it() {
    let (output, written, robot) = played("lossy", (true, false), 0.3, &["--json"]);
    assert!(written == robot.logged, "{} of {} bytes", written.len(), robot.logged.len());
    let line = counts(&output);
    assert_eq!((&line["bytes"], &line["gaps"]), (&written.len().into(), &0.into()), "{line}");
    // Twenty milliseconds apart, each after the state of check and kicker of that moment, always sent.
    let rounds: Vec<_> = robot.sent.chunk_by(|a, b| a.0 == b.0).collect();
    let mut logs = 0;
    for pair in rounds.windows(2) {
        assert_eq!(pair[1][0].0 - pair[0][0].0, 20);
        let kinds: Vec<_> = pair[1].iter().map(|(_, kind)| *kind).collect();
        let all = [protocol::bring_up::KIND, pulses::KIND, robot_log::KIND];
        assert!(kinds == all || kinds == all[..2], "{kinds:?}");
        logs += kinds.len() - 2;
    }
    assert!(10 * logs > 9 * rounds.len(), "{logs} of {}", rounds.len());
}

#[test]
fn what_the_robot_had_overwritten_before_it_was_sent_is_a_gap_between_whole_frames() {
    let (output, written, robot) = played("flood", (true, true), 0.3, &["--json"]);
    let line = counts(&output);
    assert!(line["gaps"].as_u64() > Some(0) && line["missing"].as_u64() > Some(1_000), "{line}");
    assert_eq!(line["bytes"], written.len());
    let mut logged = robot.logged.chunks(41);
    assert!(written.chunks(41).all(|frame| logged.any(|one| one == frame)), "frames in their order");
    assert!(written.len() > 1_000 && written.last_chunk::<41>() == robot.logged.last_chunk());
}

#[test]
fn a_robot_whose_image_sends_no_log_is_named_and_no_other_file_is_overwritten() {
    let (output, written, _) = played("old", (false, false), 0.0, &[]);
    let (stdout, stderr) = (text(&output.stdout), text(&output.stderr));
    assert!(written.is_empty() && stdout.ends_with(": 0 bytes, 0 missing (gaps: 0)\n"), "{stdout}");
    assert!(stderr.contains("the robot sent no log: its image is older"), "{stderr}");
    let key = file("kept.key");
    std::fs::write(&key, "5a".repeat(16)).expect("a key file");
    let output = onetwo("udp://127.0.0.1:9", &key, &key, &[]);
    let stderr = text(&output.stderr);
    assert!(stderr.contains("this command reads it; name another file"), "{stderr}");
    assert_eq!(std::fs::read(&key).expect("the key").len(), 32);
    std::fs::remove_file(key).expect("our own file");
}
