//! `identity`: sender of a referee's packet, and the referee that the operator has chosen. A source is the
//! identifier in its packets *and* the address they came from: the identifier is public and can be forged,
//! and two programs on one machine may use the same one.
//!
//! The port belongs to the address. A controller that is restarted gets another port (and usually another
//! identifier), so for up to [`SILENCE`](super::SILENCE) it stands beside its predecessor and the stricter of
//! the two is obeyed; that costs a stop of 3 s at most. Without the port two programs on one machine with
//! equal identifiers would be one source that changes its command with every packet.

use std::fmt;
use std::net::{IpAddr, Ipv6Addr, SocketAddr};

/// Longest part of a foreign identifier that is printed, characters: a controller's own is a UUID of 36.
const PRINTED_CHARS_MAX: usize = 48;

/// The network address of a packet's sender. IPv4-mapped IPv6 addresses are stored as IPv4; scope and flow
/// are dropped.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SenderAddress {
    ip: IpAddr,
    port: u16,
}

impl SenderAddress {
    /// The sender of packets that came over no network: a referee in this process, or a recording without
    /// addresses.
    pub const INTERNAL: Self = Self { ip: IpAddr::V6(Ipv6Addr::UNSPECIFIED), port: 0 };
    /// Length of [`SenderAddress::to_bytes`], bytes.
    pub const LEN: usize = 18;

    /// The address of a datagram's sender.
    pub fn new(address: SocketAddr) -> Self {
        Self { ip: address.ip().to_canonical(), port: address.port() }
    }

    /// The machine's IP address.
    pub const fn ip(self) -> IpAddr {
        self.ip
    }

    /// Bytes as a trace stores them: IPv6 (IPv4 mapped), 16 bytes, then the port, little endian.
    pub fn to_bytes(self) -> [u8; Self::LEN] {
        let ip = match self.ip {
            IpAddr::V4(ip) => ip.to_ipv6_mapped(),
            IpAddr::V6(ip) => ip,
        };
        let mut bytes = [0; Self::LEN];
        bytes[..16].copy_from_slice(&ip.octets());
        bytes[16..].copy_from_slice(&self.port.to_le_bytes());
        bytes
    }

    /// From the bytes of a trace.
    pub fn from_bytes(bytes: [u8; Self::LEN]) -> Self {
        let mut ip = [0; 16];
        ip.copy_from_slice(&bytes[..16]);
        Self { ip: IpAddr::from(ip).to_canonical(), port: u16::from_le_bytes([bytes[16], bytes[17]]) }
    }
}

impl From<SocketAddr> for SenderAddress {
    fn from(address: SocketAddr) -> Self {
        Self::new(address)
    }
}

impl fmt::Display for SenderAddress {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if *self == Self::INTERNAL {
            f.write_str("this program")
        } else {
            SocketAddr::new(self.ip, self.port).fmt(f)
        }
    }
}

/// A referee: its identifier and its address.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SourceKey {
    /// `source_identifier` of its packets; foreign text, [`fmt::Display`] escapes it.
    pub identifier: Option<String>,
    /// Address that its packets come from.
    pub address: SenderAddress,
}

impl fmt::Display for SourceKey {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.identifier {
            Some(identifier) => {
                write!(f, "\"{}\" at {}", foreign::excerpt(identifier, PRINTED_CHARS_MAX), self.address)
            }
            None => write!(f, "a referee without identifier at {}", self.address),
        }
    }
}

/// The only referee that robots obey (`--referee-source`).
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SourcePin {
    /// Every source on this machine: a restart of the controller changes its port and its identifier, not
    /// this.
    Machine(IpAddr),
    /// This address with its port.
    Address(SenderAddress),
    /// This identifier, wherever it comes from.
    Identifier(String),
}

impl SourcePin {
    /// From the text of a setting: an IP address, an address with a port, and anything else is an identifier.
    pub fn of(text: &str) -> Self {
        if let Ok(ip) = text.parse::<IpAddr>() {
            Self::Machine(ip.to_canonical())
        } else if let Ok(address) = text.parse::<SocketAddr>() {
            Self::Address(SenderAddress::new(address))
        } else {
            Self::Identifier(text.to_owned())
        }
    }

    /// Whether it names that source.
    pub fn matches(&self, source: &SourceKey) -> bool {
        match self {
            Self::Machine(ip) => *ip == source.address.ip,
            Self::Address(address) => *address == source.address,
            Self::Identifier(identifier) => source.identifier.as_ref() == Some(identifier),
        }
    }
}

impl fmt::Display for SourcePin {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Machine(ip) => ip.fmt(f),
            Self::Address(address) => SocketAddr::new(address.ip, address.port).fmt(f),
            Self::Identifier(identifier) => f.write_str(identifier),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn address(text: &str) -> SenderAddress {
        SenderAddress::new(text.parse().unwrap())
    }

    #[test]
    fn an_address_survives_a_trace_and_a_mapped_one_is_the_plain_one() {
        for text in ["192.168.1.7:41234", "[2001:db8::1]:9"] {
            let address = address(text);
            assert_eq!(SenderAddress::from_bytes(address.to_bytes()), address);
            assert_eq!(address.to_string(), text);
        }
        assert_eq!(SenderAddress::from_bytes(SenderAddress::INTERNAL.to_bytes()), SenderAddress::INTERNAL);
        assert_eq!(address("[::ffff:10.0.0.1]:5"), address("10.0.0.1:5"));
    }

    #[test]
    fn a_pin_is_a_machine_an_address_or_an_identifier() {
        let source = |identifier: &str, from| SourceKey {
            identifier: Some(identifier.into()),
            address: address(from),
        };
        let pin = SourcePin::of;
        let genuine = source("gc", "10.0.0.1:50000");
        for text in ["10.0.0.1", "10.0.0.1:50000", "gc"] {
            assert!(pin(text).matches(&genuine), "{text}");
            assert_eq!(pin(text).to_string(), text);
        }
        assert!(pin("10.0.0.1").matches(&source("restarted", "10.0.0.1:50001")));
        assert!(!pin("10.0.0.1").matches(&source("gc", "10.0.0.2:50000")));
        assert!(!pin("10.0.0.1:50000").matches(&source("gc", "10.0.0.1:50001")));
        assert!(!pin("gc").matches(&source("evil", "10.0.0.1:50000")));
    }

    #[test]
    fn finding_13_a_name_cannot_write_to_the_terminal() {
        let key = SourceKey {
            identifier: Some(format!("gc\x1b]0;pwn\x07\x1b[31m\u{202e}RED\n{}", "x".repeat(5_000))),
            address: address("10.0.0.1:5"),
        };
        let printed = key.to_string();
        assert!(printed.chars().all(|c| !c.is_control() && c != '\u{202e}'), "{printed:?}");
        assert!(printed.len() < 200 && printed.ends_with("at 10.0.0.1:5"), "{printed}");
    }
}
