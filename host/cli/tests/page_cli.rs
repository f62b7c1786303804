//! `page_cli`: tests: the verbs serve their page and accept only permitted requests. Tested with a viewer
//! that is no browser.

#[path = "page_browser/program.rs"]
mod program;
mod running;

use std::net::TcpStream;
use std::process::Command;
use std::time::{Duration, Instant};

use program::Program;
use serde_json::Value;
use tungstenite::stream::MaybeTlsStream;
use tungstenite::{Message, WebSocket};

/// Generous: a loaded machine is no failure.
const PATIENCE: Duration = Duration::from_secs(40);

struct Viewer(WebSocket<MaybeTlsStream<TcpStream>>);

impl Viewer {
    fn of(program: &Program) -> Self {
        Self::with(program, "")
    }

    fn with(program: &Program, query: &str) -> Self {
        let (socket, _) = tungstenite::connect(format!("ws://{}/socket{query}", program.address())).unwrap();
        if let MaybeTlsStream::Plain(stream) = socket.get_ref() {
            stream.set_read_timeout(Some(PATIENCE)).unwrap();
        }
        Self(socket)
    }

    fn ask(&mut self, description: &str) {
        self.0.send(Message::text(description)).unwrap();
    }

    /// The first message for which `holds` is true.
    fn until(&mut self, holds: impl Fn(&Value) -> bool) -> Value {
        let begun = Instant::now();
        while begun.elapsed() < PATIENCE {
            if let Message::Text(text) = self.0.read().unwrap() {
                self.ask(".");
                let label: Value = serde_json::from_str(&text).unwrap();
                if holds(&label) {
                    return label;
                }
            }
        }
        panic!("waited in vain");
    }
}

fn robots(scene: &Value) -> usize {
    scene["robots"].as_array().map_or(0, Vec::len)
}

/// A match on a page of its own, four times as fast as the clock.
fn played() -> Program {
    let arguments = "play --duration 600 --seed 5 --listen 127.0.0.1:0 --speed 4";
    Program::start(&arguments.split(' ').collect::<Vec<_>>())
}

