//! `remote_match_cli`: tests of `onetwo simulate` under an external game controller. A scripted controller on
//! this machine: referee packets made here, and the port for automatic referees; a client of the simulation
//! protocol and of the vision checks the effects.

mod running;

use std::net::{SocketAddr, TcpListener, UdpSocket};
use std::sync::mpsc::{Receiver, channel};
use std::thread;
use std::time::Instant;

use running::controller::Controller;
use running::simulator::teleport;
use running::{PATIENCE, Running, free, socket};
use ssl::Message;
use ssl::controller::ci::{ChangeOf, CiInput, CiOutput};
use ssl::controller::{
    AutoRefRegistration, AutoRefToController, ControllerReply, ControllerToAutoRef, StatusCode,
};
use ssl::event::GameEventType;
use ssl::net::Connection;
use ssl::referee::{Command, Point, Referee};
use ssl::simulation::TeleportBall;
use ssl::vision::{DetectionFrame, WrapperPacket};

/// Camera frames of two cameras at 75 Hz, in which a simulator takes what was sent before.
const FRAMES_UNTIL_SEEN: usize = 40;

/// The first image for which `holds`; earlier ones are passed over.
fn image(socket: &UdpSocket, what: &str, holds: impl Fn(&DetectionFrame) -> bool) {
    let (until, mut bytes, mut last) = (Instant::now() + PATIENCE, [0; 8192], None);
    while Instant::now() < until {
        let (length, _) = socket.recv_from(&mut bytes).expect("vision comes");
        let packet = WrapperPacket::decode(&bytes[..length]).expect("a packet of the vision");
        let Some(detection) = packet.detection else { continue };
        if holds(&detection) {
            return;
        }
        last = Some(detection);
    }
    panic!("{what}: {last:?}");
}

/// Stops the game and lets it run; returns once the simulator has played on with it, some camera frames
/// later.
fn start(controller: &Controller, vision: &UdpSocket) {
    controller.send(|packet| packet.command = Command::Stop as i32);
    controller.send(|packet| packet.command = Command::ForceStart as i32);
    let mut bytes = [0; 8192];
    vision.set_nonblocking(true).expect("a socket");
    while vision.recv_from(&mut bytes).is_ok() {}
    vision.set_nonblocking(false).expect("a socket");
    for _ in 0..FRAMES_UNTIL_SEEN {
        vision.recv_from(&mut bytes).expect("vision comes");
    }
}

fn ball_at(frame: &DetectionFrame, x: f32, y: f32) -> bool {
    frame.balls.iter().any(|ball| (ball.x - x).abs() < 1.0 && (ball.y - y).abs() < 1.0)
}

#[test]
fn the_assistant_puts_the_ball_takes_a_robot_off_and_brings_it_back() {
    let (vision, referee) = (socket(), free());
    let to = vision.local_addr().expect("an address").to_string();
    let controller = Controller::new(&referee);
    let simulate = ["simulate", "--ports", "0", "--listen", "127.0.0.1", "--headless", "--assistant"];
    let more = ["--referee", &referee, "--vision", &to, "--ideal", "--cameras", "1", "--speed", "4"];
    let mut simulator = Running::start(&[&simulate[..], &more[..]].concat());
    let control = SocketAddr::from(([127, 0, 0, 1], simulator.control_port()));
    simulator.wait_for("a game controller is received at");
    teleport(control, TeleportBall { x: Some(1.0), y: Some(-1.0), ..TeleportBall::default() });
    image(&vision, "the ball is moved", |frame| ball_at(frame, 1_000.0, -1_000.0));
    controller.send(|packet| {
        packet.command = Command::Stop as i32;
        packet.next_command = Some(Command::PrepareKickoffYellow as i32);
        packet.designated_position = Some(Point { x: 0.0, y: 0.0 });
    });
    let (_, line) = simulator.wait_for("assistant  puts the ball");
    assert!(line.contains("(0.00, 0.00) m: for yellow's kick-off"), "{line}");
    image(&vision, "the ball is in the middle", |frame| ball_at(frame, 0.0, 0.0));
    // A yellow card: no robot leaves by itself, and after 10 s one is taken off.
    controller.send(|packet| packet.blue.max_allowed_bots = Some(5));
    let (_, line) = simulator.wait_for("assistant  takes blue");
    assert!(line.contains("too many robots for 10 s"), "{line}");
    image(&vision, "five are left", |frame| frame.robots_blue.len() == 5);
    controller.send(|packet| packet.blue.max_allowed_bots = Some(6));
    let (_, line) = simulator.wait_for("assistant  puts blue");
    assert!(line.contains("may have another robot"), "{line}");
    image(&vision, "six again", |frame| frame.robots_blue.len() == 6);
}

