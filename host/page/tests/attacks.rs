//! `attacks`: connections that never end, viewers that all connect at once, and requests without the token,
//! over real sockets.
//!
//! Times are injected ([`Limits`]); the assertions are about which requests are answered, never about how
//! soon.

use std::io::{Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::sync::{Arc, Barrier};
use std::thread;
use std::time::{Duration, Instant};

use page::{ExplanationService, Limits, Page, PageSettings, PageTeam, Powers, Token, UserRequest};
use tungstenite::stream::MaybeTlsStream;
use tungstenite::{Message, WebSocket};

type Viewer = WebSocket<MaybeTlsStream<TcpStream>>;

/// Number of attackers of each test.
const ATTACKERS: usize = 300;
/// Longer than any test: a limit of this length has no effect.
const NEVER: Duration = Duration::from_hours(1);
/// A short limit, for what is to be closed. Genuine requests may miss it too on a loaded machine: they are
/// sent until one is in time.
const SOON: Duration = Duration::from_millis(300);
/// Time after which a test gives up.
const PATIENCE: Duration = Duration::from_mins(1);

struct Silent;

impl ExplanationService for Silent {
    fn explain(&self, _problem: &str) -> Result<String, String> {
        Err("nothing is explained".to_owned())
    }
}

fn open(limits: Limits, token: Option<Token>) -> Page {
    let listen = SocketAddr::from(([127, 0, 0, 1], 0));
    let (title, powers) = ("a test".to_owned(), Powers::Simulation);
    let settings =
        PageSettings { listen, title, recorded: false, powers, token, limits, log: Arc::default() };
    Page::open(settings, Arc::new(Silent)).unwrap()
}

fn wait_for(what: impl Fn() -> bool) {
    let begun = Instant::now();
    while !what() {
        assert!(begun.elapsed() < PATIENCE, "waited in vain");
        thread::sleep(Duration::from_millis(5));
    }
}

/// Connects and sends these bytes.
fn begin(at: SocketAddr, bytes: &str) -> TcpStream {
    let mut stream = TcpStream::connect(at).unwrap();
    stream.set_read_timeout(Some(PATIENCE)).unwrap();
    stream.write_all(bytes.as_bytes()).unwrap();
    stream
}

/// Reads until the page closes the connection.
fn rest(mut stream: TcpStream) -> String {
    let mut bytes = Vec::new();
    if let Err(error) = stream.read_to_end(&mut bytes) {
        // A reset counts as closed; a time-out does not.
        assert_eq!(error.kind(), std::io::ErrorKind::ConnectionReset, "the page keeps the connection");
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

fn get(at: SocketAddr, path: &str) -> String {
    rest(begin(at, &format!("GET {path} HTTP/1.1\r\nHost: {at}\r\nConnection: close\r\n\r\n")))
}

fn viewer(page: &Page, query: &str) -> Result<Viewer, tungstenite::Error> {
    let (viewer, _) = tungstenite::connect(format!("ws://{}/socket{query}", page.address()))?;
    if let MaybeTlsStream::Plain(stream) = viewer.get_ref() {
        stream.set_read_timeout(Some(PATIENCE)).unwrap();
    }
    Ok(viewer)
}

fn refused(viewer: &mut Viewer) -> String {
    let Message::Text(text) = viewer.read().unwrap() else { panic!("no text") };
    let value: serde_json::Value = serde_json::from_str(&text).unwrap();
    value["refused"].as_str().unwrap_or_else(|| panic!("{text}")).to_owned()
}

#[test]
fn three_hundred_half_requests_are_closed_and_the_page_goes_on_answering() {
    let page = open(Limits { header: SOON, ..Limits::default() }, None);
    let at = page.address();
    let halves =
        ["", "G", "GET / HTTP/1.1\r\nHost: 127.0.0.1", "GET /socket HTTP/1.1\r\nUpgrade: websocket\r\n"];
    let held: Vec<_> = (0..ATTACKERS).map(|n| begin(at, halves[n % halves.len()])).collect();
    // A viewer is answered while they hold on.
    wait_for(|| get(at, "/").starts_with("HTTP/1.1 200"));
    for stream in held {
        // The page may give the reason; it does not serve them.
        assert!(!rest(stream).contains("200 OK"));
    }
}

#[test]
fn no_more_connections_are_served_at_once_than_the_limit() {
    let page = open(Limits { header: NEVER, connection: NEVER, connections: 8, ..Limits::default() }, None);
    let at = page.address();
    let mut held: Vec<_> = (0..8).map(|_| begin(at, "GET / HTTP/1.1\r\n")).collect();
    // They are served in the order in which they connected: when the last of them is being served, all are.
    held[7].write_all(format!("Host: {at}\r\n\r\n").as_bytes()).unwrap();
    let mut answer = [0; 12];
    held[7].read_exact(&mut answer).unwrap();
    assert_eq!(&answer, b"HTTP/1.1 200");
    let mut ninth = begin(at, &format!("GET / HTTP/1.1\r\nHost: {at}\r\nConnection: close\r\n\r\n"));
    ninth.set_read_timeout(Some(SOON)).unwrap();
    assert!(ninth.read(&mut answer).is_err(), "the ninth waits");
    ninth.set_read_timeout(Some(PATIENCE)).unwrap();
    held.pop();
    assert!(rest(ninth).starts_with("HTTP/1.1 200"), "and is served when one of the eight has gone");
}

#[test]
fn missing_bodies_and_readers_that_never_read_are_closed() {
    let page = open(Limits { request: SOON, ..Limits::default() }, None);
    let at = page.address();
    let slow =
        begin(at, &format!("POST /api/explain HTTP/1.1\r\nHost: {at}\r\nContent-Length: 999\r\n\r\n{{"));
    assert!(rest(slow).starts_with("HTTP/1.1 408"));
    let page = open(Limits { header: NEVER, connection: SOON, ..Limits::default() }, None);
    let at = page.address();
    let asks = format!("GET /main.js HTTP/1.1\r\nHost: {at}\r\n\r\n").repeat(100);
    // A hundred answers wait for a reader that never reads: the connection is closed all the same.
    let deaf = begin(at, &asks);
    thread::sleep(2 * SOON);
    let _ = rest(deaf);
    wait_for(|| get(at, "/").starts_with("HTTP/1.1 200"));
}

#[test]
fn of_300_simultaneous_viewers_as_many_are_served_as_there_are_seats() {
    let page = open(Limits::default(), None);
    let places = Limits::default().viewers;
    let (at, together) = (page.address(), Barrier::new(ATTACKERS));
    let viewers: Vec<Viewer> = thread::scope(|scope| {
        let threads: Vec<_> = (0..ATTACKERS)
            .map(|_| {
                scope.spawn(|| {
                    together.wait();
                    match tungstenite::connect(format!("ws://{at}/socket")) {
                        Ok((viewer, _)) => Some(viewer),
                        Err(tungstenite::Error::Http(answer)) if answer.status() == 503 => None,
                        Err(other) => panic!("{other}"),
                    }
                })
            })
            .collect();
        threads.into_iter().filter_map(|thread| thread.join().unwrap()).collect()
    });
    assert_eq!((viewers.len(), page.viewers()), (places, places));
    drop(viewers);
    wait_for(|| page.viewers() == 0);
    viewer(&page, "").expect("there is room again");
}

#[test]
fn a_seat_is_free_again_when_the_upgrade_never_completes() {
    let page = open(Limits { viewers: 1, ..Limits::default() }, None);
    let at = page.address();
    let head = "Upgrade: websocket\r\nConnection: upgrade\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n";
    for _ in 0..10 {
        drop(begin(at, &format!("GET /socket HTTP/1.1\r\nHost: {at}\r\n{head}\r\n")));
    }
    wait_for(|| page.viewers() == 0 && viewer(&page, "").is_ok());
}

#[test]
fn without_the_token_viewers_see_but_cannot_request() {
    let token = Token::random().unwrap();
    let page = open(Limits::default(), Some(token.clone()));
    let at = page.address();
    assert!(get(at, "/").starts_with("HTTP/1.1 200"));
    assert!(get(at, "/api/state").contains(r#""may_ask":false"#));
    let right = format!("?token={}", token.as_str());
    let halt = Message::text(r#"{"ask":"halt"}"#);
    for query in ["", "?token=", "?token=0123", "?other=1", &format!("{right}0")] {
        let mut unauthenticated = viewer(&page, query).expect("looking is free");
        unauthenticated.send(halt.clone()).unwrap();
        let answer = refused(&mut unauthenticated);
        assert!(answer.contains("?token="), "{query}: {answer}");
        assert!(!answer.contains(token.as_str()), "the token is told to nobody: {answer}");
    }
    assert!(get(at, &format!("/api/state{right}")).contains(r#""may_ask":true"#));
    let mut own = viewer(&page, &right).unwrap();
    own.send(halt).unwrap();
    let mut asked = None;
    let begun = Instant::now();
    while asked.is_none() && begun.elapsed() < PATIENCE {
        asked = page.next_request();
        thread::sleep(Duration::from_millis(5));
    }
    assert_eq!(asked, Some(UserRequest::Halt {}));
    assert_eq!(page.next_request(), None, "the strangers asked nothing");
}

#[test]
fn a_refusal_goes_to_the_viewer_that_requested() {
    let page = open(Limits::default(), None);
    let (mut other, mut asking) = (viewer(&page, "").unwrap(), viewer(&page, "").unwrap());
    asking.send(Message::text(r#"{"ask":"robot","team":"blue","id":15,"at":[0,0]}"#)).unwrap();
    let mut asked = None;
    let begun = Instant::now();
    while asked.is_none() && begun.elapsed() < PATIENCE {
        asked = page.next_request();
        thread::sleep(Duration::from_millis(5));
    }
    assert_eq!(asked, Some(UserRequest::Robot { team: PageTeam::Blue, id: 15, at: [0.0, 0.0] }));
    page.refuse("blue has no robot 15 on the field");
    assert_eq!(refused(&mut asking), "blue has no robot 15 on the field");
    other.send(Message::text("no request")).unwrap();
    assert!(refused(&mut other).contains("no request"), "the other one hears of its own alone");
}

#[test]
fn a_machine_that_holds_every_place_keeps_nobody_else_and_no_token_out() {
    let token = Token::random().unwrap();
    let limits = Limits { header: NEVER, connection: NEVER, connections: 8, ..Limits::default() };
    let page = open(limits, Some(token.clone()));
    let at = page.address();
    let held: Vec<_> = (0..200).map(|_| begin(at, "GET / HTTP/1.1\r\n")).collect();
    thread::sleep(SOON);
    // The same machine with the token.
    let asks = format!("GET /?token={} HTTP/1.1\r\nHost: {at}\r\nConnection: close\r\n\r\n", token.as_str());
    assert!(rest(begin(at, &asks)).starts_with("HTTP/1.1 200"), "with the token");
    // Another machine: this one by another of its addresses.
    let other = socket2::Socket::new(socket2::Domain::IPV4, socket2::Type::STREAM, None).unwrap();
    other.bind(&std::net::SocketAddr::from(([127, 0, 0, 7], 0)).into()).unwrap();
    other.connect(&at.into()).unwrap();
    let mut other: std::net::TcpStream = other.into();
    other.write_all(format!("GET / HTTP/1.1\r\nHost: {at}\r\nConnection: close\r\n\r\n").as_bytes()).unwrap();
    assert!(rest(other).starts_with("HTTP/1.1 200"), "from another address");
    drop(held);
}
