//! `net_cli`: tests of `onetwo simulate` and `onetwo control` on a network. Real sockets on this machine,
//! ports that the system chooses, addresses of one machine, so that no multicast is needed.

mod running;

use std::net::{SocketAddr, UdpSocket};
use std::process::Command;
use std::time::{Duration, Instant};

use running::{PATIENCE, Running, free, socket};

use ssl::Message;
use ssl::simulation::{
    MoveCommand, MoveLocalVelocity, RobotCommand, RobotControl, RobotControlResponse, RobotMoveCommand,
};
use ssl::tracker::{TeamColor, TrackerWrapperPacket};
use ssl::vision::WrapperPacket;

/// Latest time after the start at which everything that is missing is told, in the soak; specified are 2 s.
const WAITS_TOLD_MAX: Duration = Duration::from_secs(15);

fn image(socket: &UdpSocket) -> ssl::vision::DetectionFrame {
    let mut bytes = [0; 8192];
    loop {
        let (length, _) = socket.recv_from(&mut bytes).expect("vision comes");
        let packet = WrapperPacket::decode(&bytes[..length]).expect("a packet of the vision");
        if let Some(detection) = packet.detection {
            return detection;
        }
    }
}

fn order(id: u32, forward: f32) -> Vec<u8> {
    let local = MoveLocalVelocity { forward, left: 0.0, angular: 0.0 };
    let command = RobotCommand {
        id,
        move_command: Some(RobotMoveCommand { command: Some(MoveCommand::LocalVelocity(local)) }),
        ..RobotCommand::default()
    };
    RobotControl { robot_commands: vec![command] }.encode_to_vec()
}

#[test]
fn a_client_sees_its_robot_move_and_is_informed_what_is_wrong() {
    let vision = socket();
    let to = vision.local_addr().expect("an address").to_string();
    let simulate = ["simulate", "--ports", "0", "--listen", "127.0.0.1", "--referee", "none"];
    let more = ["--vision", &to, "--ideal", "--cameras", "1", "--duration", "60"];
    let mut simulator = Running::start(&[&simulate[..], &more[..]].concat());
    let blue = SocketAddr::from(([127, 0, 0, 1], simulator.control_port() + 1));
    let x_of_3 = |image: &ssl::vision::DetectionFrame| {
        image.robots_blue.iter().find(|robot| robot.robot_id == Some(3)).map(|robot| robot.x)
    };
    let mut begin = None;
    while begin.is_none() {
        begin = x_of_3(&image(&vision));
    }
    let (begin, client, mut moved) = (begin.expect("seen"), socket(), 0.0);
    for _ in 0..2000 {
        client.send_to(&order(3, 1.0), blue).expect("sent");
        let seen = image(&vision);
        moved = x_of_3(&seen).map_or(moved, |x| x - begin);
        if moved > 300.0 {
            break;
        }
    }
    assert!(moved > 300.0, "robot 3 moved {moved} mm along +x");
    // Earlier datagrams are answered earlier.
    client.send_to(&order(99, 1.0), blue).expect("sent");
    let mut bytes = [0; 8192];
    let refused = (0..3000).find_map(|_| {
        let (length, _) = client.recv_from(&mut bytes).expect("an answer");
        let answer = RobotControlResponse::decode(&bytes[..length]).expect("an answer of the protocol");
        answer.errors.first().and_then(|error| error.code.clone())
    });
    assert!(refused.as_ref().is_some_and(|code| code.starts_with("ONETWO_")), "{refused:?}");
}

#[test]
fn the_example_in_python_drives_a_robot_by_velocities_alone() {
    let vision = socket();
    let to = vision.local_addr().expect("an address").to_string();
    let simulate = ["simulate", "--ports", "0", "--listen", "127.0.0.1", "--referee", "none"];
    let more = ["--vision", &to, "--ideal", "--cameras", "1", "--duration", "60", "--headless"];
    let mut simulator = Running::start(&[&simulate[..], &more[..]].concat());
    let port = (simulator.control_port() + 2).to_string();
    let example = concat!(env!("CARGO_MANIFEST_DIR"), "/../team/examples/velocities.py");
    let client = Command::new("python3").args([example, "4", "127.0.0.1", &port]).spawn();
    let mut client = client.expect("python3 is installed");
    let turned = (0..3000).any(|_| {
        let seen = image(&vision).robots_yellow;
        // Yellow faces −x at first; half a circle later it faces +x.
        seen.iter()
            .any(|robot| robot.robot_id == Some(4) && robot.orientation.is_some_and(|of| of.abs() < 0.3))
    });
    client.kill().and_then(|()| client.wait()).expect("it ran until now");
    assert!(turned, "yellow 4 drives a circle");
}

