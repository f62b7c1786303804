//! `bring_up_cli`: `onetwo robot bring-up` beside a robot of simulated parts on UDP, whose radio loses
//! packets: the host prints what the robot found.

use std::net::{SocketAddr, UdpSocket};
use std::path::PathBuf;
use std::process::{Command, Output, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;

use protocol::bring_up::{CHECKS, CheckReport, Reporter};
use protocol::frame::TeamKey;
use protocol::{RobotId, TeamId};
use runtime::bring_up::bench::{Fault, play_steps};
use runtime::bring_up::{Listener, Results};
use serde_json::Value;

const KEY: TeamKey = TeamKey([0x5a; 16]);
const TEAM: TeamId = TeamId(2);

/// A key file of its own for each test.
fn key_file(name: &str) -> PathBuf {
    let file = std::env::temp_dir().join(format!("onetwo-bring-up-{}-{name}.key", std::process::id()));
    std::fs::write(&file, "5a".repeat(16)).expect("a key file");
    file
}

fn onetwo(robots: &str, name: &str, more: &[&str]) -> Output {
    let key = key_file(name);
    let output = Command::new(env!("CARGO_BIN_EXE_onetwo"))
        .args(["robot", "bring-up", "--team", "2", "--robots", robots, "--key-file"])
        .arg(&key)
        .args(more)
        .env("XDG_STATE_HOME", std::env::temp_dir().join(format!("onetwo-bring-up-{}", std::process::id())))
        .stdin(Stdio::null())
        .output()
        .expect("the program starts");
    std::fs::remove_file(key).expect("our own file");
    output
}

/// A robot of simulated parts behind a base station that loses that share of its packets. It plays its checks
/// once a host is there, faster than in real time, and tells them until `end`; returns what it found.
fn robot(station: &UdpSocket, fault: Fault, loses: f32, end: &AtomicBool) -> Vec<CheckReport> {
    let mut listener = Listener::default();
    let wait = Duration::from_millis(20);
    station.set_read_timeout(Some(wait)).expect("a limit");
    let mut bytes = [0; 200];
    let mut host: Option<SocketAddr> = None;
    while host.is_none() && !end.load(Ordering::Relaxed) {
        if let Ok((len, from)) = station.recv_from(&mut bytes) {
            listener.receive(&bytes[..len]);
            host = Some(from);
        }
    }
    let Some(host) = host else { return Vec::new() };
    let robot = RobotId::new(3).expect("a number");
    let reporter = Reporter { team: TEAM, robot, key: KEY.of_robot(robot).host, epoch: 17 };
    let (mut results, mut found, mut steps, mut dice) = (Results::new(reporter), Vec::new(), 0_u32, 1_u32);
    let mut send = |results: &mut Results| {
        dice = dice.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        if let Some(packet) = results.packet(listener.host_epoch(TEAM))
            && (dice >> 8) as f32 / 16_777_216.0 >= loses
        {
            let _ = station.send_to(&packet, host);
        }
        // A receiver's queue holds some hundred datagrams.
        thread::sleep(Duration::from_micros(200));
    };
    play_steps(fault, 1, |step| {
        results.take(step);
        found.extend(step.report);
        steps += 1;
        if steps.is_multiple_of(20) {
            send(&mut results);
        }
    });
    while !end.load(Ordering::Relaxed) {
        send(&mut results);
    }
    found
}

/// Both sides.
fn played(name: &str, fault: Fault, loses: f32, more: &[&str]) -> (Output, Vec<CheckReport>) {
    let station = UdpSocket::bind("127.0.0.1:0").expect("a port");
    let robots = format!("udp://{}", station.local_addr().expect("an address"));
    let end = AtomicBool::new(false);
    thread::scope(|scope| {
        let found = scope.spawn(|| robot(&station, fault, loses, &end));
        let output = onetwo(&robots, name, more);
        end.store(true, Ordering::Relaxed);
        (output, found.join().expect("the robot"))
    })
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

#[test]
fn bring_up_prints_the_robots_findings_with_a_third_of_the_packets_lost() {
    for (name, fault) in Fault::EXAMPLES {
        let (output, found) = played(name, fault, 0.3, &["--json"]);
        let lines: Vec<Value> = text(&output.stdout)
            .lines()
            .map(|line| serde_json::from_str(line).expect("an object a line"))
            .collect();
        assert_eq!(found.len(), CHECKS.len(), "{name}: {}", text(&output.stderr));
        for (number, report) in (1..).zip(&found) {
            let of = |line: &&Value| line["number"] == number && line["verdict"] != "running";
            let told: Vec<&Value> = lines.iter().filter(of).collect();
            let [one] = told[..] else { panic!("{name}, check {number}: {told:?}") };
            assert_eq!(one["check"], report.check.to_string());
            match report.result {
                Ok(value) => {
                    assert_eq!(one["verdict"], "pass", "{name}: {one}");
                    assert!((one["value"].as_f64().expect("a value") - f64::from(value)).abs() < 1e-3);
                }
                Err(finding) => assert_eq!(
                    (&one["verdict"], &one["finding"]),
                    (&"fail".into(), &finding.to_string().into())
                ),
            }
        }
        let failed = found.iter().filter(|report| report.result.is_err()).count();
        let last = lines.last().expect("the counts");
        assert_eq!((&last["failed"], &last["hears_us"]), (&failed.into(), &true.into()), "{name}");
        assert_eq!(output.status.code(), Some(i32::from(failed > 0)), "{name}");
        assert_eq!(failed == 0, fault == Fault::None, "{name}");
    }
}

#[test]
fn as_text_a_failed_check_says_what_to_look_at_and_the_last_line_counts() {
    let (output, _) = played("text", Fault::SwappedEncoders(0, 1), 0.0, &["--robot", "3"]);
    let text = text(&output.stdout);
    assert!(text.starts_with("robot 3, start 17: 12 checks\n"), "{text}");
    assert!(text.contains("pass   1  battery: nothing moves  (15.") && text.contains(" V)\n"), "{text}");
    assert!(
        text.contains("FAIL   3  front right wheel") && text.contains("swap the two encoders' cables"),
        "{text}"
    );
    assert!(text.ends_with("robot 3: 8 passed, 4 failed\n"), "{text}");
}

#[test]
fn silence_or_another_robot_is_an_error_that_names_what_to_look_at() {
    let silent = UdpSocket::bind("127.0.0.1:0").expect("a port");
    let robots = format!("udp://{}", silent.local_addr().expect("an address"));
    let output = onetwo(&robots, "silent", &["--patience", "0.5"]);
    let error = text(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{error}");
    assert!(
        error.contains("no robot reported its checks for 0.5 s") && error.contains("base station"),
        "{error}"
    );
    let (output, _) = played("other", Fault::None, 0.0, &["--robot", "4", "--patience", "0.5"]);
    assert!(text(&output.stderr).contains("reports come in of robot 3"), "{}", text(&output.stderr));
    let output = onetwo("sim://127.0.0.1", "sim", &[]);
    assert!(text(&output.stderr).contains("simulator"), "{}", text(&output.stderr));
}
