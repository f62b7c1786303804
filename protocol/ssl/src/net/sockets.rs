//! `sockets`: multicast and unicast sockets: one that receives a group, one that sends to it, one of its own
//! port.

use std::io;
use std::net::{Ipv4Addr, SocketAddr, SocketAddrV4, UdpSocket};
use std::time::Duration;

use socket2::{Domain, Protocol, Socket, Type};

use super::error::multicast_group;
use super::interfaces::find;
use super::{Interface, Interfaces, NetError, interfaces};

/// A received datagram and its sender.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Datagram<'a> {
    /// Bytes of one message.
    pub bytes: &'a [u8],
    /// Address of the sender.
    pub from: SocketAddr,
}

/// Receives a multicast group, beside other programs that receive it too. Datagrams sent straight to its port
/// come as well.
#[derive(Debug)]
pub struct Receiver {
    inbox: Inbox,
    group: Ipv4Addr,
    joined: Vec<Interface>,
}

impl Receiver {
    /// Joins a group on the given interfaces; those it could not join are left out, if any could.
    pub fn join(group: SocketAddrV4, by: &Interfaces) -> Result<Self, NetError> {
        let address = multicast_group(group)?;
        let bound = SocketAddr::from((Ipv4Addr::UNSPECIFIED, group.port()));
        let socket = udp().map_err(|error| NetError::System { doing: "open", address: bound, error })?;
        share(&socket).map_err(|error| NetError::System { doing: "share", address: bound, error })?;
        // A hint: systems that allow less use less.
        let _ = socket.set_recv_buffer_size(RECEIVE_BUFFER);
        socket.bind(&bound.into()).map_err(|error| NetError::bind(bound, true, error))?;
        let mut joined = Vec::new();
        let mut tried = Vec::new();
        for interface in by.choose()? {
            match socket.join_multicast_v4(&address, &interface.address) {
                Ok(()) => joined.push(interface),
                Err(error) => tried.push((interface.to_string(), error)),
            }
        }
        let all_wanted = matches!(by, Interfaces::These(_));
        if joined.is_empty() || (all_wanted && !tried.is_empty()) {
            return Err(NetError::NotJoined { group: address, tried });
        }
        Ok(Self { inbox: Inbox::new(socket.into(), bound), group: address, joined })
    }

    /// Joins the group on interfaces that came or changed since, and leaves out those that went; returns
    /// whether the list changed. Cheap enough for once a second.
    pub fn rejoin(&mut self, by: &Interfaces) -> bool {
        // A named interface that is away comes back, or the next call fails again.
        let Ok(there_are) = by.choose() else { return false };
        let socket = socket2::SockRef::from(&self.inbox.socket);
        let gone = self.joined.extract_if(.., |known| !there_are.contains(known));
        let mut changed = false;
        for interface in gone {
            // Where the interface is gone its membership is, too.
            let _ = socket.leave_multicast_v4(&self.group, &interface.address);
            changed = true;
        }
        for interface in there_are {
            if !self.joined.contains(&interface)
                && socket.join_multicast_v4(&self.group, &interface.address).is_ok()
            {
                self.joined.push(interface);
                changed = true;
            }
        }
        changed
    }

    /// The interfaces it receives on.
    pub fn joined(&self) -> &[Interface] {
        &self.joined
    }

    /// The next datagram, within `wait`; a wait of zero only polls. `None`: none came.
    pub fn receive(&mut self, wait: Duration) -> Result<Option<Datagram<'_>>, NetError> {
        self.inbox.receive(wait)
    }
}

/// Sends to one address: a multicast group, or a single machine.
#[derive(Debug)]
pub struct Sender {
    socket: UdpSocket,
    to: SocketAddr,
    by: Option<Ipv4Addr>,
}

impl Sender {
    /// A sender to a group, by the interface named, or by the one the system chooses. Programs on this
    /// machine receive it too.
    ///
    /// One interface only: a program that receives on several would receive every packet several times.
    pub fn multicast(group: SocketAddrV4, by: Option<&str>) -> Result<Self, NetError> {
        multicast_group(group)?;
        let to = SocketAddr::from(group);
        let system = |error| NetError::System { doing: "open a socket to", address: to, error };
        let by = match by {
            Some(name) => Some(find(name, &interfaces().map_err(system)?)?.address),
            None => None,
        };
        let socket = udp().map_err(system)?;
        socket.set_multicast_ttl_v4(MULTICAST_TTL).map_err(system)?;
        socket.set_multicast_loop_v4(true).map_err(system)?;
        if let Some(interface) = by {
            socket.set_multicast_if_v4(&interface).map_err(system)?;
        }
        Ok(Self { socket: socket.into(), to, by })
    }

