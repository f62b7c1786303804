//! `network_page`: a robot's place in an IP network, a page of the flash beside the one of its identity
//! ([`crate::provision`]): 32 bytes.
//!
//! `magic 4 "1-2N" | own address 4 | prefix 1 | gateway 4 | radio address 4, port 2 | body address 4, port 2
//! | own port 2`, padded with 0xff; addresses in network order, ports little endian. The radio's address is
//! where the robot's frames go: a base station, an access point's program, or a broadcast address. The body's
//! is where a robot without motors of its own sends its orders: a simulator's bridge.

use core::net::{Ipv4Addr, SocketAddrV4};

/// Bytes of a page.
pub const PAGE_LEN: usize = 32;
const MAGIC: [u8; 4] = *b"1-2N";

/// Addresses of a robot on the network.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NetworkPage {
    /// Address of the robot.
    pub own: Ipv4Addr,
    /// Leading bits of the address that its network shares, at most 32.
    pub prefix: u8,
    /// The way out of its network.
    pub gateway: Ipv4Addr,
    /// The port on which it receives radio frames.
    pub port: u16,
    /// Destination of its radio frames.
    pub radio: SocketAddrV4,
    /// Destination of the orders to its body, and source of its sensor frames.
    pub body: SocketAddrV4,
}

/// The page for a robot.
pub fn page(network: &NetworkPage) -> [u8; PAGE_LEN] {
    let mut page = [0xff; PAGE_LEN];
    let end = |end: &SocketAddrV4| (end.ip().octets(), end.port().to_le_bytes());
    let ((radio, radio_port), (body, body_port)) = (end(&network.radio), end(&network.body));
    let fields = MAGIC
        .iter()
        .chain(&network.own.octets())
        .chain(&[network.prefix])
        .chain(&network.gateway.octets())
        .chain(&radio)
        .chain(&radio_port)
        .chain(&body)
        .chain(&body_port)
        .chain(&network.port.to_le_bytes())
        .copied()
        .collect::<heapless::Vec<u8, PAGE_LEN>>();
    page.iter_mut().zip(fields).for_each(|(to, from)| *to = from);
    page
}

/// Reads a page; `None` where there is none, or its prefix is longer than an address.
pub fn read(page: &[u8]) -> Option<NetworkPage> {
    let rest = page.strip_prefix(&MAGIC)?;
    let (own, rest) = address(rest)?;
    let (&prefix, rest) = rest.split_first()?;
    let (gateway, rest) = address(rest)?;
    let (radio, rest) = endpoint(rest)?;
    let (body, rest) = endpoint(rest)?;
    let (port, _) = rest.split_first_chunk()?;
    let port = u16::from_le_bytes(*port);
    (prefix <= 32).then_some(NetworkPage { own, prefix, gateway, port, radio, body })
}

fn address(bytes: &[u8]) -> Option<(Ipv4Addr, &[u8])> {
    let (octets, rest) = bytes.split_first_chunk::<4>()?;
    Some((Ipv4Addr::from(*octets), rest))
}

fn endpoint(bytes: &[u8]) -> Option<(SocketAddrV4, &[u8])> {
    let (ip, rest) = address(bytes)?;
    let (port, rest) = rest.split_first_chunk()?;
    Some((SocketAddrV4::new(ip, u16::from_le_bytes(*port)), rest))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_is_read_as_written_at_the_specified_offsets() {
        let network = NetworkPage {
            own: Ipv4Addr::new(10, 0, 2, 15),
            prefix: 24,
            gateway: Ipv4Addr::new(10, 0, 2, 2),
            port: 0x0102,
            radio: SocketAddrV4::new(Ipv4Addr::new(1, 2, 3, 4), 0x0506),
            body: SocketAddrV4::new(Ipv4Addr::new(7, 8, 9, 10), 0x0b0c),
        };
        let bytes = page(&network);
        assert_eq!(&bytes[..13], b"1-2N\x0a\x00\x02\x0f\x18\x0a\x00\x02\x02");
        assert_eq!(&bytes[13..27], &[1, 2, 3, 4, 6, 5, 7, 8, 9, 10, 0x0c, 0x0b, 2, 1]);
        assert_eq!(read(&bytes), Some(network));
    }

    #[test]
    fn empty_flash_a_short_page_and_a_prefix_that_is_none_are_refused() {
        assert_eq!(read(&[0xff; PAGE_LEN]), None);
        let mut page = [0; PAGE_LEN];
        page[..4].copy_from_slice(&MAGIC);
        assert!(read(&page).is_some());
        assert_eq!(read(&page[..26]), None);
        page[8] = 33;
        assert_eq!(read(&page), None);
    }
}