#[test]
fn a_match_is_displayed_stopped_and_begun_again() {
    let play = played();
    let mut viewer = Viewer::of(&play);
    viewer.until(|scene| robots(scene) == 12 && scene["seed"] == 5);
    viewer.ask(r#"{"ask":"pause","on":true}"#);
    let still = viewer.until(|scene| scene["paused"] == true);
    viewer.ask(r#"{"ask":"step","ticks":10}"#);
    let t = still["t"].as_f64().unwrap();
    let later = viewer.until(|scene| scene["t"].as_f64().is_some_and(|now| now > t + 0.095));
    assert!((later["t"].as_f64().unwrap() - t - 0.1).abs() < 1e-6, "ten ticks, no more");
    viewer.ask(r#"{"ask":"restart","seed":6}"#);
    let anew = viewer.until(|scene| scene["seed"] == 6);
    assert!(anew["t"].as_f64().unwrap() < t.max(3.0));
    // Paths of more than two points: planned ones.
    viewer.until(|scene| {
        let paths = scene["robots"].as_array().unwrap().iter().map(|robot| &robot["mind"]["intent"]["path"]);
        paths.filter_map(Value::as_array).any(|line| line.len() > 3)
    });
    viewer.ask(r#"{"ask":"fly"}"#);
    let refused = viewer.until(|message| message.get("refused").is_some());
    assert!(refused["refused"].as_str().unwrap().contains("no request"), "{refused}");
}

#[test]
fn what_is_asked_of_a_robot_that_is_not_there_is_refused_with_a_reason() {
    let play = played();
    let mut viewer = Viewer::of(&play);
    viewer.until(|scene| robots(scene) == 12);
    for asked in [
        r#"{"ask":"robot","team":"blue","id":15,"at":[0,0]}"#,
        r#"{"ask":"power","team":"yellow","id":15,"on":false}"#,
    ] {
        viewer.ask(asked);
        let refused = viewer.until(|message| message.get("refused").is_some());
        assert!(refused["refused"].as_str().unwrap().contains("has no robot 15"), "{asked}: {refused}");
    }
    viewer.ask("{\"ask\":\"referee\",\"command\":\"FLY\\u001b[2J\"}");
    let refused = viewer.until(|message| message.get("refused").is_some());
    let description = refused["refused"].as_str().unwrap();
    assert!(
        description.contains("makes no sense now") && !description.contains(char::is_control),
        "{description:?}"
    );
}

#[test]
fn a_page_on_the_network_is_looked_at_by_all_and_asked_by_those_with_its_token() {
    let arguments = "play --duration 600 --seed 5 --listen 0.0.0.0:0";
    let play = Program::start(&arguments.split(' ').collect::<Vec<_>>());
    let token = play.token().expect("a token is printed with the address").to_owned();
    let mut unauthenticated = Viewer::of(&play);
    unauthenticated.until(|scene| robots(scene) == 12);
    unauthenticated.ask(r#"{"ask":"pause","on":true}"#);
    let refused = unauthenticated.until(|message| message.get("refused").is_some());
    assert!(refused["refused"].as_str().unwrap().contains("?token="), "{refused}");
    let mut own = Viewer::with(&play, &format!("?token={token}"));
    own.ask(r#"{"ask":"pause","on":true}"#);
    own.until(|scene| scene["paused"] == true);
}

/// Distance of a shape of the truth layer from a place, m.
fn off(shape: &Value, at: [f64; 2]) -> f64 {
    let place = |i: usize| shape["at"][i].as_f64().unwrap();
    (place(0) - at[0]).hypot(place(1) - at[1])
}

#[test]
fn a_case_is_played_from_its_own_situation() {
    let play = played();
    let mut viewer = Viewer::of(&play);
    // Its own side is known after the first referee packet.
    viewer.until(|scene| robots(scene) == 12 && scene["t"].as_f64().unwrap() > 2.0);
    viewer.ask(r#"{"ask":"situation","name":"nowhere/nothing"}"#);
    let refused = viewer.until(|message| message.get("refused").is_some());
    assert!(refused["refused"].as_str().unwrap().contains("nowhere/nothing"), "{refused}");
    viewer.ask(r#"{"ask":"pause","on":true}"#);
    viewer.until(|scene| scene["paused"] == true);
    // From its file: three robots that build up from the back.
    let (ball, teammates) = ([-3.2, 0.5], [[-3.35, 0.5], [-2.2, 1.7], [-0.9, 0.5]]);
    viewer.ask(r#"{"ask":"situation","name":"back/build-up"}"#);
    let there = viewer.until(|scene| {
        let truth =
            scene["layers"].as_array().unwrap().iter().find(|layer| layer["name"] == "truth").unwrap();
        truth["shapes"]
            .as_array()
            .unwrap()
            .iter()
            .any(|shape| shape["tone"] == "ball" && off(shape, ball) < 0.01)
    });
    let truth = there["layers"].as_array().unwrap().iter().find(|layer| layer["name"] == "truth").unwrap();
    for at in teammates {
        assert!(truth["shapes"].as_array().unwrap().iter().any(|shape| off(shape, at) < 0.01), "{at:?}");
    }
    viewer.ask(r#"{"ask":"pause","on":false}"#);
    viewer.until(|scene| scene["game"]["phase"] == "run");
}

#[test]
fn a_taken_port_ends_a_match_with_a_word_about_what_to_do() {
    let first = Program::play(&[]);
    let second = Command::new(env!("CARGO_BIN_EXE_onetwo"))
        .args(["play", "--listen", first.address()])
        .output()
        .unwrap();
    let stderr = String::from_utf8_lossy(&second.stderr);
    assert_eq!(second.status.code(), Some(1), "{stderr}");
    assert!(stderr.contains("another program") && stderr.contains("--listen"), "{stderr}");
}

#[test]
fn a_real_field_is_halted_from_the_page_and_nothing_else() {
    let nobody = ["--vision", "127.0.0.1:0", "--referee", "127.0.0.1:0"];
    let robots = ["control", "--robots", "udp://127.0.0.1:9", "--insecure-zero-key"];
    let control = ["--duration", "60", "--listen", "127.0.0.1:0"];
    let control = Program::start(&[&robots[..], &control[..], &nobody[..]].concat());
    let mut viewer = Viewer::of(&control);
    viewer.until(|scene| scene["t"].is_number());
    viewer.ask(r#"{"ask":"speed","factor":2}"#);
    let refused = viewer.until(|message| message.get("refused").is_some());
    assert!(refused["refused"].as_str().unwrap().contains("nothing but HALT"), "{refused}");
    viewer.ask(r#"{"ask":"halt"}"#);
    control.wait_for("HALT was asked for on the page");
}

#[test]
fn a_simulated_field_for_others_is_displayed_with_its_truth() {
    let quiet = ["--vision", "127.0.0.1:9", "--referee-to", "127.0.0.1:9", "--ports", "0"];
    let simulate = ["simulate", "--page", "127.0.0.1:0", "--duration", "60"];
    let simulate = Program::start(&[&simulate[..], &quiet[..]].concat());
    let mut viewer = Viewer::of(&simulate);
    let scene = viewer.until(|scene| robots(scene) == 12);
    let layers = scene["layers"].as_array().unwrap();
    assert!(layers.iter().any(|layer| layer["name"] == "truth"));
    viewer.ask(r#"{"ask":"referee","command":"HALT"}"#);
    viewer.until(|scene| scene["game"]["phase"] == "halt");
    viewer.ask(r#"{"ask":"pause","on":true}"#);
    viewer.until(|scene| scene["paused"] == true);
    // The vision's clock stands with the world's: the scene that was in progress is displayed before the next
    // request.
    let t = viewer.until(|scene| scene["paused"] == true)["t"].as_f64().unwrap();
    viewer.ask(r#"{"ask":"step","ticks":25}"#);
    let later = viewer.until(|scene| scene["t"].as_f64().is_some_and(|now| now > t + 0.2));
    assert!((later["t"].as_f64().unwrap() - t - 0.25).abs() < 1e-4, "25 ticks, no more: {t} {}", later["t"]);
    viewer.ask(r#"{"ask":"restart","seed":9}"#);
    let anew = viewer.until(|scene| scene["seed"] == 9);
    assert!(anew["t"].as_f64().unwrap() < t && anew["paused"] == true);
}

#[test]
fn a_recording_is_kept_whole_for_who_looks_through_it() {
    let log = concat!(env!("CARGO_MANIFEST_DIR"), "/../../protocol/ssl/tests/data/grsim_divB_22s.log.gz");
    let replay = Program::start(&["replay", log, "--watch", "--listen", "127.0.0.1:0"]);
    let mut viewer = Viewer::of(&replay);
    // 22 seconds of it.
    let last = viewer.until(|scene| scene["t"].as_f64().is_some_and(|t| t > 20.0));
    assert!(robots(&last) > 0);
    viewer.ask(r#"{"ask":"halt"}"#);
    let refused = viewer.until(|message| message.get("refused").is_some());
    assert!(refused["refused"].as_str().unwrap().contains("recording"), "{refused}");
}

#[test]
fn a_recording_that_breaks_off_says_so() {
    let log = concat!(env!("CARGO_MANIFEST_DIR"), "/../../protocol/ssl/tests/data/grsim_divB_22s.log.gz");
    let whole = std::fs::read(log).unwrap();
    let cut = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("cut.log.gz");
    std::fs::write(&cut, &whole[..whole.len() / 2]).unwrap();
    let replay = Program::start(&["replay", cut.to_str().unwrap(), "--watch", "--listen", "127.0.0.1:0"]);
    replay.wait_for("the file breaks off: ");
    // A viewer has it among the events.
    Viewer::of(&replay).until(|scene| scene["t"].as_f64().is_some_and(|t| t > 5.0));
    let begun = Instant::now();
    while !replay.get("/api/events").contains("the file breaks off: ") {
        assert!(begun.elapsed() < PATIENCE, "waited in vain");
        std::thread::sleep(Duration::from_millis(20));
    }
}
