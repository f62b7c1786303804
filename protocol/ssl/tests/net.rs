//! `net`: tests of the sockets on loopback, and that each error names the fix.

use std::net::{Ipv4Addr, SocketAddr, SocketAddrV4, UdpSocket};
use std::time::{Duration, Instant};

use ssl::net::{
    Interfaces, LoopbackProbe, NetError, Port, Receiver, Sender, interfaces, probe_loopback, route,
};

/// Long enough for a loaded machine; a test that waits this long has failed.
const SOON: Duration = Duration::from_secs(5);
const GROUP: Ipv4Addr = Ipv4Addr::new(224, 5, 23, 2);

#[test]
fn several_programs_receive_one_group() {
    let group = free_group();
    let mut receivers: Vec<_> =
        (0..3).map(|_| Receiver::join(group, &Interfaces::loopback()).expect("joins")).collect();
    let sender = Sender::multicast(group, Some("127.0.0.1")).expect("a sender");
    let largest = vec![7; ssl::stream::LEAGUE_DATAGRAM_MAX];
    sender.send(b"").expect("sent");
    sender.send(&largest).expect("sent");
    for receiver in &mut receivers {
        for expected in [&b""[..], &largest] {
            let datagram = receiver.receive(SOON).expect("no error").expect("a datagram");
            assert_eq!(datagram.bytes, expected);
            assert!(datagram.from.ip().is_loopback());
        }
        assert_eq!(receiver.joined()[0].address, Ipv4Addr::LOCALHOST);
    }
}

#[test]
fn by_all_interfaces_a_packet_is_received_once() {
    let group = free_group();
    let mut receiver = Receiver::join(group, &Interfaces::All).expect("joins");
    assert!(receiver.joined().iter().any(ssl::net::Interface::is_loopback));
    let sender = Sender::multicast(group, Some("127.0.0.1")).expect("a sender");
    sender.send(b"once").expect("sent");
    assert_eq!(receiver.receive(SOON).expect("no error").map(|datagram| datagram.bytes), Some(&b"once"[..]));
    assert_eq!(receiver.receive(Duration::from_millis(50)).expect("no error"), None);
}

#[test]
fn a_receive_waits_for_its_timeout() {
    let mut port = Port::bind(localhost(0)).expect("a port");
    for wait in [0, 30, 0, 60] {
        let wait = Duration::from_millis(wait);
        let begin = Instant::now();
        assert_eq!(port.receive(wait).expect("no error"), None);
        assert!(begin.elapsed() >= wait, "{:?} of {wait:?}", begin.elapsed());
    }
    // A wait of zero finds what is there already.
    let from = Port::bind(localhost(0)).expect("a port");
    from.send(port.address(), b"here").expect("sent");
    let begin = Instant::now();
    let received = loop {
        if let Some(datagram) = port.receive(Duration::ZERO).expect("no error") {
            break (datagram.bytes.to_vec(), datagram.from);
        }
        assert!(begin.elapsed() < SOON, "nothing came");
    };
    assert_eq!(received, (b"here".to_vec(), from.address()));
}

#[test]
fn a_client_gets_its_answer() {
    let mut server = Port::bind(localhost(0)).expect("a port");
    let mut client = Port::bind(localhost(0)).expect("a port");
    client.send(server.address(), b"ask").expect("sent");
    let asked = server.receive(SOON).expect("no error").expect("a question").from;
    server.send(asked, b"answer").expect("sent");
    let answer = client.receive(SOON).expect("no error").expect("an answer");
    assert_eq!((answer.bytes, answer.from), (&b"answer"[..], server.address()));
    // No receiver: not an error, there is just no answer.
    drop(server);
    client.send(asked, b"ask").expect("sent");
    Sender::unicast(localhost(9)).expect("a sender").send(b"nobody").expect("sent");
}

