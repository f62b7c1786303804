//! `connection`: tests of the TCP connection and of its errors.

use std::io::Write;
use std::net::{Ipv4Addr, SocketAddr, TcpListener, TcpStream};
use std::time::{Duration, Instant};

use ssl::controller::{ControllerReply, ControllerToTeam, StatusCode, TeamRegistration};
use ssl::net::{Connection, NetError};

const SOON: Duration = Duration::from_secs(5);
const NOW: Duration = Duration::ZERO;

#[test]
fn a_team_registers_and_receives_the_reply() {
    let (mut team, mut controller) = pair();
    // The controller sends first, and twice in one packet is two messages.
    controller.send(&reply("token 1")).expect("sent");
    controller.send(&reply("token 2")).expect("sent");
    for token in ["token 1", "token 2"] {
        assert_eq!(team.receive(SOON).expect("no error"), Some(reply(token)));
    }
    let registration = TeamRegistration { team_name: "onetwo".into(), signature: None, team: None };
    team.send(&registration).expect("sent");
    assert_eq!(controller.receive(SOON).expect("no error"), Some(registration));
}

#[test]
fn a_message_in_pieces_comes_when_it_is_whole() {
    let (mut stream, mut controller) = raw_pair();
    let bytes = ssl::stream::delimited(&reply("token"));
    let (first, second) = bytes.split_at(5);
    stream.write_all(first).expect("sent");
    let begin = Instant::now();
    let wait = Duration::from_millis(50);
    assert_eq!(controller.receive::<ControllerToTeam>(wait).expect("no error"), None);
    assert!(begin.elapsed() >= wait);
    stream.write_all(second).expect("sent");
    assert_eq!(controller.receive(SOON).expect("no error"), Some(reply("token")));
    assert_eq!(controller.receive::<ControllerToTeam>(NOW).expect("no error"), None);
}

#[test]
fn a_refused_connection_names_the_ports() {
    let nobody = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).expect("a port").local_addr().expect("bound");
    let error = Connection::open(nobody, SOON).map(|_| ()).expect_err("nobody listens");
    assert!(matches!(error, NetError::NotConnected { .. }));
    assert!(error.to_string().contains("is the game controller running? Teams: port 10008"), "{error}");
}

#[test]
fn a_closed_connection_is_an_error_after_the_messages_before_it() {
    let (mut stream, mut controller) = raw_pair();
    let bytes = ssl::stream::delimited(&reply("token"));
    stream.write_all(&bytes).expect("sent");
    stream.write_all(&bytes[..7]).expect("sent");
    drop(stream);
    assert_eq!(controller.receive(SOON).expect("no error"), Some(reply("token")));
    let error = controller.receive::<ControllerToTeam>(SOON).expect_err("closed");
    assert!(matches!(error, NetError::Closed { pending: 7, .. }), "{error}");
}

#[test]
fn bytes_that_are_no_message_are_an_error() {
    let (mut stream, mut controller) = raw_pair();
    stream.write_all(&[0xff; 12]).expect("sent");
    let error = controller.receive::<ControllerToTeam>(SOON).expect_err("no length");
    assert!(matches!(error, NetError::NotFramed { .. }), "{error}");
    let (mut stream, mut controller) = raw_pair();
    stream.write_all(&[2, 0x0a, 9]).expect("sent");
    let error = controller.receive::<ControllerToTeam>(SOON).expect_err("no message");
    assert!(matches!(error, NetError::NotDecoded { .. }), "{error}");
    // The next one is received all the same.
    stream.write_all(&ssl::stream::delimited(&reply("token"))).expect("sent");
    assert_eq!(controller.receive(SOON).expect("no error"), Some(reply("token")));
}

fn reply(token: &str) -> ControllerToTeam {
    let reply = ControllerReply {
        status_code: Some(StatusCode::Ok.into()),
        next_token: Some(token.into()),
        ..ControllerReply::default()
    };
    ControllerToTeam { controller_reply: Some(reply) }
}

fn pair() -> (Connection, Connection) {
    let (stream, other) = raw_pair();
    (Connection::over(stream).expect("a connection"), other)
}

fn raw_pair() -> (TcpStream, Connection) {
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).expect("a port");
    let address: SocketAddr = listener.local_addr().expect("bound");
    let connection = Connection::open(address, SOON).expect("connects");
    assert_eq!(connection.peer(), address);
    (listener.accept().expect("accepts").0, connection)
}
