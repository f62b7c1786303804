//! `tracker_in`: the words of `team.toml` for another program's tracker.

use std::fmt;
use std::net::SocketAddr;

use ssl::net::resolve;

use super::{ConfigError, error};

/// The tracker of another program that takes the place of vision while it sends.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TrackerIn {
    /// Multicast group and port, or a port of this machine.
    pub address: SocketAddr,
    /// Name or identifier of the source; none: the first that sends.
    pub name: Option<String>,
}

impl TrackerIn {
    /// From `HOST:PORT` or `HOST:PORT,NAME`.
    pub fn parse(text: &str) -> Result<Self, ConfigError> {
        let (address, name) = match text.split_once(',') {
            Some((address, name)) => (address, Some(name.trim().to_owned())),
            None => (text, None),
        };
        let address = resolve(address.trim(), None)
            .map_err(|reason| error("tracker_in", format!("{reason}; HOST:PORT or HOST:PORT,NAME")))?;
        if name.as_deref() == Some("") {
            return Err(error("tracker_in", "no name after the comma; HOST:PORT or HOST:PORT,NAME"));
        }
        Ok(Self { address, name })
    }
}

impl fmt::Display for TrackerIn {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.address)?;
        self.name.iter().try_for_each(|name| write!(f, ",{name}"))
    }
}