#[test]
fn one_command_starts_a_field_with_two_teams_and_ends_them_all() {
    let port = socket().local_addr().expect("an address").port().min(65_000);
    let mut all = Running::start(&["launch", "--headless", "--ports", &port.to_string()]);
    let mut received = [(); 2].map(|()| all.wait_for("| robots are received: 0 1 2 3 4 5").1);
    received.sort();
    assert!(received[0].starts_with("blue |") && received[1].starts_with("yellow |"), "{received:?}");
    all.interrupt();
    assert!(all.process.wait().expect("it ends").success());
    UdpSocket::bind(("0.0.0.0", port)).expect("the simulator has ended with it");
}

#[test]
fn a_robot_of_a_file_is_simulated_with_its_own_limits() {
    let vision = socket();
    let to = vision.local_addr().expect("an address").to_string();
    let simulate =
        ["simulate", "--ports", "0", "--listen", "127.0.0.1", "--referee", "none", "--robot", "school"];
    let more = ["--vision", &to, "--ideal", "--cameras", "1", "--duration", "60", "--headless"];
    let mut simulator = Running::start(&[&simulate[..], &more[..]].concat());
    let blue = SocketAddr::from(([127, 0, 0, 1], simulator.control_port() + 1));
    let client = socket();
    let (mut last, mut fastest) = (None, 0.0_f64);
    for _ in 0..150 {
        client.send_to(&order(3, 6.0), blue).expect("sent");
        let seen = image(&vision);
        let Some(robot) = seen.robots_blue.iter().find(|robot| robot.robot_id == Some(3)) else { continue };
        if let Some((x, at)) = last.filter(|(_, at)| seen.t_capture > *at) {
            fastest = fastest.max((f64::from(robot.x) - x) / 1000.0 / (seen.t_capture - at));
        }
        last = Some((f64::from(robot.x), seen.t_capture));
    }
    // hardware.speed of robots/school.toml; the default robot reaches 3.5 m/s.
    assert!((1.0..1.7).contains(&fastest), "{fastest} m/s");
}

#[test]
fn while_a_port_is_taken_nothing_is_sent_and_vision_comes_once_it_is_free() {
    let vision = socket();
    let to = vision.local_addr().expect("an address").to_string();
    let taken = socket();
    let port = taken.local_addr().expect("an address").port().min(65_000).to_string();
    let simulate = ["simulate", "--ports", &port, "--listen", "127.0.0.1", "--referee", "none"];
    let mut simulator = Running::start(&[&simulate[..], &["--vision", &to, "--duration", "60"]].concat());
    let (_, line) = simulator.wait_for("is taken");
    assert!(line.contains(&port) && line.contains("tried again"), "{line}");
    vision.set_nonblocking(true).expect("a socket");
    assert!(vision.recv_from(&mut [0; 8192]).is_err(), "a field that no program can command is not shown");
    vision.set_nonblocking(false).expect("a socket");
    drop(taken);
    image(&vision);
}

#[test]
fn the_internal_referee_speaks_and_the_simulator_ends_in_order() {
    let referee = socket();
    let to = referee.local_addr().expect("an address").to_string();
    let arguments = ["simulate", "--ports", "0", "--listen", "127.0.0.1", "--vision", &free()];
    let mut simulator = Running::start(&[&arguments[..], &["--referee-to", &to, "--duration", "1"]].concat());
    let mut bytes = [0; 8192];
    let (length, _) = referee.recv_from(&mut bytes).expect("the referee speaks");
    ssl::referee::Referee::decode(&bytes[..length]).expect("a packet of the referee");
    simulator.wait_for("ended after");
    assert!(simulator.process.wait().expect("it ends").success());
}

#[test]
fn control_says_what_it_waits_for_and_goes_on_when_it_comes() {
    let (vision, referee) = (free(), free());
    let arguments = [
        "control",
        "--robots",
        "udp://127.0.0.1:9",
        "--insecure-zero-key",
        "--tracker",
        "127.0.0.1:9",
        "--duration",
        "60",
    ];
    let mut control =
        Running::start(&[&arguments[..], &["--vision", &vision, "--referee", &referee]].concat());
    let mut waits: Vec<String> = Vec::new();
    let mut latest = Duration::ZERO;
    for _ in 0..3 {
        let (at, line) = control.wait_for("waiting for");
        latest = latest.max(at);
        waits.push(line);
    }
    for (what, hint) in
        [("vision", "onetwo simulate"), ("the referee", "game controller"), ("robots", "base station")]
    {
        let line = waits.iter().find(|line| line.contains(&format!("waiting for {what}")));
        assert!(line.is_some_and(|line| line.contains(hint)), "{what}: {waits:?}");
    }
    println!("all three are told after {latest:.1?}");
    if std::env::var_os("ONETWO_SOAK").is_some() {
        assert!(latest < WAITS_TOLD_MAX, "{latest:?}");
    }
    let arguments = ["simulate", "--ports", "0", "--listen", "127.0.0.1", "--duration", "60"];
    let _simulator =
        Running::start(&[&arguments[..], &["--vision", &vision, "--referee-to", &referee]].concat());
    let mut came = [control.wait_for("vision comes").1, String::new()];
    if !control.received.iter().any(|(_, line)| line.contains("the referee is received")) {
        came[1] = control.wait_for("the referee is received").1;
    }
    assert!(came[0].contains(&vision), "{came:?}");
}

