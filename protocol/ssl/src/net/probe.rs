//! `probe`: multicast self-test of this machine, run before a user waits in vain for packets.
//!
//! Our own sockets choose their interface and reach each other by loopback on any machine. The league's
//! programs let the system choose, so for them the loopback needs a route; [`route`] finds the interface they
//! will send by.

use std::net::{Ipv4Addr, SocketAddr, SocketAddrV4, UdpSocket};
use std::time::Duration;

use super::error::LOOPBACK_HINT;
use super::{Interfaces, NetError, Receiver, Sender, addresses, interfaces};

/// Result of a packet sent by loopback.
#[derive(Debug)]
pub enum LoopbackProbe {
    /// The probe came back: programs on this machine receive each other.
    Works {
        /// Address by which programs send that let the system choose; not 127.0.0.1: the league's own
        /// programs need this machine's other interface to be received, or the fix.
        league_sends_by: Option<Ipv4Addr>,
    },
    /// The probe was sent and did not come back.
    Silent,
    /// The probe could not be sent, or not be waited for.
    Refused(NetError),
}

impl std::fmt::Display for LoopbackProbe {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Works { league_sends_by: Some(by) } if by.is_loopback() => {
                write!(f, "multicast on this machine works")
            }
            Self::Works { league_sends_by } => {
                write!(f, "multicast on this machine works for onetwo; the league's programs ")?;
                match league_sends_by {
                    Some(by) => write!(f, "send by {by}")?,
                    None => write!(f, "find no route")?,
                }
                write!(f, "; to keep them on this machine: `{LOOPBACK_HINT}`")
            }
            Self::Silent => {
                write!(f, "multicast on this machine is swallowed; a firewall? Otherwise: `{LOOPBACK_HINT}`")
            }
            Self::Refused(error) => write!(f, "multicast on this machine: {error}"),
        }
    }
}

/// Sends a packet to a group by loopback, on an unused port, and waits for it.
pub fn probe_loopback(group: Ipv4Addr, wait: Duration) -> LoopbackProbe {
    match send_and_wait(group, wait) {
        Ok(true) => {
            let league_sends_by = route(SocketAddrV4::new(group, PROBE_PORT)).ok();
            LoopbackProbe::Works { league_sends_by }
        }
        Ok(false) => LoopbackProbe::Silent,
        Err(error) => LoopbackProbe::Refused(error),
    }
}

/// Address of this machine by which the system sends to a group where a program does not choose. Sends
/// nothing.
pub fn route(group: SocketAddrV4) -> Result<Ipv4Addr, NetError> {
    let to = SocketAddr::from(group);
    let any = SocketAddr::from((Ipv4Addr::UNSPECIFIED, 0));
    let socket = UdpSocket::bind(any).map_err(|error| NetError::bind(any, false, error))?;
    socket.connect(to).map_err(|error| NetError::send(to, None, 0, error))?;
    match socket.local_addr() {
        Ok(SocketAddr::V4(by)) => Ok(*by.ip()),
        Ok(SocketAddr::V6(_)) => Err(NetError::NoRoute { to, by: None }),
        Err(error) => Err(NetError::System { doing: "find the route to", address: to, error }),
    }
}

fn send_and_wait(group: Ipv4Addr, wait: Duration) -> Result<bool, NetError> {
    // The system gives an unused port; the next moment it is ours again.
    let any = SocketAddr::from((Ipv4Addr::UNSPECIFIED, 0));
    let port = super::Port::bind(any)?.address().port();
    let to = SocketAddrV4::new(group, port);
    let loopback = interfaces().ok().and_then(|all| all.into_iter().find(super::Interface::is_loopback));
    let Some(loopback) = loopback else {
        return Err(NetError::NoInterface { requested: "lo".into(), there_are: vec![] });
    };
    let mut receiver = Receiver::join(to, &Interfaces::These(vec![loopback.name.clone()]))?;
    Sender::multicast(to, Some(&loopback.name))?.send(PROBE)?;
    let received = receiver.receive(wait)?;
    Ok(received.is_some_and(|datagram| datagram.bytes == PROBE))
}

const PROBE: &[u8] = b"onetwo: does loopback carry multicast?";

/// Any; nothing is sent to it.
const PROBE_PORT: u16 = addresses::VISION.port();