#[test]
fn an_unshared_port_is_an_error_with_the_command_that_finds_its_owner() {
    let taken = Port::bind(localhost(0)).expect("a port");
    let error = Port::bind(taken.address()).expect_err("taken");
    assert!(matches!(error, NetError::Busy { shared: false, .. }), "{error}");
    let taken = UdpSocket::bind((Ipv4Addr::UNSPECIFIED, 0)).expect("a port that is not shared");
    let port = taken.local_addr().expect("bound").port();
    let error = Receiver::join(SocketAddrV4::new(GROUP, port), &Interfaces::loopback()).expect_err("taken");
    let text = error.to_string();
    assert!(matches!(error, NetError::Busy { shared: true, .. }), "{text}");
    assert!(text.contains(&format!("ss -ulpn 'sport = :{port}'")), "{text}");
}

#[test]
fn a_missing_interface_is_an_error_that_lists_the_existing_ones() {
    let there_is = interfaces().expect("interfaces")[0].to_string();
    let by = Interfaces::These(vec!["wlan77".into()]);
    let from_receiver = Receiver::join(free_group(), &by).map(|_| ()).expect_err("no such interface");
    let from_sender =
        Sender::multicast(free_group(), Some("wlan77")).map(|_| ()).expect_err("no such interface");
    // An address of the documentation's own: no machine has it.
    let from_port =
        Port::bind("203.0.113.7:0".parse().expect("an address")).map(|_| ()).expect_err("not ours");
    for (error, requested) in [(from_receiver, "wlan77"), (from_sender, "wlan77"), (from_port, "203.0.113.7")]
    {
        let text = error.to_string();
        assert!(text.contains(requested) && text.contains(&there_is), "{text}");
    }
}

#[test]
fn an_address_that_is_no_group_is_an_error() {
    let address = SocketAddrV4::new(Ipv4Addr::new(192, 168, 0, 1), 10006);
    let error = Receiver::join(address, &Interfaces::All).map(|_| ()).expect_err("no group");
    assert!(error.to_string().contains("192.168.0.1 is no multicast address"), "{error}");
    assert!(Sender::multicast(address, None).is_err());
}

#[test]
fn a_datagram_that_udp_cannot_carry_is_an_error() {
    let sender = Sender::unicast(localhost(9)).expect("a sender");
    let error = sender.send(&vec![0; 70_000]).expect_err("too large");
    assert!(matches!(error, NetError::TooLarge { bytes: 70_000 }), "{error}");
}

#[test]
fn a_missing_route_is_an_error_with_the_command_that_adds_one() {
    let to = SocketAddr::from((GROUP, 10006));
    let text = NetError::NoRoute { to, by: None }.to_string();
    assert!(
        text.contains("sudo ip link set lo multicast on && sudo ip route add 224.0.0.0/4 dev lo"),
        "{text}"
    );
    // The system's answer about this machine is one of two, and ours is made of it.
    match route(SocketAddrV4::new(GROUP, 10006)) {
        Ok(by) => assert!(interfaces().expect("interfaces").iter().any(|one| one.address == by), "{by}"),
        Err(error) => assert!(matches!(error, NetError::NoRoute { .. }), "{error}"),
    }
}

#[test]
fn the_loopback_probe_says_what_works_here() {
    let probe = probe_loopback(GROUP, SOON);
    let LoopbackProbe::Works { league_sends_by } = &probe else { panic!("{probe}") };
    let text = probe.to_string();
    let alone = league_sends_by.is_some_and(|by| by.is_loopback());
    assert_eq!(text.contains("sudo ip link"), !alone, "{text}");
}

fn localhost(port: u16) -> SocketAddr {
    (Ipv4Addr::LOCALHOST, port).into()
}

/// The league's group on an unused port: the system gave it a moment ago.
fn free_group() -> SocketAddrV4 {
    let socket = UdpSocket::bind((Ipv4Addr::UNSPECIFIED, 0)).expect("a free port");
    SocketAddrV4::new(GROUP, socket.local_addr().expect("bound").port())
}
