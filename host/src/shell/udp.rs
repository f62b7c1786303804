//! `udp`: UDP link to robots. A datagram is a frame; one address receives them all: a base station, or the
//! robots' own broadcast or multicast group.

use std::io;
use std::net::{SocketAddr, UdpSocket};
use std::time::Duration;

use protocol::frame::FRAME_LEN_MAX;
use protocol::link::Packet;

use super::{Link, LinkError};
use crate::radio::{Relay, To};

/// The shortest wait that a socket accepts.
const WAIT_MIN: Duration = Duration::from_micros(1);

/// A socket that sends to one address and receives from all; the frames are authenticated by their tags.
#[derive(Debug)]
pub struct UdpLink {
    socket: UdpSocket,
    to: SocketAddr,
}

impl UdpLink {
    /// Resolves `HOST:PORT` and opens a socket.
    pub fn open(address: &str) -> Result<Self, LinkError> {
        let to = ssl::net::resolve_destination(address, None).map_err(|error| LinkError::UnknownHost {
            address: format!("udp://{address}"),
            error: io::Error::other(error),
        })?;
        let socket = bind(to)?;
        // A robots' network may be a broadcast address; where it is not, this does nothing.
        let _ = socket.set_broadcast(true);
        Ok(Self { socket, to })
    }
}

impl Link for UdpLink {
    fn send(&mut self, _to: To, packet: &[u8]) -> Result<(), LinkError> {
        send(&self.socket, self.to, packet)
    }

    fn receive(&mut self, wait: Duration) -> Result<Option<Packet>, LinkError> {
        receive(&self.socket, wait).map(|came| came.map(|(packet, _)| packet))
    }

    fn relay(&self) -> Relay {
        Relay::ToAll
    }

    fn advice(&self) -> String {
        format!(
            "is the base station at {} on, and are the robots on its channel and of this team and key?",
            self.to
        )
    }
}

/// A socket of our own that can reach that address.
pub(super) fn bind(to: SocketAddr) -> Result<UdpSocket, LinkError> {
    let any: SocketAddr = match to {
        SocketAddr::V4(v4) if v4.ip().is_loopback() => ([127, 0, 0, 1], 0).into(),
        SocketAddr::V4(_) => ([0, 0, 0, 0], 0).into(),
        SocketAddr::V6(_) => ([0_u16; 8], 0).into(),
    };
    UdpSocket::bind(any)
        .map_err(|error| LinkError::Socket { doing: format!("open a socket towards {to}"), error })
}

/// Sends, and ignores temporary errors: a full queue, or a receiver that does not listen yet.
pub(super) fn send(socket: &UdpSocket, to: SocketAddr, bytes: &[u8]) -> Result<(), LinkError> {
    match socket.send_to(bytes, to) {
        Ok(_) => Ok(()),
        Err(error) if passes(error.kind()) => Ok(()),
        Err(error) => Err(LinkError::Socket { doing: format!("send to {to}"), error }),
    }
}

/// The next datagram that can be a frame, and its sender.
pub(super) fn receive(socket: &UdpSocket, wait: Duration) -> Result<Option<(Packet, SocketAddr)>, LinkError> {
    let broken = |error| LinkError::Socket { doing: "receive from robots".into(), error };
    // A time of zero would mean for ever.
    socket.set_read_timeout(Some(wait.max(WAIT_MIN))).map_err(broken)?;
    // One byte more than a frame has, so that a longer datagram is detected.
    let mut bytes = [0; FRAME_LEN_MAX + 1];
    match socket.recv_from(&mut bytes) {
        Ok((len, from)) => {
            Ok(Packet::from_slice(bytes.get(..len).unwrap_or(&[])).ok().map(|packet| (packet, from)))
        }
        Err(error) if passes(error.kind()) => Ok(None),
        Err(error) => Err(broken(error)),
    }
}

fn passes(kind: io::ErrorKind) -> bool {
    use io::ErrorKind::{ConnectionRefused, ConnectionReset, Interrupted, TimedOut, WouldBlock};
    matches!(kind, ConnectionRefused | ConnectionReset | Interrupted | TimedOut | WouldBlock)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SECOND: Duration = Duration::from_secs(1);

    #[test]
    fn frames_go_out_and_come_back() {
        let station = UdpSocket::bind("127.0.0.1:0").unwrap();
        let mut link = UdpLink::open(&station.local_addr().unwrap().to_string()).unwrap();
        link.send(To::All, &[1; 30]).unwrap();
        let (frame, from) = receive(&station, SECOND).unwrap().unwrap();
        assert_eq!(frame[..], [1; 30]);
        send(&station, from, &[2; 64]).unwrap();
        assert_eq!(link.receive(SECOND).unwrap().unwrap()[..], [2; 64]);
        send(&station, from, &[3; 500]).unwrap();
        assert_eq!(link.receive(SECOND).unwrap(), None, "no frame is that long");
        assert_eq!(link.receive(Duration::ZERO).unwrap(), None);
    }

    #[test]
    fn no_one_listening_is_no_error_and_an_unknown_host_says_what_to_give() {
        // A port that was just closed: no socket listens there.
        let free = UdpSocket::bind("127.0.0.1:0").unwrap().local_addr().unwrap();
        let mut link = UdpLink::open(&free.to_string()).unwrap();
        for _ in 0..3 {
            link.send(To::All, &[1]).unwrap();
            assert_eq!(link.receive(Duration::from_millis(5)).unwrap(), None);
        }
        let error = UdpLink::open("no.such.host.invalid:1").unwrap_err().to_string();
        assert!(error.contains("udp://HOST:PORT"), "{error}");
    }
}
