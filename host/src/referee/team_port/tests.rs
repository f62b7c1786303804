//! Tests: the client follows the game controller's protocol. A minimal controller answers.

use super::*;

const S: u64 = 1_000_000;

/// A reply of the controller, as bytes.
fn from_controller(code: Option<StatusCode>, reason: Option<&str>, token: &str) -> Vec<u8> {
    let reply = ControllerReply {
        status_code: code.map(|code| code as i32),
        reason: reason.map(str::to_owned),
        next_token: Some(token.to_owned()),
        verification: Some(Verification::Unverified as i32),
    };
    delimited(&ControllerToTeam { controller_reply: Some(reply) })
}

fn ok(token: &str) -> Vec<u8> {
    from_controller(Some(StatusCode::Ok), None, token)
}

/// What the client sent, decoded.
fn sent<M: Message + Default>(port: &mut TeamPort) -> M {
    let bytes = port.poll_transmit().expect("something to send");
    M::decode_length_delimited(&bytes[..]).expect("a message")
}

fn registered() -> TeamPort {
    let mut port = TeamPort::new("onetwo", Colour::Blue);
    port.connected(Instant(0));
    port.receive(&ok("first"), Instant(0));
    let registration: TeamRegistration = sent(&mut port);
    assert_eq!((registration.team_name.as_str(), registration.team), ("onetwo", Some(2)));
    assert_eq!(registration.signature, None);
    port.receive(&ok("second"), Instant(0));
    assert_eq!(port.poll_event(), Some(TeamPortEvent::Registered { verified: false }));
    assert_eq!((port.token(), port.stage()), (Some("second"), ConnectionStage::Registered));
    port
}

#[test]
fn the_controller_greets_and_the_team_registers() {
    let mut port = TeamPort::new("onetwo", Colour::Blue);
    assert!(port.wants_connection(Instant(0)));
    port.connected(Instant(0));
    assert!(!port.wants_connection(Instant(0)));
    assert_eq!(port.poll_transmit(), None, "the controller speaks first");
    registered();
}

#[test]
fn replies_may_come_in_pieces() {
    let mut port = TeamPort::new("onetwo", Colour::Yellow);
    port.connected(Instant(0));
    for byte in ok("a token") {
        assert_eq!(port.stage(), ConnectionStage::KnownEpoch);
        port.receive(&[byte], Instant(0));
    }
    assert_eq!(port.stage(), ConnectionStage::Registering);
    assert_eq!(sent::<TeamRegistration>(&mut port).team, Some(1));
}

#[test]
fn an_unknown_team_name_is_reported_and_tried_again() {
    let mut port = TeamPort::new("twoone", Colour::Blue);
    port.connected(Instant(0));
    port.receive(&ok("t"), Instant(0));
    port.receive(&from_controller(Some(StatusCode::Rejected), Some("name unknown"), "t"), Instant(S));
    let reason = "name unknown".to_owned();
    assert_eq!(port.poll_event(), Some(TeamPortEvent::RegistrationRefused { reason }));
    assert!(!port.wants_connection(Instant(2 * S)));
    assert!(port.wants_connection(Instant(3 * S)));
}

#[test]
fn requests_go_one_at_a_time_and_replies_belong_to_them_in_order() {
    let mut port = registered();
    let keeper = TeamPortRequest::Keeper(RobotId::new(7).unwrap());
    let substitute = TeamPortRequest::Substitute(true);
    port.ask(keeper, Instant(S));
    port.ask(substitute, Instant(S));
    let first: TeamToController = sent(&mut port);
    assert_eq!(first.msg, Some(TeamRequest::DesiredKeeper(7)));
    assert_eq!(port.poll_transmit(), None);
    port.receive(&from_controller(Some(StatusCode::Rejected), Some("ball in play"), "x"), Instant(S));
    let reason = "ball in play".to_owned();
    assert_eq!(port.poll_event(), Some(TeamPortEvent::Refused { request: keeper, reason }));
    assert_eq!(sent::<TeamToController>(&mut port).msg, Some(TeamRequest::SubstituteBot(true)));
    port.receive(&ok("y"), Instant(S));
    assert_eq!(port.poll_event(), Some(TeamPortEvent::Granted(substitute)));
    for (go_on, number) in [(true, 1), (false, 0)] {
        port.ask(TeamPortRequest::Advantage { go_on }, Instant(S));
        let message: TeamToController = sent(&mut port);
        assert_eq!(message.msg, Some(TeamRequest::AdvantageChoice(number)));
        port.receive(&ok("z"), Instant(S));
        assert_eq!(port.poll_event(), Some(TeamPortEvent::Granted(TeamPortRequest::Advantage { go_on })));
    }
}