    /// A sender to a single machine's port.
    pub fn unicast(to: SocketAddr) -> Result<Self, NetError> {
        let any = if to.is_ipv4() { SocketAddr::from(([0; 4], 0)) } else { SocketAddr::from(([0u16; 8], 0)) };
        let socket = UdpSocket::bind(any).map_err(|error| NetError::bind(any, false, error))?;
        Ok(Self { socket, to, by: None })
    }

    /// Sends one datagram to the group; errors name the interface.
    pub fn send(&self, bytes: &[u8]) -> Result<(), NetError> {
        let sent = self.socket.send_to(bytes, self.to);
        sent.map(drop).map_err(|error| NetError::send(self.to, self.by, bytes.len(), error))
    }

    /// Destination of every datagram.
    pub const fn to(&self) -> SocketAddr {
        self.to
    }
}

/// A UDP port of one's own, for both directions: a simulator's, a robot's, or a client's that receives
/// answers.
///
/// Not shared: of several listeners on one port, a datagram sent straight to it reaches one (README, trap 7).
#[derive(Debug)]
pub struct Port {
    inbox: Inbox,
}

impl Port {
    /// Takes a port; port 0 takes any that is free.
    pub fn bind(address: SocketAddr) -> Result<Self, NetError> {
        let socket = UdpSocket::bind(address).map_err(|error| NetError::bind(address, false, error))?;
        let address = socket.local_addr().unwrap_or(address);
        Ok(Self { inbox: Inbox::new(socket, address) })
    }

    /// Address of the socket, with the port assigned.
    pub const fn address(&self) -> SocketAddr {
        self.inbox.address
    }

    /// The next datagram, within `wait`; a wait of zero only polls. `None`: none came.
    pub fn receive(&mut self, wait: Duration) -> Result<Option<Datagram<'_>>, NetError> {
        self.inbox.receive(wait)
    }

    /// Sends one datagram from this port to `to`.
    pub fn send(&self, to: SocketAddr, bytes: &[u8]) -> Result<(), NetError> {
        let sent = self.inbox.socket.send_to(bytes, to);
        sent.map(drop).map_err(|error| NetError::send(to, None, bytes.len(), error))
    }
}

/// A bound socket and a buffer for its largest datagram, allocated once.
#[derive(Debug)]
struct Inbox {
    socket: UdpSocket,
    address: SocketAddr,
    buffer: Box<[u8]>,
    /// Time-out of the socket; the system is called only when it changes.
    waits: Option<Duration>,
}

impl Inbox {
    fn new(socket: UdpSocket, address: SocketAddr) -> Self {
        Self { socket, address, buffer: vec![0; BUFFER_LEN].into(), waits: None }
    }

    fn receive(&mut self, wait: Duration) -> Result<Option<Datagram<'_>>, NetError> {
        let system = |error| NetError::System { doing: "receive on", address: self.address, error };
        if self.waits != Some(wait) {
            self.socket.set_nonblocking(wait.is_zero()).map_err(system)?;
            if !wait.is_zero() {
                self.socket.set_read_timeout(Some(wait)).map_err(system)?;
            }
            self.waits = Some(wait);
        }
        match self.socket.recv_from(&mut self.buffer) {
            Ok((length, from)) => Ok(Some(Datagram { bytes: &self.buffer[..length], from })),
            Err(error) if is_silence(&error) => Ok(None),
            Err(error) => Err(system(error)),
        }
    }
}

/// Returns whether nothing came, a signal came instead, or an earlier answer of ours found no receiver.
fn is_silence(error: &io::Error) -> bool {
    use io::ErrorKind::{ConnectionRefused, ConnectionReset, Interrupted, TimedOut, WouldBlock};
    matches!(error.kind(), WouldBlock | TimedOut | Interrupted | ConnectionRefused | ConnectionReset)
}

fn udp() -> io::Result<Socket> {
    Socket::new(Domain::IPV4, Type::DGRAM, Some(Protocol::UDP))
}

/// Lets other programs receive on the same port.
fn share(socket: &Socket) -> io::Result<()> {
    socket.set_reuse_address(true)?;
    #[cfg(unix)]
    socket.set_reuse_port(true)?;
    Ok(())
}

/// Time to live, as the game controller's.
const MULTICAST_TTL: u32 = 32;

/// The largest datagram and a byte, so that truncation is detected.
const BUFFER_LEN: usize = crate::stream::DATAGRAM_MAX + 1;

/// Bytes of the system's receive buffer: half a second of vision (four cameras, 100 Hz, 2 kB).
const RECEIVE_BUFFER: usize = 512 * 1024;
