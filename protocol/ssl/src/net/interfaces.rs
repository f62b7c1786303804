//! `interfaces`: choice of the network interface, among those with IPv4: the league's groups are IPv4.

use std::fmt;
use std::net::{IpAddr, Ipv4Addr};

use super::NetError;

/// An interface that is up and has IPv4.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Interface {
    /// Name in the system: `lo`, `eth0`.
    pub name: String,
    /// First IPv4 address of the interface.
    pub address: Ipv4Addr,
    /// Number in the system: an adapter that is plugged in again has another one.
    pub index: Option<u32>,
}

impl Interface {
    /// Returns whether it leads to this machine only.
    pub const fn is_loopback(&self) -> bool {
        self.address.is_loopback()
    }
}

impl fmt::Display for Interface {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} ({})", self.name, self.address)
    }
}

/// Choice of the interfaces on which a group is joined.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Interfaces {
    /// Every interface that can, loopback included: vision is received from any of them.
    #[default]
    All,
    /// These, by name or IPv4 address; a missing or unsuitable one is an error.
    These(Vec<String>),
}

impl Interfaces {
    /// This machine only: the interface 127.0.0.1.
    pub fn loopback() -> Self {
        Self::These(vec![Ipv4Addr::LOCALHOST.to_string()])
    }

    /// Resolves the choice against the machine's interfaces.
    pub(super) fn choose(&self) -> Result<Vec<Interface>, NetError> {
        let there_are = interfaces().map_err(|error| NetError::System {
            doing: "list the interfaces of",
            address: (Ipv4Addr::UNSPECIFIED, 0).into(),
            error,
        })?;
        match self {
            Self::All => Ok(there_are),
            Self::These(requested) => requested.iter().map(|requested| find(requested, &there_are)).collect(),
        }
    }
}

/// The interfaces of this machine, each once, in the system's order.
pub fn interfaces() -> std::io::Result<Vec<Interface>> {
    let mut found: Vec<Interface> = Vec::new();
    for interface in if_addrs::get_if_addrs()? {
        if let IpAddr::V4(address) = interface.ip()
            && found.iter().all(|known| known.name != interface.name)
        {
            found.push(Interface { name: interface.name, address, index: interface.index });
        }
    }
    Ok(found)
}

/// An interface by its name or address.
pub(super) fn find(requested: &str, there_are: &[Interface]) -> Result<Interface, NetError> {
    let address: Option<Ipv4Addr> = requested.parse().ok();
    let fits = |interface: &&Interface| interface.name == requested || Some(interface.address) == address;
    there_are.iter().find(fits).cloned().ok_or_else(|| NetError::NoInterface {
        requested: requested.to_owned(),
        there_are: there_are.iter().map(ToString::to_string).collect(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_interface_is_found_by_name_and_by_address() {
        let eth = Interface { name: "eth0".into(), address: Ipv4Addr::new(192, 0, 2, 2), index: None };
        let lo = Interface { name: "lo".into(), address: Ipv4Addr::LOCALHOST, index: None };
        let there_are = [lo.clone(), eth.clone()];
        assert_eq!(find("eth0", &there_are).expect("by name"), eth);
        assert_eq!(find("127.0.0.1", &there_are).expect("by address"), lo);
        let error = find("wlan0", &there_are).expect_err("there is none").to_string();
        assert!(error.contains("`wlan0`") && error.contains("lo (127.0.0.1), eth0 (192.0.2.2)"), "{error}");
    }

    #[test]
    fn this_machine_has_a_loopback() {
        let found = interfaces().expect("the system tells");
        assert_eq!(found.iter().filter(|interface| interface.is_loopback()).count(), 1, "{found:?}");
    }
}
