//! `kick_cli`: `onetwo robot bring-up --kick` beside a robot with a kicker of simulated parts on UDP, whose
//! radio loses packets: what is printed is what was fired.

mod lossy;

use std::net::UdpSocket;
use std::path::PathBuf;
use std::process::{Command, Output, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use protocol::bring_up::Reporter;
use protocol::frame::TeamKey;
use protocol::link::Link;
use protocol::team::{Handshake, TeamMessage};
use protocol::{RobotId, TeamId};
use runtime::bring_up::{Listener, Results};
use runtime::kicker::{FULL_VOLTS, KickerAct, KickerState};
use serde_json::Value;

use lossy::LossyStation;

const KEY: TeamKey = TeamKey([0x5a; 16]);
const TEAM: TeamId = TeamId(2);

/// A file of its own for each test.
fn file(name: &str) -> PathBuf {
    std::env::temp_dir().join(format!("onetwo-kick-{}-{name}", std::process::id()))
}

fn onetwo(robots: &str, name: &str, more: &[&str]) -> Output {
    let key = file(&format!("{name}.key"));
    std::fs::write(&key, "5a".repeat(16)).expect("a key file");
    let output = Command::new(env!("CARGO_BIN_EXE_onetwo"))
        .args(["robot", "bring-up", "--team", "2", "--robot", "3", "--robots", robots, "--key-file"])
        .arg(&key)
        .args(more)
        .env("XDG_STATE_HOME", file("state"))
        .stdin(Stdio::null())
        .output()
        .expect("the program starts");
    std::fs::remove_file(key).expect("our own file");
    output
}

/// A robot with its kicker behind a base station that loses that share of its packets, both ways; a person
/// lays the next ball a quarter of a second after a kick. Returns its pulses.
fn robot(mut station: LossyStation<'_>, charger: bool, end: &AtomicBool) -> Vec<KickerAct> {
    let robot = RobotId::new(3).expect("a number");
    let who = Reporter { team: TEAM, robot, key: KEY.of_robot(robot).host, epoch: 17 };
    let (mut results, mut listener, mut volts) = (Results::new(who), Listener::default(), 0.0_f32);
    let mut pulses = Vec::new();
    let (began, mut kicked, mut ms) = (Instant::now(), 0_u64, 0_u64);
    while !end.load(Ordering::Relaxed) {
        ms += 1;
        thread::sleep(Duration::from_millis(ms).saturating_sub(began.elapsed()));
        let now = protocol::Instant(1_000 * ms);
        station.receive(|packet| {
            listener.receive(packet);
            results.kicks.receive(now, packet);
        });
        let act = results.kicks.step(now, KickerState { ball: ms > kicked + 250, volts });
        match act {
            KickerAct::Charge if charger => volts = (volts + FULL_VOLTS / 1_000.0).min(1.02 * FULL_VOLTS),
            KickerAct::Charge | KickerAct::Rest => {}
            KickerAct::Bleed => volts *= 0.9997,
            KickerAct::Flat(long) | KickerAct::Chip(long) => {
                volts *= 1.0 - long.0 as f32 / 12_000.0;
                kicked = ms;
                pulses.push(act);
            }
        }
        let heard = listener.host_epoch(TEAM);
        if station.has_host() && ms.is_multiple_of(20) {
            station.send(&results.kick_packet(now, heard));
        }
    }
    pulses
}

fn played(name: &str, charger: bool, loses: f32, more: &[&str]) -> (Output, Vec<KickerAct>) {
    let station = UdpSocket::bind("127.0.0.1:0").expect("a port");
    let robots = format!("udp://{}", station.local_addr().expect("an address"));
    let end = AtomicBool::new(false);
    thread::scope(|scope| {
        let fired = scope.spawn(|| robot(LossyStation::new(&station, loses), charger, &end));
        let output = onetwo(&robots, name, more);
        end.store(true, Ordering::Relaxed);
        (output, fired.join().expect("the robot"))
    })
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

#[test]
fn every_pulse_is_fired_and_reported_once_with_30_percent_of_packets_lost() {
    let more = ["--kick", "1500,4500", "--repeat", "2", "--ball", "1", "--json", "--chip"];
    let (output, fired) = played("lossy", true, 0.3, &more);
    let lines: Vec<Value> = text(&output.stdout)
        .lines()
        .map(|line| serde_json::from_str(line).expect("an object a line"))
        .collect();
    let pulses = [1_500, 1_500, 4_500, 4_500];
    let expected = pulses.map(|micros| KickerAct::Chip(protocol::Duration(micros)));
    assert_eq!((fired, lines.len()), (expected.to_vec(), 4), "{}", text(&output.stderr));
    for (line, micros) in lines.iter().zip(pulses) {
        let volts = ["volts_before", "volts_after"].map(|key| line[key].as_f64().expect("a voltage"));
        assert_eq!((&line["pulse_us"], &line["ball"]), (&micros.into(), &true.into()));
        assert!((volts[1] / volts[0] - (1.0 - micros as f64 / 12_000.0)).abs() < 0.01, "{line}");
    }
    assert_eq!(output.status.code(), Some(0));
}

#[test]
fn without_a_ball_to_wait_for_it_fires_at_once() {
    let (output, fired) = played("text", true, 0.0, &["--kick", "2600", "--ball", "0"]);
    let stdout = text(&output.stdout);
    assert_eq!(fired, [KickerAct::Flat(protocol::Duration(2_600))], "{}", text(&output.stderr));
    assert!(stdout.starts_with(" 2600 µs flat: 20") && stdout.ends_with(" V, ball\n"), "{stdout}");
}

#[test]
fn a_refused_pulse_is_reported_with_its_reason_and_fails() {
    let (output, fired) = played("long", true, 0.0, &["--kick", "6000", "--ball", "0"]);
    let stdout = text(&output.stdout);
    assert!(stdout.contains("6000 µs flat: refused: no pulse of this length: 1 to 4500 µs"), "{stdout}");
    assert!(fired.is_empty() && output.status.code() == Some(1));
}

#[test]
fn a_capacitor_that_does_not_charge_and_a_robot_that_plays_fail_with_the_reason() {
    let (output, fired) = played("dead", false, 0.0, &["--kick", "1500", "--ball", "0", "--patience", "1"]);
    let stdout = text(&output.stdout);
    assert!(stdout.contains("refused: the capacitor is not full: 0.0 V") && fired.is_empty(), "{stdout}");
    assert_eq!(output.status.code(), Some(1));
    // A match image: it sends what a robot in play does, and answers nothing.
    let station = UdpSocket::bind("127.0.0.1:0").expect("a port");
    let robots = format!("udp://{}", station.local_addr().expect("an address"));
    let end = AtomicBool::new(false);
    let output = thread::scope(|scope| {
        scope.spawn(|| {
            let robot = RobotId::new(3).expect("a number");
            let mut link = Link::new(TEAM, robot, KEY.of_robot(robot), 1);
            station.set_read_timeout(Some(Duration::from_millis(20))).expect("a limit");
            let mut bytes = [0; 200];
            while !end.load(Ordering::Relaxed) {
                if let Ok((_, from)) = station.recv_from(&mut bytes) {
                    let packet = link.seal(&TeamMessage::Handshake(Handshake::default()));
                    let _ = station.send_to(&packet, from);
                }
            }
        });
        let output = onetwo(&robots, "playing", &["--kick", "1500", "--patience", "0.5"]);
        end.store(true, Ordering::Relaxed);
        output
    });
    let error = text(&output.stderr);
    assert!(error.contains("robot 3 runs another image than bring_up"), "{error}");
    assert_eq!(output.status.code(), Some(1));
}
