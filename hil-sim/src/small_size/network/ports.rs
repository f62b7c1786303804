//! `ports`: the ports that clients command the simulator by: the league's three, and grSim's own. A port in
//! use is reported, and opened as soon as it is free.

use std::net::{IpAddr, SocketAddr};
use std::time::{Duration, Instant};

use crate::small_size::server::{self, Server};
use rules::Colour;
use ssl::net::Port;

use super::commanders::Commanders;

/// A port in use is tried again this often.
const REOPEN_AFTER: Duration = Duration::from_secs(1);
/// Most datagrams of one port between two steps: a flood of commands must not stop the world.
const DATAGRAMS_MAX: usize = 64;

/// Sockets of the simulation protocol.
#[derive(Debug)]
pub(super) struct Ports {
    endpoints: Vec<Endpoint>,
    tried: Instant,
    commanders: Commanders,
    began: Instant,
}

#[derive(Debug)]
struct Endpoint {
    port: server::Port,
    address: SocketAddr,
    socket: Option<Port>,
    troubled: bool,
}

impl Ports {
    /// Opens the ports that are free, and adds a message for each of the others.
    pub(super) fn open(listen: IpAddr, base: u16, legacy: Option<u16>, lines: &mut Vec<String>) -> Self {
        let entry = |offset: u16, port| {
            let number = if base == 0 { 0 } else { base + offset };
            Endpoint { port, address: SocketAddr::new(listen, number), socket: None, troubled: false }
        };
        let teams = [Colour::Blue, Colour::Yellow].map(server::Port::Team);
        let mut ports = Self {
            endpoints: vec![entry(0, server::Port::Simulator), entry(1, teams[0]), entry(2, teams[1])],
            tried: Instant::now(),
            commanders: Commanders::default(),
            began: Instant::now(),
        };
        if base == 0 {
            ports.take_any();
        }
        ports.endpoints.extend(legacy.map(|number| Endpoint {
            port: server::Port::Legacy,
            address: SocketAddr::new(listen, number),
            socket: None,
            troubled: false,
        }));
        ports.take(lines);
        ports
    }

    /// Three free ports in a row, so that clients need only one number.
    fn take_any(&mut self) {
        let listen = self.endpoints[0].address.ip();
        for _ in 0..100 {
            let Ok(first) = Port::bind(SocketAddr::new(listen, 0)) else { return };
            let base = first.address().port();
            let next = |offset: u16| {
                base.checked_add(offset).and_then(|port| Port::bind(SocketAddr::new(listen, port)).ok())
            };
            if let (Some(second), Some(third)) = (next(1), next(2)) {
                for (entry, socket) in self.endpoints.iter_mut().zip([first, second, third]) {
                    entry.address = socket.address();
                    entry.socket = Some(socket);
                }
                return;
            }
        }
    }

    fn take(&mut self, lines: &mut Vec<String>) {
        for entry in self.endpoints.iter_mut().filter(|entry| entry.socket.is_none()) {
            match Port::bind(entry.address) {
                Ok(socket) => {
                    entry.address = socket.address();
                    entry.socket = Some(socket);
                    if std::mem::take(&mut entry.troubled) {
                        lines.push(format!("{} is free and taken now", entry.address));
                    }
                }
                Err(error) if !entry.troubled => {
                    entry.troubled = true;
                    lines.push(format!("{}: {error}; it is tried again every second, and vision and referee are not sent until then", entry.name()));
                }
                Err(_) => {}
            }
        }
    }

    /// Whether every port is open. The vision of a field that no program can command is not sent: it would be
    /// mixed with that of the field that can be commanded.
    pub(super) fn serve(&self) -> bool {
        self.endpoints.iter().all(|entry| entry.socket.is_some())
    }

    /// Passes received datagrams to the simulator.
    pub(super) fn listen(&mut self, server: &mut Server, lines: &mut Vec<String>) {
        for entry in &mut self.endpoints {
            let Some(socket) = &mut entry.socket else { continue };
            for _ in 0..DATAGRAMS_MAX {
                match socket.receive(Duration::ZERO) {
                    Ok(Some(datagram)) => {
                        if let server::Port::Team(team) = entry.port {
                            let now = self.began.elapsed();
                            lines.extend(self.commanders.receive(now, team, datagram.from, datagram.bytes));
                        }
                        server.handle(entry.port, datagram.from, datagram.bytes);
                    }
                    Ok(None) => break,
                    Err(error) => {
                        lines.push(format!("{}: {error}; it is opened again", entry.name()));
                        entry.socket = None;
                        break;
                    }
                }
            }
        }
        if self.tried.elapsed() >= REOPEN_AFTER {
            self.tried = Instant::now();
            self.take(lines);
        }
    }

    /// Answers a request. An answer that cannot be sent is lost, as any datagram may be.
    pub(super) fn answer(&self, from: server::Port, to: SocketAddr, bytes: &[u8]) {
        if let Some(socket) =
            self.endpoints.iter().find(|entry| entry.port == from).and_then(|entry| entry.socket.as_ref())
        {
            let _ = socket.send(to, bytes);
        }
    }

    /// Sends robots' states, in grSim's older protocol. One that cannot be sent is lost, as any datagram may
    /// be.
    pub(super) fn send_to(&self, to: SocketAddr, bytes: &[u8]) {
        self.answer(server::Port::Legacy, to, bytes);
    }

    /// The addresses that clients send to, for the operator.
    pub(super) fn addresses(&self) -> String {
        let mut endpoints = self.endpoints.iter();
        let first = endpoints.next().map(|entry| entry.address.to_string());
        let others = endpoints.map(|entry| format!("{} {}", entry.name(), entry.address.port()));
        first.into_iter().chain(others).collect::<Vec<_>>().join(", ")
    }
}

impl Endpoint {
    const fn name(&self) -> &'static str {
        match self.port {
            server::Port::Simulator => "control",
            server::Port::Team(Colour::Blue) => "blue robots",
            server::Port::Team(Colour::Yellow) => "yellow robots",
            server::Port::Legacy => "grSim's commands",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_taken_port_is_reported_and_the_others_serve() {
        let home: IpAddr = [127, 0, 0, 1].into();
        let mut lines = Vec::new();
        let first = Ports::open(home, 0, None, &mut lines);
        assert!(lines.is_empty(), "{lines:?}");
        let base = first.endpoints[0].address.port();
        let second = Ports::open(home, base, None, &mut lines);
        assert_eq!(lines.len(), 3, "{lines:?}");
        assert!(lines[0].contains("is taken") && lines[0].contains(&base.to_string()), "{}", lines[0]);
        assert!(first.serve() && !second.serve());
        drop(first);
        let mut second = second;
        lines.clear();
        second.take(&mut lines);
        assert_eq!(lines.len(), 3, "free again: {lines:?}");
        assert!(second.serve());
    }
}
