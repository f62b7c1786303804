//! `guard`: access control of the page. It admits its own viewers, and no foreign page in the same browser.
//!
//! - **DNS rebinding**: a foreign name is made to point at this machine, so that the browser takes the
//!   foreign page for ours. The name is then in `Host`. Only addresses and `localhost` are answered, which an
//!   attacker cannot point elsewhere.
//! - **Cross-origin**: a foreign page opens our WebSocket or posts to us. Browsers put the page's own origin
//!   into `Origin`; it must equal ours exactly. Programs that are no browsers send none.

use std::net::IpAddr;

use thiserror::Error;

use crate::http::Head;

/// Reason for which a request is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub(crate) enum Foreign {
    /// `Host` is not an address of ours.
    #[error("this page answers to its address or to localhost, with its own port, and to no other name")]
    Host,
    /// `Origin` is another page.
    #[error("another page asks: only this page itself may")]
    Origin,
}

/// Accepts a request to the page on `port` that its own viewer may send.
pub(crate) fn check(head: &Head, port: u16) -> Result<(), Foreign> {
    let host = head.one("host").ok().flatten().ok_or(Foreign::Host)?;
    if !is_ours(host, port) {
        return Err(Foreign::Host);
    }
    let Some(origin) = head.one("origin").map_err(|_| Foreign::Origin)? else { return Ok(()) };
    let same = origin.strip_prefix("http://").is_some_and(|origin| origin.eq_ignore_ascii_case(host));
    if same { Ok(()) } else { Err(Foreign::Origin) }
}

fn is_ours(host: &str, port: u16) -> bool {
    // Browsers leave port 80 out.
    let (name, asked) = match host.rsplit_once(':') {
        Some((name, digits)) if !digits.ends_with(']') => (name, digits.parse().ok()),
        _ => (host, Some(80)),
    };
    let bare = name.strip_prefix('[').and_then(|name| name.strip_suffix(']')).unwrap_or(name);
    asked == Some(port) && (name.eq_ignore_ascii_case("localhost") || bare.parse::<IpAddr>().is_ok())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn asked(host: &str, origin: Option<&str>) -> Result<(), Foreign> {
        let mut headers = vec![("host", host)];
        headers.extend(origin.map(|origin| ("origin", origin)));
        check(&Head::with_headers(&headers), 8080)
    }

    #[test]
    fn addresses_and_localhost_are_answered_on_the_own_port() {
        for host in ["127.0.0.1:8080", "localhost:8080", "LOCALHOST:8080", "[::1]:8080", "192.168.1.7:8080"] {
            assert_eq!(asked(host, None), Ok(()), "{host}");
            assert_eq!(asked(host, Some(&format!("http://{host}"))), Ok(()), "{host}");
        }
    }

    #[test]
    fn a_rebound_dns_name_is_not_answered() {
        for host in [
            "evil.example:8080",
            "localhost.evil.example:8080",
            "127.0.0.1.evil.example:8080",
            "127.0.0.1:8081",
            "127.0.0.1",
            "localhost",
            "",
            ":8080",
        ] {
            assert_eq!(asked(host, None), Err(Foreign::Host), "{host}");
            assert_eq!(asked(host, Some(&format!("http://{host}"))), Err(Foreign::Host), "{host}");
        }
        assert_eq!(check(&Head::default(), 8080), Err(Foreign::Host));
    }

    #[test]
    fn a_request_from_another_page_is_not_answered() {
        for origin in [
            "http://evil.example",
            "http://localhost:8080",
            "http://127.0.0.1:8081",
            "https://127.0.0.1:8080",
            "null",
            "",
        ] {
            assert_eq!(asked("127.0.0.1:8080", Some(origin)), Err(Foreign::Origin), "{origin}");
        }
    }
}
