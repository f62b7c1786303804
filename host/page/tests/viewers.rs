//! `viewers`: tests: viewers get the newest scene, and only viewers get anything. Real sockets; viewers that
//! read, that do not, that disconnect, and foreign pages that try.

use std::io::{Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::sync::Arc;
use std::thread;
use std::time::{Duration, Instant};

use page::{
    DeferredScene, ExplanationService, Layer, Limits, MatchEvent, MatchEventKind, Page, PageError,
    PageSettings, PageTeam, Powers, Scene, UserRequest,
};
use tungstenite::client::IntoClientRequest;
use tungstenite::stream::MaybeTlsStream;
use tungstenite::{Message, WebSocket};

type Viewer = WebSocket<MaybeTlsStream<TcpStream>>;

struct Echo;

impl ExplanationService for Echo {
    fn explain(&self, problem: &str) -> Result<String, String> {
        if problem.starts_with('{') {
            Ok(format!("{{\"asked\":{problem}}}"))
        } else {
            Err("no problem".to_owned())
        }
    }
}

fn settings(powers: Powers) -> PageSettings {
    let listen = SocketAddr::from(([127, 0, 0, 1], 0));
    let (token, limits) = (None, Limits::default());
    PageSettings {
        listen,
        title: "a test".to_owned(),
        recorded: false,
        powers,
        token,
        limits,
        log: Arc::default(),
    }
}

fn open(powers: Powers) -> Page {
    Page::open(settings(powers), Arc::new(Echo)).unwrap()
}

fn scene(t: f64) -> Scene {
    Scene { t, ..Scene::default() }
}

fn viewer(page: &Page) -> Viewer {
    let (viewer, _) = tungstenite::connect(format!("ws://{}/socket", page.address())).unwrap();
    if let MaybeTlsStream::Plain(stream) = viewer.get_ref() {
        stream.set_read_timeout(Some(Duration::from_secs(20))).unwrap();
    }
    viewer
}

/// Takes the next scene and returns its time, so that another may come.
fn next(viewer: &mut Viewer) -> f64 {
    let Message::Text(text) = viewer.read().unwrap() else { panic!("no text") };
    viewer.send(Message::text(".")).unwrap();
    serde_json::from_str::<Scene>(&text).unwrap().t
}

fn wait_for(what: impl Fn() -> bool) {
    let begun = Instant::now();
    while !what() {
        assert!(begun.elapsed() < Duration::from_secs(20), "waited in vain");
        thread::sleep(Duration::from_millis(5));
    }
}

/// Passes a scene to the page and waits until it is encoded.
fn show_scene(page: &mut Page, t: f64) {
    page.keep(scene(t));
    wait_for(|| get(page.address(), "/api/state", "").1.contains(&format!(",{t:?}]")));
}

/// Requests a path: status and body.
fn get(at: SocketAddr, path: &str, more: &str) -> (u16, String) {
    let host = if more.contains("Host:") { String::new() } else { format!("Host: {at}\r\n") };
    ask(at, &format!("GET {path} HTTP/1.1\r\n{host}{more}Connection: close\r\n\r\n"))
}

fn post(at: SocketAddr, path: &str, body: &str, more: &str) -> (u16, String) {
    let length = body.len();
    ask(
        at,
        &format!(
            "POST {path} HTTP/1.1\r\nHost: {at}\r\n{more}Content-Length: {length}\r\nConnection: close\r\n\r\n{body}"
        ),
    )
}

fn ask(at: SocketAddr, request: &str) -> (u16, String) {
    let mut stream = TcpStream::connect(at).unwrap();
    stream.set_read_timeout(Some(Duration::from_secs(20))).unwrap();
    stream.write_all(request.as_bytes()).unwrap();
    let mut bytes = Vec::new();
    let _ = stream.read_to_end(&mut bytes);
    let answer = String::from_utf8_lossy(&bytes).into_owned();
    let status = answer.split(' ').nth(1).and_then(|code| code.parse().ok()).unwrap_or(0);
    (status, answer.split_once("\r\n\r\n").map(|(_, body)| body.to_owned()).unwrap_or_default())
}

#[test]
fn the_page_and_its_files_are_served_from_the_program() {
    let page = open(Powers::None);
    let (status, body) = get(page.address(), "/", "");
    assert_eq!(status, 200);
    assert!(body.contains("<canvas id=\"field\""), "{body}");
    for path in ["/main.js", "/page.css", "/icon.svg"] {
        assert_eq!(get(page.address(), path, "").0, 200, "{path}");
    }
    for path in ["/nothing.js", "/../Cargo.toml", "/%2e%2e/Cargo.toml", "/api/second/9"] {
        assert_eq!(get(page.address(), path, "").0, 404, "{path}");
    }
}

#[test]
fn a_late_viewer_gets_the_newest_scene_at_once() {
    let mut page = open(Powers::None);
    show_scene(&mut page, 1.5);
    show_scene(&mut page, 2.5);
    assert!((next(&mut viewer(&page)) - 2.5).abs() < 1e-9);
}

#[test]
fn a_viewer_that_pauses_continues_with_the_newest_scene() {
    let mut page = open(Powers::None);
    let mut slow = viewer(&page);
    wait_for(|| page.viewers() == 1);
    for i in 0..500 {
        page.keep(scene(f64::from(i)));
    }
    show_scene(&mut page, 777.5);
    // Two may have been sent already; the next one is the newest.
    let seen: Vec<f64> = (0..3).map(|_| next(&mut slow)).collect();
    assert!((seen[2] - 777.5).abs() < 1e-9, "{seen:?}");
}

#[test]
fn showing_a_scene_never_waits_for_viewers() {
    let mut page = open(Powers::None);
    // None of them ever reads, and one disconnects without closing.
    let deaf: Vec<Viewer> = (0..4).map(|_| viewer(&page)).collect();
    let gone = viewer(&page);
    wait_for(|| page.viewers() == 5);
    if let MaybeTlsStream::Plain(stream) = gone.get_ref() {
        stream.shutdown(std::net::Shutdown::Both).unwrap();
    }
    let mut reader = viewer(&page);
    for i in 0..20_000 {
        page.show(scene(f64::from(i)));
    }
    // Far more was passed to the page than any viewer took: it was left out, not waited for.
    assert!(page.left_out() > 0, "{}", page.left_out());
    show_scene(&mut page, 30_000.5);
    wait_for(|| page.viewers() == 5);
    let last = (0..5).map(|_| next(&mut reader)).find(|t| (t - 30_000.5).abs() < 1e-9);
    assert!(last.is_some());
    drop(deaf);
}

#[test]
fn a_deferred_scene_is_finished_after_the_match_has_gone_on() {
    let mut page = open(Powers::None);
    let mut looking = viewer(&page);
    wait_for(|| page.viewers() == 1);
    let (gate, opens) = std::sync::mpsc::channel::<()>();
    page.show(DeferredScene::new(scene(1.5), move |scene| {
        // `show` returns before the scene is finished: else this would wait for ever.
        let _ = opens.recv();
        scene.layers.push(Layer { name: "late".into(), ..Layer::default() });
    }));
    gate.send(()).unwrap();
    let Message::Text(text) = looking.read().unwrap() else { panic!("no text") };
    let seen: Scene = serde_json::from_str(&text).unwrap();
    assert_eq!((seen.t, seen.layers[0].name.as_str()), (1.5, "late"));
}

#[test]
fn past_scenes_are_served_by_the_second() {
    let mut page = open(Powers::None);
    page.push(MatchEvent {
        t: 0.2,
        kind: MatchEventKind::Goal,
        team: Some(PageTeam::Blue),
        description: "goal".into(),
        at: None,
        problem: None,
        decided: None,
    });
    for i in 0..50 {
        page.keep(scene(f64::from(i) * 0.04));
    }
    show_scene(&mut page, 2.5);
    assert!(get(page.address(), "/api/events?from=0", "").1.contains("\"kind\":\"goal\""));
    assert!(get(page.address(), "/api/events?from=1", "").1.contains("[]"));
    assert_eq!(get(page.address(), "/api/second/0", "").0, 200);
    page.clear();
    wait_for(|| get(page.address(), "/api/second/0", "").0 == 404);
}

#[test]
fn foreign_origins_and_host_names_are_refused() {
    let page = open(Powers::Simulation);
    let at = page.address();
    let port = at.port();
    for path in ["/", "/api/state", "/socket"] {
        let (status, answer) = get(at, path, &format!("Host: evil.example:{port}\r\n"));
        assert_eq!(status, 403, "{path}");
        assert!(answer.contains("no other name"), "{answer}");
        assert_eq!(get(at, path, "Origin: http://evil.example\r\n").0, 403, "{path}");
    }
    assert_eq!(post(at, "/api/explain", "{}", "Origin: http://evil.example\r\n").0, 403);
    for origin in ["http://evil.example", "null", "https://127.0.0.1", &format!("http://localhost:{port}")] {
        let mut request = format!("ws://{at}/socket").into_client_request().unwrap();
        request.headers_mut().insert("origin", origin.parse().unwrap());
        let refused = tungstenite::connect(request).unwrap_err();
        assert!(
            matches!(&refused, tungstenite::Error::Http(answer) if answer.status() == 403),
            "{origin}: {refused}"
        );
    }
    let mut request = format!("ws://{at}/socket").into_client_request().unwrap();
    request.headers_mut().insert("origin", format!("http://{at}").parse().unwrap());
    let (mut own, _) = tungstenite::connect(request).unwrap();
    own.send(Message::text(r#"{"ask":"pause","on":true}"#)).unwrap();
    let mut asked = None;
    wait_for_some(&mut asked, || page.next_request());
    assert_eq!(asked, Some(UserRequest::Pause { on: true }), "and the foreign ones asked nothing");
}

fn wait_for_some<T>(into: &mut Option<T>, what: impl Fn() -> Option<T>) {
    let begun = Instant::now();
    while into.is_none() {
        assert!(begun.elapsed() < Duration::from_secs(20), "waited in vain");
        *into = what();
        thread::sleep(Duration::from_millis(5));
    }
}

#[test]
fn a_real_field_is_only_ever_halted() {
    let page = open(Powers::Halt);
    let mut viewer = viewer(&page);
    viewer.send(Message::text(r#"{"ask":"ball","at":[0,0]}"#)).unwrap();
    let Message::Text(answer) = viewer.read().unwrap() else { panic!("no text") };
    assert!(answer.contains("nothing but HALT"), "{answer}");
    viewer.send(Message::text(r#"{"ask":"halt"}"#)).unwrap();
    let mut asked = None;
    wait_for_some(&mut asked, || page.next_request());
    assert_eq!(asked, Some(UserRequest::Halt {}));
}

#[test]
fn a_problem_is_explained_and_a_moment_frozen() {
    let mut page = open(Powers::None);
    let ball = page::SceneBall { at: [0.5, -0.25], ..page::SceneBall::default() };
    page.keep(Scene { ball: Some(ball), ..scene(3.0) });
    show_scene(&mut page, 4.0);
    let at = page.address();
    assert_eq!(post(at, "/api/explain", "{\"ball\":[0,0]}", "").1, r#"{"asked":{"ball":[0,0]}}"#);
    assert_eq!(post(at, "/api/explain", "x", "").0, 422);
    let (status, line) = post(at, "/api/freeze", r#"{"t":3.5,"team":"yellow"}"#, "");
    assert_eq!(status, 200);
    assert!(line.contains("\"ball\":[500,-250]"), "{line}");
    assert_eq!(post(at, "/api/freeze", r#"{"t":99,"team":"yellow"}"#, "").0, 422);
    assert_eq!(post(at, "/api/explain", &"x".repeat(20_000), "").0, 413);
}

#[test]
fn the_state_has_the_scan_of_the_channels_that_the_program_passed() {
    let page = open(Powers::None);
    assert!(get(page.address(), "/api/state", "").1.contains(r#""spectrum":null"#));
    page.set_spectrum(serde_json::json!({ "sweeps": 5, "counts": [0, 5], "channel": 1, "quietest": [0] }));
    let (status, state) = get(page.address(), "/api/state", "");
    assert_eq!(status, 200);
    assert!(
        state.contains(r#""spectrum":{"channel":1,"counts":[0,5],"quietest":[0],"sweeps":5}"#),
        "{state}"
    );
}

#[test]
fn the_error_of_a_taken_port_suggests_another() {
    let page = open(Powers::None);
    let settings = PageSettings { listen: page.address(), ..settings(Powers::None) };
    let Err(error) = Page::open(settings, Arc::new(Echo)) else { panic!("the port is taken") };
    assert!(matches!(error, PageError::Taken(_)));
    assert!(error.to_string().contains("such as 127.0.0.1:"), "{error}");
}

#[test]
fn the_page_ends_with_the_match() {
    let mut page = open(Powers::None);
    show_scene(&mut page, 1.0);
    let mut viewer = viewer(&page);
    next(&mut viewer);
    drop(page);
    assert!(matches!(viewer.read(), Err(_) | Ok(Message::Close(_))));
}
