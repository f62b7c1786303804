//! `address`: addresses as people write them: a machine by name or by IPv4 or IPv6 address, and a port.

use std::net::{IpAddr, SocketAddr, ToSocketAddrs as _};

/// Splits `HOST:PORT` or `[IPV6]:PORT`; without a port the given one counts. `None`: it is neither.
pub fn split_address(text: &str, port: Option<u16>) -> Option<(&str, u16)> {
    let (host, after) = match text.strip_prefix('[') {
        Some(rest) => {
            let (host, after) = rest.split_once(']')?;
            host.parse::<std::net::Ipv6Addr>().ok()?;
            (host, after)
        }
        // More than one colon: an IPv6 address without a port.
        None if text.matches(':').count() > 1 => {
            text.parse::<std::net::Ipv6Addr>().ok()?;
            (text, "")
        }
        None => text.split_at(text.find(':').unwrap_or(text.len())),
    };
    let port = match after.strip_prefix(':') {
        Some(digits) => digits.parse().ok()?,
        None if after.is_empty() => port?,
        None => return None,
    };
    (!host.is_empty()).then_some((host, port))
}

/// The address of a machine's port, as [`split_address`] takes it; names are looked up, IPv4 first, since the
/// league's programs use it.
pub fn resolve(text: &str, port: Option<u16>) -> Result<SocketAddr, String> {
    let (host, port) = split_address(text, port).ok_or_else(|| {
        let example = if port.is_some() { "HOST[:PORT]" } else { "HOST:PORT" };
        format!("expected {example}, such as localhost:10006, 192.168.1.7:10006 or [::1]:10006")
    })?;
    if let Ok(address) = host.parse::<IpAddr>() {
        return Ok(SocketAddr::new(address, port));
    }
    let found: Vec<SocketAddr> = (host, port)
        .to_socket_addrs()
        .map_err(|error| format!("no machine `{host}` is known here ({error}); give its address"))?
        .collect();
    let first = found.iter().find(|address| address.is_ipv4()).or(found.first());
    first.copied().ok_or_else(|| format!("`{host}` has no address; give one"))
}

/// The same for a port that datagrams are sent to: 0 is none.
pub fn resolve_destination(text: &str, port: Option<u16>) -> Result<SocketAddr, String> {
    let address = resolve(text, port)?;
    if address.port() == 0 { Err("port 0 is none; ports are 1 to 65535".to_owned()) } else { Ok(address) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn machines_are_named_by_address_of_either_kind_and_by_name() {
        for (text, port, expected) in [
            ("127.0.0.1:80", None, Some("127.0.0.1:80")),
            ("127.0.0.1", Some(7), Some("127.0.0.1:7")),
            ("localhost:10008", None, Some("127.0.0.1:10008")),
            ("localhost", Some(9), Some("127.0.0.1:9")),
            ("[::1]:80", None, Some("[::1]:80")),
            ("[::1]", Some(5), Some("[::1]:5")),
            ("::1", Some(5), Some("[::1]:5")),
            ("fe80::1", None, None),
            ("localhost", None, None),
            ("", Some(1), None),
            (":80", None, None),
            ("host:", Some(1), None),
            ("[::1]80", None, None),
            ("[localhost]:80", None, None),
            ("127.0.0.1:65536", None, None),
            (":::9", None, None),
        ] {
            let found = resolve(text, port).ok().map(|address| address.to_string());
            assert_eq!(found.as_deref(), expected, "{text}");
        }
        assert!(
            resolve("no-such-machine.invalid:1", None).is_err_and(|error| error.contains("no-such-machine"))
        );
        assert!(resolve_destination("127.0.0.1:0", None).is_err_and(|error| error.contains("port 0")));
    }
}