#[test]
fn the_automatic_referee_registers_and_reports_what_it_sees() {
    let (vision, referee) = (socket(), free());
    let to = vision.local_addr().expect("an address").to_string();
    let listener = TcpListener::bind("127.0.0.1:0").expect("a port");
    let autoref = listener.local_addr().expect("an address").to_string();
    let controller = Controller::new(&referee);
    let simulate = ["simulate", "--ports", "0", "--listen", "127.0.0.1", "--headless", "--ideal"];
    let more = ["--referee", &referee, "--vision", &to, "--autoref", &autoref];
    let mut simulator = Running::start(&[&simulate[..], &more[..]].concat());
    let control = SocketAddr::from(([127, 0, 0, 1], simulator.control_port()));
    let (stream, _) = listener.accept().expect("a connection");
    let mut talk = Connection::over(stream).expect("a talk");
    let reply = ControllerReply { status_code: Some(StatusCode::Ok as i32), ..ControllerReply::default() };
    let reply = ControllerToAutoRef { controller_reply: Some(reply) };
    talk.send(&reply).expect("greeted");
    let registration: Option<AutoRefRegistration> = talk.receive(PATIENCE).expect("no error");
    assert_eq!(registration.expect("a registration").identifier, "onetwo");
    talk.send(&reply).expect("accepted");
    simulator.wait_for("a game controller is received at");
    start(&controller, &vision);
    for (x, y, vx, vy, kind) in [
        (0.0, 2.5, 0.0, 4.0, GameEventType::BallLeftFieldTouchLine),
        (4.0, 0.0, 4.0, 0.0, GameEventType::PossibleGoal),
    ] {
        let [x, y, vx, vy] = [x, y, vx, vy].map(Some);
        teleport(control, TeleportBall { x, y, vx, vy, ..TeleportBall::default() });
        let report: Option<AutoRefToController> = talk.receive(PATIENCE).expect("no error");
        let event = report.expect("a report").game_event.expect("an event");
        assert_eq!(event.r#type, Some(kind as i32), "{event:?}");
        assert_eq!((event.created_timestamp, event.id), (None, None), "both are the controller's to give");
        talk.send(&reply).expect("accepted");
        // The controller stops the game, and it goes on.
        start(&controller, &vision);
    }
}

/// A game controller in CI mode that stands at STOP: each message with a time or an act is answered. Sends on
/// what it was sent.
fn standing_controller() -> (String, Receiver<CiInput>) {
    let listener = TcpListener::bind("127.0.0.1:0").expect("a port");
    let address = listener.local_addr().expect("an address").to_string();
    let (send, inputs) = channel();
    thread::spawn(move || {
        let (stream, _) = listener.accept().expect("a connection");
        let mut talk = Connection::over(stream).expect("a talk");
        let mut packet = Referee { command: Command::Stop as i32, ..Referee::default() };
        while let Ok(Some(input)) = talk.receive::<CiInput>(PATIENCE) {
            let acts = input.api_inputs.iter().filter_map(|act| act.change.as_ref()?.change.as_ref());
            for act in acts {
                if let ChangeOf::SetStatusMessage(set) = act {
                    packet.status_message.clone_from(&set.status_message);
                }
            }
            let output = CiOutput { referee_msg: Some(packet.clone()) };
            if talk.send(&output).is_err() || send.send(input).is_err() {
                break;
            }
        }
    });
    (address, inputs)
}

#[test]
fn the_fields_clock_leads_a_game_controller_whose_packets_go_out() {
    let (vision, referee) = (free(), socket());
    let to = referee.local_addr().expect("an address").to_string();
    let (address, inputs) = standing_controller();
    let simulate = ["simulate", "--ports", "0", "--listen", "127.0.0.1", "--headless", "--speed", "2"];
    let more = ["--vision", &vision, "--referee-to", &to, "--game-controller", &address];
    let mut simulator = Running::start(&[&simulate[..], &more[..]].concat());
    simulator.wait_for(&format!("referee  game controller {address}, by this field's clock"));
    let mut stamps_ms = Vec::new();
    while stamps_ms.len() < 50 {
        let input = inputs.recv_timeout(PATIENCE).expect("the field leads");
        let Some(stamp_ns) = input.timestamp else { continue };
        assert_eq!(input.geometry.is_some(), stamps_ms.is_empty(), "once");
        let frame = input.tracker_packet.and_then(|packet| packet.tracked_frame).expect("the field");
        assert_eq!((frame.robots.len(), frame.balls.len()), (12, 1));
        stamps_ms.push(stamp_ns / 1_000_000);
    }
    let steps_ms: Vec<i64> = stamps_ms.windows(2).map(|two| two[1] - two[0]).collect();
    assert!(steps_ms.iter().all(|step| (20..=40).contains(step)), "simulated time: {steps_ms:?}");
    let mut bytes = [0; 8192];
    let (length, _) = referee.recv_from(&mut bytes).expect("the referee's packets");
    let packet = Referee::decode(&bytes[..length]).expect("a packet of the referee");
    assert_eq!(packet.command, Command::Stop as i32);
    assert!((packet.packet_timestamp / 1_000).abs_diff(stamps_ms[0] as u64) < 10_000, "the field's time");
    // Without it there is no referee: the field ends, with the reason.
    drop(inputs);
    let status = simulator.process.wait().expect("it ends");
    assert_eq!(status.code(), Some(1));
}

#[test]
fn without_a_game_controller_elsewhere_both_are_refused() {
    for more in [&["--assistant"][..], &["--autoref", "127.0.0.1"][..]] {
        let output = std::process::Command::new(env!("CARGO_BIN_EXE_onetwo"))
            .args([&["simulate", "--headless"][..], more].concat())
            .output()
            .expect("the program runs");
        assert!(!output.status.success());
        let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(stderr.contains("--referee none"), "{stderr}");
    }
}
