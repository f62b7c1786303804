//! `endpoint`: a sender and a receiver for any address: multicast where it is a group, unicast where it is
//! one machine's.

use std::net::{Ipv4Addr, SocketAddr};
use std::time::{Duration, Instant};

use super::{Datagram, Interfaces, NetError, Port, Receiver, Sender};

/// Without a network the next one is looked for after this.
const ALONE_FOR: Duration = Duration::from_secs(2);

/// Sends to an address; an error is reported once, not a thousand times a second.
#[derive(Debug)]
pub struct NetSender {
    to: SocketAddr,
    /// The interface to send by; `None`: the system's choice.
    by: Option<String>,
    sender: Option<Sender>,
    troubled: bool,
    /// When it found no network and spoke to this machine alone.
    alone: Option<Instant>,
    /// Number of datagrams sent.
    pub sent: u64,
}

impl NetSender {
    /// The socket is opened with the first datagram.
    pub fn new(to: SocketAddr, by: Option<&str>) -> Self {
        Self { to, by: by.map(str::to_owned), sender: None, troubled: false, alone: None, sent: 0 }
    }

    /// The address that it sends to.
    pub const fn to(&self) -> SocketAddr {
        self.to
    }

    /// Sends to another port of the same address from now on.
    pub fn set_port(&mut self, port: u16) {
        if self.to.port() != port {
            self.to.set_port(port);
            self.sender = None;
        }
    }

    /// Sends; returns a message for the operator where sending starts to fail, recovers, or uses another
    /// interface than requested.
    pub fn send(&mut self, bytes: &[u8]) -> Option<String> {
        if self.alone.is_some_and(|since| since.elapsed() >= ALONE_FOR) {
            // A network may be there by now.
            (self.by, self.sender) = (None, None);
        }
        let trouble = match self.try_send(bytes) {
            Ok(()) => return self.works(),
            Err(NetError::NoRoute { .. }) if self.by.is_none() && self.to.ip().is_multicast() => {
                // Without any network this machine can still be reached.
                self.by = Some(Ipv4Addr::LOCALHOST.to_string());
                self.sender = None;
                let was_alone = self.alone.replace(Instant::now()).is_some();
                match self.try_send(bytes) {
                    Ok(()) => {
                        self.sent += 1;
                        let told = format!("no network leads to {}: only this machine is spoken to", self.to);
                        return (!was_alone).then_some(told);
                    }
                    Err(error) => error.to_string(),
                }
            }
            Err(error) => error.to_string(),
        };
        self.sender = None;
        (!std::mem::replace(&mut self.troubled, true)).then_some(trouble)
    }

    fn works(&mut self) -> Option<String> {
        self.sent += 1;
        if self.by.is_none() && self.alone.take().is_some() {
            return Some(format!("a network leads to {} now", self.to));
        }
        std::mem::take(&mut self.troubled).then(|| format!("{} can be spoken to again", self.to))
    }

    fn try_send(&mut self, bytes: &[u8]) -> Result<(), NetError> {
        let sender = match &mut self.sender {
            Some(sender) => sender,
            None => self.sender.insert(match self.to {
                SocketAddr::V4(to) if to.ip().is_multicast() => Sender::multicast(to, self.by.as_deref())?,
                to => Sender::unicast(to)?,
            }),
        };
        sender.send(bytes)
    }
}

/// Receives from an address: a multicast group shared with other programs, or a port of its own.
#[derive(Debug)]
pub enum NetReceiver {
    /// A multicast group.
    Group(Receiver),
    /// A unicast port.
    Own(Port),
}

impl NetReceiver {
    /// Joins the group, or takes the port.
    pub fn open(address: SocketAddr, by: &Interfaces) -> Result<Self, NetError> {
        match address {
            SocketAddr::V4(group) if group.ip().is_multicast() => Receiver::join(group, by).map(Self::Group),
            address => Port::bind(address).map(Self::Own),
        }
    }

    /// The next datagram, within `wait`.
    pub fn receive(&mut self, wait: Duration) -> Result<Option<Datagram<'_>>, NetError> {
        match self {
            Self::Group(receiver) => receiver.receive(wait),
            Self::Own(port) => port.receive(wait),
        }
    }

    /// Joins interfaces that came or changed since ([`Receiver::rejoin`]); returns whether any did.
    pub fn rejoin(&mut self, by: &Interfaces) -> bool {
        match self {
            Self::Group(receiver) => receiver.rejoin(by),
            Self::Own(_) => false,
        }
    }

    /// Interfaces or port that it receives on, for the operator.
    pub fn route(&self) -> String {
        match self {
            Self::Group(receiver) => {
                receiver.joined().iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")
            }
            Self::Own(port) => port.address().to_string(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unicast_needs_no_group() {
        let any: SocketAddr = ([127, 0, 0, 1], 0).into();
        let port = Port::bind(any).expect("a port").address();
        let mut receiver = NetReceiver::open(port, &Interfaces::All).expect("the port is free again");
        let mut sender = NetSender::new(port, None);
        assert_eq!(sender.send(b"hello"), None);
        let received = receiver.receive(Duration::from_secs(5)).expect("no error").expect("a datagram");
        assert_eq!((received.bytes, sender.sent), (&b"hello"[..], 1));
    }

    #[test]
    fn what_cannot_be_sent_is_reported_once() {
        let mut sender = NetSender::new(([127, 0, 0, 1], 9).into(), None);
        let too_large = vec![0; 70_000];
        assert!(sender.send(&too_large).is_some_and(|trouble| trouble.contains("70000")));
        assert_eq!(sender.send(&too_large), None);
    }
}