#[test]
fn the_newest_request_of_a_kind_is_the_one_that_waits() {
    let mut port = TeamPort::new("onetwo", Colour::Blue);
    for id in 0..16 {
        port.ask(TeamPortRequest::Keeper(RobotId::new(id).unwrap()), Instant(0));
    }
    port.connected(Instant(0));
    port.receive(&ok("1"), Instant(0));
    port.poll_transmit();
    port.receive(&ok("2"), Instant(0));
    assert_eq!(sent::<TeamToController>(&mut port).msg, Some(TeamRequest::DesiredKeeper(15)));
    port.receive(&ok("3"), Instant(0));
    assert_eq!(port.poll_transmit(), None);
}

#[test]
fn an_idle_connection_is_tried_and_a_dead_one_given_up() {
    let mut port = registered();
    port.tick(Instant(4 * S));
    assert_eq!(port.poll_transmit(), None);
    port.tick(Instant(5 * S));
    assert_eq!(sent::<TeamToController>(&mut port).msg, Some(TeamRequest::Ping(true)));
    port.receive(&ok("pong"), Instant(5 * S));
    assert_eq!(port.poll_event(), None);
    port.tick(Instant(10 * S));
    port.tick(Instant(13 * S - 1));
    assert_eq!(port.stage(), ConnectionStage::Registered);
    port.tick(Instant(13 * S));
    assert_eq!(port.poll_event(), Some(TeamPortEvent::GivenUp(Trouble::NoAnswer)));
    assert!(port.wants_connection(Instant(15 * S)));
}

#[test]
fn an_unanswered_request_is_asked_again_on_the_next_connection() {
    let mut port = registered();
    port.ask(TeamPortRequest::Substitute(true), Instant(S));
    port.poll_transmit();
    port.lost(Instant(S));
    assert_eq!(port.poll_event(), Some(TeamPortEvent::GivenUp(Trouble::Closed)));
    assert_eq!(port.token(), None);
    port.connected(Instant(3 * S));
    port.receive(&ok("1"), Instant(3 * S));
    port.poll_transmit();
    port.receive(&ok("2"), Instant(3 * S));
    assert_eq!(sent::<TeamToController>(&mut port).msg, Some(TeamRequest::SubstituteBot(true)));
}

#[test]
fn a_port_that_speaks_something_else_is_reported() {
    for garbage in [&b"HTTP/1.1 400 Bad Request\r\n\r\n"[..], &[0xff; 12], &[3, 8, 1, 16]] {
        let mut port = TeamPort::new("onetwo", Colour::Blue);
        port.connected(Instant(0));
        // "HTTP" reads as a length of 72: the remaining bytes have to come, or the deadline passes.
        port.receive(garbage, Instant(0));
        port.receive(&[b'x'; 100], Instant(0));
        let reported = port.poll_event();
        assert!(
            matches!(reported, Some(TeamPortEvent::GivenUp(Trouble::NotTheTeamPort(_)))),
            "{garbage:?}: {reported:?}"
        );
    }
}

#[test]
fn a_controller_that_never_greets_is_given_up() {
    let mut port = TeamPort::new("onetwo", Colour::Blue);
    port.connected(Instant(0));
    port.tick(Instant(3 * S));
    assert_eq!(port.poll_event(), Some(TeamPortEvent::GivenUp(Trouble::NoAnswer)));
}