#[test]
fn brains_of_our_own_take_their_places_for_the_kickoff() {
    let (vision, referee, tracked) = (free(), free(), socket());
    let simulate = ["simulate", "--ports", "0", "--listen", "127.0.0.1", "--duration", "60"];
    let mut simulator =
        Running::start(&[&simulate[..], &["--vision", &vision, "--referee-to", &referee]].concat());
    let robots = format!("sim://127.0.0.1:{}", simulator.control_port());
    let to = tracked.local_addr().expect("an address").to_string();
    let control = ["control", "--robots", &robots, "--tracker", &to, "--duration", "60"];
    let mut control = Running::start(&[&control[..], &["--vision", &vision, "--referee", &referee]].concat());
    control.wait_for("robots are received");
    // Blue starts within 1.5 m of the halfway line; the keeper has 3 m to go to its goal at −x.
    let (until, mut bytes) = (Instant::now() + PATIENCE, [0; 8192]);
    let mut places = Vec::new();
    while Instant::now() < until {
        let (length, _) = tracked.recv_from(&mut bytes).expect("our tracker speaks");
        let packet = TrackerWrapperPacket::decode(&bytes[..length]).expect("a tracker packet");
        let robots = packet.tracked_frame.unwrap_or_default().robots;
        let blue = robots.iter().filter(|robot| robot.robot_id.team_color == TeamColor::Blue as i32);
        places = blue.map(|robot| (robot.robot_id.id, robot.pos.x, robot.pos.y)).collect();
        let legal = places.iter().all(|(_, x, y)| *x < 0.0 && x.hypot(*y) > 0.5);
        let guarded = places.iter().any(|(id, x, y)| *id == 0 && *x < -4.0 && y.abs() < 0.6);
        if places.len() == 6 && legal && guarded {
            return;
        }
    }
    panic!("not at their places: {places:?}");
}

#[test]
fn wrong_settings_are_refused_with_what_would_be_right() {
    for (arguments, description) in [
        (vec!["control", "--colour", "red"], "blue or yellow"),
        (vec!["control", "--robots", "tcp://x"], "sim://HOST"),
        (vec!["control", "--config", "no-such.toml"], "no-such.toml"),
        (vec!["control", "--kick", "3=9"], "0.4 to 2"),
    ] {
        let out = Command::new(env!("CARGO_BIN_EXE_onetwo")).args(&arguments).output().expect("it starts");
        assert_eq!(out.status.code(), Some(1), "{arguments:?}");
        assert!(String::from_utf8_lossy(&out.stderr).contains(description), "{arguments:?}");
    }
    let out = Command::new(env!("CARGO_BIN_EXE_onetwo")).args(["simulate", "--cameras", "3"]).output();
    assert_eq!(out.expect("it starts").status.code(), Some(2));
}

#[test]
fn settings_are_written_to_a_new_file_that_control_reads_to_the_same_settings() {
    let file = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("new-team.toml");
    let _ = std::fs::remove_file(&file);
    let control = |arguments: &[&str]| {
        let out = Command::new(env!("CARGO_BIN_EXE_onetwo")).arg("control").args(arguments).output();
        out.expect("it starts")
    };
    let path = file.display().to_string();
    let written = control(&["--colour", "yellow", "--keeper", "4", "--init", &path]);
    assert!(written.status.success(), "{}", String::from_utf8_lossy(&written.stderr));
    let text = std::fs::read_to_string(&file).expect("the file");
    assert!(text.contains("\ncolour = \"yellow\"") && text.contains("\nkeeper = 4"), "{text}");
    let printed = control(&["--config", &path, "--print-config"]);
    assert_eq!(String::from_utf8_lossy(&printed.stdout), text);
    let again = control(&["--init", &path]);
    assert_eq!(again.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&again.stderr).contains("exists already and is kept"));
    assert_eq!(std::fs::read_to_string(&file).expect("the file"), text);
}
