//! `error`: network errors, and how to fix them.

use std::io;
use std::net::{Ipv4Addr, SocketAddr, SocketAddrV4};

use super::addresses::{AUTOREF_PORT, TEAM_PORT};
use crate::stream::StreamError;

/// Reason why a socket cannot be opened or used.
#[derive(Debug, thiserror::Error)]
pub enum NetError {
    /// Another program has bound the port and does not share it.
    #[error(
        "UDP port {port} is taken by a program {}; find it with `ss -ulpn 'sport = :{port}'` and end it, or take another port",
        if *shared { "that does not share it (SO_REUSEADDR and SO_REUSEPORT)" } else { "already" },
        port = address.port()
    )]
    Busy {
        /// Address of the port.
        address: SocketAddr,
        /// True where the port was to be shared (multicast), so that the other program is at fault.
        shared: bool,
    },
    /// No interface of that name or address.
    #[error(
        "no network interface `{requested}` that is up and has IPv4; there are: {}",
        if there_are.is_empty() { "none".to_owned() } else { there_are.join(", ") }
    )]
    NoInterface {
        /// Name that was requested.
        requested: String,
        /// Existing interfaces, `name (address)`.
        there_are: Vec<String>,
    },
    /// No interface could join the group.
    #[error(
        "no interface could join {group}{}; is a network up? On this machine alone: `{LOOPBACK_HINT}`",
        listed(tried)
    )]
    NotJoined {
        /// Address of the group.
        group: Ipv4Addr,
        /// Each interface with its error.
        tried: Vec<(String, io::Error)>,
    },
    /// The group's address is not one: multicast is 224.0.0.0 to 239.255.255.255.
    #[error("{0} is no multicast address; vision is 224.5.23.2, the referee 224.5.23.1")]
    NotMulticast(Ipv4Addr),
    /// The machine has no route to that address.
    #[error("no route to {to}{}; {}", by.map_or_else(String::new, |by| format!(" by {by}")), route_hint(to))]
    NoRoute {
        /// Destination of the datagram.
        to: SocketAddr,
        /// Address of the interface, if not chosen by the system.
        by: Option<Ipv4Addr>,
    },
    /// A datagram larger than UDP carries.
    #[error("a datagram of {bytes} bytes; UDP carries {}", crate::stream::DATAGRAM_MAX)]
    TooLarge {
        /// Length of the datagram, bytes.
        bytes: usize,
    },
    /// The TCP connection was not accepted.
    #[error(
        "nobody answers at {to} ({error}); is the game controller running? Teams: port {TEAM_PORT}, automatic \
         referees: {AUTOREF_PORT}"
    )]
    NotConnected {
        /// Address that was to be connected.
        to: SocketAddr,
        /// Cause of the failure.
        #[source]
        error: io::Error,
    },
    /// The peer closed the TCP connection.
    #[error(
        "{by} closed the connection{}; connect again",
        if *pending == 0 { String::new() } else { format!(" within a message, after {pending} bytes") }
    )]
    Closed {
        /// Address of the peer.
        by: SocketAddr,
        /// Bytes of an incomplete message.
        pending: usize,
    },
    /// Bytes received by TCP are no messages of the league's.
    #[error("{from}: {error}")]
    NotFramed {
        /// Address of the sender.
        from: SocketAddr,
        /// Cause of the failure.
        #[source]
        error: StreamError,
    },
    /// A message received by TCP is not of the expected type.
    #[error("{from}: {error}; is it the port for this kind of program?")]
    NotDecoded {
        /// Address of the sender.
        from: SocketAddr,
        /// Cause of the failure.
        #[source]
        error: prost::DecodeError,
    },
    /// Any other error of the system.
    #[error("cannot {doing} {address}: {error}")]
    System {
        /// The operation that failed, as a verb.
        doing: &'static str,
        /// Address that it concerned.
        address: SocketAddr,
        /// Cause of the failure.
        #[source]
        error: io::Error,
    },
}

impl NetError {
    pub(super) fn bind(address: SocketAddr, shared: bool, error: io::Error) -> Self {
        match error.kind() {
            io::ErrorKind::AddrInUse => Self::Busy { address, shared },
            io::ErrorKind::AddrNotAvailable => Self::NoInterface {
                requested: address.ip().to_string(),
                there_are: super::interfaces().unwrap_or_default().iter().map(ToString::to_string).collect(),
            },
            _ => Self::System { doing: "bind", address, error },
        }
    }

    pub(super) fn send(to: SocketAddr, by: Option<Ipv4Addr>, bytes: usize, error: io::Error) -> Self {
        let no_route = matches!(
            error.kind(),
            io::ErrorKind::NetworkUnreachable
                | io::ErrorKind::HostUnreachable
                | io::ErrorKind::AddrNotAvailable
                | io::ErrorKind::NetworkDown
        );
        if no_route {
            return Self::NoRoute { to, by };
        }
        if bytes > crate::stream::DATAGRAM_MAX {
            return Self::TooLarge { bytes };
        }
        Self::System { doing: "send to", address: to, error }
    }
}

/// Gives a machine's loopback what the league's programs need there. Until the next boot.
pub(super) const LOOPBACK_HINT: &str =
    "sudo ip link set lo multicast on && sudo ip route add 224.0.0.0/4 dev lo";

pub(super) fn multicast_group(group: SocketAddrV4) -> Result<Ipv4Addr, NetError> {
    if group.ip().is_multicast() { Ok(*group.ip()) } else { Err(NetError::NotMulticast(*group.ip())) }
}

/// Advice where there is no route to an address.
fn route_hint(to: &SocketAddr) -> String {
    if to.ip().is_multicast() {
        format!("choose an interface, or on this machine alone: `{LOOPBACK_HINT}`")
    } else {
        "is the network up, and the address right?".to_owned()
    }
}

/// Each interface with its error, after a semicolon.
fn listed(tried: &[(String, io::Error)]) -> String {
    tried.iter().fold(String::new(), |text, (name, error)| text + "; " + name + ": " + &error.to_string())
}
