//! `error`: network errors, and how to fix them.

use std::fmt;
use std::io;
use std::net::{Ipv4Addr, SocketAddr, SocketAddrV4};

use crate::stream::StreamError;

/// Why a socket cannot be opened or used.
#[derive(Debug)]
pub enum NetError {
    /// Another program has bound the port and does not share it.
    Busy {
        /// Address of the port.
        address: SocketAddr,
        /// Whether the port was to be shared (multicast), so that the other program is at fault.
        shared: bool,
    },
    /// No interface of that name or address.
    NoInterface {
        /// Name that was requested.
        wanted: String,
        /// Existing interfaces, `name (address)`.
        there_are: Vec<String>,
    },
    /// No interface could join the group.
    NotJoined {
        /// Address of the group.
        group: Ipv4Addr,
        /// Each interface with its error.
        tried: Vec<(String, io::Error)>,
    },
    /// The group's address is not one: multicast is 224.0.0.0 to 239.255.255.255.
    NotMulticast(Ipv4Addr),
    /// The machine has no route to that address.
    NoRoute {
        /// Destination of the datagram.
        to: SocketAddr,
        /// Address of the interface, if not chosen by the system.
        by: Option<Ipv4Addr>,
    },
    /// A datagram larger than UDP carries.
    TooLarge {
        /// Length of the datagram, bytes.
        bytes: usize,
    },
    /// The TCP connection was not accepted.
    NotConnected {
        /// Address that was to be connected.
        to: SocketAddr,
        /// Cause of the failure.
        error: io::Error,
    },
    /// The peer closed the TCP connection.
    Closed {
        /// Address of the peer.
        by: SocketAddr,
        /// Bytes of an incomplete message.
        pending: usize,
    },
    /// Bytes received by TCP are no messages of the league's.
    NotFramed {
        /// Address of the sender.
        from: SocketAddr,
        /// Cause of the failure.
        error: StreamError,
    },
    /// A message received by TCP is not of the expected type.
    NotDecoded {
        /// Address of the sender.
        from: SocketAddr,
        /// Cause of the failure.
        error: prost::DecodeError,
    },
    /// Any other error of the system.
    System {
        /// The operation that failed, as a verb.
        doing: &'static str,
        /// Address that it concerned.
        address: SocketAddr,
        /// Cause of the failure.
        error: io::Error,
    },
}

impl NetError {
    pub(super) fn bind(address: SocketAddr, shared: bool, error: io::Error) -> Self {
        match error.kind() {
            io::ErrorKind::AddrInUse => Self::Busy { address, shared },
            io::ErrorKind::AddrNotAvailable => Self::NoInterface {
                wanted: address.ip().to_string(),
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

impl fmt::Display for NetError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Busy { address, shared } => {
                let port = address.port();
                write!(f, "UDP port {port} is taken by a program ")?;
                if *shared {
                    write!(f, "that does not share it (SO_REUSEADDR and SO_REUSEPORT); ")?;
                } else {
                    write!(f, "already; ")?;
                }
                write!(f, "find it with `ss -ulpn 'sport = :{port}'` and end it, or take another port")
            }
            Self::NoInterface { wanted, there_are } => write!(
                f,
                "no network interface `{wanted}` that is up and has IPv4; there are: {}",
                if there_are.is_empty() { "none".to_owned() } else { there_are.join(", ") }
            ),
            Self::NotJoined { group, tried } => {
                write!(f, "no interface could join {group}")?;
                for (name, error) in tried {
                    write!(f, "; {name}: {error}")?;
                }
                write!(f, "; is a network up? On this machine alone: `{LOOPBACK_HINT}`")
            }
            Self::NotMulticast(group) => {
                write!(f, "{group} is no multicast address; vision is 224.5.23.2, the referee 224.5.23.1")
            }
            Self::NoRoute { to, by } => {
                write!(f, "no route to {to}")?;
                if let Some(by) = by {
                    write!(f, " by {by}")?;
                }
                if is_multicast(to) {
                    write!(f, "; choose an interface, or on this machine alone: `{LOOPBACK_HINT}`")
                } else {
                    write!(f, "; is the network up, and the address right?")
                }
            }
            Self::TooLarge { bytes } => {
                write!(f, "a datagram of {bytes} bytes; UDP carries {}", crate::stream::DATAGRAM_MAX)
            }
            Self::NotConnected { to, error } => write!(
                f,
                "nobody answers at {to} ({error}); is the game controller running? Teams: port 10008, automatic referees: \
                 10007"
            ),
            Self::Closed { by, pending: 0 } => write!(f, "{by} closed the connection; connect again"),
            Self::Closed { by, pending } => {
                write!(f, "{by} closed the connection within a message, after {pending} bytes; connect again")
            }
            Self::NotFramed { from, error } => write!(f, "{from}: {error}"),
            Self::NotDecoded { from, error } => {
                write!(f, "{from}: {error}; is it the port for this kind of program?")
            }
            Self::System { doing, address, error } => write!(f, "cannot {doing} {address}: {error}"),
        }
    }
}

impl std::error::Error for NetError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::System { error, .. } | Self::NotConnected { error, .. } => Some(error),
            Self::NotFramed { error, .. } => Some(error),
            Self::NotDecoded { error, .. } => Some(error),
            _ => None,
        }
    }
}

/// Gives a machine's loopback what the league's programs need there. Until the next boot.
pub(super) const LOOPBACK_HINT: &str =
    "sudo ip link set lo multicast on && sudo ip route add 224.0.0.0/4 dev lo";

pub(super) fn multicast_group(group: SocketAddrV4) -> Result<Ipv4Addr, NetError> {
    if group.ip().is_multicast() { Ok(*group.ip()) } else { Err(NetError::NotMulticast(*group.ip())) }
}

fn is_multicast(address: &SocketAddr) -> bool {
    address.ip().is_multicast()
}
