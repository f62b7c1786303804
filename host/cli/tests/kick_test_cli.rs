//! `kick_test_cli`: test of the kick test over the network. `control` with virtual robots on a simulator that
//! is reached by the league's protocol alone; a scripted controller lets the game run, and a viewer of the
//! page asks for the test and takes its gain.

#[path = "page_browser/program.rs"]
mod program;
mod running;

use std::net::SocketAddr;
use std::time::{Duration, Instant};

use program::Program;
use running::controller::Controller;
use running::simulator::teleport;
use running::{Running, free};
use serde_json::Value;
use ssl::referee::Command;
use ssl::simulation::TeleportBall;

/// Kicks of the test.
const KICKS: usize = 5;
/// Gains of the world's kickers, one of them the robot's (`kick_gain` of
/// hil-sim/data/worlds/weak-kickers.toml).
const GAINS: [f64; 2] = [0.6, 0.8];
/// Standard deviation of its kicks, share of their speed (`speed_sd` there).
const SCATTER: f64 = 0.05;
/// The most that a kick is off (`scatter_limit` of hil-sim/data/ssl-2013.toml: two standard deviations).
const SCATTER_MAX: f64 = 2.0 * SCATTER;
/// Longest time for all of them; a loaded machine is no failure.
const LONGEST: Duration = Duration::from_mins(3);

/// Parameters of our team, as the page gets them.
fn parameters(control: &Program) -> Value {
    let answer = control.get("/api/parameters");
    let (_, body) = answer.split_once("\r\n\r\n").expect("a head");
    let teams: Value = serde_json::from_str(body).expect("JSON");
    teams[0].clone()
}

/// A viewer that comes, asks for something and goes.
fn ask(control: &Program, request: &str) {
    let (mut viewer, _) =
        tungstenite::connect(format!("ws://{}/socket", control.address())).expect("a socket");
    viewer.send(tungstenite::Message::text(request)).expect("sent");
}

#[test]
fn a_kick_test_on_robots_over_the_network_fits_the_gain_and_takes_it() {
    let (vision, referee) = (free(), free());
    let controller = Controller::new(&referee);
    let quiet = ["--referee", "none", "--headless", "--world", "weak-kickers"];
    let simulate = ["simulate", "--ports", "0", "--listen", "127.0.0.1", "--vision", &vision];
    let mut simulator = Running::start(&[&simulate[..], &quiet[..]].concat());
    let control_port = simulator.control_port();
    let robots = format!("sim://127.0.0.1:{control_port}");
    let control = ["control", "--colour", "blue", "--robots", &robots, "--insecure-zero-key"];
    let from = ["--vision", &vision, "--referee", &referee, "--tracker", "127.0.0.1:9"];
    let page = ["--live-parameters", "--listen", "127.0.0.1:0"];
    let control = Program::start(&[&control[..], &from[..], &page[..]].concat());
    control.wait_for("robots are received");

    ask(&control, r#"{"ask":"kicks","team":"blue","robot":1,"kicks":5}"#);
    controller.send(|packet| packet.command = Command::ForceStart as i32);

    // A person brings the ball back where the robot may not fetch it.
    let begun = Instant::now();
    let test = loop {
        let test = parameters(&control)["test"].clone();
        if test["state"] == "done" {
            break test;
        }
        if test["state"] == "out-of-reach" {
            let middle = TeleportBall { x: Some(0.0), y: Some(0.0), ..TeleportBall::default() };
            teleport(SocketAddr::from(([127, 0, 0, 1], control_port)), middle);
        }
        assert!(begun.elapsed() < LONGEST, "{test}");
        std::thread::sleep(Duration::from_millis(200));
    };
    assert_eq!(test["kicks"].as_array().map(Vec::len), Some(KICKS), "{test}");
    let gain = test["gain"]["value"].as_f64().expect("a gain");
    println!("{test}");
    let error = test["gain"]["error"].as_f64().expect("an error");
    let (low, high) = (GAINS[0] - 3.0 * error, GAINS[1] + 3.0 * error);
    assert!((low..high).contains(&gain) && error < SCATTER / 2.0, "{low} to {high}: {test}");
    for kick in test["kicks"].as_array().expect("a list") {
        let [ordered, seen] = [0, 1].map(|i| kick[i].as_f64().expect("a speed"));
        let off = seen / ordered / gain - 1.0;
        assert!(off.abs() < SCATTER_MAX + 3.0 * error, "{off}: {test}");
    }

    let take =
        format!(r#"{{"ask":"parameter","team":"blue","key":"calibration.kick","robot":1,"value":{gain}}}"#);
    ask(&control, &take);
    let begun = Instant::now();
    loop {
        let list = parameters(&control)["list"].to_string();
        if list.contains(&format!("{gain}")) {
            break;
        }
        assert!(begun.elapsed() < Duration::from_secs(30), "{list}");
        std::thread::sleep(Duration::from_millis(200));
    }
}
