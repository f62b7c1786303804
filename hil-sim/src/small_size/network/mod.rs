//! `network`: a simulated field on the league's network by one call: the simulation protocol's ports, vision,
//! a referee beside it, and the clock that drives the field (docs/architecture.md §7.3).
//!
//! [`Server`] is a value without sockets; here is what stands around it. It goes on
//! where a port is taken or a network is missing, and reports how to fix it. What an operator sees and asks
//! for goes through [`Spectator`].

mod autoref;
mod ci;
mod commanders;
mod controller;
mod controller_process;
mod failure;
mod field_loop;
mod ports;
mod referee;
mod sync;

use std::net::{IpAddr, SocketAddr};
use std::time::Duration;

pub use ci::{CiController, ControllerChoice};
pub use failure::{CiError, NetworkError};
pub use field_loop::run;

use super::referee::InternalReferee;
use super::server::{Server, ServerSettings};

/// Where a field is served, and with which referee.
#[derive(Clone, Debug)]
pub struct NetworkSettings {
    /// The field, robots and rules.
    pub server: ServerSettings,
    /// Unix time at the start, µs: the referee's clock.
    pub unix_us: u64,
    /// Robots of each team that the internal referee allows; the league's number by default.
    pub robots: Option<u8>,
    /// Simulated seconds a second; clients change it by the protocol.
    pub speed: f32,
    /// Address that accepts control.
    pub listen: IpAddr,
    /// The control port; blue's robots are at the next one, yellow's at the one after. 0: any three that are
    /// free.
    pub port: u16,
    /// grSim's own port for commands, if it is served.
    pub legacy_port: Option<u16>,
    /// Steps by TCP instead of by the clock: blue's port, yellow's is the next one.
    pub sync: Option<SocketAddr>,
    /// Destination of vision.
    pub vision: SocketAddr,
    /// The interface that multicast leaves by.
    pub interface: Option<String>,
    /// Source of referee messages.
    pub referee: RefereeKind,
    /// Destination of the internal referee's packets.
    pub referee_to: SocketAddr,
    /// The human's tasks that an external game controller asks for are done.
    pub assistant: bool,
    /// The external game controller that game events are reported to, `HOST:PORT`.
    pub autoref: Option<String>,
    /// The game controller that is led by the field's clock and decides the match, in place of `referee`.
    pub controller: Option<ControllerChoice>,
    /// Time after which the field ends, s; none: until it is stopped.
    pub duration: Option<f64>,
}

/// Source of referee messages.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RefereeKind {
    /// The referee of our own.
    Internal,
    /// No referee at all.
    None,
    /// A game controller, received on this address.
    Received(SocketAddr),
}

/// What a spectator asks of the field.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FieldRequest {
    /// New speed; 0 pauses.
    pub speed: Option<f32>,
    /// Number of further ticks of 10 ms, after which it stands still.
    pub ticks: u32,
    /// A restart with this seed.
    pub restart: Option<u64>,
}

/// Observer of a field: a terminal, a page, a tracker, or none.
pub trait Spectator {
    /// The ports are open: lines that say where.
    fn started(&mut self, lines: Vec<String>);
    /// A line for the operator.
    fn line(&mut self, line: String);
    /// The state in one line, once a second.
    fn status(&mut self, _status: String) {}
    /// A datagram of vision was sent; `running` is the time since the start. Lines for the operator.
    fn vision(&mut self, _bytes: &[u8], _running: Duration) -> Option<String> {
        None
    }
    /// A packet of the referee was sent or received.
    fn referee(&mut self, _bytes: &[u8], _running: Duration) {}
    /// The field between two steps; what is asked of it.
    fn look(
        &mut self,
        _running: Duration,
        _server: &mut Server,
        _referee: Option<&mut InternalReferee>,
    ) -> FieldRequest {
        FieldRequest::default()
    }
    /// Another game starts, with this seed.
    fn restarted(&mut self, _seed: u64) {}
    /// The field is at its end; only lines follow.
    fn ended(&mut self) {}
}
