//! `lossy`: a base station on UDP that loses packets, for tests with a robot of simulated parts.

use std::net::{SocketAddr, UdpSocket};

/// Base station between a robot and the host that has sent to it last.
pub(crate) struct LossyStation<'s> {
    socket: &'s UdpSocket,
    /// Share of packets that are lost, both ways.
    loses: f32,
    dice: u32,
    host: Option<SocketAddr>,
}

impl<'s> LossyStation<'s> {
    pub(crate) fn new(socket: &'s UdpSocket, loses: f32) -> Self {
        socket.set_nonblocking(true).expect("a socket");
        Self { socket, loses, dice: 1, host: None }
    }

    /// Whether a host has sent something, even if it was lost.
    pub(crate) fn has_host(&self) -> bool {
        self.host.is_some()
    }

    /// Hands over the packets that have come and are not lost.
    pub(crate) fn receive(&mut self, mut take: impl FnMut(&[u8])) {
        let mut bytes = [0; 200];
        while let Ok((len, from)) = self.socket.recv_from(&mut bytes) {
            self.host = Some(from);
            if !self.is_lost() {
                take(&bytes[..len]);
            }
        }
    }

    /// Sends to the host, unless the packet is lost.
    pub(crate) fn send(&mut self, packet: &[u8]) {
        let is_lost = self.is_lost();
        if let Some(host) = self.host.filter(|_| !is_lost) {
            let _ = self.socket.send_to(packet, host);
        }
    }

    fn is_lost(&mut self) -> bool {
        self.dice = self.dice.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        ((self.dice >> 8) as f32 / 16_777_216.0) < self.loses
    }
}
